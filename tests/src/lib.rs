//! The harness of the scenarios, which run the real binary on real and artificial inputs.

mod binary;
#[cfg(target_os = "linux")]
mod display;
pub mod ground;
mod job;
mod object_storage;
pub mod photo;
pub mod web_servers;

use std::{
    collections::BTreeMap,
    fs,
    io::Read as _,
    path::Path,
    process::{Child, Command, Output, Stdio},
    sync::{Arc, Mutex, OnceLock, PoisonError},
    thread,
    time::{Duration, Instant},
};

pub use binary::binary;
pub use corniche_testing::{
    cases, extract_with_areas, extract_with_boundaries, extract_with_coast, is_full, real_data,
    root, sample, skip, some_of,
};
#[cfg(target_os = "linux")]
pub use display::{Display, without_display};
pub use job::{Job, STORE_HEADER_BYTES, When, went_on};
pub use object_storage::{ObjectStorage, Proxy};
use serde_json::Value;

/// The result of a run of the binary.
#[derive(Debug)]
pub struct Ran {
    /// Exit code; −1 if a signal ended the program.
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

/// Runs commands of a page in a shell in `folder`: `corniche` is on the path, and the first failure
/// ends them.
///
/// # Panics
/// When there is no shell.
#[must_use]
pub fn shell(commands: &str, folder: &Path) -> Ran {
    let program = binary();
    let folders = program.parent().map(Path::to_path_buf).into_iter();
    let path = std::env::var_os("PATH").unwrap_or_default();
    // With the path of the shell, it is spawned without a fork. After a fork, PROJ's handlers
    // occasionally wait forever for a lock of another thread.
    let bash =
        std::env::split_paths(&path).map(|folder| folder.join("bash")).find(|bash| bash.is_file());
    let path = std::env::join_paths(folders.chain(std::env::split_paths(&path)));
    let mut shell = Command::new(bash.expect("bash is on the path"));
    shell.args(["-e", "-o", "pipefail", "-c", commands]).current_dir(folder);
    match shell.env("PATH", path.expect("the path was one before")).output() {
        Ok(output) => output.into(),
        Err(error) => panic!("bash does not start: {error}"),
    }
}

/// Sends a signal to a program, named without `SIG`. Returns whether the program still exists; a
/// program that was waited for does not.
///
/// # Panics
/// When there is no shell.
#[must_use]
pub fn send_signal(child: &Child, name: &str) -> bool {
    // This is the `kill` built into the shell, because a minimal machine has no such program.
    let command = format!("kill -s {name} {} 2>&1", child.id());
    let sent = Command::new("sh").args(["-c", &command]).output();
    sent.unwrap_or_else(|error| panic!("there is no shell: {error}")).status.success()
}

/// Waits for the end of a program whose standard output is not read.
///
/// # Panics
/// When it does not end within five minutes, which a busy machine may take.
#[must_use]
pub fn ended(child: &mut Child) -> Ran {
    let begun = Instant::now();
    let status = loop {
        match child.try_wait() {
            Ok(Some(status)) => break status,
            Ok(None) => assert!(begun.elapsed() < Duration::from_mins(5), "it does not end"),
            Err(error) => panic!("it cannot be waited for: {error}"),
        }
        thread::sleep(Duration::from_millis(20));
    };
    let mut err = String::new();
    let read = child.stderr.take().map(|mut said| said.read_to_string(&mut err));
    assert!(!matches!(read, Some(Err(_))), "its words are text");
    Ran { code: status.code().unwrap_or(-1), out: String::new(), err }
}

/// Starts the binary; its standard output is ignored.
///
/// # Panics
/// When it cannot be started.
#[must_use]
pub fn start(arguments: &[&str]) -> Child {
    let mut command = Command::new(binary());
    command.args(arguments).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::piped());
    command.spawn().unwrap_or_else(|error| panic!("{arguments:?} cannot be started: {error}"))
}

/// Runs the binary to its end, with a short time limit.
///
/// # Panics
/// When it does not end in time.
#[must_use]
pub fn run_soon(arguments: &[&str]) -> Ran {
    let mut child = start(arguments);
    let begun = Instant::now();
    while matches!(child.try_wait(), Ok(None)) {
        if begun.elapsed() > Duration::from_secs(30) {
            let _ = child.kill();
            let _ = child.wait();
            panic!("{arguments:?} hangs");
        }
        thread::sleep(Duration::from_millis(10));
    }
    ended(&mut child)
}

/// The resources that a program used.
#[cfg(target_os = "linux")]
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Costs {
    /// Peak resident memory.
    pub peak_bytes: u64,
    /// CPU seconds of all threads.
    pub cpu_s: f64,
    /// Bytes read from files and other sources, including repeated reads.
    pub read_bytes: u64,
}

/// Waits for the end of a program, and returns the resources that it used, as the kernel reports
/// them while it runs.
///
/// # Panics
/// Panics under the same conditions as [`ended`].
#[cfg(target_os = "linux")]
#[must_use]
pub fn ended_with_costs(child: &mut Child) -> (Ran, Costs) {
    let id = child.id();
    let read = |name: &str| fs::read_to_string(format!("/proc/{id}/{name}"));
    let mut costs = Costs::default();
    while matches!(child.try_wait(), Ok(None)) {
        let text = read("status").unwrap_or_default();
        let line = text.lines().find_map(|line| line.strip_prefix("VmHWM:"));
        let kib = line.and_then(|line| line.trim().strip_suffix(" kB")?.trim().parse::<u64>().ok());
        costs.peak_bytes = kib.map_or(0, |kib| kib * 1024).max(costs.peak_bytes);
        // After the name, which is in brackets, the twelfth and thirteenth numbers are user and
        // system time in hundredths of a second.
        let text = read("stat").unwrap_or_default();
        let numbers = text.rsplit(')').next().unwrap_or_default().split_whitespace();
        let spent: f64 =
            numbers.skip(11).take(2).filter_map(|number| number.parse::<f64>().ok()).sum();
        costs.cpu_s = (spent / 100.0).max(costs.cpu_s);
        let text = read("io").unwrap_or_default();
        let line = text.lines().find_map(|line| line.strip_prefix("rchar: "));
        costs.read_bytes = line.and_then(|bytes| bytes.parse().ok()).unwrap_or(costs.read_bytes);
        thread::sleep(Duration::from_millis(2));
    }
    (ended(child), costs)
}

/// The cells of each line of a flight's table, without the milliseconds, which are last.
///
/// # Panics
/// When it cannot be read, or is not such a table.
#[must_use]
pub fn without_times(csv: &Path) -> Vec<Vec<String>> {
    let text = fs::read_to_string(csv).unwrap_or_else(|error| panic!("no list: {error}"));
    let columns = text.lines().next().unwrap_or_default().split(',');
    let kept = columns.take_while(|name| !name.ends_with("_ms")).count();
    assert!((10..30).contains(&kept), "{text}");
    text.lines().map(|line| line.split(',').take(kept).map(str::to_owned).collect()).collect()
}

/// The folder of an incomplete output within a folder: its name has a random part.
#[must_use]
pub fn unfinished(folder: &Path) -> Option<std::path::PathBuf> {
    let entries = fs::read_dir(folder).ok()?.flatten().map(|entry| entry.path());
    entries
        .into_iter()
        .find(|path| path.is_dir() && path.extension().is_some_and(|ending| ending == "unfinished"))
}

/// The names of the files in a folder, sorted.
///
/// # Panics
/// When the folder cannot be read.
#[must_use]
pub fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap_or_else(|error| panic!("no folder: {error}"));
    let mut names: Vec<String> =
        entries.flatten().map(|entry| entry.file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

/// Whether a command failed because there is no GPU adapter, which is not a failure of the test
/// unless `CORNICHE_REQUIRE_GPU` is set; this is printed. Any other failure is one of the test.
#[must_use]
pub fn lacks_adapter(ran: &Ran) -> bool {
    let lacks = ran.code == 1
        && ran.err.contains("no graphics adapter found")
        && std::env::var_os("CORNICHE_REQUIRE_GPU").is_none();
    if lacks {
        skip("there is no graphics adapter");
    }
    lacks
}

/// Runs a command that draws from `package` to `output`; `None` if there is no adapter.
#[must_use]
pub fn draw(command: &str, package: &Path, output: &Path, options: &[&str]) -> Option<Ran> {
    let mut arguments = vec![command.as_ref(), package.as_os_str(), "-o".as_ref()];
    arguments.push(output.as_os_str());
    arguments.extend(options.iter().map(std::ffi::OsStr::new));
    let ran = corniche(arguments);
    (!lacks_adapter(&ran)).then_some(ran)
}

/// A path as text for the command line.
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

/// The JSON that a command prints.
///
/// # Panics
/// When the command fails or prints something else.
#[must_use]
pub fn json(arguments: &[&str]) -> Value {
    let ran = corniche(arguments);
    assert_eq!(ran.code, 0, "{arguments:?}: {}{}", ran.out, ran.err);
    serde_json::from_str(&ran.out).unwrap_or_else(|error| panic!("{arguments:?}: {error}"))
}

/// The manifest of a package, from `corniche info`.
///
/// # Panics
/// When the package cannot be read.
#[must_use]
pub fn manifest(package: &Path) -> Value {
    json(&["info", text(package), "--json"])["manifest"].take()
}

/// The record of a layer in a manifest; null if the package does not have the layer.
#[must_use]
pub fn layer<'a>(manifest: &'a Value, id: &str) -> &'a Value {
    named(&manifest["layers"], |layer| layer["table"]["id"] == id)
}

/// The objects of a layer in the document of a tile, in their order.
#[must_use]
pub fn objects<'a>(tile: &'a Value, layer: &str) -> &'a [Value] {
    let of_layer = named(&tile["layers"], |of| of["layer"] == layer);
    of_layer["objects"].as_array().map_or(&[], Vec::as_slice)
}

/// The number of objects of each class of a layer that were kept, in the order of the classes.
#[must_use]
pub fn kept(layer: &Value) -> Vec<(&str, u64)> {
    let kept = layer["kept"].as_array().into_iter().flatten();
    kept.filter_map(|of| Some((of["class"].as_str()?, of["objects"].as_u64()?))).collect()
}

/// The first entry of a list that meets a condition; null if there is none.
fn named(list: &Value, is_it: impl Fn(&Value) -> bool) -> &Value {
    let found = list.as_array().and_then(|list| list.iter().find(|of| is_it(of)));
    found.unwrap_or(&Value::Null)
}

/// Writes an ESRI ASCII grid of `columns` × `rows` heights, row by row from the north. `place` has
/// the header lines with its position.
///
/// # Panics
/// When the file cannot be written.
pub fn write_ascii_grid(
    path: &Path,
    [columns, rows]: [usize; 2],
    place: &str,
    height_m: impl Fn(usize, usize) -> f64,
) {
    let mut grid = format!("ncols {columns}\nnrows {rows}\n{place}\n");
    for row in 0..rows {
        for column in 0..columns {
            grid.push_str(&height_m(column, row).to_string());
            grid.push(' ');
        }
        grid.push('\n');
    }
    if let Err(error) = fs::write(path, grid) {
        panic!("{}: {error}", path.display());
    }
}

/// The default error bound of sample packages in tests: a quarter of the cell. With the program's
/// default of a 16th they have 3.6 times the triangles, on which most tests do not depend.
pub const COARSE: [&str; 2] = ["--max-error", "2.5"];

/// Builds the `pass` sample to `package` with more `options`, and with [`COARSE`] triangles if the
/// options have no error bound.
///
/// # Panics
/// When the build fails.
pub fn build_pass(package: &Path, options: &[&str]) {
    let [dem, osm] = [sample("pass/pass-dem.tif"), sample("pass/pass.osm.pbf")];
    let bound = COARSE.iter().filter(|_| !options.contains(&COARSE[0]));
    build_from([&dem, &osm], package, &bound.chain(options).copied().collect::<Vec<_>>());
}

/// The bytes of a package, once it is built.
type Built = Arc<OnceLock<Vec<u8>>>;

/// Sample packages that were built in this process, by their options. The tests `packages` and
/// `kills` check that equal options produce equal bytes.
static PASSES: Mutex<BTreeMap<Vec<String>, Built>> = Mutex::new(BTreeMap::new());

/// Writes the package of the `pass` sample with these options to `package`; it is built once per
/// process.
///
/// # Panics
/// When the build fails, or the file cannot be written.
pub fn copy_pass(package: &Path, options: &[&str]) {
    let key = options.iter().map(|&option| option.to_owned()).collect();
    let built = {
        let mut passes = PASSES.lock().unwrap_or_else(PoisonError::into_inner);
        Arc::clone(passes.entry(key).or_default())
    };
    let bytes = built.get_or_init(|| {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let package = folder.path().join("pass.pmtiles");
        build_pass(&package, options);
        fs::read(package).expect("the build left a package")
    });
    fs::write(package, bytes).unwrap_or_else(|error| panic!("{}: {error}", package.display()));
}

/// Builds `package` from elevation and an extract, with more `options`.
///
/// # Panics
/// When the build fails.
pub fn build_from([dem, osm]: [&Path; 2], package: &Path, options: &[&str]) {
    let inputs = ["build", "--dem", text(dem), "--osm", text(osm), "-o", text(package)];
    let ran = corniche(inputs.iter().chain(options));
    assert_eq!(ran.code, 0, "{}", ran.err);
}

/// Builds the package of these inputs and settings in parts, with a plan and a store in `folder`.
///
/// # Panics
/// When one of the commands fails.
#[must_use]
pub fn built_in_parts<S: AsRef<str>>(folder: &Path, inputs: &[S]) -> Vec<u8> {
    built_in_subtrees(folder, inputs, 0)
}

/// Does the same, with a part for each subtree of a level.
///
/// # Panics
/// When one of the commands fails.
#[must_use]
pub fn built_in_subtrees<S: AsRef<str>>(folder: &Path, inputs: &[S], level: u8) -> Vec<u8> {
    let succeed = |words: &[&str]| {
        let ran = corniche(words);
        assert_eq!(ran.code, 0, "{}{}", ran.out, ran.err);
        ran.out
    };
    let [plan, store, merged] =
        ["plan.json", "store", "merged.pmtiles"].map(|name| folder.join(name));
    let (plan, store) = (text(&plan), text(&store));
    let inputs: Vec<&str> = inputs.iter().map(AsRef::as_ref).collect();
    let subtrees = succeed(&[&["plan", "--subtrees", &level.to_string()], &inputs[..]].concat());
    succeed(&[&["plan", "-o", plan], &inputs[..]].concat());
    for step in ["hashes", "roads", "heights", "top", "tiles"] {
        let words = ["part", plan, "-q", "--store", store, "--step", step];
        if matches!(step, "heights" | "tiles") {
            for subtree in subtrees.lines() {
                succeed(&[&words[..], &["--subtree", subtree]].concat());
            }
        } else {
            succeed(&words);
        }
    }
    succeed(&["merge", plan, "-q", "-o", text(&merged), "--store", store]);
    fs::read(&merged).unwrap_or_else(|error| panic!("{}: {error}", merged.display()))
}
