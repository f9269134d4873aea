//! Saves images and flights as files, on a thread of their own and in the order of the requests.
//! The files are numbered, and existing files are never overwritten.

use std::{
    fs::{self, OpenOptions},
    io::{self, Cursor, Write as _},
    panic::{AssertUnwindSafe, catch_unwind},
    path::{Path, PathBuf},
    sync::{Arc, mpsc},
    thread::{self, JoinHandle},
};

use image::{ImageFormat, RgbaImage};

use crate::NotSaved;

/// The largest number in a file name.
const MOST: u32 = 99_999;

type Saved = Result<PathBuf, NotSaved>;
type Work = Box<dyn FnOnce() -> Saved + Send>;
/// Creates the bytes of a file; called outside the drawing thread.
type Encode = Box<dyn FnOnce() -> io::Result<Vec<u8>> + Send>;

/// A folder to which files are added.
pub(crate) struct FileWriter {
    folder: PathBuf,
    wake: Arc<dyn Fn() + Send + Sync>,
    sender: mpsc::Sender<Saved>,
    saved: mpsc::Receiver<Saved>,
    /// `None` while nothing has been written since [`FileWriter::finish`].
    writer: Option<Writer>,
}

struct Writer {
    work: mpsc::Sender<Work>,
    thread: JoinHandle<()>,
}

impl FileWriter {
    /// Creates the writer for files in `folder`; another thread calls `wake` whenever a file is
    /// written.
    pub(crate) fn new(folder: PathBuf, wake: Arc<dyn Fn() + Send + Sync>) -> Self {
        let (sender, saved) = mpsc::channel();
        Self { folder, wake, sender, saved, writer: None }
    }

    /// Saves an image.
    pub(crate) fn save_picture(&mut self, picture: RgbaImage) {
        let encode = move || {
            let mut png = Cursor::new(Vec::new());
            picture.write_to(&mut png, ImageFormat::Png).map_err(io::Error::other)?;
            Ok(png.into_inner())
        };
        self.save("corniche", "png", Box::new(encode));
    }

    /// Saves a flight.
    pub(crate) fn save_flight(&mut self, text: String) {
        self.save("flight", "toml", Box::new(move || Ok(text.into_bytes())));
    }

    fn hand_over(&mut self, work: Work) -> io::Result<()> {
        let writer = match self.writer.take() {
            Some(writer) => writer,
            None => self.start()?,
        };
        // This call cannot fail: the thread receives until this sender is dropped.
        let _ = writer.work.send(work);
        self.writer = Some(writer);
        Ok(())
    }

    /// Starts one thread, so that files get their numbers in order.
    fn start(&self) -> io::Result<Writer> {
        let (sender, wake) = (self.sender.clone(), Arc::clone(&self.wake));
        let (work, waiting) = mpsc::channel::<Work>();
        let write_all = move || {
            for work in waiting {
                // This call fails once the window is closed, and then nothing needs to be reported.
                let _ = sender.send(work());
                wake();
            }
        };
        let thread = thread::Builder::new().name("files".to_owned()).spawn(write_all)?;
        Ok(Writer { work, thread })
    }

    /// Writes a file with the next free number after `stem`.
    fn save(&mut self, stem: &'static str, extension: &'static str, encode: Encode) {
        let folder = self.folder.clone();
        let work = move || {
            // If an encoder panics, only that file is lost, and the loss is reported.
            let encoded = catch_unwind(AssertUnwindSafe(encode));
            let bytes =
                encoded.unwrap_or_else(|_| Err(io::Error::other("the file cannot be encoded")));
            bytes
                .and_then(|bytes| write(&folder, stem, extension, &bytes))
                .map_err(|source| NotSaved::File { folder, source })
        };
        if let Err(source) = self.hand_over(Box::new(work)) {
            let folder = self.folder.clone();
            // This call cannot fail: the receiver is a field of this struct.
            let _ = self.sender.send(Err(NotSaved::File { folder, source }));
        }
    }

    /// The results of files since the last call; never waits.
    pub(crate) fn news(&mut self) -> Vec<Saved> {
        self.saved.try_iter().collect()
    }

    /// Waits until all files are written. Returns the results that [`FileWriter::news`] has not
    /// reported yet.
    pub(crate) fn finish(&mut self) -> Vec<Saved> {
        if let Some(Writer { work, thread }) = self.writer.take() {
            drop(work);
            // The thread does not panic: it catches the panics of its tasks.
            let _ = thread.join();
        }
        self.news()
    }
}

impl Drop for FileWriter {
    /// Waits for the files: an image taken just before the window was closed is still written.
    fn drop(&mut self) {
        self.finish();
    }
}

/// Writes a file with the first free number.
fn write(folder: &Path, stem: &str, extension: &str, bytes: &[u8]) -> io::Result<PathBuf> {
    fs::create_dir_all(folder)?;
    for number in 1..=MOST {
        let path = folder.join(format!("{stem}-{number:03}.{extension}"));
        match OpenOptions::new().write(true).create_new(true).open(&path) {
            Ok(mut file) => {
                return match file.write_all(bytes) {
                    Ok(()) => Ok(path),
                    Err(error) => {
                        // An incomplete image is of no use. If it cannot be removed, the first
                        // error is still the one to report.
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

#[cfg(test)]
#[path = "files_tests.rs"]
mod tests;
