//! Windows of real elevation files have the heights in the files.

use std::path::PathBuf;
use std::time::Instant;

use corniche_dem::{Dem, DemError, GridPlan, OpenOptions, PlanOptions, Resampling};
use corniche_geom::{NodeIndex, NodeWindow};

use corniche_testing::real_data;

use crate::fixture::{all, check_near, degree_m, in_utm, options};

/// Files of the real data; `None`, with a line that says so, if one is missing.
pub(crate) fn data(names: &[&str]) -> Option<Vec<PathBuf>> {
    names.iter().map(|name| real_data(name)).collect()
}

fn open(names: &[&str], nodata: Option<f64>) -> Option<(Dem, GridPlan)> {
    let dem = Dem::open(
        &data(names)?,
        &OpenOptions { nodata: nodata.into_iter().collect(), ..OpenOptions::default() },
    )
    .unwrap();
    let plan = dem.plan(&PlanOptions { fill_voids: 32, ..options() }).unwrap();
    Some((dem, plan))
}

/// Reads all in blocks, like the pipeline: nodes, heights, filled, lowest, highest, seconds.
fn read_all(dem: &Dem, plan: &GridPlan) -> (usize, usize, u64, [f32; 2]) {
    let mut reader = dem.reader(plan);
    let whole = all(plan);
    let (mut heights, mut filled, mut range) = (0, 0, [f32::INFINITY, f32::NEG_INFINITY]);
    let start = Instant::now();
    for top in (0..whole.rows).step_by(1024) {
        for left in (0..whole.columns).step_by(1024) {
            let window = NodeWindow {
                corner: NodeIndex {
                    i: whole.corner.i + left as i64,
                    j: whole.corner.j - top as i64,
                },
                stride: 1,
                columns: 1024.min(whole.columns - left),
                rows: 1024.min(whole.rows - top),
            };
            let read = reader.window(window).unwrap();
            heights += read.heights.count_heights();
            filled += read.filled;
            if let Some([low, high]) = read.heights.range_m() {
                range = [range[0].min(low), range[1].max(high)];
            }
        }
    }
    let nodes = whole.columns * whole.rows;
    let rate = nodes as f64 / start.elapsed().as_secs_f64() / 1e6;
    println!(
        "{}: {nodes} nodes of {} m, {rate:.1} M nodes/s",
        plan.resampling_text,
        plan.frame.cell().north_m
    );
    (nodes, heights, filled, range)
}

#[test]
fn two_srtm_squares_become_one_grid_of_their_own_samples() {
    let Some((dem, plan)) = open(&["liechtenstein/N47E009.hgt", "liechtenstein/N47E010.hgt"], None)
    else {
        return;
    };
    assert_eq!((plan.crs.as_str(), plan.resampling), ("EPSG:4326", Resampling::Aligned));
    let side_m = degree_m(47.5).map(|metres| metres / 1200.0);
    check_near(plan.frame.cell().to_array(), side_m, 1e-5);
    let (nodes, heights, filled, range) = read_all(&dem, &plan);
    assert_eq!(nodes, 2401 * 1201);
    assert!(heights > nodes * 9 / 10 && filled > 1000, "{heights} of {nodes}, {filled} filled");
    assert!(range == [388.0, 3370.0], "{range:?}");
}

#[test]
fn nodes_of_tirol_are_its_samples() {
    let Some((dem, plan)) = open(&["tirol-5m/avaMal.tif"], None) else { return };
    assert_eq!(
        (plan.crs.as_str(), plan.resampling, plan.frame.cell().north_m),
        ("EPSG:31287", Resampling::Aligned, 5.0)
    );
    let (nodes, heights, filled, range) = read_all(&dem, &plan);
    assert_eq!(nodes, 567 * 787);
    let own = (nodes as f64 * 0.6245) as usize;
    assert!(heights >= own && heights < own + nodes / 50 + filled as usize, "{heights}");
    assert!((range[0] - 1328.6).abs() < 0.1 && (range[1] - 2896.1).abs() < 0.1, "{range:?}");
}

/// Also with several PROJ operations to choose from, a node's bits do not depend on the window.
#[test]
fn tirol_in_another_datum_is_the_same_through_every_window() {
    let Some((dem, _)) = open(&["tirol-5m/avaMal.tif"], None) else { return };
    let asked = PlanOptions { crs: Some("EPSG:25832".to_owned()), fill_voids: 8, ..options() };
    let plan = dem.plan(&asked).unwrap();
    assert_eq!(
        (plan.crs.as_str(), plan.resampling, plan.frame.cell().north_m),
        ("EPSG:25832", Resampling::Resampled, 5.0)
    );
    let whole = all(&plan);
    let mut reader = dem.reader(&plan);
    let reference = reader.window(whole).unwrap().heights;
    assert!(reference.count_heights() > 250_000);
    for (left, top) in [(0, 0), (101, 37), (333, 401), (256, 512)] {
        let corner = NodeIndex { i: whole.corner.i + left as i64, j: whole.corner.j - top as i64 };
        let window = NodeWindow { corner, stride: 1, columns: 150, rows: 200 };
        let seen = dem.reader(&plan).window(window).unwrap().heights;
        let expected = reference.window(left, top, 150, 200);
        assert!(seen.raw().iter().zip(expected.raw()).all(|(a, b)| a.to_bits() == b.to_bits()));
    }
}

#[test]
fn the_zone_follows_the_hemisphere_and_the_datum_is_no_obstacle() {
    let check = |name: &str, crs: &str, cell_m: f64, highest_m: f32| {
        let Some((dem, _)) = open(&[name], None) else { return };
        let plan = dem.plan(&PlanOptions { fill_voids: 32, ..in_utm() }).unwrap();
        assert_eq!((plan.crs.as_str(), plan.frame.cell().north_m), (crs, cell_m));
        let (nodes, heights, _, range) = read_all(&dem, &plan);
        assert!(
            heights > nodes * 9 / 10 && range[1] <= highest_m && range[1] > 0.98 * highest_m,
            "{range:?}"
        );
    };
    check("swellendam/srtm_41_19_4326.tif", "EPSG:32734", 77.0, 1699.0);
    check("portland/portland-ned.tif", "EPSG:32610", 7.2, 328.1);
}

#[test]
fn slovenia_is_aligned_to_whole_metres() {
    let Some((dem, plan)) = open(&["slovenia-1m/TM1_564_146.tif"], None) else { return };
    assert_eq!(
        (plan.crs.as_str(), plan.frame.origin_m(), plan.frame.cell().north_m),
        ("EPSG:3794", [0.0; 2], 1.0)
    );
    assert_eq!(plan.south_west, NodeIndex { i: 564_000, j: 146_000 });
    assert_eq!(plan.north_east, NodeIndex { i: 564_999, j: 146_999 });
    let (nodes, heights, ..) = read_all(&dem, &plan);
    assert_eq!((nodes, heights), (1_000_000, 1_000_000));
}

#[test]
fn crater_lake_needs_its_sentinel_named() {
    let Some((dem, plan)) = open(&["craterlake/craterlake-elev-16bit-30m.tif"], Some(-32767.0))
    else {
        return;
    };
    assert_eq!((plan.crs.as_str(), plan.resampling), ("EPSG:4326", Resampling::Aligned));
    let side_m = degree_m(43.0).map(|metres| metres * 0.000_269_97);
    check_near(plan.frame.cell().to_array(), side_m, 1e-4);
    let (.., range) = read_all(&dem, &plan);
    assert!(range[0] >= 1289.0 && range[1] <= 1880.0, "{range:?}");
}

#[test]
fn aletsch_is_aligned_in_spite_of_its_noisy_corner() {
    let Some((dem, plan)) = open(&["registry/aletsch.tif"], None) else { return };
    assert_eq!(
        (plan.crs.as_str(), plan.resampling, plan.frame.cell().north_m),
        ("EPSG:2056", Resampling::Aligned, 200.0)
    );
    // Corner 2601099.999999999534, half a cell of 200.000000000000966 in: 2601200, a whole number
    // of cells.
    assert_eq!(plan.frame.origin_m(), [0.0, 0.0]);
    let (nodes, ..) = read_all(&dem, &plan);
    assert_eq!(nodes, 358 * 310);
}

#[test]
fn zurich_needs_a_crs() {
    let Some(files) = data(&["registry/zh_dem_25.tif"]) else { return };
    let error = Dem::open(&files, &OpenOptions::default()).unwrap_err();
    assert!(error.to_string().contains("--dem-crs"), "{error}");
    let dem = Dem::open(
        &files,
        &OpenOptions { dem_crs: Some("EPSG:21781".to_owned()), ..OpenOptions::default() },
    )
    .unwrap();
    let plan = dem.plan(&options()).unwrap();
    assert_eq!((plan.crs.as_str(), plan.frame.cell().north_m), ("EPSG:21781", 25.0));
    let (.., range) = read_all(&dem, &plan);
    assert_eq!(range, [393.0, 870.0]);
}

#[test]
fn one_grid_georeferenced_six_ways() {
    let ways = ["tie_point_and_pixel_scale", "transformation", "tie_points"];
    let read = |way: &str, kind: &str| {
        let name = format!("nasty/dem/georef/austrian_capitals_model_{way}_pixel_is_{kind}.tif");
        let (dem, plan) = open(&[&name], None)?;
        let heights = dem.reader(&plan).window(all(&plan)).unwrap().heights;
        Some((plan.frame, plan.data_bounds, heights))
    };
    for way in ways {
        let (Some(area), Some(point)) = (read(way, "area"), read(way, "point")) else { return };
        // Pixel-is-area: samples half a cell inside the corner 4302000, 2811000. Pixel-is-point: on
        // it.
        assert_eq!((area.1.min_x, area.1.max_y), (4_302_500.0, 2_810_500.0), "{way}");
        assert_eq!((point.1.min_x, point.1.max_y), (4_302_000.0, 2_811_000.0), "{way}");
        let (same, raw) = (area.2.raw(), point.2.raw());
        assert!(same.iter().zip(raw).all(|(a, b)| a.to_bits() == b.to_bits()));
    }
}

/// South-up, feet and undeclared sentinels of one excerpt give the same ground.
#[test]
fn variants_of_one_excerpt_agree() {
    let read = |name: &str| {
        let (dem, plan) = open(&[name], None)?;
        Some((plan.frame, dem.reader(&plan).window(all(&plan)).unwrap().heights))
    };
    let Some(reference) = read("nasty/derived-dem/south-up.tif") else { return };
    for (name, tolerance_m) in
        [("void-32768-undeclared", 1e-3), ("nan-void-no-nodata-tag", 1e-3), ("feet", 0.2)]
    {
        let found = read(&format!("nasty/derived-dem/{name}.tif")).unwrap();
        assert_eq!(found.0, reference.0, "{name}");
        for (a, b) in found.1.raw().iter().zip(reference.1.raw()) {
            assert!(
                a.is_nan() == b.is_nan() && (a.is_nan() || (a - b).abs() <= tolerance_m),
                "{name}: {a}, {b}"
            );
        }
    }
}

/// Each file in the folder of awkward files is read correctly, or gives an error that names it;
/// never a panic.
#[test]
fn awkward_files_open_or_say_why_not() {
    let Some(folders) = data(&["nasty/dem", "nasty/derived-dem"]) else { return };
    let mut files: Vec<PathBuf> = folders
        .iter()
        .flat_map(|folder| std::fs::read_dir(folder).unwrap())
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.is_file() && path.extension().is_none_or(|ending| ending != "xml"))
        .collect();
    files.sort();
    let attempt = |file: &PathBuf, dem_crs: Option<&str>| -> Result<usize, DemError> {
        let given = OpenOptions { dem_crs: dem_crs.map(str::to_owned), ..OpenOptions::default() };
        let dem = Dem::open(std::slice::from_ref(file), &given)?;
        let plan = dem.plan(&PlanOptions { fill_voids: 8, ..options() })?;
        let window = dem.reader(&plan).window(all(&plan))?;
        Ok(window.heights.count_heights())
    };
    let mut refused = Vec::new();
    for file in &files {
        let name = file.file_name().unwrap().to_string_lossy().into_owned();
        match attempt(file, None) {
            Ok(heights) => println!("{name}: {heights} heights"),
            Err(error) => {
                assert!(error.to_string().contains(&name), "{error}");
                println!("{error}");
                refused.push(name);
            }
        }
    }
    for name in [
        "BigTIFF.tif",
        "BigTIFFMotorola.tif",
        "N47E009.hgt",
        "libtiff-test_ifd_loop_to_self.tif",
        "1x1.tif",
        "1x512.tif",
        "rasterio-all-nodata.tif",
        "rasterio-corrupt.tif",
        "rasterio-float_nan.tif",
        "rasterio-rotated.tif",
        "truncated-half.tif",
        "truncated-header-6-bytes.tif",
        "zero-bytes.tif",
    ] {
        assert!(refused.iter().any(|refused| refused == name), "{name} was read");
    }
    assert_eq!(refused.len(), 13, "{refused:?}");
    for file in files.iter().filter(|file| {
        ["rasterio-rotated.tif", "rasterio-float_nan.tif"].iter().any(|n| file.ends_with(n))
    }) {
        assert!(attempt(file, Some("EPSG:32618")).is_ok());
    }
}
