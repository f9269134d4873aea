//! Points of small generated extracts: nodes, and places inside closed ways and relations.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use crate::common::{POOL, outlined::read_points, request, to_lattice, written};
use corniche_geom::LatticePoint;
use corniche_layers::{AttributeValue, LayerTable, OsmObject};
use corniche_osm::{AreaLoss, ExtractDefect, LayerPoint, PointSummary, ReadOsmError, ReadRequest};
use corniche_presets::parse_layer_table;
use corniche_testing::{
    MemoryScratch,
    pbf::{BlockBuilder, TaggedNode, field, file, plain_header, raw, varint},
};

fn table(more: &str) -> LayerTable {
    let text = format!(
        r#"
        id = "trees"
        geometry = "point"
        {more}
        attributes = {{ height = {{ number = "m" }}, name = "text" }}
        [[class]]
        id = "needles"
        tags = {{ natural = "tree", leaf_type = "needleleaved" }}
        [[class]]
        id = "other"
        tags = {{ natural = ["tree", "wood"] }}
        "#
    );
    parse_layer_table(&text).unwrap()
}

#[derive(Debug, PartialEq)]
struct Found {
    points: Vec<LayerPoint>,
    defects: Vec<ExtractDefect>,
    summary: PointSummary,
}

fn read_as(request: &ReadRequest<'_>, table: &LayerTable) -> Result<Found, ReadOsmError> {
    let (mut points, mut defects) = (Vec::new(), Vec::new());
    let take = &mut |point| points.push(point);
    let summary = read_points(request, table, take, &mut |defect| defects.push(defect))?;
    Ok(Found { points, defects, summary })
}

fn read(bytes: &[u8], table: &LayerTable, memory_bytes: u64) -> Result<Found, ReadOsmError> {
    let (_folder, path) = written("made.osm.pbf", bytes);
    let scratch = MemoryScratch::default();
    let request = request(&path, &POOL, &to_lattice, &scratch);
    read_as(&ReadRequest { memory_bytes, ..request }, table)
}

const TREE: (&str, &str) = ("natural", "tree");

fn node<'a>(id: i64, tags: &'a [(&'a str, &'a str)]) -> TaggedNode<'a> {
    TaggedNode { id, at: [470_000_000 + 1000 * (id / 10), 95_000_000 + 1000 * (id % 10)], tags }
}

/// Returns an extract with trees among 40 nodes in a lattice, and woods.
fn made(is_dense: bool) -> Vec<u8> {
    let mut block = BlockBuilder::new();
    let trees: [&[(&str, &str)]; 4] = [
        &[TREE, ("leaf_type", "needleleaved"), ("height", "12.5")],
        &[TREE, ("height", "tall"), ("name", "Linde")],
        &[("natural", "peak"), ("height", "3000")],
        &[("highway", "crossing")],
    ];
    let nodes: Vec<TaggedNode<'_>> = (1..40)
        .map(|id| node(id, if id % 3 == 0 { trees[id as usize / 3 % 4] } else { &[] }))
        .collect();
    block.tagged(&nodes, is_dense);
    block.way(1, &[("natural", "wood")], &[1, 3, 23, 21, 1]);
    block.way(2, &[TREE], &[1, 3]);
    block.way(3, &[], &[11, 14, 34]);
    block.way(4, &[], &[34, 31, 11]);
    let wood: &[(&str, &str)] = &[("type", "multipolygon"), ("natural", "wood")];
    block.relation(1, wood, &[(3, "outer"), (4, "outer")]);
    file(&block)
}

fn at(u: i64, v: i64) -> LatticePoint {
    LatticePoint::new(95_000_000 + u, 470_000_000 + v)
}

#[test]
fn nodes_ways_and_relations_are_points_in_this_order() {
    for is_dense in [true, false] {
        let found = read(&made(is_dense), &table(""), 1 << 24).unwrap();
        let points: Vec<(OsmObject, u8)> =
            found.points.iter().map(|point| (point.object, point.class)).collect();
        let nodes = [(3, 1), (12, 0), (15, 1), (24, 0), (27, 1), (36, 0), (39, 1)];
        let mut expected: Vec<(OsmObject, u8)> =
            nodes.iter().map(|&(id, class)| (OsmObject::Node(id), class)).collect();
        expected.extend([(OsmObject::Way(1), 1), (OsmObject::Relation(1), 1)]);
        assert_eq!(points, expected);
        assert_eq!(found.points[0].at, at(3000, 0));
        assert_eq!(found.points[1].values, [Some(AttributeValue::Number(12.5)), None]);
        let name = AttributeValue::Text("Linde".to_owned());
        assert_eq!(found.points[0].values, [None, Some(name)]);
        assert_eq!(found.points[7].at, at(2000, 1000));
        assert_eq!(found.points[8].at, at(2500, 2000));
        let unread = |id| ExtractDefect::UnreadValue {
            object: OsmObject::Node(id),
            key: "height".to_owned(),
        };
        let lost = ExtractDefect::LostArea { object: OsmObject::Way(2), loss: AreaLoss::OpenWay };
        assert_eq!(found.defects, [vec![lost], [3, 15, 27, 39].map(unread).to_vec()].concat());
        let PointSummary { objects, kept, lost, unread } = found.summary;
        assert_eq!((objects, kept), (10, [(0, 3), (1, 6)].into()));
        assert_eq!(
            (lost, unread),
            ([(AreaLoss::OpenWay, 1)].into(), [("height".to_owned(), 4)].into())
        );
    }
}

#[test]
fn closed_ways_can_be_left_out() {
    let found = read(&made(true), &table("closed_ways = false"), 1 << 24).unwrap();
    assert!(found.points.iter().all(|point| matches!(point.object, OsmObject::Node(_))));
    assert_eq!((found.points.len(), found.summary.objects), (7, 7));
}

#[test]
fn little_memory_gives_the_same() {
    let expected = read(&made(true), &table(""), 1 << 24).unwrap();
    for memory_bytes in [1 << 8, 1 << 12] {
        assert_eq!(read(&made(true), &table(""), memory_bytes).unwrap(), expected);
    }
}

/// A node that is twice in a file counts once; one beyond the poles is lost.
#[test]
fn each_node_is_a_point_or_lost_for_a_reason() {
    let mut block = BlockBuilder::new();
    let far = TaggedNode { id: 8, at: [910_000_000, 0], tags: &[TREE] };
    block.tagged(&[node(1, &[TREE]), node(7, &[TREE]), node(1, &[TREE]), far], true);
    let found = read(&file(&block), &table(""), 1 << 24).unwrap();
    let lost = |id, loss| ExtractDefect::LostArea { object: OsmObject::Node(id), loss };
    let mut defects = found.defects;
    defects.sort_by_key(|defect| defect.object().1);
    assert_eq!(defects, [lost(1, AreaLoss::Duplicate), lost(8, AreaLoss::OutOfRange)]);
    assert_eq!((found.points.len(), found.summary.objects), (2, 4));
}

/// Of several extracts, the newest version of a node counts; here they are the same.
#[test]
fn a_node_in_two_extracts_counts_once() {
    let bytes = made(true);
    let (_first_folder, first) = written("first.osm.pbf", &bytes);
    let (_second_folder, second) = written("second.osm.pbf", &bytes);
    let scratch = MemoryScratch::default();
    let others = [second];
    let request = ReadRequest { others: &others, ..request(&first, &POOL, &to_lattice, &scratch) };
    let found = read_as(&request, &table("")).unwrap();
    let alone = read(&bytes, &table(""), 1 << 24).unwrap();
    assert_eq!(found.points, alone.points);
    assert_eq!(found.summary.kept, alone.summary.kept);
}

/// Tags of nodes that contradict themselves make the file corrupt where they are read, and only
/// there.
#[test]
fn damaged_tags_of_nodes_are_refused() {
    let with_tags = |texts: &[u64]| {
        let mut block = BlockBuilder::with_row_of_nodes(2);
        block.text(b"natural");
        let mut group = block.groups.pop().unwrap();
        // The group is one message, whose length is a single byte.
        let tags = field(10, &texts.iter().flat_map(|&text| varint(text)).collect::<Vec<_>>());
        group[1] += tags.len() as u8;
        block.groups.push([group, tags].concat());
        [plain_header(), raw(b"OSMData", &block.bytes())].concat()
    };
    for (texts, reason) in [
        (&[1, 1, 0][..], "the tags of dense nodes are incomplete"),
        (&[1], "the tags of dense nodes are incomplete"),
        (&[1, 9, 0, 0], "a tag of a node refers to a string that is not in the string table"),
        (&[1, u64::MAX, 0, 0], "a tag of a node refers to a string"),
    ] {
        let error = read(&with_tags(texts), &table(""), 1 << 24).unwrap_err().to_string();
        assert!(error.contains(reason), "{error}");
    }
    read(&with_tags(&[1, 0, 0]), &table(""), 1 << 24).unwrap_err();
    assert_eq!(read(&with_tags(&[0, 0]), &table(""), 1 << 24).unwrap().points, []);
}
