//! Several files as one raster: of one grid, and of different coordinate systems.

use std::path::PathBuf;

use corniche_dem::{GridPlan, PlanOptions, Resampling};
use corniche_geom::{Cell, GridFrame, HeightGrid, Projection};

use crate::fixture::{HUNDREDTH_M, Raster, UTM, all, check, folder, open, options, plan, plane};

/// Interpolation crosses the seam of two files, with or without a shared column, and the first
/// named has precedence in the overlap.
#[test]
fn files_of_one_grid_are_one_raster() {
    let folder = folder();
    let east = |columns: f64| [UTM[0] + 10.0 * columns, 10.0, 0.0, UTM[3], 0.0, -10.0];
    let left = Raster::new(32632, [30, 50], UTM).write(folder.path(), "left.tif", plane);
    let right = Raster::new(32632, [30, 50], east(30.0)).write(folder.path(), "right.tif", plane);
    let over = Raster::new(32632, [30, 50], east(20.0)).nodata(-1.0);
    let over = over.write(folder.path(), "over.tif", |at| {
        if (at[1] as i64 / 10) % 2 == 0 { -1.0 } else { plane(at) + 1000.0 }
    });
    let whole = Raster::new(32632, [60, 50], UTM).write(folder.path(), "whole.tif", plane);
    let off_grid = PlanOptions { cell: Some(7.0_f64.into()), ..options() };
    let read = |files: &[PathBuf], options: &PlanOptions| {
        let dem = open(files);
        let plan = dem.plan(options).unwrap();
        let mut reader = dem.reader(&plan);
        reader.window(all(&plan)).unwrap().heights
    };
    // Another first file shifts the samples' numbering, and with it the last bit of interpolation.
    let agree = |a: &HeightGrid, b: &HeightGrid| {
        let mut pairs = a.raw().iter().zip(b.raw());
        assert!(
            a.raw().len() == b.raw().len()
                && pairs.all(|(a, b)| (a - b).abs() < 1e-4 || a.is_nan() && b.is_nan())
        );
    };
    for options in [options(), off_grid] {
        let expected = read(std::slice::from_ref(&whole), &options);
        assert!(expected.count_heights() > 2900);
        agree(&read(&[left.clone(), right.clone()], &options), &expected);
        agree(&read(&[right.clone(), left.clone()], &options), &expected);
        agree(&read(&[whole.clone(), over.clone()], &options), &expected);
    }
    let overlaid = read(&[over, whole], &options());
    let truth = |column: usize, row: usize| {
        plane([500_008.0 + 10.0 * column as f64, 5_200_502.0 - 10.0 * row as f64]) as f32
    };
    for row in 0..50 {
        let is_void = ((5_200_502.0 - 10.0 * row as f64) as i64 / 10) % 2 == 0;
        assert_eq!(overlaid.height(10, row), Some(truth(10, row)));
        let expected =
            if is_void { truth(35, row) } else { (f64::from(truth(35, row)) + 1000.0) as f32 };
        assert!(
            (overlaid.height(35, row).unwrap() - expected).abs() < 1e-3,
            "a void falls through"
        );
    }
}

/// The frame of the first file's grid over all nodes of a plan.
fn grown(first: &GridFrame, plan: &GridPlan) -> GridFrame {
    GridFrame::covering(first.origin_m(), first.cell(), plan.south_west, plan.north_east).unwrap()
}

#[test]
fn files_in_different_systems_serve_one_grid() {
    let folder = folder();
    let own = Raster::new(32632, [60, 50], UTM).write(folder.path(), "a.tif", plane);
    let alone = open(std::slice::from_ref(&own));
    let alone_plan = plan(&alone);
    let projection = alone.projection(&alone_plan).unwrap();
    // Twice as wide, in degrees.
    let degrees = Raster::new(4326, [220, 100], [8.9995, 0.0001, 0.0, 46.9585, 0.0, -0.0001]);
    let degrees = degrees.write(folder.path(), "b.tif", |lonlat| {
        let mut points = [lonlat];
        projection.working_from_wgs84(&mut points).unwrap();
        plane(points[0])
    });
    let dem = open(&[own, degrees]);
    let plan = plan(&dem);
    // The degrees are the finer ones; nevertheless CRS and cell are those of the first file.
    assert_eq!((plan.crs.as_str(), plan.frame), ("EPSG:32632", grown(&alone_plan.frame, &plan)));
    assert_eq!((plan.resampling, plan.frame.cell()), (Resampling::Resampled, Cell::from(10.0)));
    let told = plan.resampling_text.as_str();
    for words in ["samples of a.tif", "bilinear between the samples of b.tif in EPSG:4326"] {
        assert!(told.contains(words), "{words:?} is not in: {told}");
    }
    let mut reader = dem.reader(&plan);
    let count = check(&mut reader, &plan, HUNDREDTH_M, plane);
    assert!(count as f64 > 0.9 * 220.0 * 100.0 * 7.6 * 11.1 / 100.0, "{count}");
    // Where the first file has data, its samples are returned bit for bit.
    let whole = all(&plan);
    let heights = reader.window(whole).unwrap().heights;
    let window = all(&alone_plan);
    let samples = alone.reader(&alone_plan).window(window).unwrap().heights;
    let (left, top) = (window.corner.i - whole.corner.i, whole.corner.j - window.corner.j);
    let seen = heights.window(left as usize, top as usize, 60, 50);
    assert!(seen.raw().iter().zip(samples.raw()).all(|(a, b)| a.to_bits() == b.to_bits()));
}
