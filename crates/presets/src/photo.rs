//! Options for photos of the ground.

use std::path::{Path, PathBuf};

use clap::Args;
use serde::Deserialize;

/// Whether these names of photos are the one word that says that no photos are wanted. A file of this name is `./off`.
#[must_use]
pub fn is_photo_off(names: &[PathBuf]) -> bool {
    names == [Path::new("off")]
}

// How photos are made: the section `[photo]`.
#[derive(Debug, Clone, PartialEq, Eq, Default, Args, Deserialize)]
#[serde(deny_unknown_fields, default, rename_all = "kebab-case")]
#[command(next_help_heading = "Photos")]
#[expect(missing_docs, reason = "clap would take it for the description of the command")]
pub struct PhotoOptions {
    /// How many levels of texels are finer than the finest cell, 0 to 4: with 3 a cell has 8 × 8 texels [default: as many as the finest
    /// photo has detail for, at most 3]
    #[arg(id = "photo_levels", long = "photo-levels", value_name = "N")]
    pub levels: Option<u8>,
    /// Quality of the photos' JPEG coding, 1 to 100 [default: 80]
    #[arg(id = "photo_quality", long = "photo-quality", value_name = "Q")]
    pub quality: Option<u8>,
    /// Credit of the photos, shown wherever the package is shown, beside those that their files have (GeoTIFF's tag Copyright)
    #[arg(id = "photo_attribution", long = "photo-attribution", value_name = "TEXT")]
    pub attribution: Option<String>,
}

impl PhotoOptions {
    /// These options; those that are not given are taken from `other`.
    #[must_use]
    pub fn or(self, other: Self) -> Self {
        Self {
            levels: self.levels.or(other.levels),
            quality: self.quality.or(other.quality),
            attribution: self.attribution.or(other.attribution),
        }
    }

    /// Whether nothing is given.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }
}
