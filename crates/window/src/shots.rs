//! Pictures and flights as files.

use std::{
    io::{self, Cursor},
    path::PathBuf,
    sync::Arc,
};

use corniche_viewer::{flight::FlightError, gpu::ReadBackError};
use image::{ImageFormat, RgbaImage};

use crate::platform::Files;

/// Why something that was to be kept is lost.
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "each message documents its variant")]
#[non_exhaustive]
pub enum NotSaved {
    #[error("nothing could be saved in {}", folder.display())]
    File { folder: PathBuf, source: io::Error },
    #[error("nothing was recorded")]
    Recording(#[from] FlightError),
    #[error("no picture was taken")]
    Picture(#[from] ReadBackError),
    #[error("no picture was taken: it was not yet drawn")]
    Untaken,
    #[error("no picture was taken: the graphics device was lost")]
    DeviceLost,
}

/// Saves what the person wants to keep.
pub(crate) struct Shots {
    files: Files,
}

impl Shots {
    /// Files go into `folder`; `wake` is called from another thread whenever one is written.
    pub(crate) fn new(folder: PathBuf, wake: Arc<dyn Fn() + Send + Sync>) -> Self {
        Self { files: Files::new(folder, wake) }
    }

    /// Writes a picture.
    pub(crate) fn save_picture(&mut self, picture: RgbaImage) {
        self.files.save("corniche", "png", move || {
            let mut png = Cursor::new(Vec::new());
            picture.write_to(&mut png, ImageFormat::Png).map_err(io::Error::other)?;
            Ok(png.into_inner())
        });
    }

    /// Writes a flight.
    pub(crate) fn save_flight(&mut self, text: String) {
        self.files.save("flight", "toml", move || Ok(text.into_bytes()));
    }

    /// What became of the files since this was asked last.
    pub(crate) fn news(&mut self) -> Vec<Result<PathBuf, NotSaved>> {
        self.files.news()
    }

    /// Waits until all is written; what became of the files that [`Shots::news`] did not tell of.
    pub(crate) fn finish(&mut self) -> Vec<Result<PathBuf, NotSaved>> {
        self.files.finish()
    }
}

#[cfg(test)]
#[path = "shots_tests.rs"]
mod tests;
