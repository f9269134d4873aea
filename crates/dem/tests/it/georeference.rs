//! Georeferences of rasters: tie points, seams of the globe, poles, and rasters too small to
//! enclose ground.

use std::path::{Path, PathBuf};

use corniche_dem::{OpenOptions, PlanOptions, Resampling};
use corniche_geom::Projection;
use gdal::Gcp;
use gdal::spatial_ref::SpatialRef;

use crate::fixture::{
    Raster, Space, UTM, all, check, check_heights, check_refused, open, options, plan, plane,
};

fn tied<'a>(bend_m: f64) -> Raster<'a> {
    Raster::new(0, [60, 50], [0.0; 6]).tagged(move |dataset| {
        let tie = |pixel: f64, line: f64, bend_m: f64| Gcp {
            id: String::new(),
            info: String::new(),
            pixel,
            line,
            x: UTM[0] + 10.0 * pixel + bend_m,
            y: UTM[3] - 10.0 * line,
            z: 0.0,
        };
        let ties = vec![
            tie(0.0, 0.0, 0.0),
            tie(60.0, 0.0, 0.0),
            tie(0.0, 50.0, 0.0),
            tie(60.0, 50.0, bend_m),
        ];
        dataset.set_gcps(ties, &SpatialRef::from_epsg(32632).unwrap()).unwrap();
    })
}

/// The fixture does not know the pixels' positions of a raster without a geotransform.
fn untied_plane() -> impl Fn([f64; 2]) -> f64 {
    let next = std::cell::Cell::new(0_u32);
    move |_| {
        let k = next.replace(next.get() + 1);
        plane([UTM[0] + 10.0 * f64::from(k % 60) + 5.0, UTM[3] - 10.0 * f64::from(k / 60) - 5.0])
    }
}

#[test]
fn tie_points_serve_when_they_agree_upon_a_map() {
    let folder = tempfile::tempdir().unwrap();
    let given = OpenOptions::default();
    let good = [tied(0.0).write(folder.path(), "ties.tif", untied_plane())];
    let count = check_heights("ties", &good, &given, (Space::Working, 1e-3), plane);
    assert_eq!(count, 3000);
    let bent = [tied(30.0).write(folder.path(), "bent.tif", untied_plane())];
    check_refused(&bent, &given, &["bent.tif", "georeference", "gdal_translate"]);
}

#[test]
fn rasters_without_place_or_with_an_unusable_one_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let given = OpenOptions { dem_crs: Some("EPSG:32632".to_owned()), ..OpenOptions::default() };
    for (name, coefficients, words) in [
        ("none.tif", [0.0; 6], "georeference"),
        ("flat.tif", [500_000.0, 10.0, 10.0, 5_200_000.0, 10.0, 10.0], "no inverse"),
        ("nan.tif", [500_000.0, f64::NAN, 0.0, 5_200_000.0, 0.0, -10.0], "geo"),
    ] {
        let path = Raster::new(0, [6, 5], coefficients).write(folder.path(), name, |_| 1.0_f32);
        check_refused(&[path], &given, &[name, words, "gdal_translate"]);
    }
    // Degrees outside the globe.
    let path = Raster::new(4326, [6, 5], [500_000.0, 10.0, 0.0, 5_200_000.0, 0.0, -10.0]).write(
        folder.path(),
        "metres-as-degrees.tif",
        |_| 1.0_f32,
    );
    let words = ["metres-as-degrees.tif", "not a longitude and latitude", "-a_srs"];
    check_refused(&[path], &OpenOptions::default(), &words);
}

#[test]
fn a_single_row_or_column_is_refused_and_a_square_of_four_is_not() {
    let folder = tempfile::tempdir().unwrap();
    let given = OpenOptions::default();
    for (epsg, corner, step) in
        [(32632, [500_000.0, 5_200_000.0], 10.0), (4326, [9.0, 47.0], 0.001)]
    {
        let frame = [corner[0], step, 0.0, corner[1], 0.0, -step];
        for size in [[1, 1], [1, 7], [7, 1]] {
            let name = format!("{epsg}-{}x{}.tif", size[0], size[1]);
            let path = Raster::new(epsg, size, frame).write(folder.path(), &name, |_| 1.0_f32);
            let says = format!("{} × {} samples", size[0], size[1]);
            check_refused(&[path], &given, &[&name, &says, "2 × 2"]);
        }
    }
    let four = Raster::new(32632, [2, 2], UTM).write(folder.path(), "four.tif", plane);
    assert_eq!(check_heights("2×2", &[four], &given, (Space::Working, 1e-4), plane), 4);
    let two = Raster::new(32632, [2, 9], UTM).write(folder.path(), "two.tif", plane);
    assert_eq!(check_heights("2×9", &[two], &given, (Space::Working, 1e-4), plane), 18);
    // 2 × 2 samples 76 m and 111 m apart enclose a node or two of the 75 m grid.
    let lonlat = |[lon, lat]: [f64; 2]| lon * 1000.0 + lat * 2000.0;
    let four = Raster::new(4326, [2, 2], [9.0, 0.001, 0.0, 47.0, 0.0, -0.001]).write(
        folder.path(),
        "degrees.tif",
        lonlat,
    );
    let count = check_heights("2×2 degrees", &[four], &given, (Space::Degrees, 0.02), lonlat);
    assert!((1..=4).contains(&count), "{count}");
    // Files of one column each, side by side, have ground together.
    let columns: Vec<PathBuf> = (0..5)
        .map(|k| {
            let frame = [UTM[0] + 10.0 * f64::from(k), 10.0, 0.0, UTM[3], 0.0, -10.0];
            let name = format!("column-{k}.tif");
            Raster::new(32632, [1, 9], frame).write(folder.path(), &name, plane)
        })
        .collect();
    assert_eq!(check_heights("columns", &columns, &given, (Space::Working, 1e-4), plane), 45);
}

/// A function of the position that is linear in degrees near the antimeridian, from either side.
fn beyond([lon, lat]: [f64; 2]) -> f64 {
    let east = if lon < 0.0 { lon + 180.0 } else { lon - 180.0 };
    1000.0 + east * 1000.0 + lat * 500.0
}

fn square(folder: &Path, name: &str, west: f64, north: f64, size: [usize; 2]) -> PathBuf {
    Raster::new(4326, size, [west, 0.01, 0.0, north, 0.0, -0.01]).write(
        folder,
        name,
        |[lon, lat]| beyond([lon - 360.0 * ((lon + 180.0) / 360.0).floor(), lat]),
    )
}

/// With any notation of longitudes, 180° is no border: there is no gap between the last column and
/// the first.
#[test]
fn the_antimeridian_is_no_seam() {
    let folder = tempfile::tempdir().unwrap();
    let given = OpenOptions::default();
    let east = square(folder.path(), "east.tif", 179.0, -16.0, [100, 80]);
    let west = square(folder.path(), "west.tif", -180.0, -16.0, [100, 80]);
    let one = square(folder.path(), "one.tif", 179.0, -16.0, [200, 80]);
    let other = square(folder.path(), "other.tif", -181.0, -16.0, [200, 80]);
    let count = |name: &str, files: &[PathBuf]| {
        let dem = open(files);
        let plan = plan(&dem);
        assert!(plan.wgs84_bounds.width() < 2.1, "{name}: {:?}", plan.wgs84_bounds);
        check_heights(name, files, &given, (Space::Degrees, 0.05), beyond)
    };
    let whole = count("one file", &[one]);
    assert!(whole > 14_000, "{whole}");
    assert_eq!(count("from -181", &[other]), whole);
    assert_eq!(count("east, west", &[east.clone(), west.clone()]), whole);
    assert_eq!(count("west, east", &[west, east]), whole);
}

#[test]
fn utm_crosses_the_antimeridian() {
    let folder = tempfile::tempdir().unwrap();
    // Zone 60 ends some 320 km east of its meridian at this latitude; half of the raster lies
    // beyond.
    let corner = [800_000.0, 500.0, 0.0, 8_200_000.0, 0.0, -500.0];
    let truth = |[x, y]: [f64; 2]| x / 1000.0 + y / 10_000.0;
    let path = Raster::new(32760, [80, 60], corner).write(folder.path(), "fiji.tif", truth);
    let dem = open(std::slice::from_ref(&path));
    let plan = plan(&dem);
    assert!(plan.wgs84_bounds.min_x < 180.0 && plan.wgs84_bounds.max_x > 180.0);
    assert_eq!((plan.crs.as_str(), plan.resampling), ("EPSG:32760", Resampling::Aligned));
    let given = OpenOptions::default();
    assert_eq!(check_heights("UTM 60", &[path], &given, (Space::Working, 1e-3), truth), 4800);
}

/// All around the earth: no voids except the caps beyond the last rows and, opposite to the
/// projection's centre, one cell about the point that the projection cannot show.
#[test]
fn a_global_grid_has_no_seam() {
    let folder = tempfile::tempdir().unwrap();
    for (name, west, columns) in
        [("from-180.tif", -180.0, 360), ("from-0.tif", 0.0, 360), ("both-ends.tif", -180.5, 361)]
    {
        let path = Raster::new(4326, [columns, 180], [west, 1.0, 0.0, 90.0, 0.0, -1.0]).write(
            folder.path(),
            name,
            |[_, lat]| lat * 10.0,
        );
        let dem = open(&[path]);
        let plan = dem.plan(&PlanOptions { cell: Some(80_000.0_f64.into()), ..options() }).unwrap();
        let projection = dem.projection(&plan).unwrap();
        let mut reader = dem.reader(&plan);
        let truth = |at: [f64; 2]| {
            let mut points = [at];
            projection.wgs84_from_working(&mut points).unwrap();
            points[0][1] * 10.0
        };
        check(&mut reader, &plan, 0.01, truth);
        let window = all(&plan);
        let heights = reader.window(window).unwrap().heights;
        let mut voids = Vec::new();
        for row in 0..window.rows {
            for column in 0..window.columns {
                let node = window.node(column, row);
                let mut at = [[plan.frame.x_m(node.i), plan.frame.y_m(node.j)]];
                projection.wgs84_from_working(&mut at).unwrap();
                // Half a degree of the pole lies beyond the centres of the last row.
                if at[0][1].abs() < 89.49 && !heights.has_height(column, row) {
                    voids.push(at[0]);
                }
            }
        }
        assert!(
            voids.is_empty(),
            "{name}: no height at {} nodes, such as {:?}",
            voids.len(),
            voids[0]
        );
    }
}

/// Samples up to both poles and on them, in degrees, in polar stereographic and in universal polar
/// coordinates.
#[test]
fn the_poles_are_covered_as_far_as_samples_go() {
    let folder = tempfile::tempdir().unwrap();
    let given = OpenOptions::default();
    for (name, north) in [("north.tif", 90.0), ("south.tif", -85.0)] {
        let truth = |[_, lat]: [f64; 2]| lat * 100.0;
        let path = Raster::new(4326, [360, 50], [-180.0, 1.0, 0.0, north, 0.0, -0.1]).write(
            folder.path(),
            name,
            truth,
        );
        let dem = open(std::slice::from_ref(&path));
        let plan = dem.plan(&PlanOptions { cell: Some(12_000.0_f64.into()), ..options() }).unwrap();
        assert!(plan.crs.starts_with("Lambert"), "{}", plan.crs);
        let projection = dem.projection(&plan).unwrap();
        let count = check(&mut dem.reader(&plan), &plan, 0.02, |mut at| {
            projection.wgs84_from_working(std::slice::from_mut(&mut at)).unwrap();
            truth(at)
        });
        let disc = std::f64::consts::PI * (550.0_f64 / 12.0).powi(2);
        assert!(count as f64 > 0.97 * disc, "{name}: {count} of {disc}");
    }
    for epsg in [3413, 3031, 5041, 5042] {
        let middle = if epsg > 5000 { 2_000_000.0 } else { 0.0 };
        let truth = move |[x, y]: [f64; 2]| (x - middle) / 1000.0 + (y - middle) / 2000.0;
        let corner = [middle - 50_500.0, 1000.0, 0.0, middle + 50_500.0, 0.0, -1000.0];
        let path = Raster::new(epsg, [101, 101], corner).write(
            folder.path(),
            &format!("{epsg}.tif"),
            truth,
        );
        let dem = open(std::slice::from_ref(&path));
        let plan = plan(&dem);
        assert_eq!((plan.crs, plan.resampling), (format!("EPSG:{epsg}"), Resampling::Aligned));
        let factors = plan.metres_per_unit;
        let own = move |[x, y]: [f64; 2]| truth([x / factors[0], y / factors[1]]);
        let count = check_heights("polar", &[path], &given, (Space::Working, 1e-3), own);
        assert_eq!(count, 101 * 101);
    }
}

/// Wider than half the earth: the rectangle in WGS84 is that of the file, in any CRS.
#[test]
fn bounds_of_wide_files_are_their_own() {
    let folder = tempfile::tempdir().unwrap();
    let per_degree = 20_037_508.342_789_244 / 180.0;
    let files = [
        (4326, 240, -120.0, 1.0),
        (4326, 360, -180.0, 1.0),
        (4326, 360, 0.0, 1.0),
        // NAD27: PROJ moves positions and names them from −180 to 180.
        (4267, 300, -150.0, 1.0),
        (4087, 240, -120.0, per_degree),
        (4087, 360, -180.0, per_degree),
    ];
    for (epsg, columns, west, unit) in files {
        let map = [west * unit, unit, 0.0, 10.0 * unit, 0.0, -unit];
        let name = format!("{epsg} {columns} {west}.tif");
        let file = Raster::new(epsg, [columns, 20], map).write(folder.path(), &name, |_| 1.0_f32);
        let found = open(&[file]).plan(&own_crs()).unwrap().wgs84_bounds;
        let first = west + 0.5;
        // All around the earth, the ground continues from the last column to the first one.
        let last = if columns == 360 { first + 360.0 } else { first + columns as f64 - 1.0 };
        for (found, expected) in found.to_array().into_iter().zip([first, -9.5, last, 9.5]) {
            assert!((found - expected).abs() < 0.01, "{name}: {found}, not {expected}");
        }
    }
}

/// Two halves of the globe side by side are one globe; longitudes do not continue for a second
/// turn.
#[test]
fn halves_of_the_globe_are_one_turn() {
    let folder = tempfile::tempdir().unwrap();
    let per_degree = 20_037_508.342_789_244 / 180.0;
    for (epsg, unit) in [(4326, 1.0), (4087, per_degree)] {
        let half = |west: f64| {
            let map = [west * unit, unit, 0.0, 10.0 * unit, 0.0, -unit];
            let name = format!("{epsg} {west}.tif");
            Raster::new(epsg, [180, 20], map).write(folder.path(), &name, |_| 1.0_f32)
        };
        let found = open(&[half(-180.0), half(0.0)]).plan(&own_crs()).unwrap().wgs84_bounds;
        assert!(
            (found.min_x + 179.5).abs() < 0.01 && (found.max_x - 180.5).abs() < 0.01,
            "{epsg}: {found:?}"
        );
    }
}

fn own_crs() -> PlanOptions {
    PlanOptions { crs: Some("dem".to_owned()), ..options() }
}

/// A spacing written with few digits is read as 1/120 of a degree: files on both sides of the
/// antimeridian are neighbours, in either order.
#[test]
fn few_digits_do_not_part_files_at_the_antimeridian() {
    let folder = tempfile::tempdir().unwrap();
    let square = |name: &str, west: f64| {
        let map = [west, 0.008_333_33, 0.0, 1.0, 0.0, -0.008_333_33];
        Raster::new(4326, [120, 120], map).write(folder.path(), name, |at| at[1] as f32)
    };
    let (east, west) = (square("east.tif", 179.0), square("west.tif", -180.0));
    for files in [[east.clone(), west.clone()], [west, east]] {
        let dem = open(&files);
        let plan = plan(&dem);
        assert_eq!(plan.resampling, Resampling::Aligned, "{}", plan.resampling_text);
        assert_eq!(plan.north_east.i - plan.south_west.i, 239, "{files:?}");
        assert_eq!(plan.north_east.j - plan.south_west.j, 119);
        assert!(
            (plan.wgs84_bounds.width() - 2.0 + 0.008_333_33).abs() < 1e-4,
            "{:?}",
            plan.wgs84_bounds
        );
        assert_eq!(
            check(&mut dem.reader(&plan), &plan, 1e-3, |[_, y]| y / plan.metres_per_unit[1]),
            240 * 120
        );
    }
}

/// A file so far from the first one that a spacing with few digits gives another grid, on the other
/// side of the antimeridian: its samples are nodes next to those of the first.
#[test]
fn aligned_files_far_across_the_antimeridian_are_near() {
    let folder = tempfile::tempdir().unwrap();
    let square = |name: &str, west: f64| {
        let map = [west, 0.008_333_33, 0.0, 1.0, 0.0, -0.008_333_33];
        Raster::new(4326, [120, 120], map).write(folder.path(), name, |at| at[1] as f32)
    };
    let (east, west) = (square("east.tif", 160.0), square("west.tif", -170.0));
    for files in [[east.clone(), west.clone()], [west, east]] {
        let dem = open(&files);
        let plan = plan(&dem);
        assert_eq!(plan.resampling, Resampling::Aligned, "{}", plan.resampling_text);
        assert_eq!(plan.north_east.i - plan.south_west.i, 31 * 120 - 1, "{files:?}");
        assert_eq!(
            check(&mut dem.reader(&plan), &plan, 1e-3, |[_, y]| y / plan.metres_per_unit[1]),
            240 * 120
        );
    }
}
