//! The rule by which voids are filled, compared with a second, simple implementation.

use std::fs;
use std::path::PathBuf;

use corniche_dem::{DemWindow, HeightReader, OpenOptions, PlanOptions};
use corniche_geom::{Cell, NodeIndex, NodeWindow};
use proptest::prelude::*;

use crate::fixture::{Raster, all, in_utm, options};

const SIZE: [usize; 2] = [46, 38];
/// Cells of 10 × 15 m.
const FRAME: [f64; 6] = [500_000.0, 10.0, 0.0, 5_200_570.0, 0.0, -15.0];

/// A hole in the data, or an island in a void.
#[derive(Debug, Clone)]
struct Shape {
    kind: u8,
    at: [f64; 2],
    size: [f64; 2],
    slope: f64,
    is_data: bool,
}

impl Shape {
    fn covers(&self, column: usize, row: usize) -> bool {
        let (x, y) = (column as f64 - self.at[0], row as f64 - self.at[1]);
        match self.kind {
            // Rectangle, ellipse, one side of a straight edge nearly along the axes or the
            // diagonal, a lone node, and a checkerboard.
            0 => x.abs() <= self.size[0] && y.abs() <= self.size[1],
            1 => (x / self.size[0]).powi(2) + (y / self.size[1]).powi(2) <= 1.0,
            2 => y > x * self.slope + self.size[1],
            3 => x.abs() < 0.5 && y.abs() < 0.5,
            _ => {
                x.abs() <= self.size[0]
                    && y.abs() <= self.size[1]
                    && (column + row).is_multiple_of(2)
            }
        }
    }
}

fn shape() -> impl Strategy<Value = Shape> {
    let at = [0.0..46.0_f64, 0.0..38.0_f64];
    let slope = prop_oneof![-1.1..-0.9_f64, -0.1..0.1_f64, 0.9..1.1_f64, -9.0..9.0_f64];
    (0..5_u8, at, [0.5..20.0_f64, 0.5..16.0_f64], slope, any::<bool>())
        .prop_map(|(kind, at, size, slope, is_data)| Shape { kind, at, size, slope, is_data })
}

fn height_m(column: usize, row: usize) -> f32 {
    1000.0 + ((column * 7919 + row * 104_729) % 977) as f32 / 3.0
}

struct Mask {
    has_data: Vec<bool>,
}

impl Mask {
    fn new(is_ground: bool, shapes: &[Shape]) -> Self {
        let has_data = (0..SIZE[0] * SIZE[1])
            .map(|k| {
                let (column, row) = (k % SIZE[0], k / SIZE[0]);
                let last = shapes.iter().rev().find(|shape| shape.covers(column, row));
                last.map_or(is_ground, |shape| shape.is_data)
            })
            .collect();
        Self { has_data }
    }

    fn data(&self, column: i64, row: i64) -> Option<f32> {
        let is_inside = column >= 0 && row >= 0 && column < SIZE[0] as i64 && row < SIZE[1] as i64;
        let (c, r) = (column as usize, row as usize);
        (is_inside && self.has_data[r * SIZE[0] + c]).then(|| height_m(c, r))
    }

    /// The result of the rule for a void: searches from every void in each direction, step by step.
    fn filled(&self, column: i64, row: i64, reach: i64, cell: Cell) -> Option<f64> {
        let (mut sum, mut weights) = (0.0, 0.0);
        for down in -1..=1_i64 {
            for right in -1..=1_i64 {
                if (right, down) == (0, 0) {
                    continue;
                }
                let seen = |steps: i64| self.data(column + steps * right, row + steps * down);
                let (steps, found_m) = (1..=reach).find_map(|steps| Some((steps, seen(steps)?)))?;
                let distance_m = ((steps * right) as f64 * cell.east_m)
                    .hypot((steps * down) as f64 * cell.north_m);
                sum += f64::from(found_m) / distance_m;
                weights += 1.0 / distance_m;
            }
        }
        Some(sum / weights)
    }

    fn write(&self, folder: &std::path::Path) -> PathBuf {
        Raster::new(32632, SIZE, FRAME).nodata(-9999.0).write(folder, "mask.tif", |[x, y]| {
            let column = ((x - FRAME[0]) / 10.0).floor() as i64;
            let row = ((FRAME[3] - y) / 15.0).floor() as i64;
            self.data(column, row).unwrap_or(-9999.0)
        })
    }
}

fn read(reader: &mut HeightReader<'_>, window: NodeWindow) -> DemWindow {
    reader.window(window).unwrap()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(150))]

    /// Exactly the nodes of the rule are filled, with its values and the same bits, in every window
    /// that contains them, also at its corners and beyond the data.
    #[test]
    fn exactly_the_nodes_of_the_rule_are_filled(
        is_ground in any::<bool>(),
        shapes in prop::collection::vec(shape(), 0..7),
        reach in 0_u32..24,
        windows in prop::collection::vec((-3_i64..44, -3_i64..36, 1_usize..40, 1_usize..40), 1..6),
    ) {
        let folder = tempfile::tempdir().unwrap();
        let mask = Mask::new(is_ground, &shapes);
        let dem = corniche_dem::Dem::open(&[mask.write(folder.path())], &OpenOptions::default()).unwrap();
        let plan = dem.plan(&PlanOptions { fill_voids: reach, ..options() }).unwrap();
        let (whole, cell) = (all(&plan), plan.frame.cell());
        prop_assert!((cell.east_m - 10.0).abs() < 0.001 && cell.north_m == 15.0);
        prop_assert_eq!([whole.columns, whole.rows], SIZE);
        let mut reader = dem.reader(&plan);
        let reference = read(&mut reader, whole);
        let mut filled = 0;
        for row in 0..SIZE[1] {
            for column in 0..SIZE[0] {
                let found = reference.heights.height(column, row);
                if let Some(data) = mask.data(column as i64, row as i64) {
                    prop_assert_eq!(found, Some(data));
                    continue;
                }
                let expected = mask.filled(column as i64, row as i64, i64::from(reach), cell);
                prop_assert_eq!(found.is_some(), expected.is_some(), "node {}, {}", column, row);
                if let (Some(found), Some(expected)) = (found, expected) {
                    prop_assert!((f64::from(found) - expected).abs() < 2e-4, "{} for {}", found, expected);
                    prop_assert!(reference.is_filled[row * SIZE[0] + column]);
                    filled += 1;
                }
            }
        }
        prop_assert_eq!(reference.filled, filled);
        prop_assert_eq!(reference.is_filled.iter().filter(|&&is| is).count() as u64, filled);
        for (left, top, columns, rows) in windows {
            let corner = NodeIndex { i: whole.corner.i + left, j: whole.corner.j - top };
            let seen = read(&mut reader, NodeWindow { corner, stride: 1, columns, rows });
            for row in 0..rows {
                for column in 0..columns {
                    let (c, r) = (left + column as i64, top + row as i64);
                    let is_inside = c >= 0 && r >= 0 && c < SIZE[0] as i64 && r < SIZE[1] as i64;
                    let same = is_inside.then(|| reference.heights.height(c as usize, r as usize)).flatten();
                    let found = seen.heights.height(column, row);
                    prop_assert_eq!(found.map(f32::to_bits), same.map(f32::to_bits), "node {}, {}", c, r);
                }
            }
        }
    }
}

/// A square of degrees has slanting edges in metres: nothing is filled beyond them, with any reach.
#[test]
fn nothing_is_filled_beyond_the_edge_of_reprojected_squares() {
    let folder = tempfile::tempdir().unwrap();
    let frame = [10.5, 0.001, 0.0, 60.5, 0.0, -0.001];
    let file = Raster::new(4326, [240, 200], frame).write(folder.path(), "ll.tif", |at| at[1]);
    let dem = crate::fixture::open(&[file]);
    let bare = dem.plan(&in_utm()).unwrap();
    let window = all(&bare);
    let bare = read(&mut dem.reader(&bare), window);
    assert!(bare.heights.count_heights() * 20 < window.columns * window.rows * 19, "edges slant");
    for reach in [1, 3, 32, 500] {
        let plan = dem.plan(&PlanOptions { fill_voids: reach, ..in_utm() }).unwrap();
        let filled = read(&mut dem.reader(&plan), window);
        assert_eq!(filled.filled, 0, "reach {reach}");
        let bits = |read: &DemWindow| -> Vec<u32> {
            read.heights.raw().iter().map(|height_m| height_m.to_bits()).collect()
        };
        assert!(bits(&filled) == bits(&bare), "reach {reach}");
    }
    assert!(fs::read_dir(folder.path()).unwrap().count() == 1);
}
