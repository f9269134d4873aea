//! Areas of small generated extracts: which are kept, which are lost, and why.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::fs;

use crate::common::{
    outlined::{built_in, class_number, read_areas},
    to_lattice,
};
use corniche_layers::{AttributeValue, OsmObject};
use corniche_osm::{AreaLoss, AreaSummary, ExtractDefect, LayerArea, ReadOsmError, ReadRequest};
use corniche_testing::MemoryScratch;
use corniche_testing::pbf::{BlockBuilder, deltas, field, file, number};

struct Found {
    areas: Vec<LayerArea>,
    defects: Vec<ExtractDefect>,
    summary: AreaSummary,
}

fn class(id: &str) -> u8 {
    class_number(&built_in("areas"), id)
}

/// Reads with a memory limit. Nodes are in a square lattice of 0.001 degrees: number 10 y + x + 1
/// at (x, y).
fn read_within(bytes: &[u8], memory_bytes: u64) -> Result<Found, ReadOsmError> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("made.osm.pbf");
    fs::write(&path, bytes).unwrap();
    let pool = rayon::ThreadPoolBuilder::new().num_threads(2).build().unwrap();
    let scratch = MemoryScratch::default();
    let frc_table = crate::common::default_table();
    let request = ReadRequest {
        path: &path,
        others: &[],
        table: &frc_table,
        place: &to_lattice,
        ring_area_m2: &corniche_geom::wgs84::area_m2,
        seam: None,
        square_steps: i64::MAX,
        node_ids: false,
        pool: &pool,
        memory_bytes,
        scratch: &scratch,
        on_progress: None,
    };
    let (mut areas, mut defects) = (Vec::new(), Vec::new());
    let summary =
        read_areas(&request, &built_in("areas"), &mut |area| areas.push(area), &mut |defect| {
            defects.push(defect);
        })?;
    Ok(Found { areas, defects, summary })
}

type Tags<'a> = &'a [(&'a str, &'a str)];

/// Returns an extract with a 10 × 10 lattice of nodes, these ways, and these relations of ways.
fn made(ways: &[(i64, Tags<'_>, &[i64])], relations: &[(i64, Tags<'_>, &[i64])]) -> Vec<u8> {
    let mut block = BlockBuilder::new();
    let node = |n: i64| (n + 1, 470_000_000 + 10_000 * (n / 10), 95_000_000 + 10_000 * (n % 10));
    block.dense(&(0..100).map(node).collect::<Vec<_>>());
    for (id, tags, node_ids) in ways {
        block.way(*id, tags, node_ids);
    }
    for (id, tags, way_ids) in relations {
        // Ways with numbers above 1000 are holes.
        let role = |id: i64| if id > 1000 { "inner" } else { "outer" };
        let members: Vec<(i64, &str)> = way_ids.iter().map(|&id| (id, role(id))).collect();
        block.relation(*id, tags, &members);
    }
    file(&block)
}

fn read(ways: &[(i64, Tags<'_>, &[i64])], relations: &[(i64, Tags<'_>, &[i64])]) -> Found {
    read_within(&made(ways, relations), 1 << 24).unwrap()
}

const LAKE: Tags<'_> = &[("natural", "water"), ("name", "Bodensee")];
const FOREST: Tags<'_> = &[("type", "multipolygon"), ("landuse", "forest")];
const PLAIN: Tags<'_> = &[];

/// Returns the area of a square of the lattice, m².
fn cell_m2() -> f64 {
    corniche_geom::wgs84::area_m2(&[[9.5, 47.0], [9.501, 47.0], [9.501, 47.001], [9.5, 47.001]])
}

#[test]
fn closed_ways_and_relations_are_areas() {
    let found = read(
        &[
            (1, LAKE, &[1, 2, 12, 11, 1]),
            (2, PLAIN, &[23, 27, 67]),
            (3, PLAIN, &[67, 63, 23]),
            (4, PLAIN, &[34, 35, 45, 44, 34]),
        ],
        &[(9, FOREST, &[2, 3, 4])],
    );
    assert_eq!(found.defects, []);
    let [lake, forest] = &found.areas[..] else { panic!("{:?}", found.areas) };
    assert_eq!((lake.object, lake.class), (OsmObject::Way(1), class("water")));
    assert_eq!(lake.values, [Some(AttributeValue::Text("Bodensee".to_owned()))]);
    assert_eq!(forest.values, [None]);
    assert!((lake.area_m2 / cell_m2() - 1.0).abs() < 1e-4, "{}", lake.area_m2);
    assert_eq!((forest.object, forest.class), (OsmObject::Relation(9), class("forest")));
    assert_eq!(forest.polygons[0].holes().len(), 1);
    assert!((forest.area_m2 / cell_m2() - 15.0).abs() < 1e-2, "{}", forest.area_m2 / cell_m2());
    let kept = found.summary.kept[&class("forest")];
    assert_eq!((kept.areas, kept.polygons, kept.points), (1, 1, 8));
}

#[test]
fn each_object_is_an_area_or_lost_for_a_reason() {
    let found = read(
        &[
            (1, LAKE, &[1, 2, 12]),
            (2, LAKE, &[1, 2, 12, 11, 1]),
            (2, LAKE, &[1, 2, 12, 11, 1]),
            (3, LAKE, &[1, 2, 12, 111, 1]),
            (4, LAKE, &[1, 12, 2, 11, 1]),
            (5, LAKE, &[1, 2, 1, 1]),
            (6, &[("natural", "water"), ("area", "no")], &[1, 2, 12, 11, 1]),
            (7, PLAIN, &[1, 2, 12]),
            (1001, PLAIN, &[34, 35, 45, 44, 34]),
            (8, &[("highway", "service"), ("area", "yes")], &[1, 2, 12, 11, 1]),
        ],
        &[
            (10, FOREST, &[7]),
            (11, FOREST, &[7, 70]),
            (12, FOREST, &[]),
            // The way is in the file, and a hole is not.
            (13, FOREST, &[2, 1071]),
            // A hole is in the file, and the way around it is not.
            (15, FOREST, &[71, 1001]),
            (14, &[("type", "route"), ("landuse", "forest")], &[2]),
        ],
    );
    let way = |id, loss| ExtractDefect::LostArea { object: OsmObject::Way(id), loss };
    let relation = |id, loss| ExtractDefect::LostArea { object: OsmObject::Relation(id), loss };
    let mut defects = found.defects;
    defects.retain(|defect| {
        matches!(defect, ExtractDefect::LostArea { .. } | ExtractDefect::MissingWays { .. })
    });
    assert_eq!(
        defects,
        [
            way(1, AreaLoss::OpenWay),
            way(2, AreaLoss::Duplicate),
            way(3, AreaLoss::MissingNodes),
            way(4, AreaLoss::CrossingOutline),
            way(5, AreaLoss::NoOutline),
            relation(10, AreaLoss::OpenOutline),
            relation(11, AreaLoss::MissingWays),
            relation(12, AreaLoss::NoOutline),
            ExtractDefect::MissingWays { relation_id: 13, ways: 1 },
            relation(15, AreaLoss::MissingWays),
        ]
    );
    let kept: Vec<OsmObject> = found.areas.iter().map(|area| area.object).collect();
    assert_eq!(kept, [OsmObject::Way(2), OsmObject::Relation(13)]);
    assert_eq!(found.summary.objects, 11);
}

/// With memory for a few ways at a time, the result is the same as with memory for all.
#[test]
fn little_memory_gives_the_same() {
    let ids: Vec<i64> = (1..=60).collect();
    let squares: Vec<[i64; 5]> = ids
        .iter()
        .map(|n| {
            let at = n + (n - 1) / 9;
            [at, at + 1, at + 11, at + 10, at]
        })
        .collect();
    let ways: Vec<(i64, Tags<'_>, &[i64])> =
        ids.iter().zip(&squares).map(|(&id, square)| (id, LAKE, &square[..])).collect();
    let relations: Vec<(i64, Tags<'_>, &[i64])> =
        (0..20).map(|n| (n + 1, FOREST, &ids[n as usize * 3..][..3])).collect();
    let bytes = made(&ways, &relations);
    let all = read_within(&bytes, 1 << 24).unwrap();
    assert_eq!(all.areas.len(), 80);
    for memory_bytes in [1 << 10, 1 << 12, 1 << 16] {
        let found = read_within(&bytes, memory_bytes).unwrap();
        assert_eq!(found.areas, all.areas);
        assert_eq!(found.defects, all.defects);
        assert_eq!(found.summary, all.summary);
    }
}

/// A relation that contradicts itself makes the file corrupt, as ways do.
#[test]
fn damaged_relations_are_refused() {
    let relation = |fields: &[Vec<u8>]| {
        let mut block = BlockBuilder::with_row_of_nodes(3);
        block.groups.push(field(4, &[number(1, 9), fields.concat()].concat()));
        read_within(&file(&block), 1 << 24).map(|found| found.areas).unwrap_err().to_string()
    };
    let [roles, ids] = [field(8, &[0]), field(9, &deltas(&[1]))];
    for (fields, reason) in [
        (
            vec![roles.clone(), ids.clone(), field(10, &[3])],
            "a member of relation 9 has the unknown type 3",
        ),
        (vec![roles.clone(), ids, field(10, &[1, 1])], "1 members, 1 roles and 2 member types"),
        (vec![roles, field(9, &deltas(&[i64::MAX, 1, i64::MIN])), field(10, &[1; 3])], "overflow"),
        (vec![field(2, &[0])], "relation 9 has 1 keys and 0 values"),
        (vec![field(2, &[0]), field(3, &[100])], "a tag of relation 9 refers to string 100"),
    ] {
        let message = relation(&fields);
        assert!(message.contains(reason), "{message}");
    }
}

const COAST: Tags<'_> = &[("natural", "coastline")];

#[test]
fn coastlines_are_handed_on_in_order_of_their_points() {
    let found = read(
        &[
            (1, COAST, &[1, 2, 12]),
            // The way is an island that is a wood.
            (2, &[("natural", "coastline"), ("landuse", "forest")], &[34, 35, 45, 44, 34]),
            // The way has an area tag and is not closed.
            (3, &[("natural", "coastline"), ("landuse", "forest")], &[12, 13]),
            (4, COAST, &[13, 111]),
            (5, LAKE, &[1, 2, 12, 11, 1]),
        ],
        &[],
    );
    let coasts = &found.summary.coastlines;
    let ways: Vec<(i64, usize)> =
        coasts.iter().map(|coast| (coast.way_id, coast.points.len())).collect();
    assert_eq!(ways, [(1, 3), (2, 5), (3, 2)]);
    let lattice = |node: i64| {
        let n = node - 1;
        to_lattice(&[[9.5 + 0.001 * (n % 10) as f64, 47.0 + 0.001 * (n / 10) as f64]])[0].unwrap()
    };
    assert_eq!(coasts[0].points, [1, 2, 12].map(lattice));
    let objects: Vec<OsmObject> = found.areas.iter().map(|area| area.object).collect();
    assert_eq!(objects, [OsmObject::Way(2), OsmObject::Way(5)]);
    // Coastlines that are not areas do not count as objects, unless they are lost.
    assert_eq!(found.summary.objects, 4);
    let way = |id, loss| ExtractDefect::LostArea { object: OsmObject::Way(id), loss };
    let expected = [way(3, AreaLoss::OpenWay), way(4, AreaLoss::MissingNodes)];
    assert_eq!(found.defects, expected);
}

/// A forest across 180° has two ways, one of which ends at −180° where the other begins at 180°:
/// outlines are joined around the Earth.
#[test]
fn an_outline_over_180_degrees_is_closed() {
    let mut block = BlockBuilder::new();
    let places = [(1799, 100), (1800, 100), (-1799, 100), (-1799, 101), (-1800, 101), (1799, 101)];
    let nodes: Vec<_> =
        (1..).zip(places).map(|(id, (lon, lat))| (id, lat * 1_000_000, lon * 1_000_000)).collect();
    block.dense(&nodes);
    block.way(1, PLAIN, &[1, 2, 3, 4]);
    block.way(2, PLAIN, &[4, 5, 6, 1]);
    block.relation(9, FOREST, &[(1, "outer"), (2, "outer")]);
    let found = read_within(&file(&block), 1 << 24).unwrap();
    assert_eq!(found.defects, []);
    let [forest] = &found.areas[..] else { panic!("{:?}", found.areas) };
    // GeographicLib gives this for 0.2 by 0.1 degrees at 10 degrees north.
    let expected_m2 = 242_503_054.0;
    assert!((forest.area_m2 / expected_m2 - 1.0).abs() < 1e-5, "{}", forest.area_m2);
}
