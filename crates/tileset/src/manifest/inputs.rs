//! The input files of a package, and their kinds.

use serde::{Deserialize, Serialize};

corniche_roads::listed! {
    /// The kind of an input.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub enum InputKind {
        /// An elevation file that was given.
        Dem = "dem",
        /// A file that a given elevation file refers to, or a sidecar file of it.
        DemPart = "dem-part",
        /// A photo that was given.
        Photo = "photo",
        /// A file that a given photo refers to, or a sidecar file of it.
        PhotoPart = "photo-part",
        /// A package whose terrain is used. It is not recorded as an input of the new package,
        /// which records the input files of this package instead.
        Terrain = "terrain",
        /// The polygon that selects the region to build.
        Polygon = "polygon",
        /// The OSM extract.
        Osm = "osm",
    }

    /// The word for it in the manifest.
    pub fn name() -> &'static str;
}

impl InputKind {
    /// The kinds that are recorded in a manifest.
    pub const RECORDED: [Self; 6] =
        [Self::Dem, Self::DemPart, Self::Photo, Self::PhotoPart, Self::Polygon, Self::Osm];
    /// The kinds of the inputs of the terrain.
    pub const OF_TERRAIN: [Self; 2] = [Self::Dem, Self::DemPart];
    /// The kinds of the inputs of photos.
    pub const OF_PHOTOS: [Self; 2] = [Self::Photo, Self::PhotoPart];

    /// Whether a record of the manifest describes an input of this kind.
    #[must_use]
    pub fn is_of(self, record: &InputRecord) -> bool {
        record.kind == self.name()
    }
}

/// An input file.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct InputRecord {
    /// "dem"; "dem-part", a file that the preceding "dem" refers to, or a sidecar file of it;
    /// "photo"; "photo-part", likewise; "polygon"; or "osm".
    pub kind: String,
    /// File name without folders.
    pub name: String,
    /// Size of the file; for a file in an archive or on a server, the number of bytes that GDAL
    /// delivers.
    pub bytes: u64,
    /// SHA-256 of these bytes; empty for an elevation file outside the bounds of the package, of
    /// which no sample is used.
    pub sha256: String,
}
