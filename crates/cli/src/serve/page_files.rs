//! The files of the page in a folder. The build script uses this file, too, so that what is built in and what is read from a folder follow one rule.

use std::{
    fs, io,
    path::{Path, PathBuf},
};

/// The page itself, without which a folder is none.
pub(crate) const INDEX: &str = "index.html";

/// More than any page has; a folder with more is another one by mistake.
const MOST_FILES: usize = 5000;

/// The files in a folder and below it, sorted: their paths in addresses, and where they are. Hidden ones are left out.
///
/// # Errors
/// When the folder cannot be read or holds what is no file of a page, such as a link: it could lead out of the folder.
pub(crate) fn page_files(folder: &Path) -> io::Result<Vec<(String, PathBuf)>> {
    if !folder.is_dir() {
        return Err(io::Error::other("there is no such folder"));
    }
    if !folder.join(INDEX).is_file() {
        return Err(io::Error::other(format!("it has no {INDEX}")));
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
        let wrong = |what: &str| Err(io::Error::other(format!("{} {what}", place.display())));
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
                "is neither a file nor a folder (a link, perhaps); put the file itself there",
            );
        }
        if found.len() > MOST_FILES {
            return Err(io::Error::other(format!("it has more than {MOST_FILES} files")));
        }
    }
    Ok(())
}
