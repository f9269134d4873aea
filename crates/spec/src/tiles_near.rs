//! The tiles that a segment may touch.

use corniche_geom::{LatticeBounds, LatticePoint, TileId};

use crate::levels::Levels;

/// Visits the tiles of `level` whose margin the segment may touch, borders included. It works row
/// by row of tiles, so that one endless segment (a misplaced node) visits the tiles along it and
/// not all those of its bounding box.
pub fn for_each_tile_near(
    segment: [LatticePoint; 2],
    level: u8,
    levels: &Levels,
    mut visit: impl FnMut(TileId),
) {
    let frame = levels.frame();
    let margin = levels.margin_steps(level);
    let last = (1_i64 << level) - 1;
    let Some(bounds) = LatticeBounds::around(&segment) else { return };
    // A point on a border belongs to the tile south of it. One more step to the north includes the
    // tile that ends there.
    let bounds = bounds.expanded(margin + 1);
    let [_, south] = frame.tile_column_row(level, bounds.min);
    let [_, north] = frame.tile_column_row(level, bounds.max);
    for y in north.max(0)..=south.min(last) {
        let Ok(row) = TileId::new(level, 0, y as u32) else { continue };
        let row = frame.tile_lattice_bounds(row);
        // The stretch of the segment between the row's borders, with margins and one step of
        // rounding.
        let reach = [row.min.v - margin - 1, row.max.v + margin + 1];
        let [low, high] = stretch_u(segment, reach);
        let column = |u: i64| frame.tile_column_row(level, LatticePoint::new(u, row.min.v))[0];
        let (west, east) = (column(low - margin - 1), column(high + margin + 1));
        for x in west.max(0)..=east.min(last) {
            if let Ok(id) = TileId::new(level, x as u32, y as u32) {
                visit(id);
            }
        }
    }
}

/// Smallest and largest u of the part of a segment whose v lies within `reach`, rounded outwards.
fn stretch_u([a, b]: [LatticePoint; 2], reach: [i64; 2]) -> [i64; 2] {
    if a.v == b.v {
        return [a.u.min(b.u), a.u.max(b.u)];
    }
    let at = |v: i64| {
        let v = v.clamp(a.v.min(b.v), a.v.max(b.v));
        let share = (v - a.v) as f64 / (b.v - a.v) as f64;
        a.u as f64 + share * (b.u - a.u) as f64
    };
    let [one, other] = reach.map(at);
    // f64 represents lattice coordinates exactly up to 2^53; one step of slack per 2^50 covers the
    // rounding.
    let slack = (one.abs().max(other.abs()) / (1_i64 << 50) as f64).ceil() + 1.0;
    [(one.min(other) - slack) as i64, (one.max(other) + slack) as i64]
}

#[cfg(test)]
#[path = "tiles_near_tests.rs"]
mod tests;
