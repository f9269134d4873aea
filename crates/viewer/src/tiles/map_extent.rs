//! What a first view of a package shows: where its roads are.

use corniche_geom::Bounds;

use super::TileGeometry;

/// A rectangle in plan, and the ground in it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MapExtent {
    /// The rectangle, working metres.
    pub plan: Bounds,
    /// All ground in it lies between these true heights.
    pub heights_m: [f64; 2],
}

/// So much of the roads' length may lie west of the rectangle, and as much east, north and south of it: a single road that
/// leads far away does not make the map small.
const TAIL: f64 = 0.01;

/// Width of the margin around the roads, as a share of the longer side of their rectangle.
const MARGIN: f64 = 0.08;

/// A map is at least so wide: a share of the longer side of the data.
const LEAST_SHARE: f64 = 0.01;

impl TileGeometry {
    /// What a first view shows, if this is the root: the rectangle of its roads with a margin; without roads, all `data`.
    ///
    /// The root has the important roads alone, simplified. That is enough to tell where they are.
    #[must_use]
    pub fn map_extent(&self, data: Bounds) -> MapExtent {
        let plan = self.roads_bounds().map_or(data, |roads| with_margin(roads, data));
        MapExtent { plan, heights_m: self.heights_in(plan) }
    }

    /// The rectangle that has nearly all of the roads' length.
    fn roads_bounds(&self) -> Option<Bounds> {
        let on_ground = self.roads.all().iter().map(|piece| {
            let [from, to] = piece.shares;
            part_of(piece.start_in_tile, piece.end_in_tile, from, to)
        });
        let in_plan = self
            .volumes
            .all()
            .iter()
            .map(|volume| part_of(volume.start_in_tile, volume.end_in_tile, 0.0, 1.0));
        let pieces: Vec<([f64; 2], f64)> = on_ground.chain(in_plan).collect();
        let [x, y, _] = self.reference_m;
        let [min_x, max_x] = without_tails(&pieces, 0)?.map(|east_m| x + east_m);
        let [min_y, max_y] = without_tails(&pieces, 1)?.map(|north_m| y + north_m);
        Some(Bounds { min_x, min_y, max_x, max_y })
    }

    /// The heights of the ground in a rectangle, as far as this tile's vertices tell; of all its ground if none is there.
    fn heights_in(&self, plan: Bounds) -> [f64; 2] {
        let [x, y, height_m] = self.reference_m;
        let inside = |position: &[f64; 3]| {
            (plan.min_x..=plan.max_x).contains(&(x + position[0]))
                && (plan.min_y..=plan.max_y).contains(&(y + position[1]))
        };
        let positions =
            self.ground.vertices.iter().map(|vertex| vertex.position_in_tile.map(f64::from));
        let [low_m, high_m] = positions
            .filter(inside)
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], [.., z]| {
                [low.min(height_m + z), high.max(height_m + z)]
            });
        if low_m <= high_m {
            [low_m, high_m]
        } else {
            self.summary.map_or([0.0; 2], |summary| summary.height_range_m)
        }
    }
}

/// Middle and length of a part of a segment.
fn part_of(start: [f32; 2], end: [f32; 2], from: f32, to: f32) -> ([f64; 2], f64) {
    let [start, end] = [start, end].map(|point| point.map(f64::from));
    let along = [end[0] - start[0], end[1] - start[1]];
    let middle = f64::midpoint(f64::from(from), f64::from(to));
    let length_m = f64::from(to - from) * along[0].hypot(along[1]);
    ([start[0] + middle * along[0], start[1] + middle * along[1]], length_m)
}

/// The range of one coordinate without the tails; `None` without any length.
fn without_tails(pieces: &[([f64; 2], f64)], axis: usize) -> Option<[f64; 2]> {
    let mut along: Vec<(f64, f64)> = pieces.iter().map(|(at, m)| (at[axis], *m)).collect();
    along.sort_by(|a, b| a.0.total_cmp(&b.0));
    let total_m: f64 = along.iter().map(|(_, length_m)| length_m).sum();
    if total_m <= 0.0 {
        return None;
    }
    let tail_m = TAIL * total_m;
    Some([end_of_tail(along.iter(), tail_m)?, end_of_tail(along.iter().rev(), tail_m)?])
}

/// Where so much length has been passed.
fn end_of_tail<'a>(mut along: impl Iterator<Item = &'a (f64, f64)>, tail_m: f64) -> Option<f64> {
    let mut passed_m = 0.0;
    along.find_map(|(at, length_m)| {
        passed_m += length_m;
        (passed_m > tail_m).then_some(*at)
    })
}

/// A rectangle with its margin, within the data.
fn with_margin(roads: Bounds, data: Bounds) -> Bounds {
    let least_m = LEAST_SHARE * data.width().max(data.height());
    let margin_m = (MARGIN * roads.width().max(roads.height())).max(least_m / 2.0);
    let wider = Bounds {
        min_x: (roads.min_x - margin_m).max(data.min_x),
        min_y: (roads.min_y - margin_m).max(data.min_y),
        max_x: (roads.max_x + margin_m).min(data.max_x),
        max_y: (roads.max_y + margin_m).min(data.max_y),
    };
    if wider.is_empty() { data } else { wider }
}

#[cfg(test)]
#[path = "map_extent_tests.rs"]
mod tests;
