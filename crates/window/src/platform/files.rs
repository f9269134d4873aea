//! Files: numbered, never in the place of another, written beside the drawing in the order in which they were asked for.

use std::{
    fs::{self, OpenOptions},
    io::{self, Write as _},
    panic::{AssertUnwindSafe, catch_unwind},
    path::{Path, PathBuf},
    sync::{Arc, mpsc},
    thread::{self, JoinHandle},
};

use crate::shots::NotSaved;

/// Numbers are tried up to here.
const MOST: u32 = 99_999;

type Saved = Result<PathBuf, NotSaved>;
type Work = Box<dyn FnOnce() -> Saved + Send>;

/// A folder that files are added to.
pub(crate) struct Files {
    folder: PathBuf,
    wake: Arc<dyn Fn() + Send + Sync>,
    sender: mpsc::Sender<Saved>,
    saved: mpsc::Receiver<Saved>,
    /// While there has been something to write since [`Files::finish`].
    writer: Option<Writer>,
}

struct Writer {
    work: mpsc::Sender<Work>,
    thread: JoinHandle<()>,
}

impl Files {
    /// Files go into `folder`; `wake` is called from another thread whenever one is written.
    pub(crate) fn new(folder: PathBuf, wake: Arc<dyn Fn() + Send + Sync>) -> Self {
        let (sender, saved) = mpsc::channel();
        Self { folder, wake, sender, saved, writer: None }
    }

    /// What became of the files since this was asked last.
    pub(crate) fn news(&mut self) -> Vec<Saved> {
        self.saved.try_iter().collect()
    }

    /// Waits until all is written; what became of the files that [`Files::news`] did not tell of.
    pub(crate) fn finish(&mut self) -> Vec<Saved> {
        if let Some(Writer { work, thread }) = self.writer.take() {
            drop(work);
            // It cannot panic: what it is given to do may, and is caught.
            let _ = thread.join();
        }
        self.news()
    }

    /// Adds the file that `encode` makes, beside the drawing.
    pub(crate) fn save(
        &mut self,
        stem: &'static str,
        extension: &'static str,
        encode: impl FnOnce() -> io::Result<Vec<u8>> + Send + 'static,
    ) {
        let folder = self.folder.clone();
        let work = move || {
            // A defect of an encoder costs a file and is told.
            let encoded = catch_unwind(AssertUnwindSafe(encode));
            let bytes = encoded.unwrap_or_else(|_| Err(io::Error::other("it cannot be encoded")));
            bytes
                .and_then(|bytes| write(&folder, stem, extension, &bytes))
                .map_err(|source| NotSaved::File { folder, source })
        };
        if let Err(source) = self.hand_over(Box::new(work)) {
            let folder = self.folder.clone();
            // This end of it is here.
            let _ = self.sender.send(Err(NotSaved::File { folder, source }));
        }
    }

    fn hand_over(&mut self, work: Work) -> io::Result<()> {
        let writer = match self.writer.take() {
            Some(writer) => writer,
            None => self.start()?,
        };
        // It listens until the other end is gone.
        let _ = writer.work.send(work);
        self.writer = Some(writer);
        Ok(())
    }

    /// One thread, so that files get their numbers in order.
    fn start(&self) -> io::Result<Writer> {
        let (sender, wake) = (self.sender.clone(), Arc::clone(&self.wake));
        let (work, waiting) = mpsc::channel::<Work>();
        let write_all = move || {
            for work in waiting {
                // Nobody listens once the window is closed.
                let _ = sender.send(work());
                wake();
            }
        };
        let thread = thread::Builder::new().name("files".to_owned()).spawn(write_all)?;
        Ok(Writer { work, thread })
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
