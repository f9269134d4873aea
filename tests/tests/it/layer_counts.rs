//! The numbers of objects of each class of the built-in layers are those that osmium finds in real
//! extracts; where they differ, for reasons that the build reports.
//!
//! Classes are decided here again, by functions.

#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test may unwrap, and prints counts"
)]

use std::{collections::BTreeMap, fs, path::Path, process::Command};

use e2e::{corniche, kept, layer, manifest, real_data, skip, text};
use serde_json::{Value, json};

type Tags<'a> = BTreeMap<&'a str, &'a str>;
type Counts = BTreeMap<String, u64>;

/// The class of a way in the layer of railways.
fn railway(tags: &Tags<'_>) -> Option<&'static str> {
    let kind = *tags.get("railway")?;
    let is_track = ["rail", "narrow_gauge", "light_rail", "subway", "tram"].contains(&kind);
    let has_rack = tags.get("rack").is_some_and(|rack| *rack != "no");
    Some(match (kind, tags.get("usage").copied()) {
        _ if is_track && tags.contains_key("service") => "service",
        _ if is_track && kind != "subway" && has_rack => "rack",
        ("funicular", _) => "rack",
        ("narrow_gauge", _) => "narrow-gauge",
        ("rail", Some("industrial" | "military" | "test")) => "industrial",
        ("rail", Some("main")) => "main",
        ("rail" | "preserved", _) => "branch",
        ("light_rail" | "subway" | "monorail", _) => "light",
        ("tram", _) => "tram",
        _ => return None,
    })
}

/// The class of an object in the layer of boundaries.
fn boundary(tags: &Tags<'_>) -> Option<String> {
    match (*tags.get("boundary")?, tags.get("admin_level")) {
        ("administrative", Some(&level @ ("2" | "3" | "4" | "5" | "6" | "7" | "8"))) => {
            Some(format!("admin-{level}"))
        }
        ("protected_area" | "national_park", _) => Some("protected".to_owned()),
        _ => None,
    }
}

/// The class of an object in the layer of areas.
fn area(tags: &Tags<'_>) -> Option<&'static str> {
    let is = |key: &str, values: &[&str]| tags.get(key).is_some_and(|own| values.contains(own));
    let is_water = is("natural", &["water", "bay"])
        || is("waterway", &["riverbank", "dock"])
        || is("landuse", &["reservoir", "basin"])
        || is("leisure", &["swimming_pool"]);
    let is_rock = is("natural", &["bare_rock", "scree", "shingle", "rock"]);
    let green = ["meadow", "farmland", "farm", "orchard", "vineyard", "grass"];
    let parks = ["park", "garden", "golf_course", "pitch", "recreation_ground"];
    let yards = ["recreation_ground", "village_green", "cemetery", "allotments"];
    let built = ["residential", "commercial", "industrial", "retail"];
    let other = ["farmyard", "construction", "railway", "garages"];
    Some(match () {
        () if is_water => "water",
        () if is("natural", &["glacier"]) => "glacier",
        () if is("natural", &["wood"]) || is("landuse", &["forest"]) => "forest",
        () if is_rock || is("landuse", &["quarry"]) => "rock",
        () if is("natural", &["grassland", "heath", "fell", "tundra"]) => "meadow",
        () if is("landuse", &green) => "meadow",
        () if is("leisure", &parks) || is("landuse", &yards) => "park",
        () if is("landuse", &built) || is("landuse", &other) => "settlement",
        () => return None,
    })
}

/// Runs osmium; `None` if it does not exist.
fn osmium(arguments: &[&str]) -> Option<String> {
    let done = Command::new("osmium").args(arguments).output().ok()?;
    assert!(done.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&done.stderr));
    Some(String::from_utf8(done.stdout).unwrap())
}

/// The tags and the members of an OPL line. Tags with special characters are not compared.
fn fields(line: &str) -> (Tags<'_>, &str) {
    let field = |letter| line.split(' ').skip(1).find_map(|field| field.strip_prefix(letter));
    let tags = field('T').unwrap_or_default().split(',');
    (tags.filter_map(|tag| tag.split_once('=')).collect(), field('M').unwrap_or_default())
}

/// The ways of the layers of railways and boundaries by class, and the number of ways of boundaries
/// that the extract lacks.
fn lines_of_osmium(extract: &Path) -> Option<([Counts; 2], u64)> {
    let filter = ["tags-filter", "-R", "-f", "opl", "-o", "-", text(extract)];
    let of_keys = osmium(&[&filter[..], &["w/railway", "wr/boundary"]].concat())?;
    let all = osmium(&["cat", "-f", "opl", "-o", "-", "-t", "way", text(extract)])?;
    let is_present =
        |way: &str| all.contains(&format!("\nw{way} ")) || all.starts_with(&format!("w{way} "));
    let (mut railways, mut classes) = (Counts::new(), BTreeMap::<String, String>::new());
    let mut tell = |way: &str, class: &str| {
        let known = classes.entry(way.to_owned()).or_insert_with(|| class.to_owned());
        if class < &**known {
            class.clone_into(known);
        }
    };
    for line in of_keys.lines() {
        let (tags, members) = fields(line);
        let id = line[1..].split(' ').next().unwrap();
        if line.starts_with('w') {
            if let Some(class) = railway(&tags) {
                *railways.entry(class.to_owned()).or_default() += 1;
            }
            if let Some(class) = boundary(&tags) {
                tell(id, &class);
            }
        } else if matches!(tags.get("type"), Some(&"boundary" | &"multipolygon"))
            && let Some(class) = boundary(&tags)
        {
            for member in members.split(',') {
                let (way, role) = member.split_once('@').unwrap();
                if let (Some(way), "" | "outer" | "inner") = (way.strip_prefix('w'), role) {
                    tell(way, &class);
                }
            }
        }
    }
    let (mut boundaries, mut missing) = (Counts::new(), 0);
    for (way, class) in classes {
        if is_present(&way) {
            *boundaries.entry(class).or_default() += 1;
        } else {
            missing += 1;
        }
    }
    Some(([railways, boundaries], missing))
}

/// The areas that osmium assembles, by class.
fn areas_of_osmium(extract: &Path, folder: &Path) -> Option<Counts> {
    let at = |name: &str| text(&folder.join(name)).to_owned();
    let settings = json!({
        "linear_tags": false,
        "area_tags": ["natural", "waterway", "landuse", "leisure"],
    });
    fs::write(at("config.json"), settings.to_string()).unwrap();
    // `export` requires objects in order of ids.
    let sorted = at("sorted.osm.pbf");
    osmium(&["sort", "-O", "-o", &sorted, text(extract)])?;
    let words = ["export", "-f", "geojsonseq", "--geometry-types=polygon", "-o", "-"];
    let more = ["-x", "print_record_separator=false", "-c", &at("config.json"), &sorted];
    let features = osmium(&[&words[..], &more].concat())?;
    let mut counts = Counts::new();
    for line in features.lines().filter(|line| !line.is_empty()) {
        let feature: Value = serde_json::from_str(line).unwrap();
        let tags = feature["properties"].as_object().unwrap().iter();
        let tags: Tags<'_> =
            tags.filter_map(|(key, value)| Some((&**key, value.as_str()?))).collect();
        if let Some(class) = area(&tags) {
            *counts.entry(class.to_owned()).or_default() += 1;
        }
    }
    Some(counts)
}

fn counts(layer: &Value) -> Counts {
    kept(layer).into_iter().map(|(class, objects)| (class.to_owned(), objects)).collect()
}

#[test]
#[ignore = "slow: builds two countries and two towns"]
fn each_class_has_the_objects_that_osmium_finds() {
    for (dem, osm, error_m) in [
        ("liechtenstein/N47E009.hgt", "liechtenstein/liechtenstein-2013-08-03.osm.pbf", "30"),
        ("liechtenstein/N47E009.hgt", "liechtenstein/liechtenstein-2021-10-28.osm.pbf", "30"),
        ("delft-oostpoort/delft_dtm_0.5m.tif", "delft-oostpoort/delft-oostpoort.osm.pbf", "1"),
        ("delft-oostpoort/delft_dtm_0.5m.tif", "delft-oostpoort/tudelft-full.osm.pbf", "1"),
    ] {
        let (Some(dem), Some(extract)) = (real_data(dem), real_data(osm)) else { continue };
        let folder = tempfile::tempdir().unwrap();
        let Some((lines, missing)) = lines_of_osmium(&extract) else {
            return skip("there is no program osmium (Debian: osmium-tool)");
        };
        let areas = areas_of_osmium(&extract, folder.path()).unwrap();
        let [package, defects] = ["a.pmtiles", "defects.csv"].map(|name| folder.path().join(name));
        let inputs = ["build", "-q", "--dem", text(&dem), "--osm", text(&extract)];
        let layers = ["--layers", "areas,boundaries,railways", "--max-error", error_m];
        let more = ["--relief", "off", "--defects", text(&defects), "-o", text(&package)];
        let ran = corniche([&inputs[..], &layers, &more].concat());
        assert_eq!(ran.code, 0, "{osm}: {}", ran.err);
        let found = manifest(&package);
        let [railways, boundaries] = lines;
        for (name, expected, missing) in
            [("railways", railways, 0), ("boundaries", boundaries, missing)]
        {
            let of_layer = layer(&found, name);
            println!("{osm}, {name}: {expected:?}, {missing} missing");
            assert_eq!(counts(of_layer), expected, "{osm}, {name}");
            let lost: Vec<(&str, u64)> = of_layer["lost"]
                .as_array()
                .unwrap()
                .iter()
                .map(|of| (of["reason"].as_str().unwrap(), of["objects"].as_u64().unwrap()))
                .collect();
            let expected = (missing > 0).then_some(("way of a line is missing", missing));
            assert_eq!(lost, Vec::from_iter(expected), "{osm}, {name}");
        }
        // Areas that only the package has were mended, or lack ways.
        let defects = fs::read_to_string(&defects).unwrap();
        let reasons = ["mended outline of an area", "missing ways of an area"];
        let is_told = |line: &&str| reasons.iter().any(|reason| line.contains(reason));
        let told = defects.lines().filter(is_told).count() as u64;
        let own = counts(layer(&found, "areas"));
        println!("{osm}, areas: {own:?}, osmium {areas:?}, {told} mended or without ways");
        assert!(areas.keys().all(|class| own.contains_key(class)), "{osm}: {own:?} {areas:?}");
        let mut more = 0;
        for (class, &objects) in &own {
            let of_osmium = areas.get(class).copied().unwrap_or_default();
            assert!(of_osmium <= objects, "{osm}, {class}: {objects}, osmium {of_osmium}");
            more += objects - of_osmium;
        }
        assert!(more <= told, "{osm}: {more} more areas than osmium, {told} for a reason");
    }
}
