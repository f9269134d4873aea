//! The input files of a package, and what each is.

use serde::{Deserialize, Serialize};

/// What an input is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum InputKind {
    /// A raster that was named.
    Dem,
    /// A file that such a raster refers to, or that lies beside it and belongs to it.
    DemPart,
    /// A photo that was named.
    Photo,
    /// A file that such a photo refers to, or that lies beside it and belongs to it.
    PhotoPart,
    /// A package whose terrain is taken. It is no input of the package that is made: that has the files of this one.
    Terrain,
    /// The polygon that says which part is wanted.
    Polygon,
    /// The extract.
    Osm,
}

impl InputKind {
    /// The kinds that a manifest has.
    pub const RECORDED: [Self; 6] =
        [Self::Dem, Self::DemPart, Self::Photo, Self::PhotoPart, Self::Polygon, Self::Osm];
    /// The kinds that the terrain is made from.
    pub const OF_TERRAIN: [Self; 2] = [Self::Dem, Self::DemPart];
    /// The kinds that photos are made from.
    pub const OF_PHOTOS: [Self; 2] = [Self::Photo, Self::PhotoPart];

    /// The word for it in the manifest.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Dem => "dem",
            Self::DemPart => "dem-part",
            Self::Photo => "photo",
            Self::PhotoPart => "photo-part",
            Self::Terrain => "terrain",
            Self::Polygon => "polygon",
            Self::Osm => "osm",
        }
    }

    /// Whether a record of the manifest is about an input of this kind.
    #[must_use]
    pub fn is_of(self, record: &InputRecord) -> bool {
        record.kind == self.name()
    }
}

/// An input file.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct InputRecord {
    /// "dem"; "dem-part", a file that the one before it refers to or that belongs to it; "photo"; "photo-part", likewise; "polygon"; or "osm".
    pub kind: String,
    /// File name without folders.
    pub name: String,
    /// Size of the file; of a file inside an archive or on a server, of what GDAL delivers.
    pub bytes: u64,
    /// SHA-256 of as many bytes; empty for an elevation file outside the bounds of the package, of which no sample is used.
    pub sha256: String,
}
