//! The DEM's own CRS as working CRS: its factors, compared with closed forms and with PROJ itself.

use corniche_dem::{PlanOptions, Resampling};
use corniche_geom::Projection;
use gdal::spatial_ref::{AxisMappingStrategy, CoordTransform, SpatialRef};

use crate::fixture::{Raster, all, check, check_near, check_words, degree_m, open, options, plan};

/// The largest relative adjustment of an east side by half a lattice step: less than 0.5 mm per
/// cell.
fn adjusted(east_m: f64) -> f64 {
    1e-6 + 0.0005 / east_m
}

/// Positions transformed by PROJ alone, longitude or x first.
fn transformed(from: u32, to: u32, point: [f64; 2]) -> [f64; 2] {
    let reference = |epsg: u32| {
        let mut reference = SpatialRef::from_epsg(epsg).unwrap();
        reference.set_axis_mapping_strategy(AxisMappingStrategy::TraditionalGisOrder);
        reference
    };
    let transform = CoordTransform::new(&reference(from), &reference(to)).unwrap();
    let (mut xs, mut ys) = ([point[0]], [point[1]]);
    transform.transform_coords(&mut xs, &mut ys, &mut []).unwrap();
    [xs[0], ys[0]]
}

/// Metres to a degree of longitude and of latitude on an ellipsoid, from chords between points that
/// are close: by the parametric latitude, without any formula for radii of curvature.
fn degree_on([major_m, flattening]: [f64; 2], latitude_deg: f64) -> [f64; 2] {
    let minor_m = major_m * (1.0 - flattening);
    let point = |latitude_deg: f64| {
        let reduced = (minor_m / major_m * latitude_deg.to_radians().tan()).atan();
        [major_m * reduced.cos(), minor_m * reduced.sin()]
    };
    let half_deg = 0.01;
    let (south, north) = (point(latitude_deg - half_deg), point(latitude_deg + half_deg));
    let chord_m = (north[0] - south[0]).hypot(north[1] - south[1]);
    [point(latitude_deg)[0] * 1_f64.to_radians(), chord_m / (2.0 * half_deg)]
}

/// A plane over CRS coordinates, small numbers on small rasters.
fn plane_about([x0, y0]: [f64; 2], slope: f64) -> impl Fn([f64; 2]) -> f64 {
    move |[x, y]| 800.0 + slope * (x - x0) - 2.0 * slope * (y - y0)
}

/// Web Mercator, World Mercator and World Equidistant Cylindrical: the unit divided by PROJ's scale
/// along each axis, at the standard latitude; lengths in the middle are true, nodes are samples.
#[test]
fn projections_that_stretch_get_true_lengths_and_keep_their_samples() {
    let folder = tempfile::tempdir().unwrap();
    let latitude_deg = 46.5_f64;
    let major_m = 6_378_137.0;
    let [degree_east_m, degree_north_m] = degree_m(latitude_deg);
    let cos = latitude_deg.to_radians().cos();
    let degree_rad = 1_f64.to_radians();
    // On the sphere of Web Mercator both scales are 1 / cos; true lengths are the ellipsoid's.
    // World Mercator is conformal.
    let web = [degree_east_m, degree_north_m].map(|metres| metres * cos / (major_m * degree_rad));
    let web = [web[0] / cos, web[1]];
    let conformal = [degree_east_m / (major_m * degree_rad); 2];
    for (epsg, expected) in [(3857, Some(web)), (3395, Some(conformal)), (4087, None)] {
        let [x, y] = transformed(4326, epsg, [9.0, latitude_deg]).map(f64::round);
        let raster = Raster::new(epsg, [60, 50], [x - 300.0, 10.0, 0.0, y + 250.0, 0.0, -10.0]);
        let truth = plane_about([x, y], 0.1);
        let dem = open(&[raster.write(folder.path(), &format!("{epsg}.tif"), &truth)]);
        let plan = plan(&dem);
        assert_eq!(
            (plan.crs.as_str(), plan.resampling),
            (&*format!("EPSG:{epsg}"), Resampling::Aligned)
        );
        // PROJ's own scale along both axes.
        let step_deg = 0.0005;
        let by_proj = [[step_deg, 0.0], [0.0, step_deg]].map(|[east, north]| {
            let end = |sign: f64| {
                let at = [9.0 + sign * east, latitude_deg + sign * north];
                transformed(4326, epsg, at)
            };
            let (from, to) = (end(-1.0), end(1.0));
            (to[0] - from[0]).hypot(to[1] - from[1]) / (2.0 * step_deg)
        });
        let share = adjusted(10.0 * plan.metres_per_unit[0]);
        let own = [degree_east_m / by_proj[0], degree_north_m / by_proj[1]];
        check_near(plan.metres_per_unit, own, share);
        if let Some(expected) = expected {
            check_near(plan.metres_per_unit, expected, share);
        }
        check_near(plan.scale.center, [1.0; 2], 1e-4);
        // A true length of 0.001 degrees each way.
        let projection = dem.projection(&plan).unwrap();
        let mut ends = [[8.9995, 46.5], [9.0005, 46.5], [9.0, 46.4995], [9.0, 46.5005]];
        projection.working_from_wgs84(&mut ends).unwrap();
        let lengths = [ends[1][0] - ends[0][0], ends[3][1] - ends[2][1]];
        check_near(lengths, [degree_east_m / 1000.0, degree_north_m / 1000.0], 1e-4);
        let [east, north] = plan.metres_per_unit;
        let on_nodes = |[x, y]: [f64; 2]| truth([x / east, y / north]);
        assert_eq!(check(&mut dem.reader(&plan), &plan, 1e-3, on_nodes), 3000);
    }
}

/// Degrees and grads, Greenwich and Paris, WGS84 and other ellipsoids: the radii of curvature are
/// those of the CRS's own ellipsoid.
#[test]
fn a_unit_of_a_geographic_system_is_as_long_as_on_its_ellipsoid() {
    let folder = tempfile::tempdir().unwrap();
    let wgs84 = [6_378_137.0, 1.0 / 298.257_223_563];
    let airy = [6_377_563.396, 1.0 / 299.324_964_6];
    let bessel = [6_377_397.155, 1.0 / 299.152_812_8];
    let clarke = [6_378_249.2, 1.0 - 6_356_515.0 / 6_378_249.2];
    for (epsg, ellipsoid, unit_deg, prime_meridian_deg) in [
        (4326, wgs84, 1.0, 0.0),
        (4277, airy, 1.0, 0.0),
        (4314, bessel, 1.0, 0.0),
        (4807, clarke, 0.9, 2.337_229_17),
    ] {
        // 5 to 5.25 degrees from the prime meridian, 49.875 to 50.125 degrees north.
        let step = 0.0025 / unit_deg;
        let corner = [5.0 / unit_deg, 50.125 / unit_deg];
        let raster = Raster::new(epsg, [100, 100], [corner[0], step, 0.0, corner[1], 0.0, -step]);
        let truth = plane_about(corner, 1000.0);
        let dem = open(&[raster.write(folder.path(), &format!("{epsg}.tif"), &truth)]);
        let plan = plan(&dem);
        assert_eq!(
            (plan.crs.as_str(), plan.resampling),
            (&*format!("EPSG:{epsg}"), Resampling::Aligned)
        );
        let expected = degree_on(ellipsoid, 50.0).map(|metres| metres * unit_deg);
        check_near(plan.metres_per_unit, expected, 1e-5);
        let [east, north] = plan.metres_per_unit;
        check_near(plan.frame.cell().to_array(), [east * step, north * step], 1e-12);
        let on_nodes = |[x, y]: [f64; 2]| truth([x / east, y / north]);
        assert_eq!(check(&mut dem.reader(&plan), &plan, 1e-3, on_nodes), 10_000);
        // The middle, in WGS84: datums differ by some hundred metres at most.
        let bounds = plan.data_bounds;
        let mut middle = [bounds.center()];
        dem.projection(&plan).unwrap().wgs84_from_working(&mut middle).unwrap();
        let lon = 5.125 + prime_meridian_deg;
        let off = [middle[0][0] - lon, middle[0][1] - 50.0];
        assert!(off.iter().all(|off| off.abs() < 0.005), "{epsg}: {middle:?}");
    }
}

/// Hartebeesthoek94 / Lo29 counts westwards and southwards: x grows east and y north nevertheless.
#[test]
fn systems_that_count_westwards_and_southwards_are_turned() {
    let folder = tempfile::tempdir().unwrap();
    let corner = [100_000.0, 2_870_000.0];
    let truth = plane_about(corner, 0.1);
    let tables = [
        // The first row in the north, the first column in the west, as a map is printed.
        ("map.tif", [corner[0], -10.0, 0.0, corner[1], 0.0, 10.0]),
        // Columns with growing westings, rows with shrinking southings.
        ("table.tif", [corner[0] - 600.0, 10.0, 0.0, corner[1] + 500.0, 0.0, -10.0]),
    ];
    let mut grounds = Vec::new();
    for (name, map) in tables {
        let dem = open(&[Raster::new(2053, [60, 50], map).write(folder.path(), name, &truth)]);
        let plan = plan(&dem);
        assert_eq!((plan.crs.as_str(), plan.resampling), ("EPSG:2053", Resampling::Aligned));
        assert_eq!(plan.metres_per_unit, [-1.0, -1.0]);
        let mut reader = dem.reader(&plan);
        assert_eq!(check(&mut reader, &plan, 1e-3, |[x, y]| truth([-x, -y])), 3000);
        // Corners, in degrees, from PROJ alone.
        let bounds = plan.data_bounds;
        let mut corners = [[bounds.min_x, bounds.min_y], [bounds.max_x, bounds.max_y]];
        let by_proj = corners.map(|[x, y]| transformed(2053, 4326, [-x, -y]));
        dem.projection(&plan).unwrap().wgs84_from_working(&mut corners).unwrap();
        for (found, expected) in corners.iter().zip(&by_proj) {
            let off = [found[0] - expected[0], found[1] - expected[1]];
            assert!(off.iter().all(|off| off.abs() < 1e-9), "{found:?}, not {expected:?}");
        }
        let [south_west, north_east] = corners;
        assert!(south_west[0] < north_east[0] && south_west[1] < north_east[1]);
        assert!(south_west[0] > 27.9 && north_east[0] < 28.1, "west of 29° E: {corners:?}");
        assert!(south_west[1] < -25.0, "south of the equator");
        let mut back = corners;
        dem.projection(&plan).unwrap().working_from_wgs84(&mut back).unwrap();
        assert!(
            (back[0][0] - bounds.min_x).abs() < 1e-4 && (back[1][1] - bounds.max_y).abs() < 1e-4
        );
        grounds.push((plan.frame, reader.window(all(&plan)).unwrap()));
    }
    assert_eq!(grounds[0], grounds[1]);
}

/// Polar stereographic systems are true to scale at 70 or 71 degrees, and keep their unit there;
/// elsewhere a factor makes them true; if no factor does within 3 %, another CRS is chosen.
#[test]
fn polar_systems_are_kept_where_lengths_are_true_within_three_percent() {
    let folder = tempfile::tempdir().unwrap();
    // Distance from the pole, half a side and spacing, kilometres.
    for (epsg, [from_pole, half, step], is_own, is_plain) in [
        (3413, [2100.0, 60.0, 1.0], true, true),
        (3031, [2000.0, 60.0, 1.0], true, true),
        (3413, [700.0, 60.0, 1.0], true, false),
        (3031, [500.0, 60.0, 1.0], true, false),
        (3413, [1900.0, 1500.0, 30.0], false, false),
    ] {
        // 3413 has its y axis along 135° E, 3031 along 0°: both are on the middle of the raster.
        let y = if epsg == 3413 { -from_pole } else { from_pole };
        let count = (2.0 * half / step) as usize;
        let map = [-half * 1000.0, step * 1000.0, 0.0, (y + half) * 1000.0, 0.0, -step * 1000.0];
        let truth = plane_about([0.0, y * 1000.0], 1e-4);
        let name = format!("{epsg}-{from_pole}.tif");
        let raster = Raster::new(epsg, [count, count], map);
        let dem = open(&[raster.write(folder.path(), &name, &truth)]);
        let plan = plan(&dem);
        assert_eq!(plan.crs == format!("EPSG:{epsg}"), is_own, "{name}: {}", plan.crs);
        assert_eq!(
            plan.resampling == Resampling::Aligned,
            is_own,
            "{name}: {}",
            plan.resampling_text
        );
        if !is_own {
            continue;
        }
        assert_eq!(
            plan.metres_per_unit == [1.0, 1.0],
            is_plain,
            "{name}: {:?}",
            plan.metres_per_unit
        );
        let ends = [plan.scale.least, plan.scale.largest].concat();
        assert!(ends.iter().all(|scale| (scale - 1.0).abs() <= 0.03), "{name}: {ends:?}");
        let [east, north] = plan.metres_per_unit;
        let on_nodes = |[x, y]: [f64; 2]| truth([x / east, y / north]);
        let read = check(&mut dem.reader(&plan), &plan, 1e-3, on_nodes);
        assert_eq!(read, count * count);
    }
}

/// A tall extent in degrees: lengths would be off by more than 3 %, so UTM is used, unless `--crs
/// dem` is given.
#[test]
fn beyond_three_percent_utm_is_taken_and_dem_overrides() {
    let folder = tempfile::tempdir().unwrap();
    let truth = |[lon, lat]: [f64; 2]| 500.0 + 40.0 * (lon - 9.0) + 30.0 * (lat - 44.0);
    let square = |south: f64, rows: usize, name: &str| {
        let map = [8.5, 0.02, 0.0, south + 0.02 * rows as f64, 0.0, -0.02];
        open(&[Raster::new(4326, [50, rows], map).write(folder.path(), name, truth)])
    };
    // cos 44 / cos 42.7 is 0.979, cos 44 / cos 41.9 is 0.966.
    let short = plan(&square(42.7, 130, "short.tif"));
    assert_eq!((short.crs.as_str(), short.resampling), ("EPSG:4326", Resampling::Aligned));
    let tall = square(41.9, 210, "tall.tif");
    let by_default = plan(&tall);
    assert_eq!(
        (by_default.crs.as_str(), by_default.resampling),
        ("EPSG:32632", Resampling::Resampled)
    );
    for text in ["dem", "EPSG:4326"] {
        let asked = PlanOptions { crs: Some(text.to_owned()), ..options() };
        let own = tall.plan(&asked).unwrap();
        assert_eq!((own.crs.as_str(), own.resampling), ("EPSG:4326", Resampling::Aligned));
        check_near(own.metres_per_unit, degree_m(44.0), 1e-5);
        assert_eq!(
            check(&mut tall.reader(&own), &own, 1e-3, |[x, y]| {
                truth([x / own.metres_per_unit[0], y / own.metres_per_unit[1]])
            }),
            50 * 210
        );
        // Scale over the rim: a degree at 44 over a degree at the southernmost and northernmost
        // rows.
        let at = |latitude_deg: f64| {
            let (standard, here) = (degree_m(44.0), degree_m(latitude_deg));
            [standard[0] / here[0], standard[1] / here[1]]
        };
        check_near([own.scale.least[0], own.scale.largest[1]], [at(41.91)[0], at(41.91)[1]], 1e-4);
        check_near([own.scale.largest[0], own.scale.least[1]], [at(46.09)[0], at(46.09)[1]], 1e-4);
        check_near(own.scale.center, [1.0; 2], 1e-4);
    }
}

#[test]
fn a_given_latitude_pins_the_factors() {
    let folder = tempfile::tempdir().unwrap();
    let map = [9.0, 0.001, 0.0, 47.3, 0.0, -0.001];
    let dem = open(&[Raster::new(4326, [40, 30], map).write(folder.path(), "a.tif", |_| 1.0_f32)]);
    check_near(plan(&dem).metres_per_unit, degree_m(47.5), 1e-5);
    for latitude_deg in [46.8, 47.25, 48.0] {
        let asked = PlanOptions { scale_latitude_deg: Some(latitude_deg), ..options() };
        let pinned = dem.plan(&asked).unwrap();
        check_near(pinned.metres_per_unit, degree_m(latitude_deg), 1e-5);
        assert_eq!(pinned.resampling, Resampling::Aligned);
    }
    // So far away that lengths are no longer true within 3 %.
    let far = PlanOptions { scale_latitude_deg: Some(30.0), ..options() };
    assert_eq!(dem.plan(&far).unwrap().crs, "EPSG:32632");
    for latitude_deg in [90.0, -95.0, f64::NAN, f64::INFINITY] {
        let asked = PlanOptions { scale_latitude_deg: Some(latitude_deg), ..options() };
        check_words(&dem.plan(&asked).unwrap_err(), &["--scale-latitude", "between -89 and 89"]);
    }
}

/// A requested projected CRS has true lengths, too.
#[test]
fn lengths_are_true_in_a_projection_that_is_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    let map = [9.0, 0.001, 0.0, 47.3, 0.0, -0.001];
    let dem = open(&[Raster::new(4326, [40, 30], map).write(folder.path(), "a.tif", |_| 1.0_f32)]);
    let asked = PlanOptions { crs: Some("EPSG:3857".to_owned()), ..options() };
    let plan = dem.plan(&asked).unwrap();
    assert_eq!((plan.crs.as_str(), plan.resampling), ("EPSG:3857", Resampling::Resampled));
    check_near(plan.scale.center, [1.0; 2], 0.01);
}

/// The whole globe in degrees: at the poles, cells have no width, which a scale of 1000 shows.
#[test]
fn the_globe_can_be_had_in_its_own_degrees() {
    let folder = tempfile::tempdir().unwrap();
    let truth = |[lon, lat]: [f64; 2]| lon + 2.0 * lat;
    let half_m = degree_m(89.5)[0];
    for (name, north, rows, largest) in
        [("cells.tif", 90.0, 180, degree_m(0.0)[0] / half_m), ("poles.tif", 90.5, 181, 1000.0)]
    {
        let map = [-180.0, 1.0, 0.0, north, 0.0, -1.0];
        let dem = open(&[Raster::new(4326, [360, rows], map).write(folder.path(), name, truth)]);
        let asked = PlanOptions { crs: Some("dem".to_owned()), ..options() };
        let plan = dem.plan(&asked).unwrap();
        check_near(plan.metres_per_unit, degree_m(0.0), 1e-5);
        let [east, north] = plan.metres_per_unit;
        // A degree beyond the last column is the first one again.
        let on_nodes = |[x, y]: [f64; 2]| {
            let lon = x / east;
            truth([if lon > 180.0 { lon - 360.0 } else { lon }, y / north])
        };
        let read = check(&mut dem.reader(&plan), &plan, 1e-3, on_nodes);
        assert_eq!(read, 361 * rows);
        check_near([plan.scale.largest[0], 1.0], [largest, 1.0], 1e-4);
    }
}

/// `--crs DEM` and `--crs Utm` are accepted in any case; the message about another word names both.
#[test]
fn words_for_the_working_crs_have_any_case() {
    let folder = tempfile::tempdir().unwrap();
    let map = [9.0, 0.001, 0.0, 47.3, 0.0, -0.001];
    let dem = open(&[Raster::new(4326, [40, 30], map).write(folder.path(), "a.tif", |_| 1.0_f32)]);
    let asked = |word: &str| dem.plan(&PlanOptions { crs: Some(word.to_owned()), ..options() });
    for (words, expected) in
        [(["dem", "DEM", "Dem"], "EPSG:4326"), (["utm", "UTM", "Utm"], "EPSG:32632")]
    {
        for word in words {
            assert_eq!(asked(word).unwrap().crs, expected, "{word}");
        }
    }
    check_words(&asked("mercator please").unwrap_err(), &["--crs", "write dem", "utm", "EPSG:n"]);
}

/// A latitude at which lengths are true has no effect in UTM.
#[test]
fn a_given_latitude_does_not_go_with_utm() {
    let folder = tempfile::tempdir().unwrap();
    let map = [9.0, 0.001, 0.0, 47.3, 0.0, -0.001];
    let dem = open(&[Raster::new(4326, [40, 30], map).write(folder.path(), "a.tif", |_| 1.0_f32)]);
    for word in ["utm", "UTM"] {
        let asked =
            PlanOptions { crs: Some(word.to_owned()), scale_latitude_deg: Some(47.0), ..options() };
        check_words(&dem.plan(&asked).unwrap_err(), &["--scale-latitude 47", "--crs utm"]);
    }
}

/// Web Mercator near the equator: one square is true to scale within 1 % all over, the one north of
/// it is not. With one latitude for both, they have the same factors.
#[test]
fn a_given_latitude_alone_decides_whether_a_projection_is_true_to_scale() {
    let folder = tempfile::tempdir().unwrap();
    let northing = |lat: f64| 6_378_137.0 * (lat.to_radians().tan().asinh());
    let factors = |name: &str, south: f64, north: f64, latitude_deg: Option<f64>| {
        let step = (northing(north) - northing(south)) / 40.0;
        let map = [1_000_000.0, step, 0.0, northing(north), 0.0, -step];
        let file = Raster::new(3857, [40, 40], map).write(folder.path(), name, |_| 1.0_f32);
        let asked = PlanOptions { scale_latitude_deg: latitude_deg, ..options() };
        open(&[file]).plan(&asked).unwrap().metres_per_unit
    };
    let both = |latitude_deg: Option<f64>| {
        [factors("south.tif", 3.4, 4.2, latitude_deg), factors("north.tif", 4.2, 5.6, latitude_deg)]
    };
    let [south, north] = both(None);
    assert!(south[1] > 0.999 && north[1] < 0.995, "{south:?} {north:?}");
    let [south, north] = both(Some(4.0));
    assert!(south[1] > 0.999 && north[1] > 0.999, "{south:?} {north:?}");
    let [south, north] = both(Some(5.4));
    assert!(south[1] < 0.995 && north[1] < 0.995, "{south:?} {north:?}");
}
