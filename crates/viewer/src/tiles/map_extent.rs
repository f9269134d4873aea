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

impl MapExtent {
    /// The rectangle of the roads of some tiles, which are all of a level, with a margin, within the rectangle of the `data`.
    /// `None` if there are no roads on them.
    ///
    /// A coarse level has the important roads alone, simplified. That is enough to tell where they are.
    #[must_use]
    pub fn of_roads(tiles: &[&TileGeometry], data: Bounds) -> Option<Self> {
        let pieces: Vec<Piece> = tiles.iter().flat_map(|tile| pieces(tile)).collect();
        let [min_x, max_x] = without_tails(&pieces, 0)?;
        let [min_y, max_y] = without_tails(&pieces, 1)?;
        let plan = with_margin(Bounds { min_x, min_y, max_x, max_y }, data);
        Some(Self { plan, heights_m: heights_in(tiles, plan) })
    }

    /// All of the `data`, whose ground lies between these heights.
    #[must_use]
    pub fn of_data(data: Bounds, heights_m: [f64; 2]) -> Self {
        Self { plan: data, heights_m }
    }
}

/// A piece of a road: its middle in the working CRS, and its length in metres.
type Piece = ([f64; 2], f64);

fn pieces(tile: &TileGeometry) -> impl Iterator<Item = Piece> {
    let [x, y, _] = tile.reference_m;
    let on_ground = tile.roads.all().iter().map(|piece| {
        let [from, to] = piece.shares;
        part_of(piece.start_in_tile, piece.end_in_tile, from, to)
    });
    let in_plan = tile
        .volumes
        .all()
        .iter()
        .map(|volume| part_of(volume.start_in_tile, volume.end_in_tile, 0.0, 1.0));
    let pieces = on_ground.chain(in_plan);
    pieces.map(move |([east, north], length_m)| ([x + east, y + north], length_m))
}

/// The heights of the ground in a rectangle, as far as the vertices of tiles tell; of all their ground if none is there.
fn heights_in(tiles: &[&TileGeometry], plan: Bounds) -> [f64; 2] {
    let heights = tiles.iter().flat_map(|tile| {
        let [x, y, height_m] = tile.reference_m;
        tile.ground.vertices.iter().filter_map(move |vertex| {
            let [east, north, above] = vertex.position_in_tile.map(f64::from);
            plan.contains([x + east, y + north]).then_some([height_m + above; 2])
        })
    });
    let all = tiles.iter().filter_map(|tile| tile.summary).map(|ground| ground.height_range_m);
    span(heights).or_else(|| span(all)).unwrap_or_default()
}

/// What all these ranges lie in.
fn span(ranges: impl Iterator<Item = [f64; 2]>) -> Option<[f64; 2]> {
    ranges.reduce(|[low, high], [next_low, next_high]| [low.min(next_low), high.max(next_high)])
}

/// Middle and length of a part of a segment.
fn part_of(start: [f32; 2], end: [f32; 2], from: f32, to: f32) -> Piece {
    let [start, end] = [start, end].map(|point| point.map(f64::from));
    let along = [end[0] - start[0], end[1] - start[1]];
    let middle = f64::midpoint(f64::from(from), f64::from(to));
    let length_m = f64::from(to - from) * libm::hypot(along[0], along[1]);
    ([start[0] + middle * along[0], start[1] + middle * along[1]], length_m)
}

/// The range of one coordinate without the tails; `None` without any length.
fn without_tails(pieces: &[Piece], axis: usize) -> Option<[f64; 2]> {
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
#[expect(clippy::float_cmp, reason = "these numbers are exact")]
#[path = "map_extent_tests.rs"]
mod tests;
