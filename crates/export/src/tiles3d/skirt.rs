//! Walls that hang from the borders of a tile, behind which gaps between levels are not seen.

use super::placed::PlacedTile;

/// The walls of a tile.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Skirt {
    /// Positions from the tile's middle, with the tile's vertex whose normal and colour they have.
    pub(crate) vertices: Vec<([f32; 3], u32)>,
    pub(crate) triangles: Vec<[u32; 3]>,
}

impl Skirt {
    /// Walls of a depth below each edge along a side of the tile.
    pub(crate) fn below(tile: &PlacedTile, depth_m: f64) -> Self {
        let mut skirt = Self::default();
        let mut place = vec![u32::MAX; tile.vertices.len()];
        let [.., up] = tile.axes;
        for triangle in &tile.triangles {
            for k in 0..3 {
                let ends = [triangle[k], triangle[(k + 1) % 3]];
                let [one, other] = ends.map(|vertex| tile.vertices[vertex as usize].sides);
                if !(0..4).any(|side| one[side] && other[side]) {
                    continue;
                }
                // An edge that two triangles share along a side comes from vertices that fell together.
                let [a, b] = ends.map(|vertex| {
                    let place = &mut place[vertex as usize];
                    if *place == u32::MAX {
                        *place = skirt.vertices.len() as u32;
                        let top = tile.vertices[vertex as usize].at_m;
                        let bottom: [f32; 3] = [0, 1, 2]
                            .map(|axis| (f64::from(top[axis]) - depth_m * up[axis]) as f32);
                        skirt.vertices.extend([(top, vertex), (bottom, vertex)]);
                    }
                    *place
                });
                // Seen from outside.
                skirt.triangles.extend([[b, a, a + 1], [b, a + 1, b + 1]]);
            }
        }
        skirt
    }
}
