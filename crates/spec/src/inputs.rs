//! The files that a run reads: their names, the hashes of their content, and whether they stayed
//! unchanged.
//!
//! GDAL reads a raster's blocks in any order, and an extract is read ways first, so content is not
//! hashed while it is used. It is hashed once, in an earlier pass. The file system then proves that
//! the bytes used are the bytes hashed: size, times and inode are recorded before the first read of
//! a file, and compared after the last read.
//!
//! ```text
//!   stamp ─► open ─► hash ─► roads, heights … ─► stamp again ─► package
//! ```

mod error;
mod planned_input;
mod servers;
mod stamp;

use std::{
    fs::{self, File},
    io::{self, Read},
    path::{Path, PathBuf},
};

use corniche_gis::{VirtualFile, raster_files};
use corniche_tileset::{InputKind, InputRecord};
use corniche_work::Stage;
use sha2::{Digest, Sha256};

pub use self::{
    error::InputError,
    planned_input::PlannedInput,
    servers::{elevation_names, extract_names, input_name, photo_names},
};
use self::{servers::reach_servers, stamp::Stamp};
use crate::{BuildObserver, hex::hex};

/// All files of a run, as they were before any of them was read.
#[derive(Debug)]
pub struct InputFiles {
    files: Vec<Input>,
}

#[derive(Debug)]
struct Input {
    kind: InputKind,
    /// The path as it was given.
    path: PathBuf,
    name: String,
    content: Content,
    stamp: Stamp,
    /// False for an elevation file outside the requested bounds: its samples are not used, so it is
    /// not hashed.
    is_used: bool,
}

/// The content of an input that is hashed.
#[derive(Debug)]
enum Content {
    File(PathBuf),
    /// The content that GDAL's virtual file system delivers under this name.
    Virtual(PathBuf),
    /// A folder, which has no bytes of its own; the files in it are parts.
    Folder,
}

impl InputFiles {
    /// Finds all files and records their state, before any of them is read for use.
    ///
    /// # Errors
    /// See [`InputError`].
    pub fn find(dem: &[PathBuf], others: OtherInputs<'_>) -> Result<Self, InputError> {
        let named = dem.iter().map(PathBuf::as_path).chain(others.named());
        reach_servers(named)?;
        let mut files: Vec<Input> = Vec::new();
        add_rasters(dem, [InputKind::Dem, InputKind::DemPart], &mut files)?;
        others.add_to(&mut files)?;
        Ok(Self { files })
    }

    /// Finds all files, as [`Self::find`] does, where the terrain comes from a package.
    ///
    /// # Errors
    /// See [`InputError`].
    pub fn find_with_package(package: &Path, others: OtherInputs<'_>) -> Result<Self, InputError> {
        reach_servers(others.named())?;
        let mut files = vec![Input::new(InputKind::Terrain, package)?];
        others.add_to(&mut files)?;
        Ok(Self { files })
    }

    /// Sets which elevation files are used, in their order; the parts of each file go with it.
    pub fn use_only(&mut self, is_used: &[bool]) {
        for (index, is_used) in self.of_elevation(is_used, true) {
            self.files[index].is_used = is_used;
        }
    }

    /// Returns the indices of elevation files, each with its value of `said` in their order, and of
    /// their parts, which have the value of their file.
    fn of_elevation(&self, said: &[bool], otherwise: bool) -> Vec<(usize, bool)> {
        let mut said = said.iter();
        let mut last = otherwise;
        let mut found = Vec::new();
        for (index, input) in self.files.iter().enumerate() {
            match input.kind {
                InputKind::Dem => last = said.next().copied().unwrap_or(otherwise),
                InputKind::DemPart => {}
                _ => continue,
            }
            found.push((index, last));
        }
        found
    }

    /// The number of files.
    #[must_use]
    pub fn count(&self) -> usize {
        self.files.len()
    }

    /// The name of a file, without folders.
    #[must_use]
    pub fn name(&self, index: usize) -> &str {
        &self.files[index].name
    }

    /// The records of all files for a plan, in their order.
    ///
    /// # Errors
    /// See [`InputError`].
    pub fn planned(&self) -> Result<Vec<PlannedInput>, InputError> {
        self.files.iter().map(Input::planned).collect()
    }

    /// Hashes the content of every file. The parts of a raster come after it, sorted.
    ///
    /// # Errors
    /// See [`InputError`].
    pub fn hash(&self, observer: &dyn BuildObserver) -> Result<Vec<InputRecord>, InputError> {
        let mut records: Vec<InputRecord> = Vec::new();
        self.hash_each(
            |_| false,
            observer,
            |_, record| {
                records.push(record);
                Ok::<_, InputError>(())
            },
        )?;
        Self::in_order(&mut records);
        Ok(records)
    }

    /// Hashes the files that are not yet hashed, and passes the record of each to `take`.
    ///
    /// # Errors
    /// See [`InputError`]; also the errors of `take`.
    pub fn hash_each<E: From<InputError>>(
        &self,
        is_done: impl Fn(usize) -> bool,
        observer: &dyn BuildObserver,
        mut take: impl FnMut(usize, InputRecord) -> Result<(), E>,
    ) -> Result<(), E> {
        let used = self.files.iter().filter(|input| input.is_used);
        observer.begin(Stage::Hash, used.map(Input::content_bytes).sum());
        for (index, input) in self.files.iter().enumerate() {
            if is_done(index) {
                let bytes = if input.is_used { input.content_bytes() } else { None };
                observer.already(Stage::Hash, bytes.unwrap_or_default());
            } else {
                take(index, input.hash(observer)?)?;
            }
        }
        observer.end(Stage::Hash);
        Ok(())
    }

    /// Hashes those elevation files that were not marked as used but are needed after all, given in
    /// their order; the parts of each file go with it. Returns the index of each file and its
    /// record.
    ///
    /// # Errors
    /// See [`InputError`].
    pub fn hash_unused(
        &self,
        is_needed: &[bool],
        observer: &dyn BuildObserver,
    ) -> Result<Vec<(u32, InputRecord)>, InputError> {
        let mut found = Vec::new();
        for (index, is_needed) in self.of_elevation(is_needed, false) {
            let input = &self.files[index];
            if is_needed && !input.is_used {
                found.push((index as u32, input.hash_content(observer)?));
            }
        }
        Ok(found)
    }

    /// Sorts the parts of each raster, because GDAL lists them in any order.
    pub fn in_order(records: &mut [InputRecord]) {
        let is_part = |record: &InputRecord| {
            InputKind::DemPart.is_of(record) || InputKind::PhotoPart.is_of(record)
        };
        for parts in records.chunk_by_mut(|a, b| is_part(a) && is_part(b)) {
            parts.sort_by(|a, b| (&a.name, &a.sha256).cmp(&(&b.name, &b.sha256)));
        }
    }

    /// The error to report after a failure: a changed input may be the cause of any other error. An
    /// input whose state cannot be read does not replace the error.
    pub fn changed_instead_of<E: From<InputError>>(&self, error: E) -> E {
        match self.check_unchanged() {
            Err(changed @ InputError::Changed { .. }) => changed.into(),
            _ => error,
        }
    }

    /// Fails if a file has changed since it was found, or if its state cannot be read.
    ///
    /// # Errors
    /// See [`InputError`].
    pub fn check_unchanged(&self) -> Result<(), InputError> {
        for input in &self.files {
            match input.stamp.still_holds() {
                Ok(true) => {}
                Ok(false) => return Err(InputError::Changed { path: input.path.clone() }),
                Err(source) => return Err(InputError::Read { path: input.path.clone(), source }),
            }
        }
        Ok(())
    }
}

/// Adds rasters and, after each raster, the files that it refers to or that belong to it.
fn add_rasters(
    paths: &[PathBuf],
    [kind, part]: [InputKind; 2],
    files: &mut Vec<Input>,
) -> Result<(), InputError> {
    for path in paths {
        // The stamp is taken before GDAL reads the file for the names of its parts.
        let input = Input::new(kind, path)?;
        let parts = raster_files(path)?;
        let is_own = |part: &PathBuf| match &input.content {
            Content::File(own) | Content::Virtual(own) => part == own || part == path,
            Content::Folder => part == path,
        };
        let parts: Vec<PathBuf> = parts.into_iter().filter(|part| !is_own(part)).collect();
        files.push(input);
        for found in parts {
            files.push(Input::new(part, &found)?);
        }
    }
    Ok(())
}

/// The inputs other than the terrain.
#[derive(Debug, Clone, Copy, Default)]
pub struct OtherInputs<'a> {
    /// Photos.
    pub photo: &'a [PathBuf],
    /// The polygon that clips the package.
    pub polygon: Option<&'a Path>,
    /// Extracts.
    pub osm: &'a [PathBuf],
}

impl<'a> OtherInputs<'a> {
    fn named(self) -> impl Iterator<Item = &'a Path> {
        let photos = self.photo.iter().map(PathBuf::as_path);
        photos.chain(self.polygon).chain(self.osm.iter().map(PathBuf::as_path))
    }

    fn add_to(self, files: &mut Vec<Input>) -> Result<(), InputError> {
        add_rasters(self.photo, [InputKind::Photo, InputKind::PhotoPart], files)?;
        if let Some(path) = self.polygon {
            files.push(Input::new(InputKind::Polygon, path)?);
        }
        for path in self.osm {
            files.push(Input::new(InputKind::Osm, path)?);
        }
        Ok(())
    }
}

impl Input {
    fn new(kind: InputKind, path: &Path) -> Result<Self, InputError> {
        let failed = |source| InputError::Read { path: path.to_path_buf(), source };
        // Opening a pipe waits for the program that writes to it, and a pipe cannot be read twice.
        if fs::metadata(path).is_ok_and(|found| !found.is_file() && !found.is_dir()) {
            return Err(InputError::Stream { path: path.to_path_buf() });
        }
        let (content, name) = named(path).ok_or(InputError::Name { path: path.to_path_buf() })?;
        let stamp = match &content {
            Content::File(file) => Stamp::of_file(file),
            Content::Folder => Stamp::of_file(path),
            Content::Virtual(name) => Stamp::of_virtual(name),
        };
        let stamp = stamp.map_err(failed)?;
        Ok(Self { kind, path: path.to_path_buf(), name, content, stamp, is_used: true })
    }

    fn planned(&self) -> Result<PlannedInput, InputError> {
        let failed = |source| InputError::Read { path: self.path.clone(), source };
        let text = self.path.to_str();
        let text = text.ok_or_else(|| InputError::Name { path: self.path.clone() })?;
        let (bytes, modified_ns, etag) = match &self.stamp {
            Stamp::File(_, state) => (state.size, state.modified_ns(), None),
            Stamp::Remote { bytes, etag, .. } => (*bytes, None, etag.clone()),
        };
        // The size of a folder is the size of its list of files, which does not matter.
        let bytes = if matches!(self.content, Content::Folder) { 0 } else { bytes };
        Ok(PlannedInput {
            kind: self.kind.name().to_owned(),
            name: self.name.clone(),
            path: stamp::absolute(text).map_err(failed)?,
            bytes,
            modified_ns,
            etag,
        })
    }

    /// The size of the content that is hashed, if it is known before the content is read.
    fn content_bytes(&self) -> Option<u64> {
        match (&self.content, &self.stamp) {
            (Content::Folder, _) => Some(0),
            (Content::File(_), Stamp::File(_, state)) => Some(state.size),
            (_, Stamp::Remote { bytes, .. }) => Some(*bytes),
            // For a file inside an archive, only the archive's own size is known.
            (Content::Virtual(_), Stamp::File(..)) => None,
        }
    }

    fn hash(&self, observer: &dyn BuildObserver) -> Result<InputRecord, InputError> {
        if self.is_used {
            return self.hash_content(observer);
        }
        Ok(self.record(self.content_bytes().unwrap_or_default(), String::new()))
    }

    fn record(&self, bytes: u64, sha256: String) -> InputRecord {
        InputRecord { kind: self.kind.name().to_owned(), name: self.name.clone(), bytes, sha256 }
    }

    fn hash_content(&self, observer: &dyn BuildObserver) -> Result<InputRecord, InputError> {
        let failed = |source: io::Error| InputError::Read { path: self.path.clone(), source };
        let mut hasher = Sha256::new();
        let bytes = match &self.content {
            Content::Folder => Some(0),
            Content::File(path) => {
                let mut file = File::open(path).map_err(failed)?;
                digest(&mut file, &mut hasher, observer).map_err(failed)?
            }
            Content::Virtual(path) => {
                let mut file = VirtualFile::open(path).map_err(failed)?;
                digest(&mut file, &mut hasher, observer).map_err(failed)?
            }
        };
        Ok(self.record(bytes.ok_or(InputError::Interrupted)?, hex(&hasher.finalize())))
    }
}

/// The number of hashed bytes; `None` when the run was interrupted.
fn digest(
    file: &mut dyn Read,
    hasher: &mut Sha256,
    observer: &dyn BuildObserver,
) -> io::Result<Option<u64>> {
    let mut buffer = vec![0; 1 << 20];
    let mut bytes = 0;
    loop {
        if observer.is_cancelled() {
            return Ok(None);
        }
        match file.read(&mut buffer) {
            Ok(0) => return Ok(Some(bytes)),
            Ok(read) => {
                hasher.update(&buffer[..read]);
                bytes += read as u64;
                observer.advance(Stage::Hash, read as u64);
            }
            Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
            Err(error) => return Err(error),
        }
    }
}

/// The source of an input's bytes, and the input's name without folders; `None` if the name is not
/// UTF-8.
///
/// The two differ for a raster inside a container, as GDAL names it (`GPKG:dem.gpkg:heights`,
/// `NETCDF:"dem.nc":Band1`).
fn named(path: &Path) -> Option<(Content, String)> {
    let short = |path: &Path| path.file_name().unwrap_or_default().to_str().map(str::to_owned);
    if path.is_dir() {
        return Some((Content::Folder, short(path)?));
    }
    if path.exists() {
        return Some((Content::File(path.to_path_buf()), short(path)?));
    }
    let text = path.to_str()?;
    // The path is compared as text, because `Path::starts_with` compares whole components, and
    // prefixes are /vsizip, /vsicurl and so on.
    if text.starts_with("/vsi") {
        // The part after a question mark may contain a secret key for the server.
        let shown = short(Path::new(text.split('?').next().unwrap_or(text)))?;
        return Some((Content::Virtual(path.to_path_buf()), shown));
    }
    let container =
        text.split(':').map(|part| part.trim_matches('"')).find(|part| Path::new(part).is_file());
    match container {
        Some(container) => {
            let name = text.replace(container, &short(Path::new(container))?);
            Some((Content::File(PathBuf::from(container)), name))
        }
        None => Some((Content::File(path.to_path_buf()), short(path)?)),
    }
}

#[cfg(test)]
#[path = "inputs_tests.rs"]
mod tests;
