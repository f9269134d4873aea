//! The files that a name on the command line means: those of a folder, a pattern, a list or an
//! archive.

use std::path::{Path, PathBuf};
use std::{fmt, fs, io};

use gdal::Dataset;

use crate::files::open::utf8_name;
use crate::{FileUse, NameError, library_error};

/// Files in a folder or an archive with one of these endings are treated as elevation files. A VRT
/// is not: it refers to files that may be in the same folder.
const ENDINGS: [&str; 13] =
    ["tif", "tiff", "hgt", "asc", "img", "dem", "dt0", "dt1", "dt2", "bil", "flt", "grd", "jp2"];
/// Endings of packed files, of which GDAL reads the content.
const PACKED: [&str; 2] = ["gz", "zip"];

/// Files in a folder with this ending are treated as extracts.
const EXTRACT_ENDINGS: [&str; 1] = ["pbf"];

/// Files in a folder with one of these endings are treated as photos.
const PHOTO_ENDINGS: [&str; 10] =
    ["tif", "tiff", "jp2", "jpg", "jpeg", "png", "webp", "img", "ecw", "sid"];

/// The kind of files to search for in a folder, by the endings of names.
#[derive(Debug, Clone, Copy)]
pub enum SoughtFiles {
    /// Elevation files.
    Elevation,
    /// Extracts: they end in pbf.
    Extracts,
    /// Photos: they end as images do.
    Photos,
}

impl SoughtFiles {
    /// Whether a file in a folder is of this kind.
    fn has(self, path: &Path) -> bool {
        match self {
            Self::Elevation => has_ending(path, &ENDINGS) || has_ending(path, &PACKED),
            Self::Extracts => has_ending(path, &EXTRACT_ENDINGS),
            Self::Photos => has_ending(path, &PHOTO_ENDINGS) || has_ending(path, &PACKED),
        }
    }
}

impl fmt::Display for SoughtFiles {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (noun, endings) = match self {
            Self::Elevation => ("elevation file", &ENDINGS[..]),
            Self::Extracts => return write!(f, "extract (extension .pbf)"),
            Self::Photos => ("photo", &PHOTO_ENDINGS[..]),
        };
        let endings = endings.join(", ");
        write!(f, "{noun} (extensions {endings}, or these in .gz or .zip)")
    }
}

/// The files that a name means, in order of precedence. The name of one file means this file,
/// whether it exists or not.
///
/// - `@LIST`: a text file with a name on each line, relative to the folder of the list; empty lines
///   and lines that begin with # are ignored. The names may be folders and patterns, but not lists.
/// - A folder: its files with matching endings, sorted by name, without subfolders. A folder that
///   is itself a raster stays one.
/// - A pattern with `*`, `?` or `[…]`: the matching files, sorted by name.
///
/// # Errors
/// When a list cannot be read, a pattern is invalid, or a folder or a pattern has no file.
pub fn expand_name(name: &Path, sought: SoughtFiles) -> Result<Vec<PathBuf>, NameError> {
    let text = utf8_name(name, FileUse::Dem)?;
    match text.strip_prefix('@').filter(|_| !name.exists()) {
        Some(list) => expand_list(Path::new(list), sought),
        None => expand_plain(name, text, sought),
    }
}

fn expand_list(list: &Path, sought: SoughtFiles) -> Result<Vec<PathBuf>, NameError> {
    let unreadable = |source| NameError::List { path: list.to_path_buf(), source };
    // Reading a pipe without a writer would block, and a device has no end.
    if !fs::metadata(list).map_err(unreadable)?.is_file() {
        return Err(unreadable(io::Error::new(
            io::ErrorKind::InvalidInput,
            "it is a folder, a pipe or a device; save it to a file first",
        )));
    }
    let text = fs::read_to_string(list).map_err(unreadable)?;
    // Editors on Windows begin text with a byte order mark.
    let text = text.strip_prefix('\u{feff}').unwrap_or(&text);
    let folder = list.parent().unwrap_or(Path::new(""));
    let lines =
        text.lines().map(str::trim).filter(|line| !line.is_empty() && !line.starts_with('#'));
    let mut files = Vec::new();
    for line in lines {
        let is_elsewhere = line.contains("://") || line.starts_with("/vsi");
        let name = if is_elsewhere { PathBuf::from(line) } else { folder.join(line) };
        let text = utf8_name(&name, FileUse::Dem)?;
        files.extend(expand_plain(&name, text, sought)?);
    }
    if files.is_empty() {
        return Err(NameError::EmptyList { path: list.to_path_buf() });
    }
    Ok(files)
}

fn expand_plain(name: &Path, text: &str, sought: SoughtFiles) -> Result<Vec<PathBuf>, NameError> {
    let is_remote = text.contains("://") || text.starts_with("/vsi");
    if !is_remote && name.is_dir() {
        return expand_folder(name, sought);
    }
    if is_remote || name.exists() || !text.contains(['*', '?', '[']) {
        return Ok(vec![name.to_path_buf()]);
    }
    let refused = |reason: String| NameError::Pattern { pattern: text.to_owned(), reason };
    let found = glob::glob(text).map_err(|error| refused(error.to_string()))?;
    let mut files: Vec<PathBuf> =
        found.collect::<Result<_, _>>().map_err(|error| refused(error.to_string()))?;
    files.retain(|file| file.is_file());
    files.sort();
    if files.is_empty() {
        return Err(refused("no file matches it".to_owned()));
    }
    Ok(files)
}

fn expand_folder(folder: &Path, sought: SoughtFiles) -> Result<Vec<PathBuf>, NameError> {
    library_error::quiet();
    if !matches!(sought, SoughtFiles::Extracts) && Dataset::open(folder).is_ok() {
        return Ok(vec![folder.to_path_buf()]);
    }
    let unreadable = |source| NameError::List { path: folder.to_path_buf(), source };
    let mut files = Vec::new();
    for entry in fs::read_dir(folder).map_err(unreadable)? {
        let path = entry.map_err(unreadable)?.path();
        if path.is_file() && sought.has(&path) {
            files.push(path);
        }
    }
    files.sort();
    if files.is_empty() {
        let path = folder.to_path_buf();
        return Err(NameError::EmptyFolder { path, sought: sought.to_string() });
    }
    Ok(files)
}

/// GDAL's names for the content of a packed file: for `FILE.gz` its content, for `FILE.zip` the
/// elevation files in it, sorted by name. Other names stay unchanged.
///
/// # Errors
/// When an archive cannot be read or contains no elevation file.
pub fn unpack_name(name: PathBuf) -> Result<Vec<PathBuf>, NameError> {
    let text = utf8_name(&name, FileUse::Dem)?;
    let is_inside = ["/vsigzip/", "/vsizip/", "/vsitar/"].iter().any(|at| text.starts_with(at));
    if is_inside {
        return Ok(vec![name]);
    }
    if has_ending(&name, &["gz"]) {
        return Ok(vec![PathBuf::from(format!("/vsigzip/{text}"))]);
    }
    if !has_ending(&name, &["zip"]) {
        return Ok(vec![name]);
    }
    library_error::quiet();
    let archive = format!("/vsizip/{text}");
    let refused = || NameError::Archive { path: name.clone(), endings: ENDINGS.join(", ") };
    let entries = gdal::vsi::read_dir(&archive, true).map_err(|_| refused())?;
    let mut files: Vec<PathBuf> = entries
        .into_iter()
        .filter(|entry| has_ending(entry, &ENDINGS))
        .map(|entry| Path::new(&archive).join(entry))
        .collect();
    files.sort();
    if files.is_empty() { Err(refused()) } else { Ok(files) }
}

fn has_ending(path: &Path, endings: &[&str]) -> bool {
    let ending = path.extension().and_then(|ending| ending.to_str());
    ending.is_some_and(|own| endings.iter().any(|ending| own.eq_ignore_ascii_case(ending)))
}
