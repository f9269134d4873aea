//! A plan with bounds has the nodes of the whole plan within the bounds, with the same heights to
//! the last bit.

use corniche_dem::{Dem, GridError, GridPlan, OpenOptions, PlanOptions};
use corniche_geom::{Cell, NodeIndex, NodeWindow, Projection};

use crate::fixture::{Raster, all, check_words, folder, in_utm, open, options, sample_blocks};

/// Rough ground with single voids and a hole in it.
fn height([x, y]: [f64; 2]) -> f32 {
    let (a, b) = ((x * 7919.0).floor() as i64, (y * 7907.0).floor() as i64);
    let is_hole = (x * 40.0).fract() < 0.12 && (y * 40.0).fract() < 0.12;
    if (a * 31 + b * 17).rem_euclid(53) == 0 || is_hole {
        -9999.0
    } else {
        (500.0 + 300.0 * (x * 90.0).sin() * (y * 70.0).cos()) as f32
    }
}

/// 200 × 160 samples of a thousandth of a degree around 9.1° east, 47.08° north.
fn degrees<'a>() -> Raster<'a> {
    Raster::new(4326, [200, 160], [9.0, 0.001, 0.0, 47.16, 0.0, -0.001]).nodata(-9999.0)
}

fn with(bounds_deg: [f64; 4], options: PlanOptions) -> PlanOptions {
    PlanOptions { bounds_deg: Some(bounds_deg), ..options }
}

/// Checks that everything unrelated to bounds is the same, that nodes inside have the same heights,
/// and that no other nodes have heights.
fn check(dem: &Dem, asked: &PlanOptions, bounds_deg: [f64; 4]) -> GridPlan {
    let whole = dem.plan(asked).unwrap();
    let part = dem.plan(&with(bounds_deg, asked.clone())).unwrap();
    assert_eq!(part.frame.origin_m(), whole.frame.origin_m());
    assert_eq!(part.frame.cell(), whole.frame.cell());
    assert_eq!(part.metres_per_unit, whole.metres_per_unit);
    assert_eq!((&part.crs, &part.scale), (&whole.crs, &whole.scale));
    assert_eq!(part.area_deg(), whole.wgs84_bounds);
    assert!(part.frame.max_level() <= whole.frame.max_level());
    // Tiles have the same borders: the corner of the root is a whole number of tiles away.
    let [own, other] = [&part, &whole].map(|plan| plan.frame.root_corner());
    assert_eq!([(own.i - other.i) % 256, (own.j - other.j) % 256], [0, 0]);
    let (mut reader, mut clipped) = (dem.reader(&whole), dem.reader(&part));
    let window =
        NodeWindow { columns: all(&part).columns + 6, rows: all(&part).rows + 6, ..all(&part) };
    let corner = NodeIndex { i: window.corner.i - 3, j: window.corner.j + 3 };
    let window = NodeWindow { corner, ..window };
    let (wanted, found) = (reader.window(window).unwrap(), clipped.window(window).unwrap());
    let mut filled = 0;
    for row in 0..window.rows {
        for column in 0..window.columns {
            let is_inside =
                (3..window.columns - 3).contains(&column) && (3..window.rows - 3).contains(&row);
            let [wanted_m, found_m] =
                [&wanted, &found].map(|window| window.heights.height(column, row));
            let expected = if is_inside { wanted_m } else { None };
            assert_eq!(found_m.map(f32::to_bits), expected.map(f32::to_bits), "{column} {row}");
            let at = row * window.columns + column;
            let was_filled = wanted.is_filled.get(at).is_some_and(|&filled| filled) && is_inside;
            assert_eq!(found.is_filled.get(at).is_some_and(|&filled| filled), was_filled);
            filled += u64::from(was_filled);
        }
    }
    assert_eq!(found.filled, filled);
    // Positions of roads are the same, too.
    let mut points = [[[9.05, 47.05], [9.9, 46.2]]; 2];
    for (plan, points) in [&whole, &part].into_iter().zip(&mut points) {
        dem.projection(plan).unwrap().working_from_wgs84(points).unwrap();
    }
    assert_eq!(points[0], points[1]);
    // The samples are those between the nodes.
    let samples = |plan| sample_blocks(dem, plan).into_iter().flat_map(|block| block.positions_m);
    let [low, high] =
        part.clip.unwrap().nodes.map(|node| [part.frame.x_m(node.i), part.frame.y_m(node.j)]);
    let inside = |at: &[f64; 2]| {
        (0..2).all(|axis| low[axis] - 1e-3 <= at[axis] && at[axis] <= high[axis] + 1e-3)
    };
    assert_eq!(samples(&part).count(), samples(&whole).filter(inside).count());
    part
}

#[test]
fn nodes_in_bounds_have_the_heights_of_the_whole() {
    let folder = folder();
    let dem = open(&[degrees().write(folder.path(), "a.tif", height)]);
    let bounds_deg = [9.053, 47.041, 9.121, 47.097];
    for asked in [
        PlanOptions { fill_voids: 5, ..options() },
        PlanOptions { fill_voids: 5, cell_every: Some(2), ..options() },
        PlanOptions { fill_voids: 5, ..in_utm() },
        PlanOptions { fill_voids: 5, cell: Some(250.0.into()), ..in_utm() },
        PlanOptions { fill_voids: 3, crs: Some("EPSG:31287".to_owned()), ..options() },
    ] {
        let part = check(&dem, &asked, bounds_deg);
        let [west, south, east, north] = part.wgs84_bounds.to_array();
        // The rectangle of nodes contains the bounds, and in a projection a little more.
        assert!(west <= 9.0531 && south <= 47.0411 && east >= 9.1209 && north >= 47.0969);
        assert!(
            west > 9.045 && south > 47.03 && east < 9.13 && north < 47.11,
            "{:?}",
            part.wgs84_bounds
        );
        let needed = dem.audit_blocks(&part).unwrap().len();
        assert!(needed <= dem.audit_blocks(&dem.plan(&asked).unwrap()).unwrap().len());
    }
}

#[test]
fn bounds_are_rounded_outwards_to_cells_and_end_at_nodes_exactly() {
    let folder = folder();
    let dem = open(&[degrees().write(folder.path(), "a.tif", height)]);
    // Samples lie in the middle of pixels: at 9.0005, 9.0015 …
    let size = |bounds_deg| {
        let window = all(&dem.plan(&with(bounds_deg, options())).unwrap());
        [window.columns, window.rows]
    };
    assert_eq!(size([9.0105, 47.0505, 9.0205, 47.0705]), [11, 21]);
    assert_eq!(size([9.0104, 47.0504, 9.0206, 47.0706]), [13, 23]);
    assert_eq!(size([9.0106, 47.0506, 9.0204, 47.0704]), [11, 21]);
    // Beyond the data there are no nodes.
    assert_eq!(size([-20.0, 30.0, 50.0, 60.0]), [200, 160]);
}

#[test]
fn only_samples_that_are_needed_are_looked_at() {
    let folder = folder();
    // Blocks are 512 samples wide.
    let tiled = ["TILED=YES", "BLOCKXSIZE=256", "BLOCKYSIZE=256"];
    let raster =
        Raster::new(4326, [2048, 2048], [9.0, 0.001, 0.0, 47.0, 0.0, -0.001]).created(&tiled);
    // An undeclared "no data" value far from the bounds does not matter.
    let path = raster
        .write(folder.path(), "a.tif", |[x, y]| if x > 10.9 { -9999.0 } else { (x + y) as f32 });
    let dem = open(&[path]);
    let count = |plan: &GridPlan| dem.audit_blocks(plan).unwrap().len();
    let whole = dem.plan(&PlanOptions { fill_voids: 32, ..options() }).unwrap();
    assert_eq!(count(&whole), 16);
    let bounds = |bounds_deg| {
        dem.plan(&with(bounds_deg, PlanOptions { fill_voids: 32, ..options() })).unwrap()
    };
    assert_eq!(count(&bounds([9.1, 46.9, 9.2, 46.95])), 1);
    // A void just inside may be filled from the next block.
    assert_eq!(count(&bounds([9.1, 46.9, 9.49, 46.95])), 2);
    let resampled = PlanOptions { fill_voids: 0, ..in_utm() };
    assert_eq!(count(&dem.plan(&with([9.1, 46.7, 9.2, 46.8], resampled)).unwrap()), 1);
    assert_eq!(dem.file_nodes(&bounds([9.1, 46.9, 9.2, 46.95])).unwrap().len(), 1);
}

#[test]
fn bounds_may_cross_180_degrees() {
    let folder = folder();
    let east = Raster::new(4326, [100, 60], [179.0, 0.01, 0.0, -16.0, 0.0, -0.01]);
    let west = Raster::new(4326, [100, 60], [-180.0, 0.01, 0.0, -16.0, 0.0, -0.01]);
    let ground = |[x, y]: [f64; 2]| (x.rem_euclid(360.0) + y) as f32;
    let files =
        [east.write(folder.path(), "e.tif", ground), west.write(folder.path(), "w.tif", ground)];
    let dem = open(&files);
    for asked in [options(), in_utm()] {
        let part = check(&dem, &asked, [179.8, -16.4, -179.7, -16.2]);
        let width = part.wgs84_bounds.width();
        assert!((0.5..0.55).contains(&width), "{:?}", part.wgs84_bounds);
        assert!(part.wgs84_bounds.min_x > 179.0, "{:?}", part.wgs84_bounds);
    }
    // Entirely beyond 180 degrees of the whole: reported within ±180.
    let part = check(&dem, &options(), [-179.9, -16.4, -179.7, -16.2]);
    assert!((-179.95..-179.85).contains(&part.wgs84_bounds.min_x), "{:?}", part.wgs84_bounds);
}

/// Bounds that go around the whole earth clip nothing along the longitude, for data anywhere and in
/// any working CRS.
#[test]
fn bounds_around_the_earth_leave_out_no_longitude() {
    let folder = folder();
    let ground = |[x, y]: [f64; 2]| (x.rem_euclid(360.0) + y) as f32;
    for (name, west) in [("at-180.tif", 179.5), ("at-0.tif", -0.5), ("east.tif", 120.0)] {
        let raster = Raster::new(4326, [100, 60], [west, 0.01, 0.0, -16.0, 0.0, -0.01]);
        let dem = open(&[raster.write(folder.path(), name, ground)]);
        let polar = PlanOptions {
            crs: Some("EPSG:3031".to_owned()),
            cell: Some(Cell::from(1000.0)),
            ..options()
        };
        for asked in [options(), in_utm(), polar] {
            let whole = dem.plan(&asked).unwrap();
            for bounds_deg in [[-180.0, -90.0, 180.0, 90.0], [-180.0, -17.0, 180.0, -15.0]] {
                let part = dem.plan(&with(bounds_deg, asked.clone())).unwrap();
                assert_eq!(
                    (part.south_west, part.north_east),
                    (whole.south_west, whole.north_east)
                );
            }
            let part = dem.plan(&with([-180.0, -16.4, 180.0, -16.2], asked.clone())).unwrap();
            let widths = [&part, &whole].map(|plan| plan.wgs84_bounds.width());
            assert!(widths[0] > widths[1] - 0.03, "{widths:?}");
            // Around a pole the ground is the rectangle around a rotated image, which is larger.
            if asked.crs.as_deref() != Some("EPSG:3031") {
                assert!(widths[0] < widths[1] + 0.03, "{widths:?}");
                assert!(part.wgs84_bounds.height() < 0.3, "{:?}", part.wgs84_bounds);
            }
            let beside = dem.plan(&with([-180.0, 10.0, 180.0, 20.0], asked)).unwrap_err();
            assert!(matches!(beside, GridError::BoundsBesideData { .. }), "{beside}");
        }
    }
}

#[test]
fn bounds_without_a_cell_or_at_both_ends_are_refused() {
    let folder = folder();
    let dem = open(&[degrees().write(folder.path(), "a.tif", height)]);
    let refuse = |bounds_deg, words: &[&str]| {
        let error = dem.plan(&with(bounds_deg, options())).unwrap_err();
        check_words(&error, words);
    };
    refuse([10.0, 47.0, 11.0, 48.0], &["--bounds 10,47,11,48", "9.0005", "47.1595"]);
    // Next to the last sample.
    refuse([9.1996, 47.0, 9.1999, 48.0], &["no cell"]);
    let globe = Raster::new(4326, [360, 180], [-180.0, 1.0, 0.0, 90.0, 0.0, -1.0]);
    let globe =
        Dem::open(&[globe.write(folder.path(), "g.tif", |_| 1.0_f32)], &OpenOptions::default())
            .unwrap();
    let own = PlanOptions { crs: Some("dem".to_owned()), ..options() };
    let error = globe.plan(&with([170.0, -20.0, -170.0, 20.0], own.clone())).unwrap_err();
    assert!(matches!(error, GridError::BoundsAtBothEnds { .. }), "{error}");
    for bounds_deg in
        [[-180.0, -90.0, 180.0, 90.0], [-20.0, -10.0, 30.0, 40.0], [150.0, 0.0, 179.0, 9.0]]
    {
        globe.plan(&with(bounds_deg, own.clone())).unwrap();
    }
}
