//! Windows of rasters whose heights are known in closed form have these heights, for rasters in any
//! orientation.

use std::path::PathBuf;

use corniche_dem::{Dem, OpenOptions, PlanOptions, Resampling};
use corniche_geom::{Cell, NodeWindow, Projection};
use gdal::Metadata;

use crate::fixture::{
    HUNDREDTH_M, Raster, UTM, all, check, check_near, degree_m, folder, in_utm, open, options,
    plan, plane, sample_blocks,
};

#[test]
fn aligned_nodes_are_the_samples() {
    let folder = folder();
    let raster = Raster::new(32632, [60, 50], UTM);
    let dem = open(&[raster.write(folder.path(), "a.tif", |at| plane(at) as f32)]);
    let plan = plan(&dem);
    assert_eq!((plan.resampling, plan.frame.cell().north_m), (Resampling::Aligned, 10.0));
    assert_eq!((plan.crs.as_str(), plan.frame.origin_m()), ("EPSG:32632", [8.0, 2.0]));
    assert!((plan.point_scale - 0.9996).abs() < 1e-6);
    assert!(plan.libraries.starts_with("GDAL 3") && plan.libraries.contains("PROJ "));
    assert_eq!(plan.data_bounds.to_array(), [500_008.0, 5_200_012.0, 500_598.0, 5_200_502.0]);
    let mut reader = dem.reader(&plan);
    assert_eq!(check(&mut reader, &plan, 1e-4, plane), 3000);
    let heights = reader.window(all(&plan)).unwrap().heights;
    for (column, row) in [(0, 0), (59, 0), (17, 31), (59, 49)] {
        assert_eq!(heights.height(column, row), Some(plane(raster.sample_at(column, row)) as f32));
    }
}

#[test]
fn south_up_is_turned_over() {
    let folder = folder();
    let south_up = Raster::new(32632, [60, 50], [500_003.0, 10.0, 0.0, 5_200_007.0, 0.0, 10.0]);
    let north_up = Raster::new(32632, [60, 50], UTM);
    let read = |path: PathBuf| {
        let dem = open(&[path]);
        let plan = plan(&dem);
        assert_eq!(plan.resampling, Resampling::Aligned);
        (plan.frame, dem.reader(&plan).window(all(&plan)).unwrap())
    };
    let a = read(south_up.write(folder.path(), "s.tif", |at| plane(at) as f32));
    assert_eq!(a, read(north_up.write(folder.path(), "n.tif", |at| plane(at) as f32)));
}

#[test]
fn pixel_is_point_lies_where_its_samples_lie() {
    let folder = folder();
    // GDAL takes and gives corners in both cases; the file stores the centre of the first pixel for
    // points.
    let point = Raster::new(32632, [60, 50], UTM)
        .tagged(|dataset| dataset.set_metadata_item("AREA_OR_POINT", "Point", "").unwrap());
    let dem = open(&[point.write(folder.path(), "point.tif", |at| plane(at) as f32)]);
    let plan = plan(&dem);
    assert_eq!(plan.frame.origin_m(), [8.0, 2.0]);
    assert_eq!(check(&mut dem.reader(&plan), &plan, 1e-4, plane), 3000);
}

#[test]
fn a_rotated_grid_is_interpolated() {
    let folder = folder();
    let (sin, cos) = 30_f64.to_radians().sin_cos();
    let turned = [500_100.0, 10.0 * cos, 10.0 * sin, 5_200_600.0, 10.0 * sin, -10.0 * cos];
    let dem = open(&[Raster::new(32632, [60, 50], turned).write(folder.path(), "r.tif", plane)]);
    let plan = plan(&dem);
    assert_eq!(plan.resampling, Resampling::Resampled);
    assert!((plan.frame.cell().north_m - 10.0).abs() < 1e-9);
    let count = check(&mut dem.reader(&plan), &plan, HUNDREDTH_M, plane);
    assert!((2700..=3000).contains(&count), "{count} nodes within the turned rectangle");
}

#[test]
fn feet_scale_and_offset_become_metres() {
    let folder = folder();
    let stored = |at: [f64; 2]| ((plane(at) / 0.3048 - 1000.0) / 0.25).round() as i16;
    let raster = Raster::new(32632, [60, 50], UTM).nodata(-9999.0).tagged(|dataset| {
        let mut band = dataset.rasterband(1).unwrap();
        band.set_scale(0.25).unwrap();
        band.set_offset(1000.0).unwrap();
    });
    let path = raster.write(folder.path(), "feet.tif", stored);
    // The crate `gdal` cannot set a band's unit; a sidecar of GDAL's own can.
    let aux = "<PAMDataset><PAMRasterBand band=\"1\"><UnitType>ft</UnitType></PAMRasterBand></PAMDataset>";
    std::fs::write(folder.path().join("feet.tif.aux.xml"), aux).unwrap();
    let dem = open(&[path]);
    let plan = plan(&dem);
    assert_eq!(check(&mut dem.reader(&plan), &plan, 0.13 * 0.3048, plane), 3000);
}

#[test]
fn a_grid_in_feet_is_laid_out_in_metres() {
    let folder = folder();
    // Pennsylvania South, US survey feet.
    let raster = Raster::new(2272, [40, 30], [2_690_000.0, 30.0, 0.0, 235_000.0, 0.0, -30.0]);
    let foot_m = 1200.0 / 3937.0;
    let dem = open(&[raster.write(folder.path(), "pa.tif", |[x, y]| {
        (x - 2_690_000.0 + 2.0 * (y - 234_000.0)) as f32
    })]);
    let plan = plan(&dem);
    assert_eq!(plan.resampling, Resampling::Aligned, "{}", plan.resampling_text);
    assert_eq!(plan.crs, "EPSG:2272");
    check_near(plan.metres_per_unit, [foot_m; 2], 1e-12);
    check_near(plan.frame.cell().to_array(), [30.0 * foot_m; 2], 1e-12);
    let truth = |[x, y]: [f64; 2]| x / foot_m - 2_690_000.0 + 2.0 * (y / foot_m - 234_000.0);
    assert_eq!(check(&mut dem.reader(&plan), &plan, 0.05, truth), 1200);
}

/// A plane in UTM, stored in longitude and latitude, is reproduced to a hundredth of a cell.
#[test]
fn a_reprojected_plane_comes_back() {
    let folder = folder();
    let utm = Raster::new(32632, [60, 50], UTM);
    let helper = open(&[utm.write(folder.path(), "utm.tif", |at| plane(at) as f32)]);
    let helper_plan = plan(&helper);
    let projection = helper.projection(&helper_plan).unwrap();
    let raster = Raster::new(4326, [300, 250], [8.9, 0.0002, 0.0, 46.98, 0.0, -0.00015]);
    let height = |lonlat: [f64; 2]| {
        let mut points = [lonlat];
        projection.working_from_wgs84(&mut points).unwrap();
        plane(points[0])
    };
    let dem = open(&[raster.write(folder.path(), "ll.tif", height)]);
    for (cell_m, averaged) in [(None, false), (Some(15.0), false), (Some(97.0), true)] {
        let plan = dem.plan(&PlanOptions { cell: cell_m.map(Cell::from), ..in_utm() }).unwrap();
        assert_eq!((plan.crs.as_str(), plan.resampling), ("EPSG:32632", Resampling::Resampled));
        assert_eq!(plan.resampling_text.contains("average"), averaged, "{}", plan.resampling_text);
        let cell = plan.frame.cell().north_m;
        assert!(cell_m.is_some() || cell == 15.0, "two digits of 15.2 and 16.7, not {cell}");
        let hundredth_m = 0.01 * cell * 0.224 + 1e-3;
        let count = check(&mut dem.reader(&plan), &plan, hundredth_m, plane);
        assert!(count as f64 > 0.9 * 300.0 * 250.0 * 15.2 * 16.7 / (cell * cell), "{count} nodes");
    }
}

#[test]
fn averages_of_a_plane_are_the_plane_also_in_its_own_crs() {
    let folder = folder();
    let dem = open(&[Raster::new(32632, [200, 180], UTM).write(folder.path(), "a.tif", plane)]);
    for cell_m in [20.0, 25.0, 73.0] {
        let plan = dem.plan(&PlanOptions { cell: Some((cell_m).into()), ..options() }).unwrap();
        let count = check(&mut dem.reader(&plan), &plan, 1e-3, plane);
        assert!(
            count as f64 > 0.9 * 200.0 * 180.0 * 100.0 / (cell_m * cell_m) - 60.0,
            "{count} nodes"
        );
    }
}

#[test]
fn original_samples_come_with_their_positions() {
    let folder = folder();
    let raster = Raster::new(32632, [300, 50], UTM).nodata(-1.0);
    let dem =
        open(&[raster
            .write(folder.path(), "a.tif", |at| if at[0] < 500_100.0 { -1.0 } else { plane(at) })]);
    let plan = dem.plan(&PlanOptions { cell: Some(33.0_f64.into()), ..options() }).unwrap();
    let mut count = 0;
    for block in sample_blocks(&dem, &plan) {
        assert_eq!(block.positions_m.len(), block.heights_m.len());
        for (&at, &height_m) in block.positions_m.iter().zip(&block.heights_m) {
            assert!((f64::from(height_m) - plane(at)).abs() < 1e-3);
            count += 1;
        }
    }
    assert_eq!(count, 290 * 50);
}

#[test]
fn wide_and_polar_extents_get_an_equal_area_projection() {
    let folder = folder();
    let europe = Raster::new(4326, [400, 300], [-10.0, 0.1, 0.0, 70.0, 0.0, -0.1]).write(
        folder.path(),
        "e.tif",
        |at| at[0],
    );
    let arctic = Raster::new(4326, [360, 50], [-180.0, 1.0, 0.0, 90.0, 0.0, -0.1]).write(
        folder.path(),
        "p.tif",
        |at| at[1],
    );
    for (file, name) in [(europe, "about 5"), (arctic, "about 89")] {
        let dem = open(&[file]);
        let plan = dem.plan(&PlanOptions { cell: Some(10_000.0_f64.into()), ..options() }).unwrap();
        assert!(plan.crs.starts_with("Lambert") && plan.crs.contains(name), "{}", plan.crs);
        let window = dem.reader(&plan).window(all(&plan)).unwrap();
        assert!(window.heights.count_heights() > 5000);
    }
}

/// Latitudes around the pole, where the lattice of positions cannot be interpolated, are correct as
/// well.
#[test]
fn nodes_around_the_pole_are_transformed_one_by_one() {
    let folder = folder();
    let file = Raster::new(4326, [361, 61], [-180.5, 1.0, 0.0, 90.05, 0.0, -0.1]).write(
        folder.path(),
        "p.tif",
        |at| at[1],
    );
    let dem = open(&[file]);
    let plan = dem.plan(&PlanOptions { cell: Some(12_000.0_f64.into()), ..options() }).unwrap();
    let projection = dem.projection(&plan).unwrap();
    let count = check(&mut dem.reader(&plan), &plan, 0.002, |at| {
        let mut points = [at];
        projection.wgs84_from_working(&mut points).unwrap();
        points[0][1]
    });
    assert!(count > 8000, "{count}");
}

#[test]
fn the_antimeridian_is_no_border() {
    let folder = folder();
    let raster = Raster::new(4326, [200, 100], [179.9, 0.001, 0.0, -16.9, 0.0, -0.001]);
    let dem = open(&[raster.write(folder.path(), "fiji.tif", |at| (at[0] - 180.0) * 1000.0)]);
    for (options, tolerance_m, is_own) in [(options(), 1e-4, true), (in_utm(), 0.02, false)] {
        let plan = dem.plan(&options).unwrap();
        let crs = plan.crs.as_str();
        assert!(if is_own {
            crs == "EPSG:4326"
        } else {
            crs == "EPSG:32701" || crs == "EPSG:32760"
        });
        assert!(plan.wgs84_bounds.width() < 0.21, "{:?}", plan.wgs84_bounds);
        let projection = dem.projection(&plan).unwrap();
        let count = check(&mut dem.reader(&plan), &plan, tolerance_m, |at| {
            let mut points = [at];
            projection.wgs84_from_working(&mut points).unwrap();
            (points[0][0].rem_euclid(360.0) - 180.0) * 1000.0
        });
        assert!(if is_own { count == 20_000 } else { count > 15_000 }, "{count}");
    }
    // In degrees nodes continue beyond 180, and positions named from either side are found there.
    let plan = plan(&dem);
    // The east factor is adjusted by half a lattice step a cell at most: 0.5 mm of 106 m.
    check_near(plan.metres_per_unit, degree_m(-17.0), 5e-6);
    let [east_m, _] = plan.metres_per_unit;
    let (west, east) = (plan.data_bounds.min_x / east_m, plan.data_bounds.max_x / east_m);
    assert!((west - 179.9005).abs() < 1e-9 && (east - 180.0995).abs() < 1e-9, "{west} {east}");
    let mut points = [[-179.95, -16.95], [180.05, -16.95], [179.95, -16.95]];
    dem.projection(&plan).unwrap().working_from_wgs84(&mut points).unwrap();
    assert!((points[0][0] - 180.05 * east_m).abs() < 1e-6, "{points:?}");
    assert!((points[1][0] - 180.05 * east_m).abs() < 1e-6 && points[2][0] < 180.0 * east_m);
}

fn is_send<T: Send + Sync>(_: &T) {}
fn fits_another_thread<T: Send>(_: &T) {}

#[test]
fn positions_out_of_range_are_not_a_number() {
    let folder = folder();
    let dem = open(&[Raster::new(32632, [6, 5], UTM).write(folder.path(), "a.tif", plane)]);
    let plan = plan(&dem);
    let projection = dem.projection(&plan).unwrap();
    let mut points = [[9.0, 47.0], [9.0, 95.0], [f64::NAN, 47.0]];
    projection.working_from_wgs84(&mut points).unwrap();
    assert!(
        (points[0][0] - 500_000.0).abs() < 1e-3 && points[1][0].is_nan() && points[2][1].is_nan()
    );
    projection.wgs84_from_working(&mut points).unwrap();
    assert!((points[0][0] - 9.0).abs() < 1e-9 && points[1][0].is_nan());
    fits_another_thread(&dem.reader(&plan));
    is_send(&projection);
    is_send(&dem);
    is_send(&plan);
}

#[test]
fn options_override_and_are_checked() {
    let folder = folder();
    let bare = Raster::new(0, [6, 5], UTM).write(folder.path(), "a.tif", plane);
    let given = OpenOptions { dem_crs: Some("EPSG:32632".to_owned()), ..OpenOptions::default() };
    let dem = Dem::open(&[bare], &given).unwrap();
    let plan = |crs: &str| dem.plan(&PlanOptions { crs: Some(crs.to_owned()), ..options() });
    assert_eq!(plan("EPSG:3035").unwrap().crs, "EPSG:3035");
    assert!(plan("EPSG:4326").unwrap_err().to_string().contains("projected"));
    let feet = plan("EPSG:2272").unwrap();
    assert_eq!((feet.crs.as_str(), feet.resampling), ("EPSG:2272", Resampling::Resampled));
    check_near(feet.metres_per_unit, [1200.0 / 3937.0; 2], 1e-12);
    assert!(plan("EPSG:999999").unwrap_err().to_string().contains("--crs"));
    assert!(dem.plan(&PlanOptions { cell: Some((-1.0).into()), ..options() }).is_err());
    assert!(
        dem.plan(&PlanOptions { cell: Some(1e5_f64.into()), ..options() }).is_err(),
        "ten thousand samples a side"
    );
    assert!(dem.plan(&PlanOptions { fill_voids: 1_000_000, ..options() }).is_err());
    let own = dem.plan(&options()).unwrap();
    let coarse = NodeWindow { stride: 2, ..all(&own) };
    assert!(dem.reader(&own).window(coarse).is_err());
}

/// A second file rotated by a quarter turn, whose rows run east and whose columns run north: its
/// samples coincide with nodes, one per node along either axis, although its own axes are 20 m and
/// 10 m long.
#[test]
fn a_file_turned_by_a_quarter_is_not_averaged_along_the_wrong_axis() {
    let folder = tempfile::tempdir().unwrap();
    let wave = |[x, y]: [f64; 2]| 10.0 * (x / 13.0).sin() + 10.0 * (y / 25.0).cos();
    let sample = |at: [f64; 2]| wave(at) as f32;
    let upright = Raster::new(32632, [60, 60], [500_000.0, 10.0, 0.0, 5_200_000.0, 0.0, -20.0])
        .write(folder.path(), "upright.tif", sample);
    let turned = Raster::new(32632, [60, 60], [500_600.0, 0.0, 10.0, 5_198_800.0, 20.0, 0.0])
        .write(folder.path(), "turned.tif", sample);
    let dem = open(&[upright, turned]);
    let plan = plan(&dem);
    assert_eq!(plan.frame.cell().to_array(), [10.0, 20.0]);
    assert!(!plan.resampling_text.contains("average"), "{}", plan.resampling_text);
    let count = check(&mut dem.reader(&plan), &plan, 1e-3, wave);
    assert!(count >= 3600 + 58 * 58, "{count}");
}
