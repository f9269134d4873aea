//! Layers of one's own, by tables alone: walls and hedges as lines, trees as points, and solar
//! plants as areas are built in all ways, verified, drawn and exported.
//!
//! The tables are in `tests/layers`. The extract has objects of every class, objects that are lost,
//! and values that cannot be read.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::{
    collections::BTreeMap,
    fs,
    path::{Path, PathBuf},
};

use corniche_testing::{
    Random,
    pbf::{BlockBuilder, field, file, varint, zigzag},
};
use e2e::{
    Job, Ran, When, built_in_parts, corniche, draw, ground::Ground, json, kept, layer, manifest,
    objects, root, sample, text,
};
use gdal::{
    Dataset,
    spatial_ref::{AxisMappingStrategy, CoordTransform, SpatialRef},
    vector::{Geometry, LayerAccess as _},
};
use image::RgbaImage;
use serde_json::Value;

/// The layers from the lowest to the highest.
const LAYERS: [&str; 3] = ["solar", "walls", "trees"];
/// The objects of each class in [`extract`].
const SOLAR: [(&str, u64); 2] = [("plant", 5), ("panels", 2)];
const WALLS: [(&str, u64); 3] = [("tall", 6), ("wall", 12), ("hedge", 6)];
const TREES: [(&str, u64); 3] = [("conifer", 14), ("tree", 27), ("grove", 4)];
/// The CRS of the sample.
const PACKAGE_EPSG: u32 = 32632;

fn table(name: &str) -> PathBuf {
    root().join(format!("tests/layers/{name}.toml"))
}

/// The value of `--layers`; the order of the files does not matter.
fn tables() -> String {
    ["trees", "solar", "walls"].map(|name| text(&table(name)).to_owned()).join(",")
}

fn succeed(ran: Ran) -> Ran {
    assert_eq!(ran.code, 0, "{}{}", ran.out, ran.err);
    ran
}

/// An extract that grows. Positions are longitude and latitude.
struct Extract {
    nodes: Vec<(i64, i64, i64)>,
    ways: BlockBuilder,
}

impl Extract {
    fn node(&mut self, place: [f64; 2]) -> i64 {
        let id = 10_000 + self.nodes.len() as i64;
        let [lon, lat] = place.map(|deg| (deg * 1e7).round() as i64);
        self.nodes.push((id, lat, lon));
        id
    }

    fn way(&mut self, id: i64, tags: &[(&str, &str)], places: &[[f64; 2]]) {
        let nodes: Vec<i64> = places.iter().map(|&place| self.node(place)).collect();
        self.ways.way(id, tags, &nodes);
    }

    /// A closed way around a rectangle.
    fn square(&mut self, id: i64, tags: &[(&str, &str)], [west, south]: [f64; 2], side: f64) {
        let (east, north) = (west + side, south + side);
        let corners = [[west, south], [east, south], [east, north], [west, north]];
        let mut nodes: Vec<i64> = corners.iter().map(|&place| self.node(place)).collect();
        nodes.push(nodes[0]);
        self.ways.way(id, tags, &nodes);
    }
}

/// Adds a node with tags, in a group of its own.
fn tagged_node(block: &mut BlockBuilder, id: i64, place: [f64; 2], tags: &[(&str, &str)]) {
    let column = |texts: Vec<u64>| texts.into_iter().flat_map(varint).collect::<Vec<u8>>();
    let keys = tags.iter().map(|(key, _)| block.text(key.as_bytes())).collect();
    let values = tags.iter().map(|(_, value)| block.text(value.as_bytes())).collect();
    let [lon, lat] = place.map(|deg| zigzag((deg * 1e7).round() as i64));
    let number = |field: u8, value: Vec<u8>| [vec![field << 3], value].concat();
    let message = [
        number(1, zigzag(id)),
        field(2, &column(keys)),
        field(3, &column(values)),
        number(8, lat),
        number(9, lon),
    ];
    block.groups.push(field(1, &message.concat()));
}

/// Writes an extract over the sample `pass`.
fn extract(folder: &Path) -> PathBuf {
    let mut random = Random::new(57);
    let mut place = || [9.455 + 0.11 * random.share(), 46.875 + 0.07 * random.share()];
    let mut nodes = BlockBuilder::new();
    let long = "Tilia ".repeat(1700);
    for n in 0..40 {
        let kind = if n % 3 == 0 { "needleleaved" } else { "broadleaved" };
        let species: &str = match n {
            7 => "\u{202e}ailiT",
            8 => &long,
            _ => "Tilia cordata",
        };
        let protected = if n % 2 == 0 { "yes" } else { "no" };
        let own = [("species", species), ("protected", protected)];
        let tags = [&[("natural", "tree"), ("leaf_type", kind)], &own[..]].concat();
        tagged_node(&mut nodes, 1 + n, place(), &tags);
    }
    // Beyond the pole, and far from the ground.
    tagged_node(&mut nodes, 41, [9.5, 95.0], &[("natural", "tree")]);
    tagged_node(&mut nodes, 42, [10.5, 47.5], &[("natural", "tree")]);

    let mut all = Extract { nodes: Vec::new(), ways: BlockBuilder::new() };
    all.way(1, &[("highway", "primary")], &[[9.46, 46.88], [9.51, 46.9], [9.56, 46.94]]);
    for n in 0..24 {
        let wall = match n % 4 {
            0 => &[("barrier", "wall"), ("height", "3.5 m"), ("material", "stone")][..],
            1 => &[("barrier", "retaining_wall"), ("height", "6'")],
            2 => &[("barrier", "hedge")],
            _ => &[("barrier", "wall"), ("height", "12,345 (2019)")],
        };
        let [lon, lat] = place();
        let step = |k: i64| [lon + 0.004 * k as f64, lat + 0.002 * ((k * k + n) % 3) as f64];
        all.way(1001 + n, wall, &[0, 1, 2, 3].map(step));
    }
    for n in 0..4 {
        let tags = if n == 0 { ("natural", "tree_group") } else { ("landuse", "orchard") };
        all.square(2001 + n, &[tags], place(), 0.001);
    }
    let plant = [("power", "plant"), ("plant:source", "solar")];
    for n in 0..4 {
        let tags = [&plant[..], &[("name", "Plant"), ("name:de", "Werk")]].concat();
        all.square(3001 + n, &tags, place(), 0.002);
    }
    // A plant with a clearing, on ground without voids.
    all.square(3010, &[], [9.46, 46.88], 0.004);
    all.square(3011, &[], [9.461, 46.881], 0.002);
    let panels = [("power", "generator"), ("generator:source", "solar")];
    all.square(3021, &panels, place(), 0.001);
    all.square(3022, &[&panels[..], &[("location", "ground")]].concat(), place(), 0.001);
    // Neither on a roof nor with wind.
    all.square(3023, &[&panels[..], &[("location", "roof")]].concat(), place(), 0.001);
    all.square(3024, &[("power", "plant"), ("plant:source", "wind")], place(), 0.001);
    // An outline that is open, and a wall without nodes.
    let [west, south] = place();
    all.way(3030, &plant, &[[west, south], [west + 0.001, south], [west, south + 0.001]]);
    all.ways.way(1099, &[("barrier", "wall")], &[1, 99_999]);
    let relation = [&plant[..], &[("type", "multipolygon")]].concat();
    all.ways.relation(4001, &relation, &[(3010, "outer"), (3011, "inner")]);

    nodes.dense(&all.nodes);
    let path = folder.join("own.osm.pbf");
    let ways = corniche_testing::pbf::raw(b"OSMData", &all.ways.bytes());
    fs::write(&path, [file(&nodes), ways].concat()).unwrap();
    path
}

/// The inputs of a build, and its layers.
fn inputs(folder: &Path) -> Vec<String> {
    let (dem, osm) = (sample("pass/pass-dem.tif"), extract(folder));
    let words = ["--dem", text(&dem), "--osm", text(&osm), "--max-error", "5", "--layers"];
    words.into_iter().map(str::to_owned).chain([tables()]).collect()
}

fn build(package: &Path, inputs: &[String], more: &[&str]) -> Ran {
    let inputs = inputs.iter().map(String::as_str);
    let words = ["build", "-O", "-o", text(package)].into_iter().chain(inputs);
    succeed(corniche(words.chain(more.iter().copied())))
}

fn verify(package: &Path, inputs: &[String], more: &[&str]) -> Value {
    let inputs = inputs[..4].iter().map(String::as_str);
    let words = ["verify", "--json", "-q", text(package)].into_iter().chain(inputs);
    json(&words.chain(more.iter().copied()).collect::<Vec<_>>())
}

/// A feature of an export, in the package's CRS.
#[derive(Debug)]
struct Exported {
    class: String,
    fields: BTreeMap<String, String>,
    parts: Vec<Vec<[f64; 3]>>,
}

/// Exports a layer, and reads its features with OGR, by the type and the id of their objects.
fn exported(
    package: &Path,
    name: &str,
    ending: &str,
    more: &[&str],
) -> BTreeMap<(String, i64), Exported> {
    fn add(geometry: &Geometry, parts: &mut Vec<Vec<[f64; 3]>>) {
        for part in 0..geometry.geometry_count() {
            add(&geometry.get_geometry(part), parts);
        }
        if geometry.geometry_count() == 0 {
            let mut points = Vec::new();
            geometry.get_points(&mut points);
            parts.push(points.into_iter().map(|(x, y, z)| [x, y, z]).collect());
        }
    }
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join(format!("{name}.{ending}"));
    let words = ["export", "layer", name, text(package), "-q", "-o", text(&file)];
    succeed(corniche([&words[..], more].concat()));
    let dataset = Dataset::open(&file).unwrap();
    let mut features = dataset.layer(0).unwrap();
    let features = features.features().map(|feature| {
        let names: Vec<String> = feature.fields().map(|(name, _)| name).collect();
        let fields: BTreeMap<String, String> = names
            .into_iter()
            .filter_map(|name| {
                let index = feature.field_index(&name).unwrap();
                let text = feature.field_as_string(index).unwrap();
                Some((name, text.filter(|text| !text.is_empty())?))
            })
            .collect();
        let mut parts = Vec::new();
        add(feature.geometry().unwrap(), &mut parts);
        if ending == "geojson" {
            for part in &mut parts {
                to_package(part);
            }
        }
        let key = (fields["object"].clone(), fields["id"].parse().unwrap());
        (key, Exported { class: fields["class"].clone(), fields, parts })
    });
    features.collect()
}

/// Transforms positions in degrees to the package's CRS.
fn to_package(part: &mut [[f64; 3]]) {
    let crs = |epsg| {
        let mut crs = SpatialRef::from_epsg(epsg).unwrap();
        crs.set_axis_mapping_strategy(AxisMappingStrategy::TraditionalGisOrder);
        crs
    };
    let transform = CoordTransform::new(&crs(4326), &crs(PACKAGE_EPSG)).unwrap();
    for at in part {
        let (mut x, mut y) = ([at[0]], [at[1]]);
        transform.transform_coords(&mut x, &mut y, &mut []).unwrap();
        *at = [x[0], y[0], at[2]];
    }
}

/// The tiles of the finest level.
fn finest_tiles(package: &Path) -> Vec<String> {
    let info = json(&["info", text(package), "--json"]);
    let ids = info["tiles"].as_array().unwrap().iter().map(|id| id.as_str().unwrap().to_owned());
    let level = |id: &String| id.split('/').next().unwrap().parse::<u8>().unwrap();
    let finest = ids.clone().map(|id| level(&id)).max();
    ids.filter(|id| Some(level(id)) == finest).collect()
}

/// The height of the triangles at a position.
fn height(grounds: &[Ground], [x, y]: [f64; 2]) -> Option<f64> {
    let is_in = |[west, south, east, north]: [f64; 4]| {
        (west..=east).contains(&x) && (south..=north).contains(&y)
    };
    grounds.iter().filter(|ground| is_in(ground.bounds)).find_map(|ground| ground.height([x, y]))
}

/// Asserts that points, and the middles of the segments between them, are on the triangles.
fn check_on_ground(grounds: &[Ground], found: &BTreeMap<(String, i64), Exported>) {
    let mut checked = 0;
    for (key, Exported { parts, .. }) in found {
        for part in parts {
            let middles = part.array_windows().map(|[from, to]: &[[f64; 3]; 2]| {
                [0, 1, 2].map(|axis| f64::midpoint(from[axis], to[axis]))
            });
            for [x, y, z] in part.iter().copied().chain(middles) {
                let expected = height(grounds, [x, y]).expect("ground below the object");
                assert!((z - expected).abs() < 2e-3, "{key:?}: {z} m, not {expected} m");
                checked += 1;
            }
        }
    }
    assert!(checked >= found.len());
}

#[test]
fn three_layers_are_built_verified_told_and_exported_by_tables_alone() {
    let folder = tempfile::tempdir().unwrap();
    let inputs = inputs(folder.path());
    let package = folder.path().join("own.pmtiles");
    let defects = folder.path().join("defects.csv");
    let said = build(&package, &inputs, &["--defects", text(&defects)]).err;

    // Counts by class are those of the objects that were made.
    let found = manifest(&package);
    let ids = found["layers"].as_array().unwrap().iter().map(|of| &of["table"]["id"]);
    assert!(ids.eq(LAYERS), "{}", found["layers"]);
    for (name, expected, lost) in [
        ("solar", &SOLAR[..], "area way is not closed"),
        ("walls", &WALLS, "way of a line lacks nodes"),
        ("trees", &TREES, "area or point is out of range"),
    ] {
        let counts = layer(&found, name);
        assert_eq!(kept(counts), expected, "{name}");
        let sum: u64 = expected.iter().map(|(_, objects)| objects).sum();
        assert_eq!(counts["objects"], sum + 1, "{name}");
        assert_eq!(counts["lost"], serde_json::json!([{ "reason": lost, "objects": 1 }]));
        // In the summary, in `info` and among the defects.
        let line = format!("{name:<12} {sum} of {} objects kept", sum + 1);
        assert!(said.lines().any(|own| own.starts_with(&line)), "{line}: {said}");
        let told = succeed(corniche(["info", text(&package)])).out;
        let what = if name == "walls" { "ways" } else { "objects" };
        let line = format!("Layer {name}: {} {what} of the extract, {sum} of them", sum + 1);
        assert!(told.contains(&line), "{line}: {told}");
        assert!(fs::read_to_string(&defects).unwrap().contains(lost), "{lost}");
    }
    let unread = |name: &str| layer(&found, name)["unread_values"].clone();
    assert_eq!(unread("walls"), serde_json::json!([{ "key": "height", "values": 6 }]));
    assert_eq!(unread("trees"), serde_json::json!([{ "key": "species", "values": 1 }]));

    let report = verify(&package, &inputs, &[]);
    assert_eq!(report["holds"], true, "{report}");
    for id in [
        "areas.rings",
        "lines.places",
        "points.places",
        "layers.tables",
        "layers.levels",
        "layers.sums",
        "osm.areas",
        "osm.lines",
        "osm.points",
        "osm.layers.counts",
    ] {
        let check = report["checks"].as_array().unwrap().iter().find(|check| check["id"] == id);
        assert!(check.expect(id)["checked"].as_u64() > Some(0), "{id}: {report}");
    }

    check_tiles(&package);
    check_exports(&package);
}

/// Attributes in tiles are typed, and hedges are on the finest level only.
fn check_tiles(package: &Path) {
    let (mut classes, mut heights) = (Vec::new(), Vec::new());
    for id in finest_tiles(package) {
        let tile = json(&["tile", text(package), &id, "--json"]);
        for wall in objects(&tile, "walls") {
            assert!(wall["line"].as_array().unwrap().len() > 1 && wall["object"] == "way");
            classes.push(wall["class"].as_str().unwrap().to_owned());
            heights.extend(wall["attributes"]["height"].as_f64());
        }
        for tree in objects(&tile, "trees") {
            let is_node = tree["object"] == "node";
            assert_eq!(is_node, tree["class"] != "grove", "{tree}");
            assert_eq!(is_node, tree["attributes"]["protected"].is_boolean(), "{tree}");
            assert_eq!(tree["point"].as_array().map(Vec::len), Some(2), "{tree}");
            // OSM's limit of characters; one extract has more.
            let species = tree["attributes"]["species"].as_str().unwrap_or_default();
            assert!(species.len() <= 255 && (tree["id"] != 9 || species.len() > 250), "{tree}");
        }
    }
    for class in ["tall", "wall", "hedge"] {
        assert!(classes.iter().any(|own| own == class), "{class}");
    }
    heights.sort_by(f64::total_cmp);
    heights.dedup();
    let [six_feet_m, 3.5] = heights[..] else { panic!("{heights:?}") };
    assert!((six_feet_m - 1.8288).abs() < 1e-9, "{six_feet_m}");
    let tile = json(&["tile", text(package), "0/0/0", "--json"]);
    let walls = objects(&tile, "walls");
    assert!(!walls.is_empty() && walls.iter().all(|wall| wall["class"] != "hedge"));
    assert!(!objects(&tile, "trees").is_empty());
}

/// Lines and points are on the triangles of the finest level, in all formats.
fn check_exports(package: &Path) {
    let tiles = finest_tiles(package);
    let grounds: Vec<Ground> = tiles.iter().map(|id| Ground::read(package, id)).collect();
    for (name, expected) in [("solar", &SOLAR[..]), ("walls", &WALLS), ("trees", &TREES)] {
        let all = exported(package, name, "gpkg", &[]);
        let most: u64 = expected.iter().map(|(_, objects)| objects).sum();
        // Some trees may be in the sample's void, and one is far from the ground.
        let least = if name == "trees" { most - 8 } else { most };
        assert!((least..=most).contains(&(all.len() as u64)), "{name}: {} features", all.len());
        if name == "solar" {
            let heights = all.values().flat_map(|of| &of.parts).flatten().map(|at| at[2]);
            assert!(heights.into_iter().all(|height_m| height_m == 0.0), "areas have no heights");
            let plant = &all[&("relation".to_owned(), 4001)];
            assert_eq!(plant.parts.len(), 2, "an outline and a hole");
            // Three quarters of a square of 0.004 degrees.
            let side_m = [0.004 * 76_200.0, 0.004 * 111_170.0];
            let area_m2: f64 = plant.fields["area_m2"].parse().unwrap();
            let ratio = area_m2 / (0.75 * side_m[0] * side_m[1]);
            assert!((ratio - 1.0).abs() < 0.01, "{ratio}");
            assert_eq!(all[&("way".to_owned(), 3001)].fields["name"], "Plant");
        } else {
            check_on_ground(&grounds, &all);
        }
        for ending in ["geojson", "csv", "fgb"] {
            let same = exported(package, name, ending, &[]);
            assert!(same.keys().eq(all.keys()), "{name}, {ending}");
            for (key, feature) in &all {
                let [own, other] = [feature, &same[key]]
                    .map(|of| of.parts.iter().flatten().copied().collect::<Vec<_>>());
                assert_eq!((own.len(), &same[key].class), (other.len(), &feature.class), "{key:?}");
                for (one, other) in own.iter().zip(&other) {
                    let beside_m = (one[0] - other[0]).hypot(one[1] - other[1]);
                    let is_near = beside_m < 0.03 && (one[2] - other[2]).abs() < 2e-3;
                    assert!(is_near, "{key:?}, {ending}: {one:?} and {other:?}");
                }
            }
        }
        let (class, objects) = expected[0];
        let some = exported(package, name, "csv", &["--classes", class]);
        assert!(some.len() as u64 <= objects && some.values().all(|of| of.class == class));
        assert!(!some.is_empty(), "{name}, {class}");
    }
    let walls = exported(package, "walls", "gpkg", &[]);
    let tall = &walls[&("way".to_owned(), 1001)].fields;
    assert_eq!((&*tall["height"], &*tall["material"]), ("3.5", "stone"));
    let bounds = ["--bounds", "9.455,46.875,9.5,46.9"];
    assert!(exported(package, "walls", "csv", &bounds).len() < walls.len());
}

#[test]
fn layers_are_drawn_one_by_one() {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("own.pmtiles");
    build(&package, &inputs(folder.path()), &["-q"]);
    let render = |layers: &[&str]| -> Option<RgbaImage> {
        let png = folder.path().join("a.png");
        let view = ["-O", "--size", "400x300", "--look-at", "9.51,46.91", "--distance", "5000"];
        let ran = draw("render", &package, &png, &[&view[..], layers].concat())?;
        succeed(ran);
        Some(image::open(&png).unwrap().to_rgba8())
    };
    let Some(all) = render(&[]) else { return };
    let none = render(&["--layers", "none"]).unwrap();
    let differ = |one: &RgbaImage, other: &RgbaImage| {
        one.pixels().zip(other.pixels()).filter(|(a, b)| a != b).count()
    };
    let mut one_by_one = 0;
    for name in LAYERS {
        let alone = render(&["--layers", name]).unwrap();
        let pixels = differ(&alone, &none);
        println!("{name}: {pixels} pixels");
        assert!(pixels > 0 && differ(&alone, &all) > 0, "{name}");
        one_by_one += pixels;
    }
    let pixels = differ(&all, &none);
    assert!(pixels <= one_by_one && pixels > 50, "{pixels} of {one_by_one}");
    assert!(render(&["--layers", "solar,walls,trees"]).unwrap() == all);

    let png = folder.path().join("b.png");
    let words = ["render", text(&package), "-o", text(&png), "--layers", "fences"];
    let ran = corniche(words);
    assert_eq!(ran.code, 2, "{}", ran.err);
    assert!(ran.err.contains("fences") && ran.err.contains("solar, walls, trees"), "{}", ran.err);
}

#[test]
#[ignore = "slow: several builds of a country"]
fn the_package_is_the_same_however_it_is_made() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let inputs = inputs(folder.path());
    let made = |name: &str, inputs: &[String], more: &[&str]| {
        build(&at(name), inputs, &[&["-q"], more].concat());
        fs::read(at(name)).unwrap()
    };
    let bytes = made("whole.pmtiles", &inputs, &["--threads", "1"]);
    let again = made("again.pmtiles", &inputs, &["--threads", "3", "--memory", "600M"]);
    assert!(again == bytes, "threads");
    assert!(built_in_parts(folder.path(), &inputs[..]) == bytes, "in parts");

    // Onto recorded terrain, with layers and without.
    let plain = made("plain.pmtiles", &inputs[..6], &[]);
    assert!(manifest(&at("plain.pmtiles")).get("layers").is_none());
    let onto = |package: &str, layers: &str| {
        let package = at(package);
        let words = ["--terrain", text(&package), "--osm", &inputs[3], "--layers", layers];
        words.map(str::to_owned)
    };
    assert!(made("onto.pmtiles", &onto("plain.pmtiles", &tables()), &[]) == bytes, "onto terrain");
    let without = made("without.pmtiles", &onto("whole.pmtiles", "none"), &[]);
    assert!(without == plain, "layers are left out");

    // By a settings file next to the tables.
    for name in LAYERS {
        fs::copy(table(name), at(&format!("{name}.toml"))).unwrap();
    }
    let settings = "[layers]\nlayers = [\"walls.toml\", \"trees.toml\", \"solar.toml\"]\n";
    fs::write(at("settings.toml"), settings).unwrap();
    let config = at("settings.toml");
    let told = made("told.pmtiles", &inputs[..6], &["--config", text(&config)]);
    assert!(told == bytes, "by a settings file");
}

/// Kills at the first durable work, and at shares of the time of a whole build.
#[test]
#[ignore = "slow: many builds, each killed"]
fn a_build_that_was_killed_goes_on_to_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let files = || [sample("pass/pass-dem.tif"), extract(folder.path())];
    let tables = tables();
    let options = ["--max-error", "0.25", "--layers", &tables];
    let whole = Job::new(&options).with_inputs(files());
    let begun = std::time::Instant::now();
    whole.succeed(&["--quiet"]);
    let takes = begun.elapsed();
    let shares = e2e::some_of(1..12_u32, [4, 4, 1]).map(|n| When::After(takes * n / 12));
    for when in [When::Worked].into_iter().chain(shares) {
        let job = Job::new(&options).with_inputs(files());
        let ran = job.stop(&[], "KILL", when);
        if job.package().exists() {
            job.succeed(&["--quiet", "--resume", "-O"]);
        } else {
            assert_ne!(ran.code, 0, "it ended by itself");
            job.succeed(&["--quiet", "--resume"]);
        }
        assert!(job.result() == whole.result(), "{when:?}");
    }
}

#[test]
fn bounds_and_polygons_cut_the_layers_and_the_result_holds() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let inputs = inputs(folder.path());
    let polygon = sample("pass/part.geojson");
    for (name, cut) in [
        ("bounds", ["--bounds", "9.47,46.885,9.53,46.925"]),
        ("polygon", ["--polygon", text(&polygon)]),
    ] {
        let package = at(&format!("{name}.pmtiles"));
        build(&package, &inputs, &[&["-q"], &cut[..]].concat());
        let more = if name == "polygon" { &cut[..] } else { &[] };
        let report = verify(&package, &inputs, more);
        assert_eq!(report["holds"], true, "{name}: {report}");
        // Counts are those of the extract, but not all objects are in the package.
        let found = manifest(&package);
        assert_eq!(kept(layer(&found, "trees")), TREES, "{name}");
        let trees = exported(&package, "trees", "csv", &[]).len() as u64;
        let all: u64 = TREES.iter().map(|(_, objects)| objects).sum();
        assert!(trees > 0 && trees < all - 1, "{name}: {trees} trees");
        if name == "polygon" {
            let checks = report["checks"].as_array().unwrap();
            let cut = checks.iter().find(|check| check["id"] == "layers.polygon").unwrap();
            assert!(cut["checked"].as_u64() > Some(10), "{cut}");
        }
    }
}
