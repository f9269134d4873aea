//! Extends areas into a strip around their tile, so that no gap shows between tiles.

use corniche_geom::{LatticeBounds, LatticePoint};

/// The strip around a tile into which its areas are extended.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Strip {
    /// Bounds of the tile.
    pub(crate) tile: LatticeBounds,
    /// Width of the strip east and north, lattice steps.
    pub(crate) wide: [i64; 2],
}

/// Moves the parts of a ring that are on the border of the tile outwards.
///
/// ```text
///        inside the tile  │  strip
///                         │
///          A ──────────── B₁ ── B₁'
///                         │     │        what was the segment B₁ B₂
///          C ──────────── B₂ ── B₂'
///                         │
/// ```
///
/// Ground on the border, and the skirt that hangs from it, is then well inside, however its
/// position is rounded. A volume paints only the ground of its own tile, so the strip itself is
/// never visible.
pub(crate) fn with_strips(ring: &[LatticePoint], strip: Strip) -> Vec<LatticePoint> {
    let mut moved = Vec::with_capacity(ring.len() + 4);
    for (index, &point) in ring.iter().enumerate() {
        let before = ring[(index + ring.len() - 1) % ring.len()];
        let after = ring[(index + 1) % ring.len()];
        match [strip.outwards(before, point), strip.outwards(point, after)] {
            [None, None] => moved.push(point),
            [None, Some(by)] => moved.extend([point, shifted(point, by)]),
            [Some(by), None] => moved.extend([shifted(point, by), point]),
            [Some(by), Some(same)] if by == same => moved.push(shifted(point, by)),
            // A corner of the tile.
            [Some(by), Some(other)] => moved.push(shifted(shifted(point, by), other)),
        }
    }
    moved
}

impl Strip {
    /// Offset of a segment on the border; `None` for all other segments.
    fn outwards(self, from: LatticePoint, to: LatticePoint) -> Option<[i64; 2]> {
        let LatticeBounds { min, max } = self.tile;
        let [east, north] = self.wide;
        let sides = [
            (from.u, to.u, min.u, [-east, 0]),
            (from.u, to.u, max.u, [east, 0]),
            (from.v, to.v, min.v, [0, -north]),
            (from.v, to.v, max.v, [0, north]),
        ];
        let found = sides.into_iter().find(|(from, to, side, _)| from == to && from == side);
        found.map(|(.., by)| by)
    }
}

fn shifted(point: LatticePoint, [u, v]: [i64; 2]) -> LatticePoint {
    LatticePoint::new(point.u + u, point.v + v)
}
