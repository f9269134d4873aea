//! Triangles against elevation data that are bilinear between samples.

use corniche_geom::LatticePoint;
use corniche_tin::{Placement, Tin, TinVertex};

use super::*;

const STEPS: f64 = 1000.0;

/// A roof of four cells a side, whose ridge runs along the diagonal, through the middle of cells.
fn roof() -> Surface {
    let vertex = |column: u16, row: u16, height_q: i32| TinVertex { column, row, height_q };
    let corners = vec![vertex(0, 0, 0), vertex(4, 0, 40), vertex(0, 4, 40), vertex(4, 4, 0)];
    let tin = Tin::new(corners, &[[0, 2, 1], [1, 2, 3]]).unwrap();
    let corner = LatticePoint::new(0, 4 * STEPS as i64);
    let placement = Placement { corner, node_steps: [STEPS as i64; 2], quantum_m: 0.25 };
    Surface::new(&tin, placement)
}

/// A line from side to side, over the ridge.
fn line(surface: &Surface, from: [f64; 2], to: [f64; 2]) -> Vec<Vertex> {
    let height_m = |at: [f64; 2]| {
        let point = LatticePoint { u: at[0] as i64, v: at[1] as i64 };
        surface.height_in_triangle_m(surface.locate(point).unwrap(), at)
    };
    // The ridge is the diagonal from the south-west to the north-east.
    let share = (from[1] - from[0]) / ((to[0] - from[0]) - (to[1] - from[1]));
    let ridge = [0, 1].map(|axis| from[axis] + share * (to[axis] - from[axis]));
    [from, ridge, to].map(|at| Vertex { at, z_m: height_m(at), is_source: false }).to_vec()
}

/// Data anywhere within the stored error at the samples are within the bound of the line
/// everywhere. Data on the triangles themselves come close to the bound: in a cell of the ridge
/// they are a quarter of its fold below.
#[test]
fn data_within_the_stored_error_are_within_the_bound() {
    let surface = roof();
    let stored_m = 0.4;
    let mut state = 3_u64;
    let mut random = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        (state >> 33) as f64 / f64::from(1_u32 << 31)
    };
    let mut nearest: f64 = 0.0;
    for round in 0..60 {
        let from = [(4000.0 * random()).floor(), 0.0];
        let to = [(4000.0 * random()).floor(), 4000.0];
        let line = line(&surface, from, to);
        let corners_m = HashMap::new();
        let mut own = TileCells { steps: [STEPS; 2], stored_m, surface: &surface, corners_m };
        let bound_m = own.bound_m(&line);
        let mut data_m = [[0.0; 5]; 5];
        for (j, row) in data_m.iter_mut().enumerate() {
            for (i, height_m) in row.iter_mut().enumerate() {
                let point = LatticePoint::new(1000 * i as i64, 1000 * j as i64);
                let triangle = surface.locate(point).unwrap();
                let own_m = surface.height_at_point_m(triangle, point);
                let off_m = if round % 2 == 0 { 2.0 * random() - 1.0 } else { -1.0 };
                *height_m = own_m + stored_m * off_m;
            }
        }
        for [from, to] in line.array_windows::<2>() {
            for k in 0..=1000 {
                let share = f64::from(k) / 1000.0;
                let at = [0, 1].map(|axis| from.at[axis] + share * (to.at[axis] - from.at[axis]));
                let cell = at.map(|at| (at / STEPS).floor().min(3.0));
                let [x, y] = [0, 1].map(|axis| at[axis] / STEPS - cell[axis]);
                let [i, j] = cell.map(|index| index as usize);
                let south = data_m[j][i] + x * (data_m[j][i + 1] - data_m[j][i]);
                let north = data_m[j + 1][i] + x * (data_m[j + 1][i + 1] - data_m[j + 1][i]);
                let line_m = from.z_m + share * (to.z_m - from.z_m);
                let off_m = (line_m - south - y * (north - south)).abs();
                assert!(off_m <= bound_m + 1e-9, "{off_m} {bound_m}");
                nearest = nearest.max(off_m / bound_m);
            }
        }
    }
    assert!(nearest > 0.95, "{nearest}");
}
