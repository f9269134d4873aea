//! P3: two tiles of one level share bit-identical border vertices.

use std::collections::BTreeMap;

use corniche_geom::TileId;
use corniche_tin::Tin;

/// One of a tile's borders.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum TileEdge {
    North,
    South,
    West,
    East,
}

/// One border of a tile: its vertices by their position along the border (from west or north), and
/// the edges of triangles between them.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(crate) struct BorderVertices {
    vertices: BTreeMap<u16, i32>,
    stretches: Vec<[u16; 2]>,
}

/// The four borders of a tile, in the order of [`TileEdge`].
pub(crate) type Borders = [BorderVertices; 4];

const LAST: u16 = 256;

pub(crate) fn borders(tin: &Tin) -> Borders {
    [TileEdge::North, TileEdge::South, TileEdge::West, TileEdge::East].map(|edge| border(tin, edge))
}

fn border(tin: &Tin, edge: TileEdge) -> BorderVertices {
    let along = |index: u32| {
        let vertex = &tin.vertices()[index as usize];
        let (across, along) = match edge {
            TileEdge::North | TileEdge::South => (vertex.row, vertex.column),
            TileEdge::West | TileEdge::East => (vertex.column, vertex.row),
        };
        let wanted = if matches!(edge, TileEdge::North | TileEdge::West) { 0 } else { LAST };
        (across == wanted).then_some((along, vertex.height_q))
    };
    let mut border = BorderVertices::default();
    for corners in tin.triangles() {
        for k in 0..3 {
            if let (Some(a), Some(b)) = (along(corners[k]), along(corners[(k + 1) % 3])) {
                border.vertices.extend([a, b]);
                border.stretches.push([a.0.min(b.0), a.0.max(b.0)]);
            }
        }
    }
    border.stretches.sort_unstable();
    border
}

/// Compares the two sides of a border where both have ground, and returns the positions at which
/// they differ.
pub(crate) fn differences(one: &BorderVertices, other: &BorderVertices) -> Vec<u16> {
    let mut positions = Vec::new();
    let covered = |border: &BorderVertices, position: u16| {
        border.stretches.iter().any(|&[low, high]| (low..=high).contains(&position))
    };
    for (own, opposite) in [(one, other), (other, one)] {
        for (&position, height_q) in &own.vertices {
            // A vertex is compared where both sides have ground around it. Where the ground of one
            // side ends, the other side must have a vertex, too; otherwise a crack could begin
            // there.
            if covered(opposite, position) && opposite.vertices.get(&position) != Some(height_q) {
                positions.push(position);
            }
        }
    }
    positions.sort_unstable();
    positions.dedup();
    positions
}

/// The tiles east and south of `id`; with each, the border of `id` and the border of the neighbour
/// that touch.
pub(crate) fn neighbours(id: TileId) -> impl Iterator<Item = (TileId, TileEdge, TileEdge)> {
    [(1, 0, TileEdge::East, TileEdge::West), (0, 1, TileEdge::South, TileEdge::North)]
        .into_iter()
        .filter_map(move |(dx, dy, own, theirs)| Some((id.neighbour(dx, dy)?, own, theirs)))
}

#[cfg(test)]
#[path = "seams_tests.rs"]
mod tests;
