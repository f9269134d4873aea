//! Finding the files of the repository.

use std::{
    fs,
    path::{Path, PathBuf},
};

use anyhow::{Context, Result};

/// The repository's root.
#[must_use]
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().map(Path::to_path_buf).unwrap_or_default()
}

/// Every file below `folder` with this extension, sorted. Hidden folders and output folders are
/// skipped; a folder that does not exist has no files.
///
/// # Errors
/// When a folder cannot be listed.
pub fn files_below(folder: &Path, extension: &str) -> Result<Vec<PathBuf>> {
    let mut found = if folder.is_dir() { files_in(folder)? } else { Vec::new() };
    found.retain(|path| path.extension().is_some_and(|found| found == extension));
    Ok(found)
}

/// Every file below `folder`, sorted. Hidden folders and output folders are skipped.
pub(crate) fn files_in(folder: &Path) -> Result<Vec<PathBuf>> {
    let mut found = Vec::new();
    gather(folder, &mut found)?;
    found.sort();
    Ok(found)
}

fn gather(folder: &Path, into: &mut Vec<PathBuf>) -> Result<()> {
    let failed = || format!("cannot list {}", folder.display());
    for entry in fs::read_dir(folder).with_context(failed)? {
        let entry = entry.with_context(failed)?;
        let (path, name) = (entry.path(), entry.file_name());
        let name = name.to_string_lossy();
        let is_output = name.starts_with('.') || name == "target" || name == "demo-out";
        if !path.is_dir() {
            into.push(path);
        } else if !is_output {
            gather(&path, into)?;
        }
    }
    Ok(())
}
