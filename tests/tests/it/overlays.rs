//! `--overlay`: lines of the user's files over the map.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::{
    fs,
    path::{Path, PathBuf},
    process::Command,
};

use e2e::{Ran, corniche, text};
use gdal::spatial_ref::{AxisMappingStrategy, CoordTransform, SpatialRef};
use image::RgbaImage;

const SIZE: [u32; 2] = [400, 300];
/// Ground size of a pixel, metres.
const PIXEL_M: f64 = 4.0;

fn succeed(ran: Ran) -> Ran {
    assert_eq!(ran.code, 0, "{}{}", ran.out, ran.err);
    ran
}

struct Scene {
    folder: tempfile::TempDir,
    package: PathBuf,
    /// Longitude and latitude of the centre of all images.
    middle_deg: [f64; 2],
    /// From WGS84 to the package's coordinate system.
    to_package: CoordTransform,
}

impl Scene {
    fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        let package = folder.path().join("pass.pmtiles");
        e2e::copy_pass(&package, &["--max-error", "2"]);
        let info = succeed(corniche(["info", text(&package), "--json"]));
        let info: serde_json::Value = serde_json::from_str(&info.out).unwrap();
        let bounds = &info["manifest"]["wgs84_bounds"];
        let middle = |low: &str, high: &str| {
            f64::midpoint(bounds[low].as_f64().unwrap(), bounds[high].as_f64().unwrap())
        };
        let middle_deg = [middle("min_x", "max_x"), middle("min_y", "max_y")];
        let reference = |reference: gdal::errors::Result<SpatialRef>| {
            let mut reference = reference.unwrap();
            reference.set_axis_mapping_strategy(AxisMappingStrategy::TraditionalGisOrder);
            reference
        };
        let from = reference(SpatialRef::from_epsg(4326));
        let to = reference(SpatialRef::from_wkt(info["manifest"]["crs_wkt"].as_str().unwrap()));
        let to_package = CoordTransform::new(&from, &to).unwrap();
        Self { folder, package, middle_deg, to_package }
    }

    fn at(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// A point some metres east and north of the centre.
    fn beside_deg(&self, [east_m, north_m]: [f64; 2]) -> [f64; 2] {
        let [lon, lat] = self.middle_deg;
        // Lengths of a degree on the ellipsoid of WGS84, by their series.
        let (cos, cos_2, cos_3) = (
            lat.to_radians().cos(),
            (2.0 * lat).to_radians().cos(),
            (3.0 * lat).to_radians().cos(),
        );
        [
            lon + east_m / (111_412.84 * cos - 93.5 * cos_3),
            lat + north_m / (111_132.92 - 559.82 * cos_2),
        ]
    }

    /// Metres east and north of the centre, along the axes of the package.
    fn metres_beside_middle(&self, at_deg: [f64; 2]) -> [f64; 2] {
        let mut x = [self.middle_deg[0], at_deg[0]];
        let mut y = [self.middle_deg[1], at_deg[1]];
        self.to_package.transform_coords(&mut x, &mut y, &mut []).unwrap();
        [x[1] - x[0], y[1] - y[0]]
    }

    fn write_line(&self, name: &str, points_m: &[[f64; 2]]) -> PathBuf {
        let points: Vec<String> = points_m
            .iter()
            .map(|&at| {
                let [lon, lat] = self.beside_deg(at);
                format!("[{lon:.9},{lat:.9}]")
            })
            .collect();
        let path = self.at(name);
        let line = format!(r#"{{"type":"LineString","coordinates":[{}]}}"#, points.join(","));
        fs::write(&path, line).unwrap();
        path
    }

    fn render(&self, name: &str, roads: &str, overlays: &[&str], more: &[&str]) -> RgbaImage {
        let path = self.at(name);
        let [lon, lat] = self.middle_deg;
        let (look_at, size) = (format!("{lon},{lat}"), format!("{}x{}", SIZE[0], SIZE[1]));
        let mut words = vec!["render", text(&self.package), "-o", text(&path), "--roads", roads];
        words.extend(["--look-at", &look_at, "--size", &size, "--supersampling", "1"]);
        words.extend(more);
        for overlay in overlays {
            words.extend(["--overlay", overlay]);
        }
        succeed(corniche(words));
        image::open(path).unwrap().to_rgba8()
    }

    fn seen_from_above(&self, name: &str, roads: &str, overlays: &[&str]) -> RgbaImage {
        let pixel = PIXEL_M.to_string();
        self.render(name, roads, overlays, &["--ortho", "--pixel", &pixel])
    }
}

fn distance(at: [f64; 2], [a, b]: [[f64; 2]; 2]) -> f64 {
    let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
    let along = ((at[0] - a[0]) * dx + (at[1] - a[1]) * dy) / (dx * dx + dy * dy);
    let along = along.clamp(0.0, 1.0);
    (at[0] - a[0] - along * dx).hypot(at[1] - a[1] - along * dy)
}

/// From above, a line is at its coordinates: every pixel within half its width has its colour, and
/// no other pixel has.
#[test]
fn a_line_is_drawn_where_it_is() {
    let scene = Scene::new();
    let points_m = [[-700.0, -300.0], [-100.0, 420.0], [250.0, -200.0], [600.0, 300.0]];
    let line = scene.write_line("line.geojson", &points_m);
    let points_m = points_m.map(|at| scene.metres_beside_middle(scene.beside_deg(at)));
    let overlay = format!("{},color=#FF00FF,width=6", text(&line));
    for roads in ["geo", "sv"] {
        let before = scene.seen_from_above(&format!("before-{roads}.png"), roads, &[]);
        let after = scene.seen_from_above(&format!("after-{roads}.png"), roads, &[&overlay]);
        let (mut inside, mut outside, mut wrong) = (0, 0, Vec::new());
        for (x, y, pixel) in after.enumerate_pixels() {
            let at_m = [
                (f64::from(x) + 0.5 - f64::from(SIZE[0]) / 2.0) * PIXEL_M,
                (f64::from(SIZE[1]) / 2.0 - f64::from(y) - 0.5) * PIXEL_M,
            ];
            let segments = points_m.array_windows::<2>().map(|pair| distance(at_m, *pair));
            let from_px = segments.fold(f64::INFINITY, f64::min) / PIXEL_M;
            let is_line = pixel.0[0] > 200 && pixel.0[1] < 60 && pixel.0[2] > 200;
            // Half of the width is three pixels; the edge of one more has another colour.
            if from_px < 2.5 {
                inside += 1;
                if !is_line {
                    wrong.push((x, y));
                }
            } else if from_px > 4.7 {
                outside += 1;
                if *pixel != *before.get_pixel(x, y) {
                    wrong.push((x, y));
                }
            }
        }
        assert!(inside > 1500 && outside > 100_000, "{inside} and {outside} pixels");
        assert!(wrong.is_empty(), "{roads}: {} pixels, such as {:?}", wrong.len(), wrong[0]);
    }
}

/// Lines are drawn everywhere, in the same way by both methods, over the slopes of an oblique view.
#[test]
fn methods_agree_and_dashes_leave_gaps() {
    let scene = Scene::new();
    let points_m = [[-1500.0, -900.0], [-100.0, 800.0], [900.0, -700.0], [1800.0, 1300.0]];
    let line = scene.write_line("line.geojson", &points_m);
    let view = ["--distance", "4000", "--pitch", "60", "--heading", "30"];
    let count = |picture: &RgbaImage| {
        picture.pixels().filter(|pixel| pixel.0[0] > 200 && pixel.0[1] < 60).count()
    };
    let solid = format!("{},color=#FF00FF,width=4", text(&line));
    let dashed = format!("{solid},dash=12/12");
    let bare = scene.render("bare.png", "none", &[], &view);
    let none = scene.render("none.png", "none", &[&solid], &view);
    let geo = scene.render("geo.png", "geo", &[&solid], &view);
    let dashed_geo = scene.render("dashed-geo.png", "geo", &[&dashed], &view);
    let dashed_sv = scene.render("dashed-sv.png", "sv", &[&dashed], &view);
    assert_eq!(count(&bare), 0);
    let (solid, dashed) = (count(&geo), count(&dashed_geo));
    assert!(solid > 1000, "{solid} pixels");
    assert!(count(&none).abs_diff(solid) * 50 < solid, "{} and {solid} pixels", count(&none));
    let share = dashed as f64 / solid as f64;
    assert!((0.4..0.6).contains(&share), "half of the line is dashes, not {share}");
    assert!(count(&dashed_sv).abs_diff(dashed) * 50 < dashed);
}

/// Groups of adjacent pixels: their number, and the sides of the rectangle around them.
fn groups(picture: &RgbaImage) -> Vec<(usize, [u32; 2])> {
    let is_line = |x: u32, y: u32| {
        let pixel = picture.get_pixel(x, y);
        pixel.0[0] > 200 && pixel.0[1] < 60
    };
    let [width, height] = [picture.width(), picture.height()];
    let mut seen = vec![false; (width * height) as usize];
    let mut found = Vec::new();
    for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
        let mut waiting = vec![(x, y)];
        let (mut count, mut low, mut high) = (0, [x, y], [x, y]);
        while let Some((x, y)) = waiting.pop() {
            let place = (y * width + x) as usize;
            if !is_line(x, y) || std::mem::replace(&mut seen[place], true) {
                continue;
            }
            count += 1;
            low = [low[0].min(x), low[1].min(y)];
            high = [high[0].max(x), high[1].max(y)];
            waiting.extend((x > 0).then(|| (x - 1, y)));
            waiting.extend((y > 0).then(|| (x, y - 1)));
            waiting.extend((x + 1 < width).then_some((x + 1, y)));
            waiting.extend((y + 1 < height).then_some((x, y + 1)));
        }
        if count > 0 {
            found.push((count, [high[0] - low[0] + 1, high[1] - low[1] + 1]));
        }
    }
    found
}

/// A pattern twice as long as its line is wide makes circles in the image, also in oblique views.
#[test]
fn dots_are_round() {
    let scene = Scene::new();
    let line =
        scene.write_line("line.geojson", &[[-1500.0, -600.0], [-100.0, 500.0], [1500.0, 100.0]]);
    let dots = format!("{},color=#FF00FF,width=12,pattern=dots/24", text(&line));
    // On slopes that face away from the camera, lines are narrower.
    let view = ["--distance", "3000", "--pitch", "25", "--heading", "30"];
    for roads in ["geo", "sv"] {
        let above = scene.seen_from_above(&format!("above-{roads}.png"), roads, &[&dots]);
        let oblique = scene.render(&format!("oblique-{roads}.png"), roads, &[&dots], &view);
        for (name, picture, least) in [("above", above, 0.75), ("oblique", oblique, 0.5)] {
            let groups = groups(&picture);
            assert!(groups.len() >= 8, "{name}, {roads}: {} dots", groups.len());
            let is_round = |&&(count, [width, height]): &&(usize, [u32; 2])| {
                let share = count as f64 / f64::from(width * height);
                (9..=15).contains(&width)
                    && width.abs_diff(height) <= 3
                    && (0.65..0.9).contains(&share)
            };
            let round = groups.iter().filter(is_round).count();
            // Some are on corners, borders of tiles or the edge of the image, or where lines are
            // narrower.
            let share = round as f64 / groups.len() as f64;
            assert!(share >= least, "{name}, {roads}: {round} of {groups:?}");
        }
    }
}

/// The same lines in four formats and two coordinate systems give the same image.
#[test]
fn every_format_is_read_alike() {
    let scene = Scene::new();
    let line =
        scene.write_line("line.geojson", &[[-700.0, -300.0], [-100.0, 420.0], [600.0, 300.0]]);
    let expected = scene.seen_from_above("geojson.png", "none", &[text(&line)]);
    let convert = |name: &str, more: &[&str]| {
        let path = scene.at(name);
        let mut command = Command::new("ogr2ogr");
        let done = command.args(more).arg(&path).arg(&line).output().unwrap();
        assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
        path
    };
    let files = [
        convert("track.gpx", &["-f", "GPX", "-nlt", "MULTILINESTRING"]),
        convert("lines.gpkg", &["-f", "GPKG", "-t_srs", "EPSG:3857"]),
        convert("lines.shp", &["-f", "ESRI Shapefile", "-t_srs", "EPSG:32632"]),
    ];
    for path in &files {
        let found = scene.seen_from_above("other.png", "none", &[text(path)]);
        fs::remove_file(scene.at("other.png")).unwrap();
        let differ = found.pixels().zip(expected.pixels()).filter(|(a, b)| a != b).count();
        assert!(differ <= 4, "{}: {differ} pixels differ", path.display());
    }
}

fn refused(scene: &Scene, overlays: &[&str]) -> String {
    let out = scene.at("refused.png");
    let mut words = vec!["render", text(&scene.package), "-o", text(&out)];
    words.extend(overlays.iter().flat_map(|overlay| ["--overlay", overlay]));
    let ran = corniche(words);
    assert_eq!(ran.code, 2, "{}{}", ran.out, ran.err);
    assert!(!Path::new(&out).exists());
    ran.err
}

#[test]
fn what_is_wrong_with_a_file_is_told() {
    let scene = Scene::new();
    let write = |name: &str, content: &str| {
        let path = scene.at(name);
        fs::write(&path, content).unwrap();
        path
    };
    let missing = scene.at("missing.gpx");
    assert!(refused(&scene, &[text(&missing)]).contains("missing.gpx"));
    let points = write("points.geojson", r#"{"type":"Point","coordinates":[9,47]}"#);
    assert!(refused(&scene, &[text(&points)]).contains("no lines and no polygons"));
    let broken = write("broken.gpx", "<gpx");
    assert!(refused(&scene, &[text(&broken)]).contains("not a vector file"));
    assert!(refused(&scene, &["a.gpx,width=900"]).contains("width must be 0.5 to 50"));
    // Each file is within the limit of points, but both together are not.
    let few = write("few.geojson", r#"{"type":"LineString","coordinates":[[9,47],[9,48]]}"#);
    let most = "[9,47],".repeat((1 << 20) - 1) + "[9,48]";
    let most = write("most.geojson", &format!(r#"{{"type":"LineString","coordinates":[{most}]}}"#));
    let told = refused(&scene, &[text(&few), text(&most)]);
    assert!(
        told.contains("most.geojson\" and the files named before it have more than 1048576"),
        "{told}"
    );
    let line = scene.write_line("out.png.geojson", &[[0.0, 0.0], [100.0, 0.0]]);
    let same = corniche([
        "render",
        text(&scene.package),
        "-o",
        text(&line),
        "-O",
        "--overlay",
        text(&line),
    ]);
    assert_eq!(same.code, 2, "the picture would replace the lines: {}", same.err);
    // Far away: nothing is drawn, and this is reported.
    let far = write("far.geojson", r#"{"type":"LineString","coordinates":[[100,10],[101,11]]}"#);
    let out = scene.at("far.png");
    let ran = succeed(corniche([
        "render",
        text(&scene.package),
        "-o",
        text(&out),
        "--overlay",
        text(&far),
    ]));
    assert!(ran.err.contains("no point of its lines is in the package"), "{}", ran.err);
}
