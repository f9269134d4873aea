//! Pictures and flights as files: numbered, never in the place of another, written beside the drawing.

use std::{
    fs::{self, OpenOptions},
    io::{self, Cursor, Write as _},
    path::{Path, PathBuf},
    sync::{Arc, mpsc},
    thread::{self, JoinHandle},
};

use image::{ImageFormat, RgbaImage};

/// Numbers are tried up to here.
const MOST: u32 = 99_999;

/// Writes files.
pub(crate) struct Shots {
    folder: PathBuf,
    wake: Arc<dyn Fn() + Send + Sync>,
    sender: mpsc::Sender<String>,
    said: mpsc::Receiver<String>,
    writers: Vec<JoinHandle<()>>,
}

impl Shots {
    /// Files go into `folder`; `wake` is called from another thread whenever one is written.
    pub(crate) fn new(folder: PathBuf, wake: Arc<dyn Fn() + Send + Sync>) -> Self {
        let (sender, said) = mpsc::channel();
        Self { folder, wake, sender, said, writers: Vec::new() }
    }

    /// Writes a picture.
    pub(crate) fn save_picture(&mut self, picture: RgbaImage) {
        self.save("corniche", "png", move || {
            let mut png = Cursor::new(Vec::new());
            picture.write_to(&mut png, ImageFormat::Png).map_err(io::Error::other)?;
            Ok(png.into_inner())
        });
    }

    /// Writes a flight.
    pub(crate) fn save_flight(&mut self, text: String) {
        self.save("flight", "toml", move || Ok(text.into_bytes()));
    }

    /// What became of the files since this was asked last.
    pub(crate) fn news(&mut self) -> Vec<String> {
        self.writers.retain(|writer| !writer.is_finished());
        self.said.try_iter().collect()
    }

    fn save(
        &mut self,
        stem: &'static str,
        extension: &'static str,
        encode: impl FnOnce() -> io::Result<Vec<u8>> + Send + 'static,
    ) {
        let (folder, wake, sender) =
            (self.folder.clone(), Arc::clone(&self.wake), self.sender.clone());
        let work = move || {
            let news = match encode().and_then(|bytes| write(&folder, stem, extension, &bytes)) {
                Ok(path) => format!("saved {}", path.display()),
                Err(error) => {
                    format!("nothing could be saved in {}: {error}", folder.display())
                }
            };
            // Nobody listens once the window is closed.
            let _ = sender.send(news);
            wake();
        };
        match thread::Builder::new().name("file".to_owned()).spawn(work) {
            Ok(writer) => self.writers.push(writer),
            Err(error) => {
                let _ = self.sender.send(format!("nothing could be saved: {error}"));
            }
        }
    }
}

impl Drop for Shots {
    /// A picture taken just before the window was closed is still written.
    fn drop(&mut self) {
        for writer in self.writers.drain(..) {
            let _ = writer.join();
        }
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

#[cfg(test)]
mod tests {
    use std::time::{Duration, Instant};

    use super::*;

    fn news_of(shots: &mut Shots, count: usize) -> Vec<String> {
        let begun = Instant::now();
        let mut news = Vec::new();
        while news.len() < count {
            news.extend(shots.news());
            assert!(begun.elapsed() < Duration::from_secs(30), "{news:?}");
            thread::sleep(Duration::from_millis(1));
        }
        news
    }

    #[test]
    fn files_are_numbered_and_never_replaced() {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("corniche-001.png"), b"mine").unwrap();
        let mut shots = Shots::new(folder.path().join("."), Arc::new(|| ()));
        for _ in 0..2 {
            shots.save_picture(RgbaImage::from_pixel(3, 2, image::Rgba([1, 2, 3, 255])));
            let news = news_of(&mut shots, 1);
            assert!(news[0].starts_with("saved "), "{news:?}");
        }
        assert_eq!(fs::read(folder.path().join("corniche-001.png")).unwrap(), b"mine");
        let picture = image::open(folder.path().join("corniche-003.png")).unwrap().to_rgba8();
        assert_eq!((picture.dimensions(), picture.get_pixel(2, 1).0), ((3, 2), [1, 2, 3, 255]));
    }

    #[test]
    fn what_cannot_be_written_is_said() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("file");
        fs::write(&file, b"no folder").unwrap();
        let mut shots = Shots::new(file, Arc::new(|| ()));
        shots.save_flight("text".to_owned());
        let news = news_of(&mut shots, 1);
        assert!(news[0].contains("nothing could be saved"), "{news:?}");
    }

    #[test]
    fn a_file_under_way_is_written_before_all_ends() {
        let folder = tempfile::tempdir().unwrap();
        let mut shots = Shots::new(folder.path().to_owned(), Arc::new(|| ()));
        shots.save_flight("the way".to_owned());
        drop(shots);
        let path = folder.path().join("flight-001.toml");
        assert_eq!(fs::read_to_string(path).unwrap(), "the way");
    }
}
