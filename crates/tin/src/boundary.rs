//! Chooses vertices on the tile's border and on the boundaries of voids, before greedy insertion
//! begins.

use crate::tile_raster::TileRaster;

/// A straight, simplified stretch of border or boundary: nodes `[column, row]`, west to east or
/// north to south.
pub(crate) type BorderStretch = Vec<[usize; 2]>;

/// Returns all stretches of the tile's border and of the boundaries of its voids, each simplified
/// separately.
///
/// A grid line is cut where ground begins or ends on either side of it. On the border of the tile,
/// the halo has the outer side:
///
/// ```text
///          outer:  ground   ground   void    void
///      ●────────┼────────●────────┼────────●         ●: end of a stretch
///          inner:  ground   ground   ground  ground
/// ```
///
/// The neighbour sees the same two sides with their names swapped, cuts at the same nodes, and
/// simplifies the same heights in the same direction: both tiles get the same vertices wherever
/// both have ground. Each end of a stretch becomes a vertex, including the corners of boundaries
/// and of the tile.
pub(crate) fn stretches(
    tile: &TileRaster<'_>,
    max_error_m: f64,
    quantum_m: f64,
) -> Vec<BorderStretch> {
    let (columns, rows) = (tile.columns(), tile.rows());
    let mut found = Vec::new();
    let mut line = |length: usize,
                    sides: &dyn Fn(usize) -> Option<[bool; 2]>,
                    node: &dyn Fn(usize) -> [usize; 2]| {
        let mut start = 0;
        while start + 1 < length {
            let here = sides(start);
            let mut end = start + 1;
            while end + 1 < length && sides(end) == here {
                end += 1;
            }
            if here.is_some() {
                found.push(simplify(tile, start, end, node, max_error_m, quantum_m));
            }
            start = end;
        }
    };
    for row in 0..rows {
        let sides = |column: usize| {
            let [north, south] =
                [tile.halo_cell([column + 1, row]), tile.halo_cell([column + 1, row + 1])];
            let bounds_ground = match row {
                0 => south,
                _ if row == rows - 1 => north,
                _ => north != south,
            };
            bounds_ground.then_some([north, south])
        };
        line(columns, &sides, &|column| [column, row]);
    }
    for column in 0..columns {
        let sides = |row: usize| {
            let [west, east] =
                [tile.halo_cell([column, row + 1]), tile.halo_cell([column + 1, row + 1])];
            let bounds_ground = match column {
                0 => east,
                _ if column == columns - 1 => west,
                _ => west != east,
            };
            bounds_ground.then_some([west, east])
        };
        line(rows, &sides, &|row| [column, row]);
    }
    found
}

/// Greedy insertion in one dimension: the node farthest from the line between two kept nodes is
/// also kept, until no node is farther than `max_error_m`. Among equally distant nodes the first is
/// chosen. The ends are kept.
///
/// Source: Garland & Heckbert 1995, *Fast Polygonal Approximation of Terrains and Height Fields*,
/// applied to one dimension, where it is the algorithm of Ramer 1972 and Douglas & Peucker 1973
/// with vertical distances.
fn simplify(
    tile: &TileRaster<'_>,
    start: usize,
    end: usize,
    node: &dyn Fn(usize) -> [usize; 2],
    max_error_m: f64,
    quantum_m: f64,
) -> BorderStretch {
    let stored_m = |index: usize| f64::from(tile.height_q(node(index))) * quantum_m;
    let mut kept = vec![node(start)];
    // The intervals that are still to be examined, the next one on top.
    let mut spans = vec![[start, end]];
    while let Some([from, to]) = spans.pop() {
        let (from_m, to_m, length) = (stored_m(from), stored_m(to), (to - from) as f64);
        // Everything is multiplied by the length, so that the numbers are exact, as in the
        // residuals of triangles.
        let mut worst = (max_error_m * length, None);
        for index in from + 1..to {
            let on_line = from_m * length + (to_m - from_m) * (index - from) as f64;
            let scaled = (tile.height_m(node(index)) * length - on_line).abs();
            if scaled > worst.0 {
                worst = (scaled, Some(index));
            }
        }
        if let Some(index) = worst.1 {
            spans.push([index, to]);
            spans.push([from, index]);
        } else {
            kept.push(node(to));
        }
    }
    kept
}
