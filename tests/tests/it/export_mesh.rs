//! `export mesh`: models that other programs read, compared with `tile --json`.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

mod bridges;
mod photos;
mod readers;
mod relief;
mod surfaces;

use std::{
    collections::BTreeSet,
    fs,
    path::{Path, PathBuf},
};

use e2e::{Ran, corniche, manifest, text};
use serde_json::Value;

use self::readers::{Model, read_glb, read_obj, read_ply};

fn succeed(ran: Ran) -> Ran {
    assert_eq!(ran.code, 0, "{}{}", ran.out, ran.err);
    ran
}

fn export(package: &Path, name: &str, more: &[&str]) -> PathBuf {
    let path = package.with_file_name(name);
    let words = ["export", "mesh", text(package), "-o", text(&path)];
    succeed(corniche([&words[..], more].concat()));
    path
}

/// The model's origin, as the command prints it.
fn origin(package: &Path, more: &[&str]) -> [f64; 2] {
    let path = package.with_file_name("origin.ply");
    let words = ["export", "mesh", text(package), "-O", "-o", text(&path)];
    let told = succeed(corniche([&words[..], more].concat())).err;
    let line = told.lines().find_map(|line| line.strip_prefix("origin: ")).unwrap();
    let parts: Vec<f64> =
        line.split(" in ").next().unwrap().split(", ").map(|part| part.parse().unwrap()).collect();
    [parts[0], parts[1]]
}

/// A level as `tile --json` prints it, in local metres.
fn expected(package: &Path, level: u8, origin: [f64; 2]) -> Model {
    let found = manifest(package);
    let pair = |value: &Value| [0, 1].map(|axis: usize| value[axis].as_f64().unwrap());
    let (scale, unit) = (pair(&found["scale"]["center"]), pair(&found["metres_per_unit"]));
    let local = |at: &Value| {
        let [x, y, z] = [0, 1, 2].map(|axis: usize| at[axis].as_f64().unwrap());
        [(x - origin[0] * unit[0]) / scale[0], (y - origin[1] * unit[1]) / scale[1], z]
    };
    let mut model = Model::default();
    for id in (0..1 << level).flat_map(|y| (0..1 << level).map(move |x| format!("{level}/{x}/{y}")))
    {
        let ran = corniche(["tile", text(package), &id, "--json"]);
        if ran.code != 0 {
            continue;
        }
        let tile: Value = serde_json::from_str(&ran.out).unwrap();
        assert_eq!(tile["coordinates"], "working");
        let Some(vertices) = tile["tin"]["vertices"].as_array() else { continue };
        let first = model.corners.len();
        model.corners.extend(vertices.iter().map(local));
        for triangle in tile["tin"]["triangles"].as_array().unwrap() {
            model.classes.push(255);
            model
                .triangles
                .push([0, 1, 2].map(|at| first + triangle[at].as_u64().unwrap() as usize));
        }
        for road in tile["roads_geo"].as_array().unwrap() {
            let line: Vec<[f64; 3]> = road["line"].as_array().unwrap().iter().map(local).collect();
            let class = road["frc"].as_u64().unwrap() as u8;
            model.edges.extend(line.array_windows::<2>().map(|pair| (*pair, class)));
        }
    }
    model
}

/// Whole millimetres.
fn mm(at: [f64; 3]) -> [i64; 3] {
    at.map(|part| (part * 1e3).round() as i64)
}

fn is_near(one: [f64; 3], other: [f64; 3], most_m: f64) -> bool {
    (0..3).all(|axis| (one[axis] - other[axis]).abs() <= most_m)
}

/// The same triangles with positions instead of indices, in a canonical order.
fn triangles(model: &Model) -> Vec<[[f64; 3]; 3]> {
    let mut all: Vec<[[f64; 3]; 3]> = model
        .triangles
        .iter()
        .map(|triangle| {
            let mut corners = triangle.map(|at| model.corners[at]);
            // Corners are at least a cell apart.
            let least =
                (0..3).min_by_key(|at| corners[*at].map(|part| part.round() as i64)).unwrap();
            corners.rotate_left(least);
            corners
        })
        .collect();
    all.sort_by_key(|corners| corners.map(|at| at.map(|part| part.round() as i64)));
    all
}

#[test]
fn models_are_the_packages_ground_and_roads() {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("pass.pmtiles");
    e2e::copy_pass(&package, &["--max-error", "20"]);
    let origin = origin(&package, &[]);
    let finest = manifest(&package)["frame"]["max_level"].as_u64().unwrap() as u8;
    let expected = expected(&package, finest, origin);
    assert!(expected.triangles.len() > 1000 && expected.edges.len() > 500);
    let ply = read_ply(&export(&package, "m.ply", &[]));
    let models = [
        ("ply", 1e-9, read_ply(&export(&package, "m2.ply", &[]))),
        ("obj", 0.6e-4, read_obj(&export(&package, "m.obj", &[]))),
        ("glb", 1e-3, read_glb(&export(&package, "m.glb", &[]))),
    ];
    for (format, most_m, model) in &models {
        let (own, wanted) = (triangles(model), triangles(&expected));
        assert_eq!(own.len(), wanted.len(), "{format}");
        let is_same = |(own, wanted): (&[[f64; 3]; 3], &[[f64; 3]; 3])| {
            own.iter().zip(wanted).all(|(own, wanted)| is_near(*own, *wanted, *most_m))
        };
        assert!(own.iter().zip(&wanted).all(is_same), "{format}");
        assert_eq!(model.edges.len(), expected.edges.len(), "{format}");
        let is_known = |(own, class): &&([[f64; 3]; 2], u8)| {
            expected.edges.iter().any(|(wanted, other)| {
                class == other && (0..2).all(|end| is_near(own[end], wanted[end], *most_m))
            })
        };
        assert_eq!(model.edges.iter().filter(is_known).count(), model.edges.len(), "{format}");
    }
    // No corner exists twice, and no side of a triangle has two triangles on it.
    let places: BTreeSet<[i64; 3]> = ply.corners.iter().map(|at| mm(*at)).collect();
    assert_eq!(places.len(), ply.corners.len(), "corners that tiles share are welded");
    let by_number = open_sides(ply.triangles.iter().copied());
    let by_place =
        open_sides(expected.triangles.iter().map(|own| own.map(|at| mm(expected.corners[at]))));
    let placed: BTreeSet<_> =
        by_number.iter().map(|side| side.map(|at| mm(ply.corners[at]))).collect();
    assert!(
        !placed.is_empty() && placed == by_place,
        "{} and {} open sides",
        placed.len(),
        by_place.len()
    );
}

/// The sides of triangles without a neighbour.
fn open_sides<T: Ord + Copy>(triangles: impl Iterator<Item = [T; 3]>) -> BTreeSet<[T; 2]> {
    let mut sides = BTreeSet::new();
    for [a, b, c] in triangles {
        for side in [[a, b], [b, c], [c, a]] {
            assert!(sides.insert(side), "a side has two triangles on one side");
        }
    }
    sides.iter().filter(|[from, to]| !sides.contains(&[*to, *from])).copied().collect()
}

#[test]
fn what_cannot_be_a_model_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("pass.pmtiles");
    e2e::copy_pass(&package, &["--max-error", "20"]);
    let at = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let taken = export(&package, "taken.ply", &["--level", "0"]);
    let before = fs::read(&taken).unwrap();
    for (name, more, code, word) in [
        ("a.xyz", &[][..], 2, ".glb, .ply, .obj"),
        ("a.glb", &["--up", "z"], 2, "the y axis of glTF always points up"),
        ("a.glb", &["--bounds", "1,1,2,2"], 2, "no ground in the requested area"),
        ("a.obj", &["--level", "30"], 2, "has no level 30"),
        ("taken.ply", &[], 3, "already exists"),
    ] {
        let ran = corniche([&["export", "mesh", text(&package), "-o", &at(name)], more].concat());
        assert_eq!(ran.code, code, "{name} {more:?}: {}", ran.err);
        assert!(ran.err.contains(word), "{name} {more:?}: {}", ran.err);
    }
    let names: BTreeSet<String> = fs::read_dir(folder.path())
        .unwrap()
        .map(|entry| entry.unwrap().file_name().to_str().unwrap().to_owned())
        .collect();
    assert_eq!(names, ["pass.pmtiles", "taken.ply"].map(str::to_owned).into());
    assert_eq!(fs::read(&taken).unwrap(), before);
}

#[test]
fn bounds_leave_what_lies_in_them() {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("pass.pmtiles");
    e2e::copy_pass(&package, &["--max-error", "20"]);
    let bounds = &manifest(&package)["wgs84_bounds"];
    let middle = |low: &str, high: &str, share: f64| {
        let [low, high] = [low, high].map(|key| bounds[key].as_f64().unwrap());
        low + share * (high - low)
    };
    let rectangle = format!(
        "{},{},{},{}",
        middle("min_x", "max_x", 0.4),
        middle("min_y", "max_y", 0.4),
        middle("min_x", "max_x", 0.6),
        middle("min_y", "max_y", 0.6)
    );
    let all = read_ply(&export(&package, "all.ply", &["--up", "z"]));
    let part =
        read_ply(&export(&package, "part.ply", &["--bounds", &rectangle, "--classes", "0-4"]));
    let bare = read_ply(&export(&package, "bare.ply", &["--roads", "none"]));
    assert_eq!((bare.edges.len(), bare.triangles.len()), (0, all.triangles.len()));
    let share = part.triangles.len() as f64 / all.triangles.len() as f64;
    assert!((0.02..0.15).contains(&share), "a twenty-fifth of the ground and its rim, not {share}");
    assert!(part.edges.iter().all(|(_, class)| *class <= 4));
}
