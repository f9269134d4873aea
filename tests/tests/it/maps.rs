//! Images from above with a scale in print are georeferenced: as GeoTIFF and with a world file, as
//! GDAL reads them.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::{
    fs,
    path::{Path, PathBuf},
};

use e2e::{corniche, draw, json, names, sample, text};
use gdal::{
    Dataset, DatasetOptions, GdalOpenFlags, Metadata as _,
    vector::{Geometry, LayerAccess as _},
};

/// Secondary and tertiary roads have a unique colour.
const STYLE: &str = r##"
base = "road-atlas"
roads.3 = { color = "#FF00FF", outline = "#FF00FF", thin = "#FF00FF" }
roads.4 = { color = "#FF00FF", outline = "#FF00FF", thin = "#FF00FF" }
"##;

/// 25 000 · 0.0254 m / 150.
const PIXEL_M: f64 = 635.0 / 150.0;
const SCALE: [&str; 6] = ["--ortho", "--scale", "1:25000", "--dpi", "150", "--size"];

fn build(folder: &Path) -> PathBuf {
    let (dem, osm) = (sample("pass/pass-dem.tif"), sample("pass/pass.osm.pbf"));
    let package = folder.join("pass.pmtiles");
    let words = ["build", "-q", "-o", text(&package), "--max-error", "10"];
    let ran = corniche([&words[..], &["--dem", text(&dem), "--osm", text(&osm)]].concat());
    assert_eq!(ran.code, 0, "{}", ran.err);
    package
}

/// Lines of secondary and tertiary roads in the package's CRS.
fn roads(package: &Path) -> Vec<Vec<[f64; 2]>> {
    let path = package.with_file_name("roads.gpkg");
    let ran = corniche(["export", "roads", text(package), "-q", "-o", text(&path)]);
    assert_eq!(ran.code, 0, "{}", ran.err);
    let vector = GdalOpenFlags::GDAL_OF_VECTOR;
    let options = DatasetOptions { open_flags: vector, ..DatasetOptions::default() };
    let dataset = Dataset::open_ex(&path, options).unwrap();
    let mut layer = dataset.layer_by_name("roads").unwrap();
    let class = layer.defn().field_index("class").unwrap();
    let is_wanted = |class: Option<i32>| matches!(class, Some(3 | 4));
    let features = layer.features().filter(|road| is_wanted(road.field_as_integer(class).unwrap()));
    features.flat_map(|road| lines(road.geometry().unwrap())).collect()
}

fn lines(geometry: &Geometry) -> Vec<Vec<[f64; 2]>> {
    match geometry.geometry_count() {
        0 => {
            let points = (0..geometry.point_count() as i32).map(|k| geometry.get_point(k));
            vec![points.map(|(x, y, _)| [x, y]).collect()]
        }
        count => (0..count).flat_map(|k| lines(&geometry.get_geometry(k))).collect(),
    }
}

/// An image as GDAL reads it.
struct Map {
    dataset: Dataset,
    size: [f64; 2],
    crs_from_pixel: [f64; 6],
    bands: Vec<Vec<u8>>,
}

impl Map {
    fn open(path: &Path) -> Self {
        let dataset = Dataset::open(path).unwrap();
        let (columns, rows) = dataset.raster_size();
        let read = |band: usize| {
            dataset.rasterband(band).unwrap().read_band_as::<u8>().unwrap().data().to_vec()
        };
        let bands = (1..=3).map(read).collect();
        let crs_from_pixel = dataset.geo_transform().unwrap();
        Self { dataset, size: [columns as f64, rows as f64], crs_from_pixel, bands }
    }

    /// Column and row of a position.
    fn pixel(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [x0, a, b, y0, c, d] = self.crs_from_pixel;
        let (dx, dy, det) = (x - x0, y - y0, a * d - b * c);
        [(d * dx - b * dy) / det, (a * dy - c * dx) / det]
    }

    fn is_within(&self, [column, row]: [f64; 2], margin_px: f64) -> bool {
        let [columns, rows] = self.size;
        // The attribution is at the bottom.
        (margin_px..columns - margin_px).contains(&column)
            && (margin_px..rows - 3.0 * margin_px).contains(&row)
    }

    fn is_road(&self, [column, row]: [f64; 2]) -> bool {
        let place = row as usize * self.size[0] as usize + column as usize;
        let [red, green, blue] = [0, 1, 2].map(|band: usize| self.bands[band][place]);
        red > 170 && blue > 170 && green < 130
    }

    /// The offsets between the centres of some straight pieces of roads and the centres of their
    /// drawings: along the normal of each, pixels.
    fn offsets(&self, roads: &[Vec<[f64; 2]>]) -> Vec<f64> {
        let mut offsets = Vec::new();
        for [from, to] in
            roads.iter().flat_map(|line| line.windows(2)).map(|pair| [pair[0], pair[1]])
        {
            let [from, to] = [self.pixel(from), self.pixel(to)];
            let along = [to[0] - from[0], to[1] - from[1]];
            let length = along[0].hypot(along[1]);
            let middle = [f64::midpoint(from[0], to[0]), f64::midpoint(from[1], to[1])];
            if length < 4.0 || !self.is_within(middle, 20.0) {
                continue;
            }
            let normal = [-along[1] / length, along[0] / length];
            let at = |t: f64| self.is_road([middle[0] + t * normal[0], middle[1] + t * normal[1]]);
            assert!(at(0.0), "no road at {middle:?}");
            let reach = |step: f64| {
                let steps = (0..100).map(|k| f64::from(k) * step);
                steps.take_while(|t| at(*t)).last().unwrap()
            };
            let [left, right] = [reach(0.1), reach(-0.1)];
            // In narrow bends two legs of a road are drawn as one.
            if left - right < 7.0 {
                offsets.push(f64::midpoint(left, right));
            }
        }
        offsets
    }
}

/// A road of the package is within a pixel of its position in the file, north up and rotated.
#[test]
fn a_map_has_its_roads_where_they_are() {
    let folder = tempfile::tempdir().unwrap();
    let package = build(folder.path());
    let style = folder.path().join("style.toml");
    fs::write(&style, STYLE).unwrap();
    let roads = roads(&package);
    let bounds = json(&["info", text(&package), "--json"])["manifest"]["wgs84_bounds"].clone();
    let degrees = |low: &str, high: &str| {
        f64::midpoint(bounds[low].as_f64().unwrap(), bounds[high].as_f64().unwrap())
    };
    let middle = format!("{:.5},{:.5}", degrees("min_x", "max_x"), degrees("min_y", "max_y"));
    let views: [(&str, &[&str], f64); 2] =
        [("north.tif", &[], 0.0), ("turned.tif", &["--look-at", &middle, "--heading", "30"], 30.0)];
    for (name, more, heading_deg) in views {
        let path = folder.path().join(name);
        let options = [&SCALE[..], &["1000x800", "--style", text(&style)], more].concat();
        let Some(ran) = draw("render", &package, &path, &options) else { return };
        assert_eq!(ran.code, 0, "{}", ran.err);
        let map = Map::open(&path);
        assert_eq!(map.dataset.raster_size(), (1000, 800));
        // UTM is 0.9996 to 0.9997 true metres here.
        let [_, a, b, _, c, d] = map.crs_from_pixel;
        let pixel_m = a.hypot(c);
        assert!((0.9995..0.9998).contains(&(pixel_m / PIXEL_M)), "{pixel_m}");
        assert!((b.hypot(d) / pixel_m - 1.0).abs() < 1e-9);
        assert!(((-c).atan2(a).to_degrees() - heading_deg).abs() < 1e-6, "{a} {b} {c} {d}");
        assert_eq!(map.dataset.spatial_ref().unwrap().auth_code().unwrap(), 32632);
        let item = |key: &str, domain: &str| map.dataset.metadata_item(key, domain);
        assert_eq!(item("TIFFTAG_XRESOLUTION", "").unwrap(), "150");
        assert_eq!(item("COMPRESSION", "IMAGE_STRUCTURE").unwrap(), "DEFLATE");
        let offsets = map.offsets(&roads);
        assert!(offsets.len() >= 10, "{offsets:?}");
        let most = offsets.iter().fold(0.0_f64, |most, offset| most.max(offset.abs()));
        assert!(most <= 1.0, "{offsets:?}");
    }
    // No other files remain.
    let left = names(folder.path());
    let beside = left.iter().filter(|name| name.contains("unfinished") || name.contains(".xml"));
    assert_eq!(beside.count(), 0, "{left:?}");
}

/// GDAL finds the same position in a PNG with its world file as in a GeoTIFF, and the same pixels.
#[test]
fn a_world_file_places_a_picture_as_a_geotiff_does() {
    let folder = tempfile::tempdir().unwrap();
    let package = build(folder.path());
    let [tif, png, pgw, prj] =
        ["tif", "png", "pgw", "prj"].map(|ending| folder.path().join("map").with_extension(ending));
    let options = [&SCALE[..], &["300x200", "--legend", "--title", "Über den Paß"]].concat();
    let Some(ran) = draw("render", &package, &tif, &options) else { return };
    assert_eq!(ran.code, 0, "{}", ran.err);
    let options = [&options[..], &["--world-file"]].concat();
    // One of the files already exists: none is written.
    fs::write(&prj, "mine").unwrap();
    let ran = draw("render", &package, &png, &options).unwrap();
    assert_eq!(ran.code, 3, "{}", ran.err);
    assert!(ran.err.contains("map.prj"), "{}", ran.err);
    assert!(!png.exists() && !pgw.exists());
    let replacing = [&options[..], &["-O"]].concat();
    let ran = draw("render", &package, &png, &replacing).unwrap();
    assert_eq!(ran.code, 0, "{}", ran.err);
    let [of_tif, of_png] = [Map::open(&tif), Map::open(&png)];
    assert!(of_tif.bands == of_png.bands, "other pixels");
    for (one, other) in of_tif.crs_from_pixel.iter().zip(of_png.crs_from_pixel) {
        assert!((one - other).abs() < 1e-6, "{one} {other}");
    }
    assert!(fs::read_to_string(&prj).unwrap().contains("UTM_Zone_32N"));
    // 150 pixels per inch are 5906 per metre.
    let bytes = fs::read(&png).unwrap();
    assert_eq!(bytes[37..50], [b'p', b'H', b'Y', b's', 0, 0, 0x17, 0x12, 0, 0, 0x17, 0x12, 1]);
}

/// Meaningless combinations are rejected with the name of the option, before anything is drawn or
/// written.
#[test]
fn what_is_no_map_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let package = build(folder.path());
    let before = names(folder.path());
    let long = "x".repeat(50);
    for (output, options, expected) in [
        ("map.tif", &[][..], "--ortho"),
        ("map.tif", &["--look-at", "9.5,46.93"], "--ortho"),
        ("map.tif", &["--ortho", "--world-file"], "--world-file"),
        ("map.jpg", &["--ortho"], ".png"),
        ("map.png", &["--world-file"], "--ortho"),
        ("map.png", &["--scale", "25000"], "--ortho"),
        ("map.png", &["--ortho", "--dpi", "300"], "--scale"),
        ("map.png", &["--ortho", "--scale", "0"], "--scale"),
        ("map.png", &["--ortho", "--scale", "-25000"], "--scale"),
        ("map.png", &["--ortho", "--scale", "1:"], "--scale"),
        ("map.png", &["--ortho", "--scale", "1:25000", "--dpi", "0"], "--dpi"),
        ("map.png", &["--ortho", "--scale", "1:25000", "--dpi", "NaN"], "--dpi"),
        (
            "map.png",
            &["--ortho", "--look-at", "9.5,46.93", "--scale", "5000", "--pixel", "2"],
            "--pixel",
        ),
        ("map.png", &["--title", ""], "--title"),
        ("map.png", &["--title", "  "], "--title"),
        ("map.png", &["--title", "two\nlines"], "--title"),
    ] {
        let path = folder.path().join(output);
        let words = ["render", text(&package), "-o", text(&path)];
        let ran = corniche([&words[..], options].concat());
        assert_eq!(ran.code, 2, "{options:?}: {}", ran.err);
        assert!(ran.err.contains(expected), "{options:?}: {}", ran.err);
        assert_eq!(names(folder.path()), before, "{options:?}");
    }
    let png = folder.path().join("map.png");
    let options = ["--size", "200x100", "--title", &format!("峠 {long}")];
    let Some(ran) = draw("render", &package, &png, &options) else { return };
    assert_eq!(ran.code, 0, "{}", ran.err);
    assert!(ran.err.contains("no 峠") && ran.err.contains("truncated"), "{}", ran.err);
}
