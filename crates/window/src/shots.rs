//! Pictures and flights as files.

use std::{
    io::{self, Cursor},
    path::PathBuf,
};

use image::{ImageFormat, RgbaImage};

use crate::{NotSaved, save_files::SaveFiles};

/// Saves pictures and flights.
pub(crate) struct Shots {
    files: Box<dyn SaveFiles>,
}

impl Shots {
    /// Files are saved by `files`.
    pub(crate) fn new(files: Box<dyn SaveFiles>) -> Self {
        Self { files }
    }

    /// Saves a picture.
    pub(crate) fn save_picture(&mut self, picture: RgbaImage) {
        let encode = move || {
            let mut png = Cursor::new(Vec::new());
            picture.write_to(&mut png, ImageFormat::Png).map_err(io::Error::other)?;
            Ok(png.into_inner())
        };
        self.files.save("corniche", "png", Box::new(encode));
    }

    /// Saves a flight.
    pub(crate) fn save_flight(&mut self, text: String) {
        self.files.save("flight", "toml", Box::new(move || Ok(text.into_bytes())));
    }

    /// The files that were saved, or not, since this was called last; never waits.
    pub(crate) fn news(&mut self) -> Vec<Result<PathBuf, NotSaved>> {
        self.files.news()
    }

    /// Waits until all files are written; the result is that of the files that [`Shots::news`] did not yet tell of.
    pub(crate) fn finish(&mut self) -> Vec<Result<PathBuf, NotSaved>> {
        self.files.finish()
    }
}

#[cfg(test)]
#[path = "shots_tests.rs"]
mod tests;
