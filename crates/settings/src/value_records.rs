//! What the manifest records of settings that are more than a number or a text.

use serde::{Deserialize, Serialize};

/// The polygon that the package was cut with.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct PolygonRecord {
    /// File name without folders.
    pub name: String,
    /// SHA-256 of its coordinate system and corners, whatever the format of the file.
    pub sha256: String,
}

/// The table of classes of areas.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct AreaTableRecord {
    /// Its name.
    pub table: String,
    /// SHA-256 of its text.
    pub sha256: String,
}

/// How the photos of a package were made.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct PhotoRecord {
    /// A cell of the finest level has 2^levels texels along each side: `--photo-levels`, or what
    /// follows from the photos.
    pub levels: u8,
    /// `--photo-quality`: JPEG's, from 1 to 100.
    pub quality: u8,
}

impl PhotoRecord {
    /// A cell of a level has 2 to this power texels along each side. A coarse tile is drawn while
    /// its cells look like some pixels, so its texels are half a cell, unless the photos have no
    /// such detail.
    #[must_use]
    pub fn levels_on(self, level: u8, finest_level: u8) -> u8 {
        if level == finest_level { self.levels } else { self.levels.min(1) }
    }
}
