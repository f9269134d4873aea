//! Boundaries of the extract, split by tile: each tile of each level gets a section with the lines
//! near it.

use std::{borrow::Cow, collections::BTreeMap};

use corniche_areas::BoundaryClass;
use corniche_drape::{ClippedPart, clip_region};
use corniche_geom::{LatticePoint, Polyline, TileId};
use corniche_osm::{ClassedLine, LineSummary};
use corniche_roads::simplify;
use corniche_spec::{
    artifacts::damaged, levels::Levels, tiles_near::for_each_tile_near, true_lengths::TrueLengths,
};
use corniche_store::{Artifacts, ScratchSpace, record_bytes, take_record};
use corniche_tileset::{LineRecord, encode_boundaries};
use corniche_work::Stage;

use crate::{
    ExtractError,
    layers::{
        SectionLayer,
        fixed_points::fixed_of_part,
        layer_writer::{LayerContext, LayerEncoder, TileSplitting},
        parts_by_tile::PartsByTile,
        plan_splitting::PlanSplitting,
        tile_section::LineTotals,
        tile_section::TileSection,
    },
};

/// Tolerance of simplification on levels above the finest, in cells of the level.
const TOLERANCE_CELLS: f64 = 0.25;

/// Splits and measures boundaries.
pub(crate) struct LineSplitting<'a> {
    pub plan: PlanSplitting<'a>,
    pub levels: &'a Levels,
    pub lengths: &'a TrueLengths<'a>,
}

impl LineSplitting<'_> {
    /// Whether a class is stored on a level.
    fn shows(&self, level: u8, class: BoundaryClass) -> bool {
        let frame = self.plan.frame;
        let cell_m = frame.level_cell(level).shorter_m();
        level == frame.max_level() || class.coarsest_cell_m().is_none_or(|most_m| cell_m <= most_m)
    }

    /// Returns the parts of a line by tile.
    pub(crate) fn split(&self, object: &ClassedLine) -> Vec<(TileId, LineRecord)> {
        let parts = self.parts(object);
        let levels = self.levels.numbers().filter(|&level| self.shows(level, object.class));
        levels
            .flat_map(|level| parts.iter().flat_map(move |part| self.split_level(part, level)))
            .collect()
    }

    /// The parts of a line inside the polygon; without a polygon, the line.
    fn parts<'b>(&self, object: &'b ClassedLine) -> Vec<Cow<'b, ClassedLine>> {
        let Some(region) = self.plan.polygon else { return vec![Cow::Borrowed(object)] };
        let Ok(line) = Polyline::new(object.points.clone()) else { return Vec::new() };
        let cut = |part: ClippedPart| {
            let fixed = fixed_of_part(&object.points, &object.fixed, &part);
            let points = part.line.points().to_vec();
            Cow::Owned(ClassedLine { way_id: object.way_id, class: object.class, points, fixed })
        };
        clip_region(&line, region).into_iter().map(cut).collect()
    }

    fn split_level(&self, object: &ClassedLine, level: u8) -> Vec<(TileId, LineRecord)> {
        let points = self.line(object, level);
        let data = self.plan.data.above(level);
        let mut near: Vec<(TileId, usize)> = Vec::new();
        for (segment, pair) in points.array_windows::<2>().enumerate() {
            for_each_tile_near(*pair, level, self.levels, |id| {
                if data.contains(id) && self.is_wanted(id) {
                    near.push((id, segment));
                }
            });
        }
        near.sort_unstable();
        let runs = near.chunk_by(|(one, at), (other, next)| one == other && at + 1 == *next);
        let record = |run: &[(TileId, usize)]| {
            let (first, last) = (run[0].1, run[run.len() - 1].1);
            let points = points[first..=last + 1].to_vec();
            (run[0].0, LineRecord { way_id: object.way_id, class: object.class, points })
        };
        runs.map(record).collect()
    }

    fn is_wanted(&self, id: TileId) -> bool {
        let tile = self.plan.frame.tile_lattice_bounds(id);
        self.plan.clip.is_none_or(|clip| clip.intersects(&tile))
    }

    /// A line as a level shows it: simplified, on the level's lattice.
    fn line(&self, object: &ClassedLine, level: u8) -> Vec<LatticePoint> {
        let frame = self.plan.frame;
        let tolerance_m = if level == frame.max_level() {
            0.0
        } else {
            TOLERANCE_CELLS * frame.level_cell(level).shorter_m()
        };
        let Ok(line) = Polyline::new(object.points.clone()) else { return Vec::new() };
        let step = self.plan.step(level);
        let on_lattice = |part: i64| (part + step / 2).div_euclid(step) * step;
        let simplified = simplify(&line, &object.fixed, tolerance_m / frame.lattice_step_m());
        let points = simplified.points().iter();
        let mut points: Vec<LatticePoint> = points
            .map(|point| LatticePoint::new(on_lattice(point.u), on_lattice(point.v)))
            .collect();
        points.dedup();
        points
    }
}

/// The order of a tile's parts: by class and way, and parts of one way by their start, so that the
/// order depends on the parts alone.
type PartOrder = (u8, i64, LatticePoint, u64);

/// Receives boundaries in the order in which they are read.
pub(crate) struct LinesLayer<'a> {
    splitting: LineSplitting<'a>,
    store: &'a dyn Artifacts,
    parts: PartsByTile<'a, PartOrder>,
    /// The true lengths of all ways that were read, by class.
    lengths_um: BTreeMap<BoundaryClass, u64>,
}

impl<'a> LinesLayer<'a> {
    pub(crate) fn new(
        splitting: LineSplitting<'a>,
        (store, scratch): (&'a dyn Artifacts, &'a dyn ScratchSpace),
        memory_bytes: u64,
    ) -> Self {
        let parts = PartsByTile::new(scratch, memory_bytes);
        Self { splitting, store, parts, lengths_um: BTreeMap::new() }
    }
}

/// A line that has been split.
pub(crate) struct SplitLine {
    class: BoundaryClass,
    length_um: u64,
    parts: Vec<(TileId, PartOrder, Vec<u8>)>,
}

impl TileSplitting for LineSplitting<'_> {
    type Object = ClassedLine;
    type Split = SplitLine;

    fn points(line: &ClassedLine) -> usize {
        line.points.len()
    }

    fn split_object(&self, _: u64, object: ClassedLine) -> SplitLine {
        let class = object.class;
        let Ok(line) = Polyline::new(object.points.clone()) else {
            return SplitLine { class, length_um: 0, parts: Vec::new() };
        };
        let part = |(number, (id, record)): (u64, (TileId, LineRecord))| {
            let order = (class.number(), record.way_id, record.points[0], number);
            (id, order, record_bytes(&record.points))
        };
        SplitLine {
            class,
            length_um: self.lengths.segments_um(&line).iter().sum(),
            parts: (0..).zip(self.split(&object)).map(part).collect(),
        }
    }
}

impl<'a> LayerEncoder for LinesLayer<'a> {
    type Splitting = LineSplitting<'a>;
    type Summary = LineSummary;
    type Done = LineTotals;

    fn stage(&self) -> Stage {
        SectionLayer::Boundaries.stage()
    }

    fn splitting(&self) -> &LineSplitting<'a> {
        &self.splitting
    }

    fn take(&mut self, split: SplitLine) -> Result<(), ExtractError> {
        *self.lengths_um.entry(split.class).or_default() += split.length_um;
        split.parts.into_iter().try_for_each(|(id, order, bytes)| self.parts.push(id, order, bytes))
    }

    /// Stores the sections of all tiles and finally the totals.
    fn finish(
        self,
        _: u64,
        summary: LineSummary,
        told: &LayerContext<'_>,
    ) -> Result<LineTotals, ExtractError> {
        let (splitting, store) = (&self.splitting.plan, self.store);
        let layer = SectionLayer::Boundaries;
        self.parts.for_each_tile(
            told.observer,
            |parts: &mut Vec<LineRecord>, tile, (class, way_id, ..), bytes| {
                let class = BoundaryClass::from_number(class);
                let part = class.zip(take_record(&mut &*bytes)).ok_or_else(|| {
                    let key = layer.section().item(tile);
                    damaged(key, &"the record read back is not a boundary")
                });
                let (class, points) = part?;
                parts.push(LineRecord { way_id, class, points });
                Ok(())
            },
            |tile, parts| {
                let points = parts.iter().map(|line| line.points.len() as u64).sum();
                let counts = [parts.len() as u64, points];
                TileSection::put((layer, tile), store, counts, |id| {
                    encode_boundaries(id, splitting.step(id.z()), &parts)
                })
            },
        )?;
        let kept = summary.kept.iter().map(|(class, &ways)| {
            let length_um = self.lengths_um.get(class).copied().unwrap_or_default();
            (class.number(), (ways, length_um))
        });
        let totals = LineTotals {
            objects: summary.ways,
            kept: kept.collect(),
            lost: summary.lost.iter().map(|(loss, &n)| (loss.reason().to_owned(), n)).collect(),
        };
        totals.put(layer, store)?;
        Ok(totals)
    }
}

#[cfg(test)]
#[path = "layer_tests.rs"]
mod tests;
