//! Sums over all tiles: folds of their records.

use std::collections::BTreeMap;

use corniche_geom::TileId;
use corniche_pieces::{
    layers::{
        ByLayer, SectionLayer,
        tile_section::{SectionOfTile, SectionSums},
    },
    roads::lay::ClassSums,
};
use corniche_tileset::{SampleSums, SvTails, VerticalRecord};

use crate::{
    context::Context,
    tile::record::{LevelShare, TileRecord},
};

/// Sums over all tiles.
///
/// Whole numbers, maxima, and lists that are sorted before they are used: the order in which records come does not matter.
pub(crate) struct TileSums {
    pub(crate) levels: BTreeMap<u8, LevelSums>,
    /// Sums by level and class.
    pub(crate) classes: BTreeMap<(u8, u8), ClassSums>,
    /// Per level, root first: distances to samples.
    pub(crate) samples: Vec<SampleSums>,
    pub(crate) sv_tails: SvTails,
    least_measured_m: f64,
}

/// Sums over the tiles of a level.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct LevelSums {
    pub(crate) tiles: u64,
    pub(crate) vertices: u64,
    pub(crate) triangles: u64,
    pub(crate) terrain_bytes: u64,
    pub(crate) relief_bytes: u64,
    /// Tiles with a photo.
    pub(crate) photo_tiles: u64,
    pub(crate) photo_bytes: u64,
    pub(crate) sections: ByLayer<SectionSums>,
    /// Geometric errors of its tiles.
    pub(crate) geometric_errors_m: Vec<f64>,
    /// Geometric errors of its tiles over their deviations, where those can be measured.
    pub(crate) tightness: Vec<f64>,
    /// Nodes with data that its tiles do not cover, or that have no tile above them.
    pub(crate) uncovered_nodes: u64,
}

impl TileSums {
    /// Nothing yet.
    pub(crate) fn new(context: &Context<'_>) -> Self {
        let quantum_m = context.levels.quantum_m();
        Self {
            levels: BTreeMap::new(),
            classes: BTreeMap::new(),
            samples: vec![SampleSums::new(quantum_m); context.levels.numbers().count()],
            sv_tails: SvTails::new(),
            least_measured_m: VerticalRecord::least_measured_error_m(quantum_m),
        }
    }

    /// Adds the spans of a tile.
    pub(crate) fn add_spans(&mut self, level: u8, own: SectionOfTile) {
        self.levels.entry(level).or_default().sections[SectionLayer::Spans].add(own);
    }

    /// Adds a tile.
    pub(crate) fn add(&mut self, id: TileId, record: &TileRecord) {
        let level = id.z();
        for ((above, share), samples) in (0..).zip(&record.levels).zip(&mut self.samples) {
            let LevelShare { has_ground, seen, sums } = share;
            samples.merge(sums);
            if !has_ground {
                self.levels.entry(above).or_default().uncovered_nodes += seen.uncovered_nodes;
            }
        }
        let Some(ground) = record.ground else { return };
        let sums = self.levels.entry(level).or_default();
        let deviation = ground.deviation;
        sums.tiles += 1;
        sums.vertices += ground.vertices;
        sums.triangles += ground.triangles;
        sums.terrain_bytes += ground.terrain_bytes;
        sums.relief_bytes += ground.relief_bytes;
        sums.photo_tiles += u64::from(ground.photo_bytes > 0);
        sums.photo_bytes += ground.photo_bytes;
        for layer in SectionLayer::all() {
            sums.sections[layer].add(ground.sections[layer]);
        }
        sums.geometric_errors_m.push(deviation.geometric_error_m);
        if deviation.deviation_m >= self.least_measured_m {
            sums.tightness.push(deviation.geometric_error_m / deviation.deviation_m);
        }
        sums.uncovered_nodes += deviation.uncovered_nodes;
        self.sv_tails.add(id, record.classes.values().map(|class| class.sv_stored_bytes).sum());
        for (&class, counted) in &record.classes {
            self.classes.entry((level, class)).or_default().merge(counted);
        }
    }
}
