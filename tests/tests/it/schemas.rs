//! The output of `--json` conforms to the schemas in `docs/schema`.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::{collections::BTreeSet, fs};

use corniche_testing::package;
use e2e::{copy_pass, corniche, json, manifest, root, sample, text, write_ascii_grid};
use serde_json::{Value, json as value};

fn schema(name: &str) -> Value {
    let path = root().join(format!("docs/schema/{name}.schema.json"));
    let text =
        fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    serde_json::from_str(&text).unwrap()
}

/// Fails with the fields that do not fit. Each field must be in the schema, so that none is
/// undocumented.
fn check(name: &str, documents: &[Value]) {
    let mut schema = schema(name);
    close(&mut schema);
    let (mut compiler, mut schemas) = (boon::Compiler::new(), boon::Schemas::new());
    let address = format!("schema:///{name}");
    compiler.add_resource(&address, schema).unwrap();
    let schema = compiler.compile(&address, &mut schemas).unwrap();
    assert!(!documents.is_empty());
    for document in documents {
        if let Err(error) = schemas.validate(document, schema) {
            panic!("{name}: {error:#}");
        }
    }
    // A schema that accepts anything would be useless.
    for odd in [value!({}), value!({ "odd": 1 })] {
        assert!(schemas.validate(&odd, schema).is_err(), "{name}");
    }
}

/// Forbids all fields that are not in the schema.
fn close(schema: &mut Value) {
    match schema {
        Value::Object(fields) => {
            if fields.get("properties").is_some_and(Value::is_object) {
                fields.insert("additionalProperties".into(), false.into());
            }
            fields.values_mut().for_each(close);
        }
        Value::Array(values) => values.iter_mut().for_each(close),
        _ => {}
    }
}

fn lines(text: &str) -> Vec<Value> {
    text.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

#[test]
fn what_is_printed_fits_its_schema() {
    let folder = tempfile::tempdir().unwrap();
    let [package, plan] = ["pass.pmtiles", "plan.json"].map(|name| folder.path().join(name));
    let [dem, osm] = [sample("pass/pass-dem.tif"), sample("pass/pass.osm.pbf")];
    let inputs = ["--dem", text(&dem), "--osm", text(&osm)];
    let build = [&["build", "-o", text(&package), "--json-progress"], &inputs[..]].concat();
    let ran = corniche(&build);
    assert_eq!(ran.code, 0, "{}", ran.err);
    let mut told = lines(&ran.err);
    // An end with an error.
    told.extend(lines(&corniche(&build).err));
    assert_eq!(told.last().unwrap()["end"]["result"], "exists");
    // A warning: an option that has no effect here.
    check("progress", &told);
    let kinds: BTreeSet<&str> = told
        .iter()
        .filter_map(|record| {
            ["stage", "summary", "end"].into_iter().find(|key| !record[key].is_null())
        })
        .collect();
    assert_eq!(kinds.len(), 3, "{kinds:?}");

    let package = text(&package);
    let info = json(&["info", package, "--json"]);
    let counts = &info["manifest"]["counts"];
    for list in ["defects", "roads_lost", "classes", "highways_left_out"] {
        assert!(counts[list][0].is_object(), "the sample has {list}: {counts}");
    }
    check("info", std::slice::from_ref(&info));
    check("growth", &[json(&["growth", package, "--json"])]);
    let coarse = folder.path().join("coarse.pmtiles");
    copy_pass(&coarse, &["-q", "--max-error", "20", "--simplify", "0"]);
    let comparison = json(&["growth", package, text(&coarse), "--json"]);
    assert_eq!(comparison["differences"][0]["what"], "simplification");
    check("growth-comparison", &[comparison]);
    check(
        "verify",
        &[json(&["verify", package, "--json", "-q", "--dem", text(&dem), "--osm", text(&osm)])],
    );
    let profile = folder.path().join("profile.json");
    let of_dem = ["profile", package, "--ref", "L 28", "--json", text(&profile), "-q", "-O"];
    let mut profiles = Vec::new();
    for more in [&[][..], &inputs] {
        let ran = corniche(of_dem.iter().chain(more));
        assert_eq!(ran.code, 0, "{}", ran.err);
        profiles.extend(lines(&fs::read_to_string(&profile).unwrap()));
    }
    check("profile", &profiles);
    check("plan", &[json(&[&["plan", "--json", "-o", text(&plan)], &inputs[..]].concat())]);
    check("job", &lines(&corniche(["jobs", text(&plan), "--slots", "3"]).out));
    let tiles: Vec<&str> =
        info["tiles"].as_array().unwrap().iter().map(|id| id.as_str().unwrap()).collect();
    let mut documents: Vec<Value> =
        tiles.iter().step_by(7).map(|id| json(&["tile", package, id, "--json"])).collect();
    documents.push(json(&["tile", package, "0/0/0", "--json", "--coordinates", "crs"]));
    check("tile", &documents);
}

/// A bridge that begins at a vertex of the ground, and a tunnel: each point has the right position
/// and height.
#[test]
fn spans_of_a_tile_are_told() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("spans.pmtiles");
    let tiles = package::ids().into_iter().map(|id| (id, package::encoded_with_spans(id)));
    fs::write(&path, package::written_with(&package::manifest(), tiles)).unwrap();
    let tile = json(&["tile", text(&path), "2/2/1", "--json"]);
    check("tile", std::slice::from_ref(&tile));
    // The tile's corner is node (0, 768) of cells of 10 m; heights are in quarters of a metre.
    let at = |column: f64, row: f64| [0.5 + 10.0 * column, 0.25 + 10.0 * (768.0 - row)];
    let point = |column, row, height_m: f64| {
        let [x, y] = at(column, row);
        value!([x, y, height_m])
    };
    let bridge = [point(64.0, 64.0, 10.0), point(70.0, 65.0, 100.25), point(80.0, 65.0, 99.75)];
    let spans = &tile["spans"];
    assert_eq!(spans.as_array().unwrap().len(), 2);
    assert_eq!(
        spans[0],
        value!({ "way_id": 7, "frc": 3, "layer": null, "structure": "bridge", "line": bridge, "on_ground": [true, false] })
    );
    let is_vertex = |vertex: &Value| *vertex == spans[0]["line"][0];
    assert!(tile["tin"]["vertices"].as_array().unwrap().iter().any(is_vertex));
    // A row of 64 cells is 7.5 m higher than the one north of it, and the second column 2.5 m
    // higher than the first.
    let ground_m = (30.0 * (201.0 / 64.0) + 10.0 * (20.0 / 64.0)) * 0.25;
    let tunnel = [point(10.0, 200.0, -1.75), point(20.0, 201.0, ground_m)];
    assert_eq!(
        spans[1],
        value!({ "way_id": 9, "frc": 3, "layer": null, "structure": "tunnel", "line": tunnel, "on_ground": [false, true] })
    );
    let told = corniche(["tile", text(&path), "2/2/1"]).out;
    assert!(told.lines().any(|line| line.split_whitespace().eq(["spans", "2"])), "{told}");
}

/// The contents of a tile: one normal of length 1 per vertex, and the attributes of exactly the
/// ways in it.
#[test]
fn a_tile_has_normals_and_attributes() {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("pass.pmtiles");
    copy_pass(&package, &["-q", "--max-error", "10"]);
    let package = text(&package);
    let tiles = json(&["info", package, "--json"])["tiles"].take();
    let mut named = 0;
    for id in tiles.as_array().unwrap() {
        let tile = json(&["tile", package, id.as_str().unwrap(), "--json"]);
        let list = |value: &Value| value.as_array().unwrap().clone();
        let normals = list(&tile["tin"]["normals"]);
        assert_eq!(normals.len(), list(&tile["tin"]["vertices"]).len());
        for normal in &normals {
            let squares: f64 = list(normal).iter().map(|side| side.as_f64().unwrap().powi(2)).sum();
            assert!((squares - 1.0).abs() < 1e-9 && normal[2].as_f64() >= Some(0.0), "{normal}");
        }
        let ids = |of: &str| -> BTreeSet<i64> {
            list(&tile[of]).iter().map(|road| road["way_id"].as_i64().unwrap()).collect()
        };
        assert_eq!(ids("attributes"), ids("roads_geo").union(&ids("roads_sv")).copied().collect());
        named += list(&tile["attributes"]).iter().filter(|way| way["name"].is_string()).count();
    }
    assert!(named > 0, "the sample has ways with names");
}

/// The tile at a position is the one whose rectangle contains it, on each level.
#[test]
fn a_tile_is_found_by_its_place() {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("pass.pmtiles");
    copy_pass(&package, &["-q", "--max-error", "10"]);
    let package = text(&package);
    let at = |place: &str, more: &[&str]| {
        json(&[&["tile", package, "--json", "--at", place], more].concat())
    };
    let info = json(&["info", package, "--json"]);
    let coordinates = &info["manifest"]["coordinates"];
    let size = coordinates["size"].as_u64().unwrap() as usize;
    let number = |value: &Value| value.as_f64().unwrap();
    let [min_x, min_y, max_x, max_y] =
        ["min_x", "min_y", "max_x", "max_y"].map(|side| number(&coordinates["bounds"][side]));
    // Samples of the table, away from its border: their positions are known in both systems.
    for (column, row) in [(2, 2), (1, 1), (3, 2)] {
        let sample = &coordinates["samples_deg"][row * size + column];
        let place = format!("{},{}", sample[0], sample[1]);
        let share = |k: usize| k as f64 / (size - 1) as f64;
        let (x, y) =
            (min_x + (max_x - min_x) * share(column), min_y + (max_y - min_y) * share(row));
        for level in 0..=3 {
            let tile = at(&place, &["--level", &level.to_string()]);
            assert!(
                tile["id"].as_str().unwrap().starts_with(&format!("{level}/")),
                "{}",
                tile["id"]
            );
            let bounds: Vec<f64> = tile["bounds"].as_array().unwrap().iter().map(number).collect();
            let within =
                |low: f64, value: f64, high: f64| low - 0.01 <= value && value <= high + 0.01;
            assert!(
                within(bounds[0], x, bounds[2]) && within(bounds[1], y, bounds[3]),
                "{bounds:?} {x} {y}"
            );
        }
        assert_eq!(at(&place, &[])["id"], at(&place, &["--level", "3"])["id"]);
    }
    for (arguments, word) in [
        (&["--at", "100,10"][..], "the package covers"),
        (&["--at", "46.9,9.5"], "longitude comes first: 9.5,46.9 is inside"),
        (&["--at", "95.4,46.9", "--level", "1"], "no ground on level 1"),
        (&["--at", "9.54,46.9", "--level", "9"], "finest level is 3"),
        (&["--at", "9.54"], "longitude,latitude"),
        (&["--at", "9.54,46.9", "0/0/0"], "cannot be used with"),
        (&["0/0/0", "--level", "1"], "cannot be used with"),
        (&[], "Z/X/Y"),
    ] {
        let ran = corniche([&["tile", package], arguments].concat());
        assert!(ran.code == 2 && ran.err.contains(word), "{arguments:?}: {}", ran.err);
    }
}

/// For a position in a void, the tile around it is printed with a note; if there is no tile either,
/// the error says what to do.
#[test]
fn a_place_without_ground_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let (dem, package) = (folder.path().join("a.asc"), folder.path().join("a.pmtiles"));
    // Ground with a hole in the west, ground in the east, and a void as wide as four tiles between
    // them.
    let place = "xllcorner 500000\nyllcorner 5200000\ncellsize 10\nNODATA_value -9999";
    write_ascii_grid(&dem, [1537, 257], place, |column, row| {
        let is_hole = (60..200).contains(&column) && (60..200).contains(&row);
        let is_between = (256..1280).contains(&column);
        if is_hole || is_between { -9999.0 } else { 100.0 }
    });
    let built = corniche([
        "build",
        "-q",
        "--dem",
        text(&dem),
        "--dem-crs",
        "EPSG:32632",
        "--max-error",
        "5",
        "-o",
        text(&package),
    ]);
    assert_eq!(built.code, 0, "{}", built.err);
    let manifest = manifest(&package);
    let (bounds, finest) = (&manifest["wgs84_bounds"], manifest["frame"]["max_level"].to_string());
    let side = |name: &str| bounds[name].as_f64().unwrap();
    let at = |east: f64, north: f64, more: &[&str]| {
        let lon = side("min_x") + east * (side("max_x") - side("min_x"));
        let lat = side("min_y") + north * (side("max_y") - side("min_y"));
        let place = format!("{lon},{lat}");
        corniche([&["tile", text(&package), "--at", &place], more].concat())
    };
    let ground = at(0.02, 0.5, &[]);
    assert!(ground.code == 0 && ground.err.is_empty(), "{}", ground.err);
    let hole = at(0.085, 0.5, &[]);
    assert!(hole.code == 0 && hole.err.contains("no ground at this position"), "{}", hole.err);
    let void = at(0.5, 0.5, &[]);
    assert!(void.code == 0 && void.err.contains("is the finest one"), "{}", void.err);
    let void = at(0.5, 0.5, &["--level", &finest]);
    assert!(void.code == 2 && void.err.contains("omit --level"), "{}", void.err);
}
