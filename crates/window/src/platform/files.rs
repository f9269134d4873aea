//! Files: numbered, never in the place of another, written beside the drawing.

use std::{
    fs::{self, OpenOptions},
    io::{self, Write as _},
    path::{Path, PathBuf},
    sync::{Arc, mpsc},
    thread::{self, JoinHandle},
};

use crate::shots::NotSaved;

/// Numbers are tried up to here.
const MOST: u32 = 99_999;

/// A folder that files are added to.
pub(crate) struct Files {
    folder: PathBuf,
    wake: Arc<dyn Fn() + Send + Sync>,
    sender: mpsc::Sender<Result<PathBuf, NotSaved>>,
    said: mpsc::Receiver<Result<PathBuf, NotSaved>>,
    writers: Vec<JoinHandle<()>>,
}

impl Files {
    /// Files go into `folder`; `wake` is called from another thread whenever one is written.
    pub(crate) fn new(folder: PathBuf, wake: Arc<dyn Fn() + Send + Sync>) -> Self {
        let (sender, said) = mpsc::channel();
        Self { folder, wake, sender, said, writers: Vec::new() }
    }

    /// What became of the files since this was asked last.
    pub(crate) fn news(&mut self) -> Vec<Result<PathBuf, NotSaved>> {
        self.writers.retain(|writer| !writer.is_finished());
        self.said.try_iter().collect()
    }

    /// Waits until all is written; what became of the files that [`Files::news`] did not tell of.
    pub(crate) fn finish(&mut self) -> Vec<Result<PathBuf, NotSaved>> {
        for writer in self.writers.drain(..) {
            // It panicked, then, and said so.
            let _ = writer.join();
        }
        self.said.try_iter().collect()
    }

    /// Adds the file that `encode` makes, beside the drawing.
    pub(crate) fn save(
        &mut self,
        stem: &'static str,
        extension: &'static str,
        encode: impl FnOnce() -> io::Result<Vec<u8>> + Send + 'static,
    ) {
        let (folder, wake, sender) =
            (self.folder.clone(), Arc::clone(&self.wake), self.sender.clone());
        let work = move || {
            let saved = encode().and_then(|bytes| write(&folder, stem, extension, &bytes));
            // Nobody listens once the window is closed.
            let _ = sender.send(saved.map_err(|source| NotSaved::File { folder, source }));
            wake();
        };
        match thread::Builder::new().name("file".to_owned()).spawn(work) {
            Ok(writer) => self.writers.push(writer),
            Err(source) => {
                let folder = self.folder.clone();
                let _ = self.sender.send(Err(NotSaved::File { folder, source }));
            }
        }
    }
}

impl Drop for Files {
    /// A picture taken just before the window was closed is still written.
    fn drop(&mut self) {
        self.finish();
    }
}

/// Writes to the first free number.
fn write(folder: &Path, stem: &str, extension: &str, bytes: &[u8]) -> io::Result<PathBuf> {
    fs::create_dir_all(folder)?;
    for number in 1..=MOST {
        let path = folder.join(format!("{stem}-{number:03}.{extension}"));
        match OpenOptions::new().write(true).create_new(true).open(&path) {
            Ok(mut file) => {
                return match file.write_all(bytes) {
                    Ok(()) => Ok(path),
                    Err(error) => {
                        // Half a picture is of no use; that it cannot be removed adds nothing to the first error.
                        let _ = fs::remove_file(&path);
                        Err(error)
                    }
                };
            }
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
            Err(error) => return Err(error),
        }
    }
    Err(io::Error::other(format!("all numbers up to {MOST} are taken; choose another folder")))
}
