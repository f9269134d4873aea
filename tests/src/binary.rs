//! The program under test, which must be as new as its sources.

use std::{
    fs,
    path::{Path, PathBuf},
    sync::LazyLock,
    time::SystemTime,
};

static BINARY: LazyLock<PathBuf> = LazyLock::new(|| {
    // Tests run from target/<profile>/deps; binaries lie one folder up.
    let tests = std::env::current_exe().unwrap_or_default();
    let folder = tests.parent().and_then(Path::parent).map(Path::to_path_buf).unwrap_or_default();
    let binary = folder.join(format!("corniche{}", std::env::consts::EXE_SUFFIX));
    if let Err(why) = check_is_new(&binary) {
        panic!("{why}; run cargo build -p corniche-cli first, or scripts/test");
    }
    binary
});

/// The program under test, built before the scenarios by cargo in the same target folder.
///
/// # Panics
/// When it is not there, or older than one of its sources: `scripts/test` builds it, `cargo test` alone does not.
#[must_use]
pub fn binary() -> PathBuf {
    BINARY.clone()
}

fn changed(path: &Path) -> Option<SystemTime> {
    fs::metadata(path).and_then(|file| file.modified()).ok()
}

/// Says why not, when a program is missing or older than a file that it was made of. Cargo lists these files beside it, with the
/// extension `d`: `program: source source …`, where a backslash stands before a space of a name.
fn check_is_new(binary: &Path) -> Result<(), String> {
    let built = changed(binary).ok_or_else(|| format!("{} is missing", binary.display()))?;
    let list = binary.with_extension("d");
    let text = fs::read_to_string(&list).map_err(|error| format!("{}: {error}", list.display()))?;
    let (_, sources) =
        text.split_once(": ").ok_or_else(|| format!("{} lists nothing", list.display()))?;
    let sources = sources.trim().replace("\\ ", "\0");
    for source in sources.split_whitespace().map(|name| PathBuf::from(name.replace('\0', " "))) {
        // A file that was removed has changed, too.
        if changed(&source).is_none_or(|time| time > built) {
            return Err(format!("{} is older than {}", binary.display(), source.display()));
        }
    }
    Ok(())
}

#[cfg(test)]
#[path = "binary_tests.rs"]
mod tests;
