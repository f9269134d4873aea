//! Harness of the scenarios: runs the real binary on real and made-up inputs.

#[cfg(target_os = "linux")]
mod display;

use std::{
    path::{Path, PathBuf},
    process::{Command, Output},
};

#[cfg(target_os = "linux")]
pub use display::{Display, without_display};

/// The repository's root.
#[must_use]
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().map(Path::to_path_buf).unwrap_or_default()
}

/// A file of the bundled samples.
#[must_use]
pub fn sample(path: &str) -> PathBuf {
    root().join("data-samples").join(path)
}

/// The developers' real data, if they are here: `CORNICHE_DATA`, else `../shared/data`. Says so when not.
#[must_use]
#[expect(clippy::print_stderr, reason = "a test that is skipped says so")]
pub fn real_data(path: &str) -> Option<PathBuf> {
    let folder = std::env::var_os("CORNICHE_DATA").map_or_else(
        || root().parent().map(|up| up.join("shared/data")).unwrap_or_default(),
        PathBuf::from,
    );
    let file = folder.join(path);
    if file.exists() {
        return Some(file);
    }
    eprintln!("skipped: {} is not here; set CORNICHE_DATA to a folder that has it", file.display());
    None
}

/// The binary under test, built before the scenarios by cargo in the same target folder.
///
/// # Panics
/// When it is not there: `cargo test --workspace` builds it, `cargo test -p e2e` alone does not.
#[must_use]
pub fn binary() -> PathBuf {
    // Tests run from target/<profile>/deps; binaries lie one folder up.
    let tests = std::env::current_exe().unwrap_or_default();
    let folder = tests.parent().and_then(Path::parent).map(Path::to_path_buf).unwrap_or_default();
    let binary = folder.join(format!("corniche{}", std::env::consts::EXE_SUFFIX));
    assert!(
        binary.exists(),
        "{} is missing; run cargo build -p corniche-cli first",
        binary.display()
    );
    binary
}

/// What a run of the binary came to.
#[derive(Debug)]
pub struct Ran {
    /// Exit code, −1 when a signal ended it.
    pub code: i32,
    /// Standard output.
    pub out: String,
    /// Standard error.
    pub err: String,
}

impl From<Output> for Ran {
    fn from(output: Output) -> Self {
        Self {
            code: output.status.code().unwrap_or(-1),
            out: String::from_utf8_lossy(&output.stdout).into_owned(),
            err: String::from_utf8_lossy(&output.stderr).into_owned(),
        }
    }
}

/// Runs the binary with `arguments`.
///
/// # Panics
/// When it cannot be started.
#[must_use]
pub fn corniche<I: AsRef<std::ffi::OsStr>>(arguments: impl IntoIterator<Item = I>) -> Ran {
    match Command::new(binary()).args(arguments).output() {
        Ok(output) => output.into(),
        Err(error) => panic!("the binary does not start: {error}"),
    }
}

/// Says that a test was skipped, and why.
#[expect(clippy::print_stderr, reason = "a test that is skipped says so")]
pub fn skipped(why: &str) {
    eprintln!("skipped: {why}");
}

/// Whether a command failed for want of a graphics adapter, which is no failure unless `CORNICHE_REQUIRE_GPU` is set; says
/// so. Any other failure is one.
#[must_use]
pub fn lacks_adapter(ran: &Ran) -> bool {
    let lacks = ran.code == 1
        && ran.err.contains("no graphics adapter found")
        && std::env::var_os("CORNICHE_REQUIRE_GPU").is_none();
    if lacks {
        skipped(&ran.err);
    }
    lacks
}

/// Runs a command that draws from `package` into `output`; `None` where there is no adapter.
#[must_use]
pub fn draw(command: &str, package: &Path, output: &Path, options: &[&str]) -> Option<Ran> {
    let mut arguments = vec![command.as_ref(), package.as_os_str(), "-o".as_ref()];
    arguments.push(output.as_os_str());
    arguments.extend(options.iter().map(std::ffi::OsStr::new));
    let ran = corniche(arguments);
    (!lacks_adapter(&ran)).then_some(ran)
}

/// A path as it is said on the command line.
///
/// # Panics
/// When it is not UTF-8, as all paths of these tests are.
#[must_use]
pub fn text(path: &Path) -> &str {
    match path.to_str() {
        Some(text) => text,
        None => panic!("{} is not UTF-8", path.display()),
    }
}

/// Builds the `pass` sample into `package` with more `options`.
///
/// # Panics
/// When the build fails.
pub fn build_pass(package: &Path, options: &[&str]) {
    let [dem, osm] = [sample("pass/pass-dem.tif"), sample("pass/pass.osm.pbf")];
    let mut arguments = vec![
        "build".into(),
        "--dem".into(),
        dem.into_os_string(),
        "--osm".into(),
        osm.into_os_string(),
        "-o".into(),
        package.as_os_str().to_owned(),
    ];
    arguments.extend(options.iter().map(Into::into));
    let ran = corniche(arguments);
    assert_eq!(ran.code, 0, "{}", ran.err);
}
