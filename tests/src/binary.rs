//! The program under test, which must not be older than its sources.

use std::{
    fs,
    path::{Path, PathBuf},
    sync::LazyLock,
    time::SystemTime,
};

static BINARY: LazyLock<PathBuf> = LazyLock::new(|| {
    // Tests run from target/<profile>/deps; binaries are one folder up.
    let tests = std::env::current_exe().unwrap_or_default();
    let folder = tests.parent().and_then(Path::parent).map(Path::to_path_buf).unwrap_or_default();
    let binary = folder.join(format!("corniche{}", std::env::consts::EXE_SUFFIX));
    if let Err(why) = check_is_new(&binary) {
        panic!("{why}; run cargo build -p corniche-cli first, or scripts/test");
    }
    binary
});

/// The program under test, which cargo builds in the same target folder before the scenarios.
///
/// # Panics
/// When the program does not exist, or is older than one of its sources: `scripts/test` builds it,
/// `cargo test` alone does not.
#[must_use]
pub fn binary() -> PathBuf {
    BINARY.clone()
}

fn changed(path: &Path) -> Option<SystemTime> {
    fs::metadata(path).and_then(|file| file.modified()).ok()
}

/// Fails when a program is missing or older than one of its sources, with the reason. Cargo lists
/// the sources next to the program, in a file with the extension `d`: `program: source source …`,
/// where spaces in names are escaped by backslashes.
fn check_is_new(binary: &Path) -> Result<(), String> {
    let built = changed(binary).ok_or_else(|| format!("{} is missing", binary.display()))?;
    let list = binary.with_extension("d");
    let text = fs::read_to_string(&list).map_err(|error| format!("{}: {error}", list.display()))?;
    let (_, sources) =
        text.split_once(": ").ok_or_else(|| format!("{} lists nothing", list.display()))?;
    let sources = sources.trim().replace("\\ ", "\0");
    for source in sources.split_whitespace().map(|name| PathBuf::from(name.replace('\0', " "))) {
        // A removed file counts as a change, too.
        if changed(&source).is_none_or(|time| time > built) {
            return Err(format!("{} is older than {}", binary.display(), source.display()));
        }
    }
    Ok(())
}

#[cfg(test)]
#[path = "binary_tests.rs"]
mod tests;
