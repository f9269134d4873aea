//! Size, times and identity of a file, which reveal a change of its content.

use std::{
    fs::{self, Metadata},
    io,
    path::{Path, PathBuf},
    thread,
    time::{Duration, SystemTime},
};

use corniche_gis::VirtualFile;

/// Common file systems other than FAT record times at least this finely. Two writes within this
/// time may have the same time.
const CLOCK: Duration = Duration::from_millis(20);

/// The state of a file that is recorded before it is read.
#[derive(Debug)]
pub(crate) enum Stamp {
    /// A file on disk; for a raster in an archive, the archive.
    File(PathBuf, FileState),
    /// A file on a server: its size, and its `ETag` if the server gives one.
    Remote { path: PathBuf, bytes: u64, etag: Option<String> },
}

/// The state of a file. Its content cannot change without a change of one of these values: neither
/// by writing, nor by replacing the file, nor by replacing it and restoring its old time.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct FileState {
    /// In bytes.
    pub size: u64,
    modified: Option<SystemTime>,
    /// Device and inode, and the time of the last status change (ctime), which programs cannot set.
    #[cfg(unix)]
    identity: [i64; 4],
}

impl Stamp {
    pub(crate) fn of_file(path: &Path) -> io::Result<Self> {
        Ok(Self::File(path.to_path_buf(), settled(path)?))
    }

    /// The stamp of a name that GDAL's virtual file systems understand.
    pub(crate) fn of_virtual(path: &Path) -> io::Result<Self> {
        if let Some(container) = path.to_str().and_then(container) {
            return Self::of_file(&container);
        }
        let bytes = VirtualFile::open(path)?.into_size()?;
        Ok(Self::Remote { path: path.to_path_buf(), bytes, etag: VirtualFile::etag(path) })
    }

    /// Whether the file still exists and is unchanged; an error if its state cannot be read.
    pub(crate) fn still_holds(&self) -> io::Result<bool> {
        match self {
            Self::File(path, state) => match fs::metadata(path) {
                Ok(now) => Ok(FileState::from_metadata(&now) == *state),
                Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(false),
                Err(error) => Err(error),
            },
            Self::Remote { path, bytes, etag } => {
                // Without this call GDAL answers from its cache and does not ask the server.
                VirtualFile::forget(path);
                let now = VirtualFile::open(path)?.into_size()?;
                match (etag, VirtualFile::etag(path)) {
                    (Some(_), None) => Err(io::Error::other("the server no longer sends its ETag")),
                    (then, etag) => Ok(now == *bytes && etag == *then),
                }
            }
        }
    }
}

impl FileState {
    /// Time of the last modification, nanoseconds since the start of 1970 (negative: before);
    /// `None` if the file system does not record it.
    pub(crate) fn modified_ns(&self) -> Option<i64> {
        let time = self.modified?;
        let nanoseconds = match time.duration_since(SystemTime::UNIX_EPOCH) {
            Ok(after) => i64::try_from(after.as_nanos()).ok()?,
            Err(before) => -i64::try_from(before.duration().as_nanos()).ok()?,
        };
        Some(nanoseconds)
    }

    fn from_metadata(found: &Metadata) -> Self {
        Self {
            size: found.len(),
            modified: found.modified().ok(),
            #[cfg(unix)]
            identity: {
                use std::os::unix::fs::MetadataExt as _;
                [
                    found.dev().cast_signed(),
                    found.ino().cast_signed(),
                    found.ctime(),
                    found.ctime_nsec(),
                ]
            },
        }
    }
}

/// Returns the state of a file, once enough time has passed since its last change that the next
/// change will have another time.
fn settled(path: &Path) -> io::Result<FileState> {
    let mut found = fs::metadata(path)?;
    // A file that is written continuously never settles. Its time reveals its next change.
    for _ in 0..3 {
        let age = found.modified().ok().and_then(|time| time.elapsed().ok());
        if age.is_none_or(|age| age >= CLOCK) {
            break;
        }
        thread::sleep(CLOCK);
        found = fs::metadata(path)?;
    }
    Ok(FileState::from_metadata(&found))
}

/// Returns a name as GDAL takes it, with the path of the file on disk made absolute. The file on
/// disk is the archive of a virtual file, a container (`GPKG:dem.gpkg:heights`), or the whole name.
/// Names of files on a server stay as they are.
pub(crate) fn absolute(name: &str) -> io::Result<String> {
    let file = if name.starts_with("/vsi") {
        match container(name) {
            Some(file) => file,
            None => return Ok(name.to_owned()),
        }
    } else if Path::new(name).exists() {
        PathBuf::from(name)
    } else {
        let part = name.split(':').map(|part| part.trim_matches('"'));
        part.map(Path::new).find(|part| part.is_file()).unwrap_or(Path::new(name)).to_path_buf()
    };
    if file.is_absolute() {
        return Ok(name.to_owned());
    }
    let whole = std::path::absolute(&file)?;
    // Both paths are parts of `name`, which is text.
    Ok(name.replacen(&*file.to_string_lossy(), &whole.to_string_lossy(), 1))
}

/// The file on disk that contains a virtual file: `/vsizip//data/a.zip/inner.hgt`,
/// `/vsisubfile/7_100,/data/a`, `/vsizip/{/data/a}/inner.hgt`.
///
/// `None` for a file on a server, even if a part of its name is the path of a local file.
fn container(name: &str) -> Option<PathBuf> {
    const LOCAL: [&str; 7] =
        ["vsizip", "vsigzip", "vsitar", "vsi7z", "vsirar", "vsisubfile", "vsisparse"];
    let handlers = name.match_indices("/vsi").map(|(at, _)| {
        let rest = &name[at + 1..];
        &rest[..rest.find('/').unwrap_or(rest.len())]
    });
    let mut handlers = handlers.map(|handler| LOCAL.contains(&handler)).peekable();
    if handlers.peek().is_none() || handlers.any(|is_local| !is_local) {
        return None;
    }
    let starts = name.match_indices(['/', ',', '{']).flat_map(|(at, sign)| {
        let is_root = sign == "/" && at > 0;
        is_root.then_some(at).into_iter().chain([at + 1])
    });
    for start in starts {
        let rest = &name[start..];
        let ends = rest.match_indices(['/', '}', '?']).map(|(at, _)| at).chain([rest.len()]);
        let file = ends.map(|end| Path::new(&rest[..end])).find(|path| path.is_file());
        if let Some(file) = file {
            return Some(file.to_path_buf());
        }
    }
    None
}

#[cfg(test)]
#[path = "stamp_tests.rs"]
mod tests;
