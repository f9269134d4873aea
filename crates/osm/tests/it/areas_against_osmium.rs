//! Areas of real extracts are the areas that osmium assembles (`osmium export`).

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::{
    collections::{BTreeMap, BTreeSet},
    fs,
    path::Path,
    process::Command,
};

use crate::common::{
    default_table,
    outlined::{built_in, read_areas},
    to_lattice,
};
use corniche_areas::Polygon;
use corniche_geom::wgs84;
use corniche_layers::{LayerTable, OsmObject};
use corniche_osm::{AreaLoss, AreaSummary, ExtractDefect, LayerArea, ReadRequest};
use corniche_testing::{MemoryScratch, real_data};
use serde_json::{Value, json};

/// Returns the areas of osmium, m², by object: all closed ways with a tag of the table, and all
/// relations.
fn areas_of_osmium(extract: &Path, table: &LayerTable) -> Option<BTreeMap<OsmObject, f64>> {
    let folder = tempfile::tempdir().unwrap();
    let [config, output] = ["config.json", "areas.geojsonseq"].map(|name| folder.path().join(name));
    // `export` decides by key which closed ways are areas; the table's classes are compared below.
    let tags = table.needed_keys();
    let attributes = json!({ "type": true, "id": true });
    let settings = json!({ "attributes": attributes, "linear_tags": false, "area_tags": tags });
    fs::write(&config, settings.to_string()).unwrap();
    // `export` requires objects in order of ids.
    let sorted = folder.path().join("sorted.osm.pbf");
    let done =
        Command::new("osmium").arg("sort").arg(extract).arg("-o").arg(&sorted).output().ok()?;
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    let mut command = Command::new("osmium");
    command.args(["export", "-f", "geojsonseq", "--geometry-types=polygon", "-O"]);
    command.args(["-x", "print_record_separator=false", "-c"]).arg(&config);
    let done = command.arg("-o").arg(&output).arg(&sorted).output().ok()?;
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    let mut areas = BTreeMap::new();
    for line in fs::read_to_string(&output).unwrap().lines() {
        if line.is_empty() {
            continue;
        }
        let feature: Value = serde_json::from_str(line).unwrap();
        let properties = feature["properties"].as_object().unwrap();
        let tags: Vec<(&str, &str)> =
            properties.iter().filter_map(|(key, value)| Some((&**key, value.as_str()?))).collect();
        if table.classify(&tags).is_none() {
            continue;
        }
        let id = properties["@id"].as_i64().unwrap();
        let object = match properties["@type"].as_str().unwrap() {
            "way" => OsmObject::Way(id),
            _ => OsmObject::Relation(id),
        };
        let area_m2 = polygons_of(&feature["geometry"]).iter().map(|rings| area_m2(rings)).sum();
        assert_eq!(areas.insert(object, area_m2), None, "{object}");
    }
    Some(areas)
}

fn polygons_of(geometry: &Value) -> Vec<Vec<Vec<[f64; 2]>>> {
    let coordinates = geometry["coordinates"].clone();
    match geometry["type"].as_str().unwrap() {
        "Polygon" => vec![serde_json::from_value(coordinates).unwrap()],
        _ => serde_json::from_value(coordinates).unwrap(),
    }
}

/// GeoJSON repeats the first position of a ring at its end.
fn area_m2(rings: &[Vec<[f64; 2]>]) -> f64 {
    let of_ring = |ring: &Vec<[f64; 2]>| wgs84::area_m2(&ring[1..]).abs();
    rings.iter().map(of_ring).reduce(|outer, hole| outer - hole).unwrap()
}

fn own_areas(
    extract: &Path,
    table: &LayerTable,
) -> (Vec<LayerArea>, Vec<ExtractDefect>, AreaSummary) {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(2).build().unwrap();
    let scratch = MemoryScratch::default();
    let request = ReadRequest {
        path: extract,
        others: &[],
        table: &default_table(),
        place: &to_lattice,
        ring_area_m2: &corniche_geom::wgs84::area_m2,
        seam: None,
        square_steps: i64::MAX,
        node_ids: false,
        pool: &pool,
        memory_bytes: 1 << 26,
        scratch: &scratch,
        on_progress: None,
    };
    let (mut areas, mut defects) = (Vec::new(), Vec::new());
    let summary = read_areas(&request, table, &mut |area| areas.push(area), &mut |defect| {
        defects.push(defect);
    })
    .unwrap();
    (areas, defects, summary)
}

/// Every area of osmium is also one of ours, with the same square metres. Areas that only we have
/// were mended, or lack ways.
#[test]
fn areas_are_those_of_osmium() {
    let table = built_in("areas");
    for name in [
        "liechtenstein/liechtenstein-2013-08-03.osm.pbf",
        "liechtenstein/liechtenstein-2021-10-28.osm.pbf",
        "portland/portland-central-filtered.osm.pbf",
        "swellendam/swellendam-roads.osm.pbf",
        "nasty/osm/monaco-latest.lz4.osm.pbf",
        "nasty/osm/r5-missing-nodes.osm.pbf",
        "nasty/derived-osm/simple-extract-missing-nodes.osm.pbf",
    ] {
        let Some(extract) = real_data(name) else { return };
        let folder = tempfile::tempdir().unwrap();
        // We do not read this compression, and report that.
        let extract = if name.contains("lz4") {
            let again = folder.path().join("zlib.osm.pbf");
            let cat =
                Command::new("osmium").arg("cat").arg(&extract).arg("-o").arg(&again).output();
            if !cat.is_ok_and(|cat| cat.status.success()) {
                corniche_testing::skip(&format!("osmium cannot read {name} here"));
                continue;
            }
            again
        } else {
            extract
        };
        let Some(expected) = areas_of_osmium(&extract, &table) else {
            return corniche_testing::skip("there is no program osmium (Debian: osmium-tool)");
        };
        let (areas, defects, summary) = own_areas(&extract, &table);
        let excused: BTreeSet<(&str, i64)> = defects
            .iter()
            .filter(|defect| {
                matches!(
                    defect,
                    ExtractDefect::MissingWays { .. } | ExtractDefect::MendedOutline { .. }
                )
            })
            .map(ExtractDefect::object)
            .collect();
        let mut only_ours = 0;
        let mut worst = 0.0_f64;
        for area in &areas {
            if let Some(expected_m2) = expected.get(&area.object) {
                worst = worst.max((area.area_m2 - expected_m2).abs() / expected_m2.max(1.0));
                continue;
            }
            only_ours += 1;
            let of_it = |defect: &&ExtractDefect| defect.object() == area.object.parts();
            println!("{}: {:?}", area.object, defects.iter().find(of_it));
            assert!(excused.contains(&area.object.parts()), "{name}: {}", area.object);
        }
        let own: BTreeSet<OsmObject> = areas.iter().map(|area| area.object).collect();
        let only_osmium: Vec<_> = expected.keys().filter(|object| !own.contains(object)).collect();
        let km2 = |m2: f64| m2 / 1e6;
        println!(
            "{name}: {} objects; {} areas, {:.3} km², {} polygons; osmium {} areas, {:.3} km²; only ours {only_ours}, only osmium's {}; \
             largest difference of an area {worst:.1e}; lost {:?}",
            summary.objects,
            areas.len(),
            km2(areas.iter().map(|area| area.area_m2).sum()),
            areas.iter().map(|area| area.polygons.len()).sum::<usize>(),
            expected.len(),
            km2(expected.values().sum()),
            only_osmium.len(),
            summary.lost,
        );
        assert!(worst < 1e-9, "{name}: {worst}");
        assert_eq!(only_osmium, Vec::<&OsmObject>::new(), "{name}");
        assert!(
            areas.iter().flat_map(|area| &area.polygons).all(|p: &Polygon| p.doubled_area() > 0)
        );
        assert!(!summary.lost.contains_key(&AreaLoss::TooIntricate));
    }
}
