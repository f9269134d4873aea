//! The ground deviates from a plane by at most the bounds from its slopes.

use corniche_geom::{Cell, NodeIndex, TILE_CELLS, TileId};
use corniche_tin::{Placement, Tin, TinVertex};
use proptest::prelude::*;

use super::*;

const STEP: u16 = 8;

/// Returns a tile with a vertex at every eighth node. `height_q` returns heights by column and row
/// of the vertices, in steps of half a metre.
fn ground(height_q: impl Fn(u16, u16) -> i32) -> (GridFrame, Surface) {
    let frame = GridFrame::new(
        [0.5, 0.25],
        Cell { east_m: 10.0, north_m: 15.0 }.fitted(),
        NodeIndex { i: 0, j: 256 },
        0,
    )
    .unwrap();
    let count = TILE_CELLS as u16 / STEP + 1;
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    for row in 0..count {
        for column in 0..count {
            let height_q = height_q(column, row);
            vertices.push(TinVertex { row: row * STEP, column: column * STEP, height_q });
            let [nw, sw] = [row, row + 1].map(|row| u32::from(row * count + column));
            if row + 1 < count && column + 1 < count {
                triangles.extend([[nw, sw, nw + 1], [sw, sw + 1, nw + 1]]);
            }
        }
    }
    let placement = Placement::of_tile(&frame, TileId::ROOT, 0.5);
    (frame, Surface::new(&Tin::new(vertices, &triangles).unwrap(), placement))
}

/// Returns the corners of a rectangle around a point, counter-clockwise, rotated by an angle.
/// `half_m` has half its length and half its width.
fn turned([x, y]: [f64; 2], angle_rad: f64, half_m: [f64; 2]) -> [[f64; 2]; 4] {
    let (sin, cos) = angle_rad.sin_cos();
    [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|[along, across]| {
        let (a, b) = (along * half_m[0], across * half_m[1]);
        [x + a * cos - b * sin, y + a * sin + b * cos]
    })
}

proptest! {
    /// The ground in a rectangle is never farther from a plane than the bounds from the slopes.
    #[test]
    fn no_ground_leaves_a_plane_by_more(
        seed in 0_i32..1000, steep in 1_i32..60, angle_rad in 0.0..6.3_f64,
        at_m in [0.0..2560.0_f64, 0.0..3840.0_f64], half_m in [1.0..600.0_f64, 1.0..300.0_f64],
        height_m in -500.0..3000.0_f64, gradient in [-1.0..1.0_f64, -1.0..1.0_f64],
        samples in prop::collection::vec([-1.0..=1.0_f64, -1.0..=1.0_f64], 60),
    ) {
        let rough = |column: u16, row: u16| {
            steep * (i32::from(column) * 7919 + i32::from(row) * 104_729 + seed * 31).rem_euclid(97)
        };
        let (frame, surface) = ground(rough);
        let slopes = Slopes::of_surface(&surface, frame.tile_bounds(TileId::ROOT), &frame);
        let plane = Plane { at_m, height_m, gradient };
        let [below_m, above_m] = slopes.leaving(&plane, turned(at_m, angle_rad, half_m));
        for share in samples {
            let (sin, cos) = angle_rad.sin_cos();
            let [a, b] = [share[0] * half_m[0], share[1] * half_m[1]];
            let at = frame.snap([at_m[0] + a * cos - b * sin, at_m[1] + a * sin + b * cos]).unwrap();
            let Some(triangle) = surface.locate(at) else { continue };
            let leaves_m = surface.height_at_point_m(triangle, at) - plane.height_at_m(frame.position_m(at));
            // Snapping to the lattice moves a point by up to a millimetre.
            prop_assert!(leaves_m <= above_m + 0.1 && -leaves_m <= below_m + 0.1, "{leaves_m} {below_m} {above_m}");
        }
    }
}

#[test]
fn a_plane_does_not_leave_itself() {
    let (frame, surface) = ground(|column, row| 64 * i32::from(column) - 32 * i32::from(row));
    let slopes = Slopes::of_surface(&surface, frame.tile_bounds(TileId::ROOT), &frame);
    // The plane rises by 32 m for each 80 m eastwards and by 16 m for each 120 m northwards. In the
    // south-west it is 32 rows of 16 m below sea level. Positions of cells are rounded to the
    // lattice, by less than a millimetre.
    let plane = Plane { at_m: [0.5, 0.25], height_m: -512.0, gradient: [0.4, 16.0 / 120.0] };
    let leaving_m = slopes.leaving(&plane, turned([1280.0, 1280.0], 0.3, [400.0, 100.0]));
    assert!(leaving_m.iter().all(|m| *m < 0.1), "{leaving_m:?}");
    // A level plane with the same height in the south-west: eastwards the ground deviates from it
    // by at most 0.4 m per metre.
    let level = Plane { gradient: [0.0; 2], ..plane };
    let [below_m, above_m] = slopes.leaving(&level, turned([100.5, 0.25], 0.0, [100.0, 10.0]));
    assert!(
        (0.0..20.0).contains(&below_m) && (80.0..110.0).contains(&above_m),
        "{below_m} {above_m}"
    );
}
