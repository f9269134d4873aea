//! One boundary to its parts near the tiles of each level.

use std::borrow::Cow;

use corniche_areas::BoundaryClass;
use corniche_drape::{ClippedPart, clip_region};
use corniche_geom::{LatticeBounds, LatticePoint, LatticeRegion, Polyline, TileId};
use corniche_osm::Boundary;
use corniche_roads::{FunctionalRoadClass, Road, RoadAttributes, simplify};
use corniche_tileset::BoundaryRecord;

use crate::{
    heights::data_tiles::DataTiles, layers::fixed_points::fixed_of_part, levels::Levels,
    points_step::points_step, tiles_near::for_each_tile_near,
};

/// On levels above the finest, lines are simplified by so many of the level's cells.
const TOLERANCE_CELLS: f64 = 0.25;

/// The coarsest cell, metres, on whose level boundaries of a class are stored; `None`: all. What is stored nowhere above need not be drawn
/// there: districts and parks are too small.
fn coarsest_cell_m(class: BoundaryClass) -> Option<f64> {
    match class {
        BoundaryClass::Admin2 | BoundaryClass::Admin3 | BoundaryClass::Admin4 => None,
        BoundaryClass::Admin5 | BoundaryClass::Admin6 => Some(250.0),
        BoundaryClass::Admin7 | BoundaryClass::Admin8 | BoundaryClass::Protected => Some(80.0),
    }
}

/// How boundaries are split.
pub(crate) struct BoundarySplitting<'a> {
    pub(crate) levels: &'a Levels,
    pub(crate) data: DataTiles,
    /// The bounds that were asked for: tiles that do not touch them get none.
    pub(crate) clip: Option<LatticeBounds>,
    /// The polygon that was asked for: boundaries end at its outline.
    pub(crate) polygon: Option<&'a LatticeRegion>,
}

impl BoundarySplitting<'_> {
    /// The spacing of the lattice on which points of a level lie, in steps of the package's: a power of two.
    pub(crate) fn step(&self, level: u8) -> i64 {
        points_step(self.levels.frame(), level)
    }

    /// Whether a class is stored on a level.
    fn shows(&self, level: u8, class: BoundaryClass) -> bool {
        let frame = self.levels.frame();
        let cell_m = frame.level_cell(level).shorter_m();
        level == frame.max_level() || coarsest_cell_m(class).is_none_or(|most_m| cell_m <= most_m)
    }

    /// The parts of a boundary by tile.
    pub(crate) fn split(&self, boundary: &Boundary) -> Vec<(TileId, BoundaryRecord)> {
        let parts = self.parts(boundary);
        let levels = self.levels.numbers().filter(|&level| self.shows(level, boundary.class));
        levels
            .flat_map(|level| parts.iter().flat_map(move |part| self.split_level(part, level)))
            .collect()
    }

    /// The parts of a boundary in the polygon; without one, the boundary.
    fn parts<'b>(&self, boundary: &'b Boundary) -> Vec<Cow<'b, Boundary>> {
        let Some(region) = self.polygon else { return vec![Cow::Borrowed(boundary)] };
        let Ok(line) = Polyline::new(boundary.points.clone()) else { return Vec::new() };
        let cut = |part: ClippedPart| {
            let fixed = fixed_of_part(&boundary.points, &boundary.fixed, &part);
            let points = part.line.points().to_vec();
            Cow::Owned(Boundary { way_id: boundary.way_id, class: boundary.class, points, fixed })
        };
        clip_region(&line, region).into_iter().map(cut).collect()
    }

    fn split_level(&self, boundary: &Boundary, level: u8) -> Vec<(TileId, BoundaryRecord)> {
        let points = self.line(boundary, level);
        let data = self.data.above(level);
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
            (run[0].0, BoundaryRecord { way_id: boundary.way_id, class: boundary.class, points })
        };
        runs.map(record).collect()
    }

    fn is_wanted(&self, id: TileId) -> bool {
        let tile = self.levels.frame().tile_lattice_bounds(id);
        self.clip.is_none_or(|clip| clip.intersects(&tile))
    }

    /// A boundary as a level shows it: simplified, on the level's lattice.
    fn line(&self, boundary: &Boundary, level: u8) -> Vec<LatticePoint> {
        let frame = self.levels.frame();
        let tolerance_m = if level == frame.max_level() {
            0.0
        } else {
            TOLERANCE_CELLS * frame.level_cell(level).shorter_m()
        };
        let (Ok(line), Some(class)) =
            (Polyline::new(boundary.points.clone()), FunctionalRoadClass::new(0))
        else {
            return Vec::new();
        };
        // Simplification looks at the line and its fixed points alone.
        let road = Road {
            way_id: boundary.way_id,
            class,
            attributes: RoadAttributes::default(),
            line,
            fixed: boundary.fixed.clone(),
            node_ids: Vec::new(),
            same_places: Vec::new(),
        };
        let step = self.step(level);
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
