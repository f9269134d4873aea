//! Boundaries of small generated extracts: each way once, in the most important class.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::fs;

use crate::common::{
    outlined::{built_in, read_lines},
    to_lattice,
};
use corniche_layers::{AttributeValue, LayerTable};
use corniche_osm::{ExtractDefect, LayerLine, LineLoss, LineSummary, ReadRequest};
use corniche_presets::parse_layer_table;
use corniche_testing::MemoryScratch;
use corniche_testing::pbf::{BlockBuilder, file};

#[derive(Default)]
struct Found {
    boundaries: Vec<LayerLine>,
    defects: Vec<ExtractDefect>,
    summary: LineSummary,
}

/// Reads with a memory limit. Nodes are in a square lattice of 0.001 degrees: number 10 y + x + 1
/// at (x, y).
fn read(bytes: &[u8], memory_bytes: u64) -> Found {
    read_by(&built_in("boundaries"), bytes, memory_bytes)
}

fn read_by(table: &LayerTable, bytes: &[u8], memory_bytes: u64) -> Found {
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
    let (mut boundaries, mut defects) = (Vec::new(), Vec::new());
    let sink = &mut |line| boundaries.push(line);
    let summary = read_lines(&request, table, sink, &mut |defect| defects.push(defect)).unwrap();
    Found { boundaries, defects, summary }
}

type Tags<'a> = &'a [(&'a str, &'a str)];
type Members<'a> = &'a [(i64, &'a str)];

fn made(ways: &[(i64, Tags<'_>, &[i64])], relations: &[(i64, Tags<'_>, Members<'_>)]) -> Vec<u8> {
    let mut block = BlockBuilder::new();
    let node = |n: i64| (n + 1, 470_000_000 + 10_000 * (n / 10), 95_000_000 + 10_000 * (n % 10));
    block.dense(&(0..100).map(node).collect::<Vec<_>>());
    for (id, tags, node_ids) in ways {
        block.way(*id, tags, node_ids);
    }
    for (id, tags, members) in relations {
        block.relation(*id, tags, members);
    }
    file(&block)
}

const COUNTRY: Tags<'_> =
    &[("type", "boundary"), ("boundary", "administrative"), ("admin_level", "2")];
const DISTRICT: Tags<'_> =
    &[("type", "boundary"), ("boundary", "administrative"), ("admin_level", "6")];
const PARK: Tags<'_> = &[("type", "boundary"), ("boundary", "protected_area")];

fn classes(found: &Found) -> Vec<(i64, String)> {
    let table = built_in("boundaries");
    let class = |line: &LayerLine| table.classes()[usize::from(line.class)].id.clone();
    found.boundaries.iter().map(|line| (line.way_id, class(line))).collect()
}

fn expected(classes: &[(i64, &str)]) -> Vec<(i64, String)> {
    classes.iter().map(|&(way_id, class)| (way_id, class.to_owned())).collect()
}

#[test]
fn a_shared_border_comes_once_in_the_most_important_class() {
    let ways: [(i64, Tags<'_>, &[i64]); 3] =
        [(1, &[], &[1, 2, 3]), (2, &[], &[3, 13, 23]), (3, &[], &[23, 22, 21, 1])];
    let relations: [(i64, Tags<'_>, Members<'_>); 3] = [
        (10, DISTRICT, &[(1, "outer"), (2, "outer"), (3, "outer")]),
        (11, COUNTRY, &[(2, ""), (1, "inner")]),
        (12, PARK, &[(3, "outer"), (2, "outer")]),
    ];
    let found = read(&made(&ways, &relations), 1 << 24);
    assert_eq!(classes(&found), expected(&[(1, "admin-2"), (2, "admin-2"), (3, "admin-6")]));
    assert!(found.defects.is_empty(), "{:?}", found.defects);
    assert_eq!((found.summary.objects, found.summary.ways), (3, 3));
}

#[test]
fn ways_with_tags_count_by_themselves_and_other_roles_do_not() {
    let own: Tags<'_> = &[("boundary", "administrative"), ("admin_level", "8")];
    let ways: [(i64, Tags<'_>, &[i64]); 3] =
        [(1, own, &[1, 2]), (2, own, &[2, 3, 13, 2]), (3, &[], &[5, 6])];
    let relations: [(i64, Tags<'_>, Members<'_>); 2] = [
        (10, COUNTRY, &[(1, "outer"), (3, "label")]),
        // This is not a boundary by its type.
        (
            11,
            &[("type", "route"), ("boundary", "administrative"), ("admin_level", "2")],
            &[(3, "")],
        ),
    ];
    let found = read(&made(&ways, &relations), 1 << 24);
    assert_eq!(classes(&found), expected(&[(1, "admin-2"), (2, "admin-8")]));
}

/// Values come from the object that gives the class: the way itself before relations, and of
/// relations of one class the one with the lowest id.
#[test]
fn values_are_those_of_the_object_that_gives_the_class() {
    let named = |tags: Tags<'static>, name| [tags, &[("name", name)]].concat();
    let own = named(&[("boundary", "administrative"), ("admin_level", "2")], "own");
    let (country, district) = (named(COUNTRY, "A"), named(DISTRICT, "B"));
    let other = [named(COUNTRY, "C"), vec![("disputed", "perhaps")]].concat();
    let ways: [(i64, Tags<'_>, &[i64]); 4] =
        [(1, &own, &[1, 2]), (2, &[], &[2, 3]), (3, &[], &[5, 6]), (4, &[], &[7, 8])];
    let relations: [(i64, Tags<'_>, Members<'_>); 4] = [
        (9, &district, &[(1, ""), (2, ""), (3, "")]),
        (10, &country, &[(1, ""), (2, "")]),
        (11, &other, &[(2, ""), (4, "")]),
        (12, PARK, &[(4, "")]),
    ];
    let bytes = made(&ways, &relations);
    for memory_bytes in [1 << 24, 1 << 10] {
        let found = read(&bytes, memory_bytes);
        let names: Vec<(i64, &str)> = found
            .boundaries
            .iter()
            .map(|line| match &line.values[..] {
                // Disputed, maritime and name, in the order of their keys.
                [None, None, Some(AttributeValue::Text(name))] => (line.way_id, &**name),
                values => panic!("{values:?}"),
            })
            .collect();
        assert_eq!(names, [(1, "own"), (2, "A"), (3, "B"), (4, "C")]);
        let unread = ExtractDefect::UnreadValue {
            object: corniche_layers::OsmObject::Relation(11),
            key: "disputed".to_owned(),
        };
        assert_eq!(found.defects, [unread]);
        assert_eq!(found.summary.unread, [("disputed".to_owned(), 1)].into());
    }
}

/// A layer without `members` contains no ways of relations, and `members` without `roles` accepts
/// every role.
#[test]
fn members_are_those_of_the_table() {
    let ways: [(i64, Tags<'_>, &[i64]); 3] =
        [(1, &[("route", "hiking")], &[1, 2]), (2, &[], &[2, 3]), (3, &[], &[5, 6])];
    let route: Tags<'_> = &[("type", "route"), ("route", "hiking")];
    let relations: [(i64, Tags<'_>, Members<'_>); 2] = [
        (9, route, &[(2, "forward")]),
        (10, &[("type", "superroute"), ("route", "hiking")], &[(3, "")]),
    ];
    let bytes = made(&ways, &relations);
    let of_table = |members: &str| {
        let class = "[[class]]\nid = \"hiking\"\ntags.route = \"hiking\"";
        let text = format!("id = \"paths\"\ngeometry = \"line\"\n{members}\n{class}");
        let found = read_by(&parse_layer_table(&text).unwrap(), &bytes, 1 << 24);
        found.boundaries.iter().map(|line| line.way_id).collect::<Vec<i64>>()
    };
    assert_eq!(of_table(""), [1]);
    assert_eq!(of_table("members = { types = [\"route\"] }"), [1, 2]);
    assert_eq!(of_table("members = { types = [\"route\"], roles = [\"\"] }"), [1]);
}

/// The fixed points are the ends, and the points where two boundaries meet.
#[test]
fn junctions_are_fixed() {
    let ways: [(i64, Tags<'_>, &[i64]); 2] = [(1, &[], &[1, 2, 3, 4, 5]), (2, &[], &[3, 13, 23])];
    let found = read(&made(&ways, &[(10, COUNTRY, &[(1, "outer"), (2, "outer")])]), 1 << 24);
    assert_eq!(found.boundaries[0].fixed, [0, 2, 4]);
    assert_eq!(found.boundaries[1].fixed, [0, 2]);
}

#[test]
fn what_is_lost_is_counted_by_reason() {
    let ways: [(i64, Tags<'_>, &[i64]); 4] = [
        (1, &[], &[1, 2, 3]),
        // A node in the middle is missing, so there are two parts.
        (2, &[], &[1, 2, 900, 12, 13]),
        (3, &[], &[900, 1, 901]),
        (4, &[], &[7, 7]),
    ];
    let members: Members<'_> =
        &[(1, "outer"), (2, "outer"), (3, "outer"), (4, "outer"), (5, "outer")];
    let found = read(&made(&ways, &[(10, COUNTRY, members)]), 1 << 24);
    assert_eq!(classes(&found).iter().map(|(id, _)| *id).collect::<Vec<_>>(), [1, 2, 2]);
    let lost: Vec<(i64, LineLoss)> = found
        .defects
        .iter()
        .filter_map(|defect| match defect {
            ExtractDefect::LostLine { way_id, loss, .. } => Some((*way_id, *loss)),
            _ => None,
        })
        .collect();
    assert_eq!(
        lost,
        [(3, LineLoss::MissingNodes), (4, LineLoss::OutsideProjection), (5, LineLoss::MissingWay)]
    );
    assert!(found.defects.contains(&ExtractDefect::MissingNodes { way_id: 2, points: 1 }));
    assert_eq!(found.summary.ways, 5);
}

/// With little memory, everything is sorted on disk, and the result is the same.
#[test]
fn little_memory_changes_nothing() {
    let ways: Vec<(i64, Tags<'_>, Vec<i64>)> =
        (1..=90).map(|id| (id, &[] as Tags<'_>, vec![id, id + 1, id + 10])).collect();
    let ways: Vec<(i64, Tags<'_>, &[i64])> =
        ways.iter().map(|(id, tags, nodes)| (*id, *tags, nodes.as_slice())).collect();
    let members: Vec<(i64, &str)> = (1..=90).map(|id| (id, "outer")).collect();
    let bytes = made(&ways, &[(10, COUNTRY, &members), (11, PARK, &members)]);
    let (one, other) = (read(&bytes, 1 << 24), read(&bytes, 1 << 19));
    assert_eq!(one.boundaries, other.boundaries);
    assert_eq!(one.summary, other.summary);
    assert_eq!(one.boundaries.len(), 90);
}

/// If two relations have the same id, the first counts. Ways that only the other references are not
/// read, and make no junction.
#[test]
fn ways_of_a_relation_that_does_not_count_are_not_looked_at() {
    let ways: [(i64, Tags<'_>, &[i64]); 2] = [(1, &[], &[1, 2, 3]), (2, &[], &[2, 12, 22])];
    let once: [(i64, Tags<'_>, Members<'_>); 1] = [(1, COUNTRY, &[(1, "outer")])];
    let twice: [(i64, Tags<'_>, Members<'_>); 2] =
        [once[0], (1, COUNTRY, &[(1, "outer"), (2, "outer")])];
    let [expected, found] =
        [&once[..], &twice].map(|relations| read(&made(&ways, relations), 1 << 24));
    assert_eq!(found.boundaries, expected.boundaries);
    assert_eq!(found.boundaries[0].fixed, [0, 2]);
    assert_eq!(found.summary.ways, 1);
}
