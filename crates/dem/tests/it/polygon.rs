//! A plan with a polygon has the nodes of the cells that the polygon touches, with the heights of
//! the whole to the last bit.

use std::{collections::HashSet, fs, path::Path};

use corniche_dem::{Dem, GridPlan, PlanOptions};
use corniche_geom::{NodeIndex, NodeWindow};
use corniche_gis::{PolygonError, RegionPolygons, VectorError};
use gdal::{
    DriverManager,
    spatial_ref::SpatialRef,
    vector::{Geometry, LayerAccess, LayerOptions, OGRwkbGeometryType},
};

use crate::fixture::{Raster, all, check_words, folder, in_utm, open, options};

/// 200 × 160 samples of a thousandth of a degree, at 9.0005, 9.0015 … east and 47.1595 … north,
/// with voids.
fn dem(folder: &Path) -> Dem {
    let raster =
        Raster::new(4326, [200, 160], [9.0, 0.001, 0.0, 47.16, 0.0, -0.001]).nodata(-9999.0);
    open(&[raster.write(folder, "dem.tif", |[x, y]| {
        let (a, b) = ((x * 7919.0).floor() as i64, (y * 7907.0).floor() as i64);
        let is_void = (a * 31 + b * 17).rem_euclid(53) == 0;
        if is_void { -9999.0 } else { (500.0 + 300.0 * (x * 90.0).sin() * (y * 70.0).cos()) as f32 }
    })])
}

/// A GeoJSON file with one feature of this geometry.
fn geojson(folder: &Path, name: &str, kind: &str, coordinates: &str) -> std::path::PathBuf {
    let path = folder.join(name);
    let text = format!(
        r#"{{"type":"FeatureCollection","features":[{{"type":"Feature","properties":{{}},"geometry":{{"type":"{kind}","coordinates":{coordinates}}}}}]}}"#
    );
    fs::write(&path, text).unwrap();
    path
}

fn polygon(folder: &Path, rings: &str) -> RegionPolygons {
    RegionPolygons::read(&geojson(folder, "polygon.geojson", "Polygon", rings)).unwrap()
}

fn within(polygon: &RegionPolygons, options: PlanOptions) -> PlanOptions {
    PlanOptions { polygon: Some(polygon.clone()), ..options }
}

/// The nodes with a height; checks that each has the height of the whole plan, in this window and
/// in small ones.
fn nodes_with_height(dem: &Dem, part: &GridPlan, whole: &GridPlan) -> HashSet<NodeIndex> {
    let window = all(part).with_halo(2);
    let found = dem.reader(part).window(window).unwrap();
    let wanted = dem.reader(whole).window(window).unwrap();
    let mut nodes = HashSet::new();
    let (mut filled, mut narrow) = (0, dem.reader(part));
    for row in 0..window.rows {
        for column in 0..window.columns {
            let at = row * window.columns + column;
            if found.is_filled.get(at).is_some_and(|&is_filled| is_filled) {
                assert!(wanted.is_filled[at] && found.heights.has_height(column, row));
                filled += 1;
            }
            let Some(height_m) = found.heights.height(column, row) else { continue };
            assert_eq!(Some(height_m), wanted.heights.height(column, row), "{column} {row}");
            nodes.insert(window.node(column, row));
        }
    }
    assert_eq!(found.filled, filled);
    for (left, top) in [(0, 0), (7, 3), (window.columns / 2, window.rows / 2)] {
        let small = NodeWindow { corner: window.node(left, top), stride: 1, columns: 9, rows: 5 };
        let heights = narrow.window(small).unwrap().heights;
        for (column, row) in (0..5).flat_map(|row| (0..9).map(move |column| (column, row))) {
            let node = small.node(column, row);
            assert_eq!(heights.has_height(column, row), nodes.contains(&node), "{node:?}");
        }
    }
    nodes
}

#[test]
fn a_square_is_the_same_as_bounds() {
    let folder = folder();
    let dem = dem(folder.path());
    // On nodes; and across cells, where both are rounded outwards.
    for [w, s, e, n] in [[9.0105, 47.0505, 9.0705, 47.1005], [9.0107, 47.0501, 9.0703, 47.1009]] {
        let own = polygon(
            folder.path(),
            &format!("[[[{w},{s}],[{e},{s}],[{e},{n}],[{w},{n}],[{w},{s}]]]"),
        );
        let asked = PlanOptions { fill_voids: 3, ..options() };
        let part = dem.plan(&within(&own, asked.clone())).unwrap();
        let bounds = dem.plan(&PlanOptions { bounds_deg: Some([w, s, e, n]), ..asked }).unwrap();
        assert_eq!((part.frame, part.clip), (bounds.frame, bounds.clip));
        assert_eq!(part.wgs84_bounds, bounds.wgs84_bounds);
        let window = all(&part).with_halo(3);
        let [a, b] = [&part, &bounds].map(|plan| dem.reader(plan).window(window).unwrap());
        assert_eq!((a.filled, a.is_filled), (b.filled, b.is_filled));
        let bits = |window: &corniche_geom::HeightGrid| -> Vec<Option<u32>> {
            (0..window.rows())
                .flat_map(|row| (0..window.columns()).map(move |column| (column, row)))
                .map(|(column, row)| window.height(column, row).map(f32::to_bits))
                .collect()
        };
        assert_eq!(bits(&a.heights), bits(&b.heights));
    }
}

#[test]
fn a_triangle_has_the_cells_that_it_enters() {
    let folder = folder();
    let dem = dem(folder.path());
    let asked = PlanOptions { fill_voids: 32, ..options() };
    let whole = dem.plan(&asked).unwrap();
    // With corners on nodes and a long side through corners of cells: 20 columns of cells, 1 to 20
    // high, have nodes in rows of 2 to 21.
    let own = polygon(
        folder.path(),
        "[[[9.0105,47.0505],[9.0305,47.0505],[9.0305,47.0705],[9.0105,47.0505]]]",
    );
    let part = dem.plan(&within(&own, asked)).unwrap();
    let nodes = nodes_with_height(&dem, &part, &whole);
    assert_eq!(nodes.len(), (2..=21).sum::<usize>() + 21);
}

#[test]
fn a_hole_is_left_out_and_polygons_are_united() {
    let folder = folder();
    let dem = dem(folder.path());
    let asked = PlanOptions { fill_voids: 32, ..options() };
    let whole = dem.plan(&asked).unwrap();
    let square = |w: f64, s: f64, size: f64| {
        let (e, n) = (w + size, s + size);
        format!("[[{w},{s}],[{e},{s}],[{e},{n}],[{w},{n}],[{w},{s}]]")
    };
    let (outer, hole) = (square(9.0105, 47.0505, 0.02), square(9.0155, 47.0555, 0.01));
    let own = polygon(folder.path(), &format!("[{outer},{hole}]"));
    let part = dem.plan(&within(&own, asked.clone())).unwrap();
    assert_eq!(nodes_with_height(&dem, &part, &whole).len(), 21 * 21 - 9 * 9);
    // Another polygon over half of the hole, and one that overlaps the first.
    let (island, over) = (square(9.0175, 47.0575, 0.002), square(9.0105, 47.0505, 0.003));
    let path = geojson(
        folder.path(),
        "several.geojson",
        "MultiPolygon",
        &format!("[[{outer},{hole}],[{island}]]"),
    );
    let several = fs::read_to_string(&path).unwrap();
    let feature = format!(
        r#",{{"type":"Feature","properties":{{}},"geometry":{{"type":"Polygon","coordinates":[{over}]}}}}]}}"#
    );
    fs::write(
        &path,
        several.replace("]}", &feature).replacen(&feature, "]}", several.matches("]}").count() - 1),
    )
    .unwrap();
    let own = RegionPolygons::read(&path).unwrap();
    let part = dem.plan(&within(&own, asked)).unwrap();
    assert_eq!(nodes_with_height(&dem, &part, &whole).len(), 21 * 21 - 9 * 9 + 9);
}

#[test]
fn bounds_and_a_polygon_hold_both() {
    let folder = folder();
    let dem = dem(folder.path());
    let own = polygon(
        folder.path(),
        "[[[9.0105,47.0505],[9.0305,47.0505],[9.0305,47.0705],[9.0105,47.0505]]]",
    );
    let bounds_deg = Some([9.0205, 47.0405, 9.0605, 47.0605]);
    let asked = PlanOptions { bounds_deg, fill_voids: 32, ..options() };
    let part = dem.plan(&within(&own, asked)).unwrap();
    let whole = dem.plan(&PlanOptions { fill_voids: 32, ..options() }).unwrap();
    assert_eq!([all(&part).columns, all(&part).rows], [11, 11]);
    assert_eq!(nodes_with_height(&dem, &part, &whole).len(), 11 * 11);
    let beside = PlanOptions { bounds_deg: Some([9.1, 47.0, 9.15, 47.1]), ..options() };
    let error = dem.plan(&within(&own, beside)).unwrap_err();
    check_words(&error, &["--bounds 9.1,47,9.15,47.1", "polygon.geojson", "in common"]);
}

#[test]
fn edges_are_straight_in_the_files_own_coordinates() {
    let folder = folder();
    let dem = dem(folder.path());
    let asked = PlanOptions { cell: Some(5.0.into()), ..in_utm() };
    let whole = dem.plan(&asked).unwrap();
    // Over 0.18 degrees a parallel bends by 4 m in UTM. Without more corners some thousand cells
    // would differ.
    let few = polygon(
        folder.path(),
        "[[[9.01,47.05],[9.19,47.05],[9.19,47.052],[9.01,47.052],[9.01,47.05]]]",
    );
    let between = |a: f64, b: f64| (0..50).map(move |k| a + (b - a) * f64::from(k) / 50.0);
    let mut corners: Vec<String> = Vec::new();
    corners.extend(between(9.01, 9.19).map(|x| format!("[{x},47.05]")));
    corners.extend(between(47.05, 47.052).map(|y| format!("[9.19,{y}]")));
    corners.extend(between(9.19, 9.01).map(|x| format!("[{x},47.052]")));
    corners.extend(between(47.052, 47.05).map(|y| format!("[9.01,{y}]")));
    corners.push(corners[0].clone());
    let many = polygon(folder.path(), &format!("[[{}]]", corners.join(",")));
    let [few, many] = [&few, &many].map(|own| {
        let part = dem.plan(&within(own, asked.clone())).unwrap();
        nodes_with_height(&dem, &part, &whole)
    });
    // Corners are added to within a hundredth of a cell, so hardly a cell differs.
    let differ = few.symmetric_difference(&many).count();
    assert!(few.len() > 100_000 && differ <= 100, "{differ} of {}", few.len());
}

#[test]
fn polygons_across_180_degrees_lie_on_data_across_180_degrees() {
    let folder = folder();
    let raster = Raster::new(4326, [200, 60], [179.0, 0.01, 0.0, -16.0, 0.0, -0.01]);
    let dem = open(&[raster.write(folder.path(), "dem.tif", |[x, y]| (x + y) as f32)]);
    // As RFC 7946 requires: cut in two at 180 degrees.
    let two = geojson(
        folder.path(),
        "two.geojson",
        "MultiPolygon",
        "[[[[179.805,-16.405],[180,-16.405],[180,-16.205],[179.805,-16.205],[179.805,-16.405]]],\
          [[[-180,-16.405],[-179.695,-16.405],[-179.695,-16.205],[-180,-16.205],[-180,-16.405]]]]",
    );
    let own = RegionPolygons::read(&two).unwrap();
    for asked in [options(), in_utm()] {
        let (part, whole) =
            (dem.plan(&within(&own, asked.clone())).unwrap(), dem.plan(&asked).unwrap());
        let nodes = nodes_with_height(&dem, &part, &whole);
        assert!((0.5..0.55).contains(&part.wgs84_bounds.width()), "{:?}", part.wgs84_bounds);
        if asked == options() {
            assert_eq!(nodes.len(), 51 * 21);
        }
    }
}

/// The same polygon as a `GeoPackage` and as a Shapefile, in another coordinate system and in
/// several features.
#[test]
fn every_vector_format_gives_the_same_polygon() {
    let folder = folder();
    let square =
        "[[[9.0105,47.0505],[9.0705,47.0505],[9.0705,47.1005],[9.0105,47.1005],[9.0105,47.0505]]]";
    let json = polygon(folder.path(), square);
    let wkt =
        "POLYGON ((9.0105 47.0505,9.0705 47.0505,9.0705 47.1005,9.0105 47.1005,9.0105 47.0505))";
    for (driver, name) in [("GPKG", "a.gpkg"), ("ESRI Shapefile", "a.shp")] {
        let path = folder.path().join(name);
        write(&path, driver, Some(4326), &[wkt]);
        let read = RegionPolygons::read(&path).unwrap();
        assert_eq!(read, json, "{name}");
        assert_eq!(read.canonical_bytes(), json.canonical_bytes());
    }
    // The order of features does not matter, the coordinate system does.
    let other = "POLYGON ((9.1 47.1,9.11 47.1,9.11 47.11,9.1 47.1))";
    let path = |name: &str| folder.path().join(name);
    write(&path("ab.gpkg"), "GPKG", Some(4326), &[wkt, other]);
    write(&path("ba.gpkg"), "GPKG", Some(4326), &[other, wkt]);
    write(&path("etrs.gpkg"), "GPKG", Some(4258), &[wkt, other]);
    let [ab, ba, etrs] =
        ["ab.gpkg", "ba.gpkg", "etrs.gpkg"].map(|name| RegionPolygons::read(&path(name)).unwrap());
    assert_eq!(ab, ba);
    assert_ne!(ab, etrs);
    assert_ne!(ab, json);
}

fn write(path: &Path, driver: &str, epsg: Option<u32>, wkts: &[&str]) {
    let driver = DriverManager::get_driver_by_name(driver).unwrap();
    let mut dataset = driver.create_vector_only(path).unwrap();
    let reference = epsg.map(|epsg| {
        let mut reference = SpatialRef::from_epsg(epsg).unwrap();
        reference
            .set_axis_mapping_strategy(gdal::spatial_ref::AxisMappingStrategy::TraditionalGisOrder);
        reference
    });
    let mut layer = dataset
        .create_layer(LayerOptions {
            name: "polygons",
            srs: reference.as_ref(),
            ty: OGRwkbGeometryType::wkbPolygon,
            options: None,
        })
        .unwrap();
    for wkt in wkts {
        layer.create_feature(Geometry::from_wkt(wkt).unwrap()).unwrap();
    }
    dataset.close().unwrap();
}

#[test]
fn files_without_a_usable_polygon_are_refused_with_what_to_do() {
    let folder = folder();
    let refuse = |path: &Path, words: &[&str]| {
        let error = RegionPolygons::read(path).unwrap_err();
        check_words(&error, words);
    };
    let json =
        |kind: &str, coordinates: &str| geojson(folder.path(), "a.geojson", kind, coordinates);
    refuse(
        &json("LineString", "[[9,47],[9.1,47.1]]"),
        &["a.geojson", "LINESTRING", "polygons only"],
    );
    refuse(&json("Point", "[9,47]"), &["POINT", "encloses no area"]);
    // Rings that are not closed, including an inner one of a second polygon.
    let closed = "[[9,47],[9.1,47],[9.1,47.1],[9,47]]";
    let open = "[[9,47],[9.1,47],[9.1,47.1]]";
    let advice = [
        "a.geojson",
        "feature 1",
        "begins at 9, 47",
        "ends at 9.1, 47.1",
        "repeat the first position",
    ];
    refuse(&json("Polygon", &format!("[{open}]")), &advice);
    refuse(&json("MultiPolygon", &format!("[[{closed}],[{closed},{open}]]")), &advice);
    // A bow tie.
    refuse(
        &json("Polygon", "[[[9,47],[9.1,47.1],[9.1,47],[9,47.1],[9,47]]]"),
        &["not valid", "Self-intersection", "-makevalid"],
    );
    refuse(
        &json("Polygon", "[[[179,-16],[-179,-16],[-179,-17],[179,-17],[179,-16]]]"),
        &["180", "-wrapdateline"],
    );
    // The edge from the last corner to the first counts like any other.
    for ring in ["[-100,10],[9.5,60],[100,10],[-100,10]", "[9.5,60],[100,10],[-100,10],[9.5,60]"] {
        refuse(&json("Polygon", &format!("[[{ring}]]")), &["180", "-wrapdateline"]);
    }
    let path = folder.path().join("empty.geojson");
    fs::write(&path, r#"{"type":"FeatureCollection","features":[]}"#).unwrap();
    refuse(&path, &["empty.geojson", "no polygon"]);
    // Truncated files.
    let whole = fs::read(json("Polygon", "[[[9,47],[9.1,47],[9.1,47.1],[9,47]]]")).unwrap();
    fs::write(&path, &whole[..whole.len() - 30]).unwrap();
    refuse(&path, &["empty.geojson", "corrupt"]);
    refuse(Path::new("/nowhere.gpkg"), &["cannot open", "nowhere.gpkg"]);
    let text = folder.path().join("text.gpkg");
    fs::write(&text, "no polygons here").unwrap();
    refuse(&text, &["not a vector file"]);
    fs::write(&text, "<!DOCTYPE html><html>404 Not Found</html>").unwrap();
    let page = RegionPolygons::read(&text).unwrap_err();
    let why = std::error::Error::source(&page).unwrap().to_string();
    assert!(why.contains("an HTML page"), "{page}: {why}");
    // A Shapefile without its .prj; one with half of its corners.
    let wkts = ["POLYGON ((9 47,9.1 47,9.1 47.1,9 47))", "POLYGON ((9 47,9.2 47,9.2 47.2,9 47))"];
    let shape = folder.path().join("b.shp");
    write(&shape, "ESRI Shapefile", None, &wkts);
    refuse(&shape, &["no coordinate system", "-a_srs"]);
    write(&folder.path().join("c.shp"), "ESRI Shapefile", Some(4326), &wkts);
    let shape = folder.path().join("c.shp");
    let bytes = fs::read(&shape).unwrap();
    fs::write(&shape, &bytes[..bytes.len() / 2]).unwrap();
    let error = RegionPolygons::read(&shape).unwrap_err();
    assert!(
        matches!(
            error,
            PolygonError::Vector(
                VectorError::Damaged { .. } | VectorError::CutOff { .. } | VectorError::Open { .. }
            )
        ),
        "{error}"
    );
}

#[test]
fn polygons_beside_the_data_are_refused() {
    let folder = folder();
    let dem = dem(folder.path());
    let own = polygon(folder.path(), "[[[10,47],[10.1,47],[10.1,47.1],[10,47]]]");
    let error = dem.plan(&within(&own, options())).unwrap_err();
    check_words(&error, &["--polygon", "polygon.geojson", "contains no cell", "9.0005", "47.1595"]);
}
