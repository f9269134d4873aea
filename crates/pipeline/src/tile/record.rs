//! The record of a tile: everything that the manifest needs from it, so that the package need not
//! be read again for its own table of contents.

use std::collections::BTreeMap;

use corniche_geom::TileId;
use corniche_ground::heights::patch::union;
use corniche_pieces::{
    layers::tile_section::SectionOfTile,
    roads::lay::{ClassSums, RoadFate},
};
use corniche_spec::artifacts::{self, ArtifactError, ArtifactKind};
use corniche_store::Artifacts;
use corniche_tileset::SampleSums;
use serde::{Deserialize, Serialize};

/// The record of a tile. Sums over tiles are sums of records, in whole numbers, maxima and minima:
/// they do not depend on the order or grouping of tiles.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct TileRecord {
    /// The tile's ground; `None` if the tile has no ground, and therefore no payload.
    pub ground: Option<GroundRecord>,
    /// Sums by number of the class.
    pub classes: BTreeMap<u8, ClassSums>,
    /// Finest tiles only: the fates of roads in this tile, by ordinal.
    pub fates: Vec<(u32, RoadFate)>,
    /// Finest tiles only, root first: distances of its nodes and samples from the TINs of its
    /// ancestors, and from its own TIN.
    pub levels: Vec<LevelShare>,
}

/// Counts of a tile's ground, and its distance from the heights.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct GroundRecord {
    pub vertices: u64,
    pub triangles: u64,
    pub terrain_bytes: u64,
    pub relief_bytes: u64,
    /// Bytes of the photo; 0 without one.
    pub photo_bytes: u64,
    /// The sections of the layers, in their order.
    pub layers: Vec<SectionOfTile>,
    pub deviation: TileDeviation,
}

/// The distance of one tile's TIN from the nodes.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct TileDeviation {
    /// The value that the tile stores: never below the deviations of the tiles below it.
    pub geometric_error_m: f64,
    /// The largest deviation of the tile itself and of its children, each by its own TIN.
    pub deviation_m: f64,
    pub height_range_m: [f64; 2],
    pub uncovered_nodes: u64,
}

/// The contribution of one finest tile to the statistics of a tile above it, or of itself.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct LevelShare {
    /// Whether the tile of that level has ground.
    pub has_ground: bool,
    pub seen: TinStatistics,
    /// Distances to the nodes that are not filled voids, or, where samples are not nodes, to the
    /// DEM's samples.
    pub sums: SampleSums,
}

/// Statistics of a tile's TIN, collected over one or several finest tiles.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct TinStatistics {
    /// Largest vertical distance from the TIN to a node, metres.
    pub max_abs_m: f64,
    /// Lowest and highest node.
    pub range_m: Option<[f32; 2]>,
    /// Nodes with a height where there is no triangle.
    pub uncovered_nodes: u64,
}

impl TinStatistics {
    /// Adds other statistics of the same tile, in any order.
    pub(crate) fn merge(&mut self, other: Self) {
        self.max_abs_m = self.max_abs_m.max(other.max_abs_m);
        self.uncovered_nodes += other.uncovered_nodes;
        self.range_m = union(self.range_m, other.range_m);
    }
}

impl TileDeviation {
    /// Combines the statistics of a tile, the largest geometric error beneath it, and the largest
    /// own deviation of its children.
    pub(crate) fn from_statistics(seen: TinStatistics, beneath_m: f64, children_m: f64) -> Self {
        let [low, high] = seen.range_m.unwrap_or([0.0, 0.0]);
        Self {
            geometric_error_m: beneath_m.max(seen.max_abs_m),
            deviation_m: children_m.max(seen.max_abs_m),
            height_range_m: [f64::from(low), f64::from(high)],
            uncovered_nodes: seen.uncovered_nodes,
        }
    }
}

impl TileRecord {
    pub(crate) fn put(&self, store: &dyn Artifacts, id: TileId) -> Result<(), ArtifactError> {
        artifacts::put(store, ArtifactKind::Record.of_tile(id), self)
    }

    pub(crate) fn get(store: &dyn Artifacts, id: TileId) -> Result<Option<Self>, ArtifactError> {
        artifacts::get(store, ArtifactKind::Record.of_tile(id))
    }
}
