//! Records of settings in the manifest that are more than a number or a text.

use serde::{Deserialize, Serialize};

/// The polygon that the package was clipped to.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct PolygonRecord {
    /// File name without folders.
    pub name: String,
    /// SHA-256 of its coordinate system and vertices, independent of the format of the file.
    pub sha256: String,
}

/// The table of a layer.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct LayerTableRecord {
    /// The id of the layer.
    pub id: String,
    /// SHA-256 of the table as JSON.
    pub sha256: String,
}

/// How the photos of a package are stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct PhotoRecord {
    /// A cell of the finest level has 2^levels texels along each side: `--photo-levels`, or the
    /// value derived from the photos.
    pub levels: u8,
    /// `--photo-quality`: the JPEG quality, from 1 to 100.
    pub quality: u8,
}

impl PhotoRecord {
    /// The exponent of the number of texels along each side of a cell of a level. A coarse tile is
    /// drawn while its cells are a few pixels wide, so its texels are half a cell, unless the
    /// photos have less detail.
    #[must_use]
    pub fn levels_on(self, level: u8, finest_level: u8) -> u8 {
        if level == finest_level { self.levels } else { self.levels.min(1) }
    }
}
