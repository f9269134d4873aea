//! The JSON metadata of a PMTiles file, with the manifest under a key of its own.

use serde::{Deserialize, Serialize};

use crate::Manifest;

/// Version of a package's encodings, in [`Manifest::format_version`](crate::Manifest::format_version). Readers
/// refuse any other.
pub const FORMAT_VERSION: u32 = 1;

/// The JSON metadata of the file: what PMTiles tools show, and the manifest under a key of its own.
#[derive(Serialize, Deserialize)]
pub(crate) struct Metadata<M> {
    #[serde(default)]
    pub(crate) name: String,
    #[serde(default)]
    pub(crate) description: String,
    /// All credits in one line, as the PMTiles specification has it.
    #[serde(default)]
    pub(crate) attribution: String,
    pub(crate) corniche: M,
}

impl<'a> Metadata<&'a Manifest> {
    /// What goes with a manifest.
    pub(crate) fn of(manifest: &'a Manifest) -> Self {
        Self {
            name: "Corniche package".to_owned(),
            description: format!(
                "Terrain and roads by {}; z/x/y is a local quadtree in {}",
                manifest.generator, manifest.crs
            ),
            attribution: manifest.attribution.join(", "),
            corniche: manifest,
        }
    }
}
