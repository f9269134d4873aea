//! `export mesh`: models that other programs read, compared with what `tile --json` says of the package.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::{
    collections::{BTreeMap, BTreeSet},
    fs,
    path::{Path, PathBuf},
};

use e2e::{Ran, corniche, manifest, text};
use serde_json::Value;

fn succeed(ran: Ran) -> Ran {
    assert_eq!(ran.code, 0, "{}{}", ran.out, ran.err);
    ran
}

/// A model as a reader sees it, z upwards.
#[derive(Default)]
struct Model {
    /// Of the ground.
    corners: Vec<[f64; 3]>,
    triangles: Vec<[usize; 3]>,
    /// Ends of each piece of a road, with its class.
    edges: Vec<([[f64; 3]; 2], u8)>,
}

fn export(package: &Path, name: &str, more: &[&str]) -> PathBuf {
    let path = package.with_file_name(name);
    let words = ["export", "mesh", text(package), "-o", text(&path)];
    succeed(corniche([&words[..], more].concat()));
    path
}

/// A reader of our own for the PLY that is written: header by header line.
fn read_ply(path: &Path) -> Model {
    let bytes = fs::read(path).unwrap();
    let end = b"end_header\n";
    let head_length =
        bytes.windows(end.len()).position(|window| window == end).unwrap() + end.len();
    let head = std::str::from_utf8(&bytes[..head_length]).unwrap();
    assert!(head.starts_with("ply\nformat binary_little_endian 1.0\n"), "{head}");
    let count = |name: &str| -> usize {
        let line = head.lines().find_map(|line| line.strip_prefix(&format!("element {name} ")));
        line.map_or(0, |number| number.parse().unwrap())
    };
    let properties: Vec<&str> = head.lines().filter(|line| line.starts_with("property")).collect();
    assert_eq!(properties[0], "property double x");
    assert_eq!(properties[6], "property uchar frc");
    let mut rest = &bytes[head_length..];
    let mut take = |length: usize| {
        let (own, after) = rest.split_at(length);
        rest = after;
        own
    };
    let mut vertices = Vec::new();
    for _ in 0..count("vertex") {
        let own = take(3 * 8 + 3 * 4 + 1);
        let axis = |at: usize| f64::from_le_bytes(own[8 * at..8 * at + 8].try_into().unwrap());
        vertices.push(([axis(0), axis(1), axis(2)], own[36]));
    }
    let number = |own: &[u8], at: usize| {
        u32::from_le_bytes(own[4 * at..4 * at + 4].try_into().unwrap()) as usize
    };
    let mut model = Model::default();
    // Vertices of roads come between those of the ground.
    let mut ground = BTreeMap::new();
    for (index, (at, class)) in vertices.iter().enumerate() {
        if *class == 255 {
            ground.insert(index, model.corners.len());
            model.corners.push(*at);
        }
    }
    for _ in 0..count("face") {
        let own = take(13);
        assert_eq!(own[0], 3);
        model.triangles.push([0, 1, 2].map(|at| ground[&number(&own[1..], at)]));
    }
    for _ in 0..count("edge") {
        let own = take(8);
        let [from, to] = [0, 1].map(|at| vertices[number(own, at)]);
        assert_eq!(from.1, to.1);
        model.edges.push(([from.0, to.0], from.1));
    }
    assert!(rest.is_empty());
    model
}

fn read_obj(path: &Path) -> Model {
    let content = fs::read_to_string(path).unwrap();
    let (mut places, mut model) = (Vec::new(), Model::default());
    let (mut faces, mut class) = (Vec::new(), 255);
    for line in content.lines() {
        let words: Vec<&str> = line.split(' ').collect();
        let index = |word: &str| word.split('/').next().unwrap().parse::<usize>().unwrap() - 1;
        match words[0] {
            "v" => {
                let [x, y, z] = [1, 2, 3].map(|at: usize| words[at].parse::<f64>().unwrap());
                places.push([x, -z, y]);
            }
            "f" => faces.push([1, 2, 3].map(|at: usize| index(words[at]))),
            "g" => {
                class = words[1].strip_prefix("roads_frc_").map_or(255, |frc| frc.parse().unwrap());
            }
            "l" => model.edges.extend(
                words[1..]
                    .windows(2)
                    .map(|pair| ([places[index(pair[0])], places[index(pair[1])]], class)),
            ),
            _ => {}
        }
    }
    model.corners = places;
    model.triangles = faces;
    model
}

fn read_glb(path: &Path) -> Model {
    let bytes = fs::read(path).unwrap();
    let u32_at = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
    assert_eq!((&bytes[..4], u32_at(4), u32_at(8)), (&b"glTF"[..], 2, bytes.len()));
    let json_length = u32_at(12);
    let document: Value = serde_json::from_slice(&bytes[20..20 + json_length]).unwrap();
    let start = 20 + json_length + 8;
    assert_eq!(bytes.len() - start, u32_at(start - 8));
    let numbers = |accessor: &Value| -> Vec<[u8; 4]> {
        let accessor = &document["accessors"][accessor.as_u64().unwrap() as usize];
        let view = &document["bufferViews"][accessor["bufferView"].as_u64().unwrap() as usize];
        let [offset, length] =
            ["byteOffset", "byteLength"].map(|key| view[key].as_u64().unwrap() as usize);
        bytes[start + offset..start + offset + length].as_chunks::<4>().0.to_vec()
    };
    let mut model = Model::default();
    for node in document["nodes"].as_array().unwrap() {
        let shift: Vec<f64> = serde_json::from_value(node["translation"].clone()).unwrap();
        let mesh = &document["meshes"][node["mesh"].as_u64().unwrap() as usize];
        for primitive in mesh["primitives"].as_array().unwrap() {
            let flat = numbers(&primitive["attributes"]["POSITION"]);
            let places: Vec<[f64; 3]> = flat
                .as_chunks::<3>()
                .0
                .iter()
                .map(|at| {
                    let [x, y, z] =
                        [0, 1, 2].map(|axis| f64::from(f32::from_le_bytes(at[axis])) + shift[axis]);
                    [x, -z, y]
                })
                .collect();
            let indices: Vec<usize> = numbers(&primitive["indices"])
                .into_iter()
                .map(|index| u32::from_le_bytes(index) as usize)
                .collect();
            if primitive["mode"] == 4 {
                let first = model.corners.len();
                model
                    .triangles
                    .extend(indices.as_chunks::<3>().0.iter().map(|own| own.map(|at| first + at)));
                model.corners.extend(places);
            } else {
                let class = primitive["extras"]["frc"].as_u64().unwrap() as u8;
                let ends = indices.as_chunks::<2>().0.iter();
                model.edges.extend(ends.map(|ends| (ends.map(|at| places[at]), class)));
            }
        }
    }
    model
}

/// A level as `tile --json` tells it, in local metres.
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

/// The same triangles with places in the stead of numbers, in one order.
fn triangles(model: &Model) -> Vec<[[f64; 3]; 3]> {
    let mut all: Vec<[[f64; 3]; 3]> = model
        .triangles
        .iter()
        .map(|triangle| {
            let mut corners = triangle.map(|at| model.corners[at]);
            // Corners are whole cells apart.
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
    e2e::build_pass(&package, &["--max-error", "20"]);
    let origin = {
        let ran =
            corniche(["export", "mesh", text(&package), "-o", text(&folder.path().join("o.ply"))]);
        let told = succeed(ran).err;
        let line = told.lines().find_map(|line| line.strip_prefix("origin: ")).unwrap();
        let parts: Vec<f64> = line
            .split(" in ")
            .next()
            .unwrap()
            .split(", ")
            .map(|part| part.parse().unwrap())
            .collect();
        [parts[0], parts[1]]
    };
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
    // No corner is there twice, and no side of a triangle has two triangles on it.
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

/// The sides of triangles that have no triangle beyond them.
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
    e2e::build_pass(&package, &["--max-error", "20"]);
    let at = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let taken = export(&package, "taken.ply", &["--level", "0"]);
    let before = fs::read(&taken).unwrap();
    for (name, more, code, word) in [
        ("a.xyz", &[][..], 2, ".glb, .ply, .obj"),
        ("a.glb", &["--up", "z"], 2, "glTF has the y axis upwards"),
        ("a.glb", &["--bounds", "1,1,2,2"], 2, "no ground there"),
        ("a.obj", &["--level", "30"], 2, "has no level 30"),
        ("taken.ply", &[], 3, "exists already"),
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
    e2e::build_pass(&package, &["--max-error", "20"]);
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
