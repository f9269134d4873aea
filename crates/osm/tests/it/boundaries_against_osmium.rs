//! Boundaries of real extracts match the objects that osmium lists (`osmium cat -f opl`).

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::{collections::BTreeMap, path::Path, process::Command};

use crate::common::{
    default_table,
    outlined::{built_in, read_lines},
    to_lattice,
};
use corniche_layers::LayerTable;
use corniche_osm::{ExtractDefect, LineLoss, ReadRequest};
use corniche_testing::{MemoryScratch, real_data};

/// Returns the number of the class that tags give, implemented independently:
/// `Tkey=value,key=value`.
fn class_of(table: &LayerTable, fields: &str) -> Option<u8> {
    let tags: BTreeMap<&str, &str> =
        fields.split(',').filter_map(|tag| tag.split_once('=')).collect();
    let id = match *tags.get("boundary")? {
        "administrative" => format!("admin-{}", tags.get("admin_level")?),
        "protected_area" | "national_park" => "protected".to_owned(),
        _ => return None,
    };
    let number = table.classes().iter().position(|class| class.id == id)?;
    Some(number as u8)
}

/// Returns for each way its class, and whether the extract contains it.
fn of_osmium(table: &LayerTable, extract: &Path) -> Option<BTreeMap<i64, (u8, bool)>> {
    let mut command = Command::new("osmium");
    command.args(["cat", "-f", "opl", "-o", "-", "-t", "way", "-t", "relation"]).arg(extract);
    let done = command.output().ok()?;
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    let text = String::from_utf8(done.stdout).unwrap();
    let mut ways: BTreeMap<i64, u8> = BTreeMap::new();
    let mut present = std::collections::BTreeSet::new();
    let mut name = |way_id: i64, class: u8| {
        let known = ways.entry(way_id).or_insert(class);
        *known = (*known).min(class);
    };
    for line in text.lines() {
        let mut fields = line.split(' ');
        let object = fields.next().unwrap();
        let id: i64 = object[1..].parse().unwrap();
        let fields: Vec<&str> = fields.collect();
        let field = |letter: char| {
            fields.iter().find(|field| field.starts_with(letter)).map_or("", |field| &field[1..])
        };
        let class = class_of(table, field('T'));
        if object.starts_with('w') {
            present.insert(id);
            if let Some(class) = class {
                name(id, class);
            }
            continue;
        }
        let kind = field('T').split(',').find_map(|tag| tag.strip_prefix("type="));
        let (Some(class), Some("boundary" | "multipolygon")) = (class, kind) else { continue };
        for member in field('M').split(',').filter_map(|member| member.strip_prefix('w')) {
            let (way, role) = member.split_once('@').unwrap();
            if ["", "outer", "inner"].contains(&role) {
                name(way.parse().unwrap(), class);
            }
        }
    }
    Some(ways.into_iter().map(|(id, class)| (id, (class, present.contains(&id)))).collect())
}

#[test]
fn boundaries_are_the_ways_that_osmium_lists() {
    let table = built_in("boundaries");
    for name in [
        "liechtenstein/liechtenstein-2013-08-03.osm.pbf",
        "liechtenstein/liechtenstein-2021-10-28.osm.pbf",
        "portland/portland-central-filtered.osm.pbf",
        "swellendam/swellendam-roads.osm.pbf",
    ] {
        let Some(extract) = real_data(name) else { return };
        let Some(expected) = of_osmium(&table, &extract) else {
            return corniche_testing::skip("there is no program osmium (Debian: osmium-tool)");
        };
        let pool = rayon::ThreadPoolBuilder::new().num_threads(2).build().unwrap();
        let request = ReadRequest {
            path: &extract,
            others: &[],
            table: &default_table(),
            place: &to_lattice,
            ring_area_m2: &corniche_geom::wgs84::area_m2,
            seam: None,
            square_steps: i64::MAX,
            node_ids: false,
            pool: &pool,
            memory_bytes: 1 << 26,
            scratch: &MemoryScratch::default(),
            on_progress: None,
        };
        let (mut kept, mut lost) = (BTreeMap::new(), BTreeMap::new());
        let summary = read_lines(
            &request,
            &table,
            &mut |boundary| {
                kept.insert(boundary.way_id, boundary.class);
            },
            &mut |defect| {
                if let ExtractDefect::LostLine { way_id, loss, .. } = defect {
                    lost.insert(way_id, loss);
                }
            },
        )
        .unwrap();
        assert_eq!(summary.ways, expected.len() as u64, "{name}");
        for (way_id, (class, is_present)) in &expected {
            if *is_present {
                assert!(
                    kept.get(way_id) == Some(class)
                        || lost.get(way_id) == Some(&LineLoss::MissingNodes),
                    "{name}: way {way_id} {class}"
                );
            } else {
                assert_eq!(lost.get(way_id), Some(&LineLoss::MissingWay), "{name}: way {way_id}");
            }
        }
        println!("{name}: {} ways, {} kept, {} lost", expected.len(), kept.len(), lost.len());
    }
}
