//! The fields of a package that PMTiles tools show, in addition to the manifest.

use corniche_geom::{Bounds, Seam};
use serde::de::IgnoredAny;

use crate::{
    Manifest,
    package::{
        error::OpenError,
        header::{HEADER_BYTES, bytes_at},
        metadata::Metadata,
    },
};

/// The number of steps per degree in the header.
const STEPS_PER_DEGREE: f64 = 1e7;

/// The fields of a package that PMTiles tools show: fields of the file's header, and the texts next
/// to the manifest. This reader uses none of them.
///
/// Source: PMTiles version 3 specification, sections 3 and 5.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ToolRecord {
    /// Number of tile ids that have a payload.
    pub addressed_tiles: u64,
    /// Directory entries that point to tiles.
    pub tile_entries: u64,
    /// Number of different payloads.
    pub tile_contents: u64,
    /// 1 if tiles are stored in the order of their ids.
    pub clustered: u8,
    /// Smallest and largest level.
    pub zooms: [u8; 2],
    /// West, south, east and north, in steps of 10⁻⁷ degrees.
    pub bounds_e7: [i32; 4],
    /// The level at which tools open the map.
    pub center_zoom: u8,
    /// Longitude and latitude of the centre, in steps of 10⁻⁷ degrees.
    pub center_e7: [i32; 2],
    /// The name of the package.
    pub name: String,
    /// A description of the content.
    pub description: String,
    /// All attribution texts in one line.
    pub attribution: String,
}

impl ToolRecord {
    /// Returns the record for a package with this manifest and this number of tiles.
    #[must_use]
    pub fn from_manifest(manifest: &Manifest, tiles: u64) -> Self {
        let bounds = header_bounds(manifest.wgs84_bounds);
        let Metadata { name, description, attribution, .. } = Metadata::from_manifest(manifest);
        Self {
            addressed_tiles: tiles,
            tile_entries: tiles,
            tile_contents: tiles,
            clustered: 1,
            zooms: [0, manifest.frame.max_level()],
            bounds_e7: bounds.to_array().map(e7),
            center_zoom: 0,
            center_e7: bounds.center().map(e7),
            name,
            description,
            attribution,
        }
    }

    /// Parses the record from the header's bytes and the metadata's JSON.
    pub(crate) fn parse(header: &[u8], metadata: &[u8]) -> Result<Self, OpenError> {
        let Some(bytes) = header.first_chunk::<HEADER_BYTES>() else {
            let actual = header.len() as u64;
            return Err(OpenError::Truncated { needed: HEADER_BYTES as u64, actual });
        };
        let count = |at: usize| u64::from_le_bytes(bytes_at(bytes, at));
        let degrees = |at: usize| i32::from_le_bytes(bytes_at(bytes, at));
        let texts: Metadata<IgnoredAny> =
            serde_json::from_slice(metadata).map_err(OpenError::manifest)?;
        Ok(Self {
            addressed_tiles: count(72),
            tile_entries: count(80),
            tile_contents: count(88),
            clustered: bytes[96],
            zooms: [bytes[100], bytes[101]],
            bounds_e7: [102, 106, 110, 114].map(degrees),
            center_zoom: bytes[118],
            center_e7: [119, 123].map(degrees),
            name: texts.name,
            description: texts.description,
            attribution: texts.attribution,
        })
    }
}

/// Converts a rectangle in degrees to one that fits in the header, whose numbers end at 214.75
/// degrees. A rectangle that extends beyond (such as a grid that counts from 0 to 360 degrees) or
/// covers a full turn becomes −180 to 180 degrees.
pub(crate) fn header_bounds(bounds: Bounds) -> Bounds {
    let most = f64::from(i32::MAX) / STEPS_PER_DEGREE;
    let degrees = Seam::of_degrees();
    let is_turn = bounds.width() >= degrees.turn() - 1.0 / STEPS_PER_DEGREE;
    if bounds.min_x >= -most && bounds.max_x <= most && !is_turn {
        return bounds;
    }
    let [west, east] = degrees.ends();
    Bounds { min_x: west, max_x: east, ..bounds }
}

/// Converts degrees to steps of the header.
fn e7(degrees: f64) -> i32 {
    (degrees * STEPS_PER_DEGREE).round() as i32
}
