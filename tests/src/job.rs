//! A build in a separate folder, which tests interrupt and resume.

use std::{
    fs,
    path::{Path, PathBuf},
    process::{Child, Command, Stdio},
    thread,
    time::{Duration, Instant},
};

use tempfile::TempDir;

use crate::{Ran, binary, ended, sample, send_signal, text};

/// Bytes at the beginning of each file of a store, before its artifacts or entries.
pub const STORE_HEADER_BYTES: u64 = 48;

/// A build of the sample `pass`, with a list of its defects.
pub struct Job {
    folder: TempDir,
    /// The option for the ground: `--dem` or `--terrain`.
    ground: &'static str,
    inputs: [PathBuf; 2],
    options: Vec<String>,
}

impl Job {
    /// Creates a job with more options.
    ///
    /// # Panics
    /// When its folder cannot be created.
    #[must_use]
    pub fn new(options: &[&str]) -> Self {
        let folder = match tempfile::tempdir() {
            Ok(folder) => folder,
            Err(error) => panic!("no folder: {error}"),
        };
        let inputs = [sample("pass/pass-dem.tif"), sample("pass/pass.osm.pbf")];
        let options = options.iter().map(ToString::to_string).collect();
        Self { folder, ground: "--dem", inputs, options }
    }

    /// The same build from other files.
    #[must_use]
    pub fn with_inputs(self, inputs: [PathBuf; 2]) -> Self {
        Self { inputs, ..self }
    }

    /// The same build onto the terrain of a package.
    #[must_use]
    pub fn on_terrain(self, package: &Path) -> Self {
        let [_, osm] = self.inputs;
        Self { ground: "--terrain", inputs: [package.to_path_buf(), osm], ..self }
    }

    /// The folder of the package, the list of defects and the store.
    #[must_use]
    pub fn folder(&self) -> &Path {
        self.folder.path()
    }

    /// The path of the package.
    #[must_use]
    pub fn package(&self) -> PathBuf {
        self.folder().join("out.pmtiles")
    }

    /// The path of the list of defects.
    #[must_use]
    pub fn defects(&self) -> PathBuf {
        self.folder().join("defects.csv")
    }

    /// The path of its store, unless `--tmp` is given.
    #[must_use]
    pub fn store(&self) -> PathBuf {
        self.folder().join(".out.pmtiles.work")
    }

    fn command(&self, more: &[&str]) -> Command {
        let mut command = Command::new(binary());
        let [ground, osm] = &self.inputs;
        command.args(["build", self.ground, text(ground), "--osm", text(osm)]);
        command.args(["-o", text(&self.package()), "--defects", text(&self.defects())]);
        command.args(&self.options).args(more);
        command
    }

    /// Runs the job to its end.
    ///
    /// # Panics
    /// When the job does not start.
    #[must_use]
    pub fn run(&self, more: &[&str]) -> Ran {
        match self.command(more).output() {
            Ok(output) => output.into(),
            Err(error) => panic!("the binary does not start: {error}"),
        }
    }

    /// Runs the job to its end; it must succeed.
    ///
    /// # Panics
    /// When the job fails.
    pub fn succeed(&self, more: &[&str]) {
        let _ = self.said(more);
    }

    /// Does the same as [`Job::succeed`], and returns the output.
    ///
    /// # Panics
    /// When the job fails.
    #[must_use]
    pub fn said(&self, more: &[&str]) -> Ran {
        let ran = self.run(more);
        assert_eq!(ran.code, 0, "{more:?}: {}", ran.err);
        ran
    }

    /// Starts the job.
    ///
    /// # Panics
    /// When the job does not start.
    #[must_use]
    pub fn start(&self, more: &[&str]) -> Child {
        match self.command(more).stderr(Stdio::piped()).spawn() {
            Ok(child) => child,
            Err(error) => panic!("the binary does not start: {error}"),
        }
    }

    /// Starts the job, and sends a signal as soon as the store has new durable work, or after a
    /// given time. Returns the result, which is a success if the job was faster.
    ///
    /// # Panics
    /// When the job does not start or never ends.
    #[must_use]
    pub fn stop(&self, more: &[&str], signal: &str, when: When) -> Ran {
        let before = self.journal_bytes();
        let mut child = self.start(&[&["--quiet"], more].concat());
        let begun = Instant::now();
        let is_time = || match when {
            When::After(time) => begun.elapsed() >= time,
            When::Worked => self.journal_bytes() > before.max(STORE_HEADER_BYTES),
        };
        while !is_time() && matches!(child.try_wait(), Ok(None)) {
            thread::sleep(Duration::from_millis(2));
        }
        // The job may have been faster.
        let _ = send_signal(&child, signal);
        ended(&mut child)
    }

    /// The names of all files in its folder, ascending.
    ///
    /// # Panics
    /// When the folder cannot be read.
    #[must_use]
    pub fn names(&self) -> Vec<String> {
        let names = files_of(self.folder()).into_iter();
        names.map(|(path, _)| text(&path).to_owned()).collect()
    }

    /// The store's files with their content, without the lock file.
    #[must_use]
    pub fn stored(&self) -> Vec<(PathBuf, Vec<u8>)> {
        let files = files_of(&self.store()).into_iter();
        files
            .filter(|(name, _)| name != Path::new("lock"))
            .map(|(name, path)| (name, fs::read(path).unwrap_or_default()))
            .collect()
    }

    /// Bytes of the longest journal in the store; 0 without one.
    #[must_use]
    pub fn journal_bytes(&self) -> u64 {
        let files = files_of(&self.store()).into_iter();
        let journals = files.filter(|(name, _)| name.extension().is_some_and(|e| e == "journal"));
        journals.filter_map(|(_, path)| Some(fs::metadata(path).ok()?.len())).max().unwrap_or(0)
    }

    /// Whether the store has durable work.
    #[must_use]
    pub fn has_work(&self) -> bool {
        self.journal_bytes() > STORE_HEADER_BYTES
    }

    /// The package and the list of defects, which must be the only files in the folder.
    ///
    /// # Panics
    /// When one is missing, or another file exists.
    #[must_use]
    pub fn result(&self) -> [Vec<u8>; 2] {
        assert_eq!(self.names(), ["defects.csv", "out.pmtiles"]);
        [self.package(), self.defects()].map(|path| match fs::read(&path) {
            Ok(bytes) => bytes,
            Err(error) => panic!("{}: {error}", path.display()),
        })
    }
}

/// Whether a run with `--json-progress` resumed earlier work.
#[must_use]
pub fn went_on(ran: &Ran) -> bool {
    let mut already = ran.err.lines().filter_map(|line| line.split_once("\"already\":"));
    already.any(|(_, rest)| !rest.starts_with('0'))
}

/// The names in a folder, ascending, with their paths.
fn files_of(folder: &Path) -> Vec<(PathBuf, PathBuf)> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let mut files: Vec<_> =
        entries.map(|entry| (PathBuf::from(entry.file_name()), entry.path())).collect();
    files.sort();
    files
}

/// The moment at which a build is stopped.
#[derive(Debug, Clone, Copy)]
pub enum When {
    /// After a fixed time.
    After(Duration),
    /// When the store has more durable work than at the start.
    Worked,
}
