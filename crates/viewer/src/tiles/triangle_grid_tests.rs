//! Every triangle that contains a point is found in the grid.

use corniche_geom::barycentric;
use proptest::prelude::*;

use super::*;

type Triangle = [[f64; 2]; 3];

/// A fan of triangles around a point. Some are slivers, others are large.
fn fan(center: [f32; 2], rim: usize) -> Vec<Triangle> {
    let vertex = |x: f32, y: f32| [f64::from(x), f64::from(y)];
    let center = vertex(center[0], center[1]);
    // The rim is a square of 200 m.
    let around: Vec<[f64; 2]> = (0..rim)
        .map(|k| {
            let along = k as f32 / rim as f32 * 4.0;
            let (side, share) = (along as u32, along.fract() * 200.0 - 100.0);
            match side {
                0 => vertex(share, -100.0),
                1 => vertex(100.0, share),
                2 => vertex(-share, 100.0),
                _ => vertex(-100.0, -share),
            }
        })
        .collect();
    (0..rim).map(|k| [center, around[k], around[(k + 1) % rim]]).collect()
}

fn holds([a, b, c]: Triangle, at: [f64; 2]) -> bool {
    barycentric(at, a, b, c).iter().all(|weight| *weight >= -1e-6)
}

proptest! {
    /// The cell of a point lists every triangle that contains the point, in the order of the
    /// surface. This also applies to borders of cells and of the surface.
    #[test]
    fn every_triangle_that_holds_a_place_is_found_there(
        center in prop::array::uniform2(-99.0..99.0_f32),
        rim in 4..300_usize,
        place in prop::array::uniform2(-101.0..101.0_f64),
        on_border in 0..3_u8,
    ) {
        let surface = fan(center, rim);
        let grid = TriangleGrid::new(surface.iter().copied());
        let cell_m = 200.0 / SIDE as f64;
        let at = match on_border {
            0 => place,
            1 => place.map(|side| (side / cell_m).round() * cell_m),
            _ => [place[0], place[1].signum() * 100.0],
        };
        let expected: Vec<u32> = (0..)
            .zip(&surface)
            .filter(|(_, corners)| holds(**corners, at))
            .map(|(triangle, _)| triangle)
            .collect();
        let near = grid.at(at);
        prop_assert!(near.is_sorted());
        for triangle in &expected {
            prop_assert!(near.contains(triangle), "{triangle} at {at:?}");
        }
        // They are also found along a line through the point.
        for (from, to) in [([-150.0, at[1]], [150.0, at[1]]), ([at[0], 150.0], [at[0], -150.0])] {
            let met: Vec<u32> = grid.along(from, to).flat_map(|(_, near)| near).collect();
            for triangle in &expected {
                prop_assert!(met.contains(triangle), "{triangle} from {from:?}");
            }
        }
    }
}

#[test]
fn a_cell_holds_a_part_of_many_triangles_and_a_grid_of_none_is_empty() {
    let grid = TriangleGrid::new(fan([0.0, 0.0], 4000).into_iter());
    // The worst case: all triangles are slivers. A cell then has at most those between the middle
    // and one side of the rim.
    assert!(grid.at([90.0, 5.0]).len() < 1200, "{}", grid.at([90.0, 5.0]).len());
    let shares: Vec<f64> =
        grid.along([150.0, 3.0], [-150.0, 4.0]).map(|(share, _)| share).collect();
    assert_eq!(shares.len(), SIDE);
    assert!(shares.is_sorted(), "{shares:?}");
    let none = TriangleGrid::new(std::iter::empty());
    assert!(none.at([0.0, 0.0]).is_empty() && none.along([0.0; 2], [1.0; 2]).next().is_none());
    assert_eq!(none, TriangleGrid::default());
}
