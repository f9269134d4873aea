//! The JSON metadata of a PMTiles file, which contains the manifest under its own key.

use serde::{Deserialize, Serialize};

use crate::Manifest;

/// Version of a package's encodings, in
/// [`Manifest::format_version`](crate::Manifest::format_version). Readers reject all other
/// versions.
pub const FORMAT_VERSION: u32 = 2;

/// The JSON metadata of the file: texts for PMTiles tools, and the manifest under its own key.
#[derive(Serialize, Deserialize)]
pub(crate) struct Metadata<M> {
    #[serde(default)]
    pub name: String,
    #[serde(default)]
    pub description: String,
    /// All attribution texts in one line, as the PMTiles specification requires.
    #[serde(default)]
    pub attribution: String,
    pub corniche: M,
}

impl<'a> Metadata<&'a Manifest> {
    /// Returns the metadata for a manifest.
    pub(crate) fn from_manifest(manifest: &'a Manifest) -> Self {
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
