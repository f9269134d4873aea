//! Voids are filled by the documented rule, and heights do not depend on the window.

use corniche_dem::{Dem, HeightReader, OpenOptions, PlanOptions};
use corniche_geom::{Cell, NodeIndex, NodeWindow};
use proptest::prelude::*;

use crate::fixture::{Raster, all, open, options};

/// Holes of all sizes and single void samples, placed by a hash of the position.
fn holed(column: usize, row: usize) -> bool {
    let blob = (column as f64 / 9.0).sin() * (row as f64 / 7.0).cos() > 0.75;
    let speck = (column * 7919 + row * 104_729).is_multiple_of(31);
    blob || speck
}

fn geographic(folder: &std::path::Path) -> Dem {
    let raster =
        Raster::new(4326, [400, 300], [9.0, 0.001, 0.0, 47.3, 0.0, -0.001]).nodata(-9999.0);
    let path = raster.write(folder, "v.tif", |[lon, lat]| {
        let (column, row) = (((lon - 9.0) * 1000.0) as usize, ((47.3 - lat) * 1000.0) as usize);
        if holed(column, row) {
            -9999.0_f32
        } else {
            (900.0 + 300.0 * (lon * 90.0).sin() * (lat * 70.0).cos()) as f32
        }
    });
    open(&[path])
}

/// A second, simple implementation of the rule: eight directions, only original data, lengths in
/// working metres.
fn filled_by_rule(
    data: impl Fn(i64, i64) -> Option<f32>,
    i: i64,
    j: i64,
    reach: i64,
    cell: Cell,
) -> Option<f64> {
    let mut found = Vec::new();
    for (di, dj) in [(-1, -1), (-1, 0), (-1, 1), (0, -1), (0, 1), (1, -1), (1, 0), (1, 1)] {
        let hit =
            (1..=reach).find_map(|k| data(i + k * di, j + k * dj).map(|height_m| (k, height_m)))?;
        let [east_m, north_m] = [di as f64 * cell.east_m, dj as f64 * cell.north_m];
        let length = hit.0 as f64 * (east_m * east_m + north_m * north_m).sqrt();
        found.push((1.0 / length, f64::from(hit.1)));
    }
    let weight: f64 = found.iter().map(|(weight, _)| weight).sum();
    Some(found.iter().map(|(weight, height_m)| weight * height_m).sum::<f64>() / weight)
}

#[test]
fn voids_are_filled_by_the_rule_and_by_nothing_else() {
    let folder = tempfile::tempdir().unwrap();
    let dem = geographic(folder.path());
    let raw_plan = dem.plan(&options()).unwrap();
    let window = all(&raw_plan);
    let raw = dem.reader(&raw_plan).window(window).unwrap();
    assert_eq!((raw.filled, raw.is_filled.len()), (0, 0));
    let cell = raw_plan.frame.cell();
    assert!(cell.east_m < 0.7 * cell.north_m, "rectangles: {cell}");
    for reach in [1, 4, 9, 32] {
        let plan = dem.plan(&PlanOptions { fill_voids: reach, ..options() }).unwrap();
        let read = dem.reader(&plan).window(window).unwrap();
        let data = |i: i64, j: i64| {
            let is_inside =
                (0..window.columns as i64).contains(&i) && (0..window.rows as i64).contains(&j);
            is_inside.then(|| raw.heights.height(i as usize, j as usize)).flatten()
        };
        let mut filled = 0;
        for row in 0..window.rows {
            for column in 0..window.columns {
                let (before, after) =
                    (raw.heights.height(column, row), read.heights.height(column, row));
                if before.is_some() {
                    assert_eq!(before, after);
                    continue;
                }
                let at = (column as i64, row as i64);
                let expected = filled_by_rule(data, at.0, at.1, i64::from(reach), cell);
                assert_eq!(after.is_some(), expected.is_some(), "reach {reach} at {column}, {row}");
                if let (Some(after), Some(expected)) = (after, expected) {
                    assert!((f64::from(after) - expected).abs() < 1e-3);
                    assert!(read.is_filled[row * window.columns + column]);
                    filled += 1;
                }
            }
        }
        assert_eq!(read.filled, filled);
        // A lone void makes at least two nodes void on either axis, out of reach for a single cell.
        assert!(filled > 100 || reach == 1, "reach {reach} filled {filled}");
    }
}

fn bits(reader: &mut HeightReader<'_>, window: NodeWindow) -> Vec<u32> {
    reader.window(window).unwrap().heights.raw().iter().map(|height_m| height_m.to_bits()).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    /// A node has the same bits in any window: reprojected, averaged, with voids.
    #[test]
    fn heights_do_not_depend_on_the_window(
        left in 0_i64..250, top in 0_i64..250, columns in 1_usize..90, rows in 1_usize..90, case in 0_usize..3,
    ) {
        let folder = tempfile::tempdir().unwrap();
        let dem = geographic(folder.path());
        let cell_m = [None, Some(30.0), Some(290.0)][case];
        let plan = dem.plan(&PlanOptions { cell: cell_m.map(Cell::from), fill_voids: 6, ..options() }).unwrap();
        let whole = all(&plan);
        let mut reader = dem.reader(&plan);
        let reference = bits(&mut reader, whole);
        let (left, top) = (left % whole.columns as i64, top % whole.rows as i64);
        let corner = NodeIndex { i: whole.corner.i + left, j: whole.corner.j - top };
        let window = NodeWindow { corner, stride: 1, columns, rows };
        let seen = bits(&mut dem.reader(&plan), window);
        for row in 0..rows {
            for column in 0..columns {
                let (c, r) = (left as usize + column, top as usize + row);
                if c < whole.columns && r < whole.rows {
                    prop_assert_eq!(seen[row * columns + column], reference[r * whole.columns + c]);
                }
            }
        }
    }
}

#[test]
fn all_sorts_of_voids_are_voids() {
    let folder = tempfile::tempdir().unwrap();
    let frame = [500_000.0, 10.0, 0.0, 5_200_050.0, 0.0, -10.0];
    let column = |at: [f64; 2]| ((at[0] - 500_000.0) / 10.0) as usize;
    let values = [5.0_f32, f32::NAN, f32::INFINITY, -3.4e38, 3.402_823_5e38, -9999.0, 4e-27];
    let float =
        Raster::new(32632, [7, 5], frame).write(folder.path(), "f.tif", |at| values[column(at)]);
    let dem = Dem::open(&[float], &OpenOptions { nodata: vec![-9999.0], ..OpenOptions::default() })
        .unwrap();
    let plan = dem.plan(&options()).unwrap();
    let heights = dem.reader(&plan).window(all(&plan)).unwrap().heights;
    let has: Vec<bool> = (0..7).map(|c| heights.has_height(c, 2)).collect();
    assert_eq!(has, [true, false, false, false, false, false, true]);

    let values = [-32768_i16, 7, -32767, 0, 9];
    let int = Raster::new(32632, [5, 5], frame)
        .nodata(0.0)
        .write(folder.path(), "i.tif", |at| values[column(at)]);
    let dem = open(&[int]);
    let plan = dem.plan(&options()).unwrap();
    let heights = dem.reader(&plan).window(all(&plan)).unwrap().heights;
    let row: Vec<Option<f32>> = (0..5).map(|c| heights.height(c, 0)).collect();
    assert_eq!(row, [None, Some(7.0), Some(-32767.0), None, Some(9.0)]);
}
