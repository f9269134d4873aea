//! The files of the page in a folder. The build script also uses this file, so that the same
//! rules apply to built-in files and to files in a folder.

use std::{
    fs, io,
    path::{Path, PathBuf},
};

/// The page itself, which every folder must have.
pub(crate) const INDEX: &str = "index.html";

/// The largest number of files; a folder with more was named by mistake.
const MOST_FILES: usize = 5000;

/// Lists the files in a folder and its subfolders, sorted: their URL paths, and their paths on
/// disk. Hidden files are skipped.
///
/// # Errors
/// When the folder cannot be read, or has something that is not a file of a page, such as a link,
/// which could lead out of the folder.
pub(crate) fn page_files(folder: &Path) -> io::Result<Vec<(String, PathBuf)>> {
    if !folder.is_dir() {
        return Err(io::Error::other("no such folder"));
    }
    if !folder.join(INDEX).is_file() {
        return Err(io::Error::other(format!("the folder has no {INDEX}")));
    }
    let mut found = Vec::new();
    collect(folder, "", &mut found)?;
    found.sort();
    Ok(found)
}

fn collect(folder: &Path, above: &str, found: &mut Vec<(String, PathBuf)>) -> io::Result<()> {
    for entry in fs::read_dir(folder)? {
        let entry = entry?;
        let place = entry.path();
        let wrong = |what: &str| Err(io::Error::other(format!("{place:?} {what}")));
        let Ok(name) = entry.file_name().into_string() else {
            return wrong("has a name that is not UTF-8; rename it");
        };
        if name.starts_with('.') {
            continue;
        }
        let path = format!("{above}{name}");
        let kind = entry.file_type()?;
        if kind.is_dir() {
            collect(&place, &format!("{path}/"), found)?;
        } else if kind.is_file() {
            found.push((path, place));
        } else {
            return wrong(
                "is neither a file nor a folder (perhaps a link); replace it with the file itself",
            );
        }
        if found.len() > MOST_FILES {
            return Err(io::Error::other(format!("the folder has more than {MOST_FILES} files")));
        }
    }
    Ok(())
}
