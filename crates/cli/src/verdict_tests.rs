//! A build ends with a summary: a few lines, with all skipped objects and how to include them.

use corniche_osm::LineLoss;
use corniche_testing::package::manifest;
use corniche_tileset::{InputRecord, LayerCounts, LeftOutRecord, Manifest, RoadLoss};

use super::*;

fn told(manifest: &Manifest) -> String {
    to_text(manifest, 1_444_800, Path::new("maps/li.pmtiles"), Digits::Plain)
}

fn left_out(reason: &str, highway: &str, ways: u64, length_um: u64) -> LeftOutRecord {
    LeftOutRecord { reason: reason.to_owned(), highway: highway.to_owned(), ways, length_um }
}

fn lost(reason: &str, roads: u64, length_um: u64) -> RoadLoss {
    RoadLoss { reason: reason.to_owned(), roads, length_um }
}

/// A kilometre.
const KM: u64 = 1_000_000_000;

/// A manifest with contents for every line.
fn full() -> Manifest {
    let mut manifest = manifest();
    let counts = &mut manifest.counts;
    (counts.roads_in, counts.roads_in_um) = (4956, 876 * KM);
    (counts.roads_kept, counts.roads_kept_um) = (4900, 850 * KM);
    counts.roads_lost = vec![
        lost("outside the elevation data", 50, 25 * KM),
        lost("where the data have no ground (void or edge)", 6, KM),
        lost("outside the bounds that were asked for", 0, 0),
    ];
    let reasons = [("class is off", 2002), ("listed as no road", 13), ("an area", 16)];
    counts.highways_left_out = reasons.map(|(reason, number)| (reason.to_owned(), number)).to_vec();
    counts.left_out = vec![
        left_out("class is off", "path", 950, 337 * KM),
        left_out("class is off", "footway", 646, 52 * KM),
        left_out("class is off", "cycleway", 238, 46 * KM),
        left_out("class is off", "steps", 168, 6 * KM),
        left_out("an area", "pedestrian", 16, 2 * KM),
    ];
    counts.defects = [("area", 16), ("missing nodes", 3), ("split by gaps", 1)]
        .map(|(name, number)| (name.to_owned(), number))
        .to_vec();
    let missing = (LineLoss::MissingWay.reason().to_owned(), 1493);
    manifest.layers =
        vec![layer("areas", 30, Vec::new()), layer("boundaries", 1602, vec![missing])];
    manifest
}

/// A layer without kept objects.
fn layer(id: &str, objects: u64, lost: Vec<(String, u64)>) -> LayerRecord {
    let class = serde_json::json!({ "id": "one", "tags": { "natural": true } });
    let table = serde_json::json!({ "id": id, "geometry": "area", "class": [class] });
    let counts = LayerCounts { objects, kept: Vec::new(), lost, unread_values: Vec::new() };
    LayerRecord { table: serde_json::from_value(table).unwrap(), counts, levels: Vec::new() }
}

#[test]
fn many_layers_are_told_in_one_line() {
    let ids = ["areas", "boundaries", "railways", "walls", "trees"];
    let mut manifest = full();
    manifest.layers = ids.map(|id| layer(id, 7, Vec::new())).to_vec();
    let text = told(&manifest);
    assert!(
        text.contains("\nlayers       0 objects in areas, boundaries, railways and 2 more\n"),
        "{text}"
    );
}

#[test]
fn the_verdict_has_at_most_ten_lines_and_names_what_is_left_out() {
    let full = full();
    let text = told(&full);
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines.len(), MOST_LINES, "{text}");
    assert!(lines.iter().all(|line| line.chars().count() <= 100), "{text}");
    assert_eq!(lines[0], "roads        4900 of 4956 kept, 850.0 km of 876.0 km");
    // There is space for two lines: one with the objects that can be included, and the number of
    // others.
    assert_eq!(
        lines[1..5],
        [
            "skipped      2002 ways, class is off (path, footway, …), 441.0 km; --classes 0-8 includes them",
            "             85 more, for other reasons, 28.0 km; corniche info lists them",
            "areas        0 of 30 objects kept",
            "boundaries   0 of 1602 objects kept, 1493 missing from the extract",
        ]
    );
    assert!(lines[6].starts_with("datum        vertical datum unknown; "), "{text}");
    assert_eq!(
        lines[9],
        "wrote        maps/li.pmtiles. Inspect it with corniche info, show it with corniche view or serve"
    );
}

#[test]
fn what_can_be_had_comes_first_with_its_option() {
    let mut manifest = full();
    manifest.layers.clear();
    manifest.counts.defects.truncate(1);
    let text = told(&manifest);
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(
        lines[1..4],
        [
            "skipped      2002 ways, class is off (path, footway, …), 441.0 km; --classes 0-8 includes them",
            "             50 roads outside the elevation data, 25.0 km; a DEM that covers them includes them",
            "             35 more, for other reasons, 3.0 km; corniche info lists them",
        ]
    );
    assert!(!text.contains("defects"), "an outline of a surface is no defect: {text}");
}

#[test]
fn parts_of_roads_are_told_without_a_number() {
    let mut manifest = full();
    manifest.counts.roads_lost = vec![lost("where the data have no ground (void or edge)", 0, KM)];
    manifest.counts.highways_left_out.clear();
    let text = told(&manifest);
    let line = "skipped      parts of roads where the data has no ground (void or edge), 1.0 km; see --fill-voids\n";
    assert!(text.contains(line), "{text}");
    assert!(text.lines().all(|line| line.chars().count() <= 100), "{text}");
}

/// Without an extract, with a datum, and without losses the summary is short.
#[test]
fn a_whole_build_has_four_lines() {
    let mut manifest = manifest();
    manifest.vertical.datum = "EGM96 height".to_owned();
    manifest.counts.roads_in = 0;
    let text = told(&manifest);
    let names: Vec<&str> = text.lines().map(|line| line.split(' ').next().unwrap()).collect();
    assert_eq!(names, ["roads", "error", "size", "wrote"], "{text}");
    assert!(text.starts_with("roads        none: built without an extract\n"), "{text}");
    let [kind, name, sha256] = ["osm", "lakes.osm.pbf", ""].map(str::to_owned);
    manifest.inputs.push(InputRecord { kind, name, bytes: 1, sha256 });
    manifest.counts.highways_in = 0;
    assert!(told(&manifest).starts_with("roads        none: the extract has none\n"));
    manifest.counts.highways_in = 3;
    let text = told(&manifest);
    assert!(
        text.starts_with("roads        none: the extract has none of the classes that are on\n")
    );
}
