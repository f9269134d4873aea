//! One line with its class to its parts near the tiles of each level.

use std::borrow::Cow;

use corniche_areas::LineClass;
use corniche_drape::{ClippedPart, clip_region};
use corniche_geom::{LatticePoint, Polyline, TileId};
use corniche_osm::ClassedLine;
use corniche_roads::{FunctionalRoadClass, MetNodes, Road, RoadAttributes, simplify};
use corniche_spec::{levels::Levels, tiles_near::for_each_tile_near};
use corniche_tileset::LineRecord;

use crate::layers::{fixed_points::fixed_of_part, plan_splitting::PlanSplitting};

/// On levels above the finest, lines are simplified by so many of the level's cells.
const TOLERANCE_CELLS: f64 = 0.25;

/// How the lines of a layer are split.
pub(crate) struct LineSplitting<'a> {
    pub plan: PlanSplitting<'a>,
    pub levels: &'a Levels,
}

impl LineSplitting<'_> {
    /// Whether a class is stored on a level.
    fn shows(&self, level: u8, class: LineClass) -> bool {
        let frame = self.plan.frame;
        let cell_m = frame.level_cell(level).shorter_m();
        level == frame.max_level() || class.coarsest_cell_m().is_none_or(|most_m| cell_m <= most_m)
    }

    /// The parts of a line by tile.
    pub(crate) fn split(&self, object: &ClassedLine) -> Vec<(TileId, LineRecord)> {
        let parts = self.parts(object);
        let levels = self.levels.numbers().filter(|&level| self.shows(level, object.class));
        levels
            .flat_map(|level| parts.iter().flat_map(move |part| self.split_level(part, level)))
            .collect()
    }

    /// The parts of a line in the polygon; without one, the line.
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
        let (Ok(line), Some(class)) =
            (Polyline::new(object.points.clone()), FunctionalRoadClass::new(0))
        else {
            return Vec::new();
        };
        // Simplification looks at the line and its fixed points alone.
        let road = Road {
            way_id: object.way_id,
            class,
            attributes: RoadAttributes::default(),
            line,
            fixed: object.fixed.clone(),
            node_ids: Vec::new(),
            same_places: Vec::new(),
            met: MetNodes::default(),
        };
        let step = self.plan.step(level);
        let on_lattice = |part: i64| (part + step / 2).div_euclid(step) * step;
        let simplified = simplify(&road, tolerance_m / frame.lattice_step_m());
        let points = simplified.points().iter();
        let mut points: Vec<LatticePoint> = points
            .map(|point| LatticePoint::new(on_lattice(point.u), on_lattice(point.v)))
            .collect();
        points.dedup();
        points
    }
}

#[cfg(test)]
#[path = "split_tests.rs"]
mod tests;
