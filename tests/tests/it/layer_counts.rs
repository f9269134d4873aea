//! The numbers of objects of each class of the built-in layers but ferries are those that osmium
//! finds in real extracts; where they differ, for reasons that the build reports.
//!
//! Classes are decided here again, by functions.

#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test may unwrap, and prints counts"
)]

use std::{
    collections::{BTreeMap, BTreeSet},
    fs,
    path::Path,
    process::Command,
};

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

/// Whether an object has the key with one of these values.
fn has(tags: &Tags<'_>, key: &str, values: &[&str]) -> bool {
    tags.get(key).is_some_and(|own| values.contains(own))
}

/// The class of an object in the layer of areas.
fn area(tags: &Tags<'_>) -> Option<&'static str> {
    let is = |key: &str, values: &[&str]| has(tags, key, values);
    let is_water = is("natural", &["water", "bay"])
        || is("waterway", &["riverbank", "dock"])
        || is("landuse", &["reservoir", "basin"])
        || is("leisure", &["swimming_pool"]);
    let fields = ["farmland", "farm", "orchard", "vineyard"];
    let parks = ["park", "garden", "golf_course", "pitch", "recreation_ground"];
    let yards = ["recreation_ground", "village_green", "cemetery", "allotments"];
    let built = ["residential", "commercial", "industrial", "retail"];
    let other = ["farmyard", "construction", "railway", "garages"];
    Some(match () {
        () if is("man_made", &["pier"]) => "pier",
        () if is("man_made", &["breakwater", "groyne"]) => "breakwater",
        () if is_water => "water",
        () if is("natural", &["glacier"]) => "glacier",
        () if is("natural", &["wood"]) || is("landuse", &["forest"]) => "forest",
        () if is("natural", &["scrub"]) => "scrub",
        () if is("natural", &["wetland"]) => "wetland",
        () if is("natural", &["bare_rock", "rock"]) || is("landuse", &["quarry"]) => "rock",
        () if is("natural", &["scree", "shingle"]) => "scree",
        () if is("natural", &["sand", "beach", "dune"]) => "sand",
        () if is("natural", &["bare_ground", "mud", "landslide"]) => "bare-ground",
        () if is("landuse", &["brownfield", "landfill"]) => "bare-ground",
        () if is("leisure", &parks) || is("landuse", &yards) => "park",
        () if is("natural", &["grassland", "heath", "fell", "tundra"]) => "meadow",
        () if is("landuse", &["meadow", "grass"]) => "meadow",
        () if is("landuse", &fields) => "farmland",
        () if is("landuse", &["greenhouse_horticulture", "plant_nursery"]) => "farmland",
        () if is("landuse", &built) || is("landuse", &other) => "settlement",
        () => return None,
    })
}

/// The class of a building.
fn building(tags: &Tags<'_>) -> Option<&'static str> {
    Some(match *tags.get("building")? {
        "no" => return None,
        "ruins" | "collapsed" => "ruin",
        _ if tags.get("ruins").is_some_and(|ruins| *ruins != "no") => "ruin",
        "roof" | "carport" | "greenhouse" => "roof",
        _ => "building",
    })
}

/// The class of a way in the layer of waterways.
fn waterway(tags: &Tags<'_>) -> Option<&'static str> {
    let kind = *tags.get("waterway")?;
    let is_tagged = |key: &str| tags.get(key).is_some_and(|value| *value != "no");
    let natural = ["river", "stream", "tidal_channel"].contains(&kind);
    let is_made = ["canal", "ditch", "drain", "pressurised"].contains(&kind);
    Some(match kind {
        _ if (natural || is_made) && is_tagged("tunnel") => "culvert",
        _ if natural && (is_tagged("intermittent") || is_tagged("seasonal")) => "intermittent",
        "wadi" => "intermittent",
        "river" | "tidal_channel" => "river",
        "canal" => "canal",
        "stream" => "stream",
        "ditch" | "drain" => "ditch",
        _ => return None,
    })
}

/// The class of a way in the layer of landforms.
fn landform(tags: &Tags<'_>) -> Option<&'static str> {
    let is = |key: &str, values: &[&str]| has(tags, key, values);
    Some(match () {
        () if is("waterway", &["dam", "weir"]) => "dam",
        () if is("man_made", &["dyke"]) => "dyke",
        () if is("man_made", &["pier", "breakwater", "groyne"]) => "pier",
        () if is("natural", &["cliff"]) => "cliff",
        () if is("natural", &["ridge", "arete"]) => "ridge",
        () if is("man_made", &["embankment"]) || is("natural", &["earth_bank"]) => "embankment",
        () => return None,
    })
}

/// The class of a node in the layer of places.
fn place(tags: &Tags<'_>) -> Option<&'static str> {
    let people = tags.get("population").and_then(|people| people.parse::<f64>().ok());
    Some(match *tags.get("place")? {
        "city" => "city",
        "town" if people.is_some_and(|people| people >= 10_000.0) => "large-town",
        "town" => "town",
        "village" => "village",
        "hamlet" => "hamlet",
        "suburb" | "quarter" | "borough" | "neighbourhood" => "quarter",
        "locality" => "locality",
        "farm" | "isolated_dwelling" => "farm",
        _ => return None,
    })
}

/// The class of a node in the layer of peaks.
fn peak(tags: &Tags<'_>) -> Option<&'static str> {
    Some(match (tags.get("natural").copied(), tags.get("mountain_pass").copied()) {
        (Some("volcano"), _) => "volcano",
        (Some("peak"), _) => "peak",
        (Some("saddle"), _) | (_, Some("yes")) => "pass",
        (Some("hill"), _) => "hill",
        _ => return None,
    })
}

/// The class of a point of interest: a node or an area.
fn poi(tags: &Tags<'_>) -> Option<&'static str> {
    let is = |key: &str, values: &[&str]| has(tags, key, values);
    let towers = ["tower", "communications_tower", "water_tower", "lighthouse"];
    Some(match () {
        () if is("tourism", &["alpine_hut", "wilderness_hut"]) => "hut",
        () if is("railway", &["station", "halt"]) || is("aerialway", &["station"]) => "station",
        () if is("aeroway", &["aerodrome", "heliport"]) => "airfield",
        () if is("tourism", &["viewpoint"]) => "viewpoint",
        () if is("man_made", &towers) => "tower",
        () if is("natural", &["cave_entrance"]) => "cave",
        () if is("natural", &["spring", "hot_spring"]) => "spring",
        () if is("amenity", &["parking"]) && !is("access", &["private", "no"]) => "parking",
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

/// Counts by class, by layer.
type LayerCounts = BTreeMap<&'static str, Counts>;
/// The class of an object by its tags.
type Classify = fn(&Tags<'_>) -> Option<&'static str>;

fn count(found: &mut LayerCounts, layer: &'static str, class: Option<&str>) {
    let classes = found.entry(layer).or_default();
    if let Some(class) = class {
        *classes.entry(class.to_owned()).or_default() += 1;
    }
}

/// The nodes and ways of the layers of points and lines by class, without members of relations.
fn nodes_and_ways_of_osmium(extract: &Path) -> Option<LayerCounts> {
    let keys = ["railway", "waterway", "natural", "man_made", "place", "mountain_pass"];
    let more = ["tourism", "aerialway", "aeroway", "amenity"];
    let wanted: Vec<String> = keys.iter().chain(&more).map(|key| format!("nw/{key}")).collect();
    let filter = ["tags-filter", "-R", "-f", "opl", "-o", "-", text(extract)];
    let words: Vec<&str> = filter.into_iter().chain(wanted.iter().map(String::as_str)).collect();
    let lines: [(&str, Classify); 3] =
        [("railways", railway), ("waterways", waterway), ("landforms", landform)];
    let points: [(&str, Classify); 3] = [("places", place), ("peaks", peak), ("pois", poi)];
    let mut found = LayerCounts::new();
    for line in osmium(&words)?.lines() {
        let of_kind = if line.starts_with('w') { &lines } else { &points };
        let (tags, _) = fields(line);
        for (layer, classify) in of_kind {
            count(&mut found, layer, classify(&tags));
        }
    }
    Some(found)
}

/// The ways of the layer of boundaries by class, and the number of those that the extract lacks.
fn boundaries_of_osmium(extract: &Path) -> Option<(Counts, u64)> {
    let filter = ["tags-filter", "-R", "-f", "opl", "-o", "-", text(extract), "wr/boundary"];
    let of_keys = osmium(&filter)?;
    let all = osmium(&["cat", "-f", "opl", "-o", "-", "-t", "way", text(extract)])?;
    let present: BTreeSet<&str> =
        all.lines().filter_map(|line| line[1..].split(' ').next()).collect();
    let mut classes = BTreeMap::<String, String>::new();
    let mut tell = |way: &str, class: &str| {
        let known = classes.entry(way.to_owned()).or_insert_with(|| class.to_owned());
        if class < &**known {
            class.clone_into(known);
        }
    };
    for line in of_keys.lines() {
        let (tags, members) = fields(line);
        let id = line[1..].split(' ').next().unwrap();
        let Some(class) = boundary(&tags) else { continue };
        if line.starts_with('w') {
            tell(id, &class);
        } else if matches!(tags.get("type"), Some(&"boundary" | &"multipolygon")) {
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
        if present.contains(&*way) {
            *boundaries.entry(class).or_default() += 1;
        } else {
            missing += 1;
        }
    }
    Some((boundaries, missing))
}

/// The areas that osmium assembles, by class, and points of interest that are areas.
fn areas_of_osmium(extract: &Path, folder: &Path) -> Option<LayerCounts> {
    let at = |name: &str| text(&folder.join(name)).to_owned();
    let keys = ["natural", "waterway", "landuse", "leisure", "man_made", "building"];
    let of_points = ["tourism", "railway", "aerialway", "aeroway", "amenity"];
    let keys = [&keys[..], &of_points].concat();
    let settings = json!({ "linear_tags": false, "area_tags": keys });
    fs::write(at("config.json"), settings.to_string()).unwrap();
    // `export` requires objects in order of ids.
    let sorted = at("sorted.osm.pbf");
    osmium(&["sort", "-O", "-o", &sorted, text(extract)])?;
    let words = ["export", "-f", "geojsonseq", "--geometry-types=polygon", "-o", "-"];
    let more = ["-x", "print_record_separator=false", "-c", &at("config.json"), &sorted];
    let features = osmium(&[&words[..], &more].concat())?;
    let mut found = LayerCounts::new();
    for line in features.lines().filter(|line| !line.is_empty()) {
        let feature: Value = serde_json::from_str(line).unwrap();
        let tags = feature["properties"].as_object().unwrap().iter();
        let tags: Tags<'_> =
            tags.filter_map(|(key, value)| Some((&**key, value.as_str()?))).collect();
        let of_kind: [(&str, Classify); 3] =
            [("areas", area), ("buildings", building), ("pois", poi)];
        for (layer, classify) in of_kind {
            count(&mut found, layer, classify(&tags));
        }
    }
    Some(found)
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
        let Some((boundaries, missing)) = boundaries_of_osmium(&extract) else {
            return skip("there is no program osmium (Debian: osmium-tool)");
        };
        let mut exact = nodes_and_ways_of_osmium(&extract).unwrap();
        exact.insert("boundaries", boundaries);
        let mut areas = areas_of_osmium(&extract, folder.path()).unwrap();
        for (class, objects) in areas.remove("pois").unwrap_or_default() {
            *exact.entry("pois").or_default().entry(class).or_default() += objects;
        }
        let [package, defects] = ["a.pmtiles", "defects.csv"].map(|name| folder.path().join(name));
        let inputs = ["build", "-q", "--dem", text(&dem), "--osm", text(&extract)];
        let names: Vec<&str> = exact.keys().chain(areas.keys()).copied().collect();
        let layers = ["--layers", &names.join(","), "--max-error", error_m];
        let more = ["--relief", "off", "--defects", text(&defects), "-o", text(&package)];
        let ran = corniche([&inputs[..], &layers, &more].concat());
        assert_eq!(ran.code, 0, "{osm}: {}", ran.err);
        let found = manifest(&package);
        for (name, expected) in exact {
            let missing = if name == "boundaries" { missing } else { 0 };
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
        let mut more = 0;
        for (name, areas) in areas {
            let own = counts(layer(&found, name));
            println!("{osm}, {name}: {own:?}, osmium {areas:?}, {told} mended or without ways");
            assert!(areas.keys().all(|class| own.contains_key(class)), "{own:?} {areas:?}");
            for (class, &objects) in &own {
                let of_osmium = areas.get(class).copied().unwrap_or_default();
                assert!(of_osmium <= objects, "{osm}, {class}: {objects}, osmium {of_osmium}");
                more += objects - of_osmium;
            }
        }
        assert!(more <= told, "{osm}: {more} more areas than osmium, {told} for a reason");
    }
}
