//! Errors in single ways and nodes: everything else is read, and every loss has a defect that names
//! the object.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::collections::{BTreeMap, BTreeSet};

use crate::common::{Extract, read_bytes, roads::check_summary};
use corniche_osm::{ExtractDefect, LeftOutReason};
use corniche_testing::pbf::{
    BlockBuilder, deltas, field, file, number, packed_blob, plain_header, raw,
};
use proptest::prelude::*;

/// Checks the points of each road, west to east in hundredths of the row's spacing, and the
/// defects.
#[track_caller]
fn check(block: &BlockBuilder, roads: &[(i64, &[i64])], defects: &[ExtractDefect]) {
    let extract = read_bytes(&file(block)).unwrap();
    let found: Vec<(i64, Vec<i64>)> = extract
        .roads
        .iter()
        .map(|road| {
            (road.way_id, road.line.points().iter().map(|p| (p.u - 90_000_000) / 100).collect())
        })
        .collect();
    let expected: Vec<_> = roads.iter().map(|&(id, points)| (id, points.to_vec())).collect();
    assert_eq!(found, expected);
    assert_eq!(extract.defects, defects);
}

/// With an invalid layer, a tunnel beside the road, no lanes or no width, the road stays, and each
/// value is counted and listed.
#[test]
fn tags_taken_for_another_value_are_counted_by_value() {
    let mut block = BlockBuilder::with_row_of_nodes(3);
    let tags: [&[(&str, &str)]; 7] = [
        &[("highway", "track"), ("layer", "1000")],
        &[("highway", "track"), ("layer", "-5"), ("tunnel", "yes")],
        &[("highway", "track"), ("tunnel", "culvert"), ("layer", "1000")],
        &[("highway", "track"), ("tunnel", "building_passage")],
        &[("highway", "track"), ("layer", "1;2")],
        &[("highway", "track"), ("lanes", "0"), ("width", "narrow"), ("maxspeed", "slow")],
        // The way is not a road, so its tags do not matter.
        &[("highway", "proposed"), ("layer", "5000")],
    ];
    for (id, tags) in (1..).zip(tags) {
        block.way(id, tags, &[1, 2]);
    }
    let extract = read_bytes(&file(&block)).unwrap();
    assert_eq!(extract.roads.len(), 6);
    let counted = [
        ("lanes=0", 1),
        ("layer=1000", 2),
        ("layer=1;2", 1),
        ("tunnel=building_passage", 1),
        ("tunnel=culvert", 1),
        ("width=narrow", 1),
    ];
    let counted = counted.map(|(tag, ways)| (tag.to_owned(), ways));
    assert_eq!(extract.summary.tags_taken_otherwise, BTreeMap::from(counted));
    let listed: Vec<(i64, &str)> = extract
        .defects
        .iter()
        .filter(|defect| matches!(defect, ExtractDefect::TagTakenOtherwise { .. }))
        .map(|defect| (defect.object().1, defect.detail().unwrap()))
        .collect();
    let expected = [
        (1, "layer=1000"),
        (3, "layer=1000"),
        (3, "tunnel=culvert"),
        (4, "tunnel=building_passage"),
        (5, "layer=1;2"),
        (6, "lanes=0"),
        (6, "width=narrow"),
    ];
    assert_eq!(listed, expected);
}

/// Ways that the table skips are counted by reason and value, with their lengths, and make no
/// junction in roads.
#[test]
fn ways_that_are_left_out_are_counted_with_their_lengths() {
    let mut block = BlockBuilder::with_row_of_nodes(9);
    block.track(1, &[1, 2, 3, 4]);
    block.way(2, &[("highway", "footway")], &[2, 3]);
    block.way(3, &[("highway", "footway")], &[3, 4, 5, 6]);
    block.way(4, &[("highway", "proposed")], &[1, 9]);
    block.way(5, &[("highway", "moat")], &[7, 8]);
    block.way(6, &[("highway", "track"), ("area", "yes")], &[7, 8, 9, 7]);
    // A node without a position has no length, and this is not a defect of roads.
    block.way(7, &[("highway", "path")], &[1, 99, 5, 6]);
    block.way(8, &[("highway", "path")], &[4]);
    // The id occurs twice: both count, as ways do.
    block.way(8, &[("highway", "path")], &[4, 5]);
    let extract = read_bytes(&file(&block)).unwrap();
    check_summary(&extract.summary);
    assert_eq!(extract.roads[0].fixed, [0, 3], "a footway is no junction");
    let (needed, missing) = (extract.summary.nodes_needed, extract.summary.nodes_missing);
    assert_eq!((needed, missing), (4, 0), "nodes of roads");
    // 1e-5 degrees at 47 degrees north are 0.760559 m, by the series for a degree of longitude.
    let step_um = 760_559_u64;
    let expected = [
        (LeftOutReason::ClassOff, "footway", 2, 4),
        (LeftOutReason::ClassOff, "path", 3, 2),
        (LeftOutReason::Listed, "proposed", 1, 8),
        (LeftOutReason::Unknown, "moat", 1, 1),
        (LeftOutReason::Area, "track", 1, 4),
    ];
    assert_eq!(extract.summary.left_out_ways.len(), expected.len());
    for (reason, highway, ways, steps) in expected {
        let found = extract.summary.left_out_ways[&(reason, highway.to_owned())];
        assert_eq!(found.ways, ways, "{highway}");
        assert!(found.length_um.abs_diff(steps * step_um) < 20 * steps, "{highway}: {found:?}");
    }
}

#[test]
fn ways_of_every_shape_are_roads_or_defects() {
    let row = || BlockBuilder::with_row_of_nodes(5);
    let way = |node_ids: &[i64]| {
        let mut block = row();
        block.track(7, node_ids);
        block
    };
    let too_few = |nodes| [ExtractDefect::TooFewNodes { way_id: 7, nodes }];
    let missing = |points| ExtractDefect::MissingNodes { way_id: 7, points };
    let duplicates = |points| ExtractDefect::DuplicatePoints { way_id: 7, points };
    let no_line = ExtractDefect::NoLine { way_id: 7 };
    check(&way(&[]), &[], &too_few(0));
    check(&way(&[1]), &[], &too_few(1));
    check(&way(&[99]), &[], &too_few(1));
    check(&way(&[1, 2]), &[(7, &[1, 2])], &[]);
    // The ways are closed, go back and forth, or pass one node twice.
    check(&way(&[1, 2, 1]), &[(7, &[1, 2, 1])], &[]);
    check(&way(&[1, 2, 3, 2, 5]), &[(7, &[1, 2, 3, 2, 5])], &[]);
    check(&way(&[1, 1, 2, 2, 2, 3]), &[(7, &[1, 2, 3])], &[duplicates(3)]);
    check(&way(&[1, 1]), &[], &[duplicates(1), no_line.clone()]);
    check(&way(&[1, 1, 1]), &[], &[duplicates(2), no_line.clone()]);
    // Nodes are missing at the start, in the middle, at the end, and everywhere.
    check(&way(&[99, 1, 2]), &[(7, &[1, 2])], &[missing(1)]);
    check(&way(&[1, 2, 99]), &[(7, &[1, 2])], &[missing(1)]);
    check(&way(&[99, 98]), &[], &[missing(2), no_line.clone()]);
    check(&way(&[1, 99]), &[], &[missing(1), no_line.clone()]);
    check(&way(&[1, 99, 1]), &[], &[missing(1), no_line.clone()]);
    let split = ExtractDefect::Split { way_id: 7, roads: 2 };
    check(&way(&[1, 2, 99, 4, 5]), &[(7, &[1, 2]), (7, &[4, 5])], &[missing(1), split]);
    let stray = ExtractDefect::StrayPoints { way_id: 7, points: 1 };
    check(&way(&[1, 2, 99, 4, 99]), &[(7, &[1, 2])], &[missing(2), stray]);
}

#[test]
fn a_way_may_be_longer_than_osm_allows() {
    let mut block = BlockBuilder::with_row_of_nodes(2001);
    let ids: Vec<i64> = (1..=2001).collect();
    block.track(7, &ids);
    check(&block, &[(7, &ids)], &[]);
}

#[test]
fn a_way_that_runs_to_and_fro_a_million_times_does_not_take_forever() {
    let mut block = BlockBuilder::new();
    let nodes: Vec<_> = (0..1000).map(|id| (id, id % 7, 1_000_000 * (id % 2))).collect();
    block.dense(&nodes);
    let ids: Vec<i64> = (0..300_000).map(|number| number * 7919 % 1000).collect();
    block.track(7, &ids);
    let extract = read_bytes(&file(&block)).unwrap();
    assert_eq!(extract.roads.len(), 1);
    assert!(extract.reasons().contains_key("self-crossing"));
}

#[test]
fn ids_may_be_negative_or_at_the_ends_of_what_there_is() {
    for [a, b] in
        [[i64::MIN, i64::MIN + 1], [i64::MAX - 1, i64::MAX], [-1, 0], [0, 1], [-1, 1 << 40]]
    {
        let mut block = BlockBuilder::new();
        block.dense(&[(a, 0, 90_000_100), (b, 0, 90_000_200)]);
        block.track(a, &[a, b]);
        block.track(b, &[b, a]);
        check(&block, &[(a, &[1, 2]), (b, &[2, 1])], &[]);
    }
}

#[test]
fn objects_may_come_in_any_order_and_in_any_blob() {
    let nodes = BlockBuilder::with_row_of_nodes(4).bytes();
    let mut ways = BlockBuilder::new();
    ways.track(8, &[3, 4]);
    ways.track(7, &[1, 2, 3]);
    let ways = ways.bytes();
    let mut one = BlockBuilder::with_row_of_nodes(4);
    one.track(8, &[3, 4]);
    one.track(7, &[1, 2, 3]);
    let expected = read_bytes(&file(&one)).unwrap();
    for blocks in [[&nodes, &ways], [&ways, &nodes]] {
        for blob in [raw, packed_blob] {
            let blobs: Vec<u8> = blocks.iter().flat_map(|block| blob(b"OSMData", block)).collect();
            assert_eq!(read_bytes(&[plain_header(), blobs].concat()).unwrap(), expected);
        }
    }
}

#[test]
fn nodes_with_two_places_or_none_on_earth_are_defects() {
    let mut block = BlockBuilder::new();
    // Node 2 occurs twice and the first stays; node 3 is at latitude 1000, node 4 at longitude
    // -181, node 5 at the limit of both axes.
    block.dense(&[(1, 0, 90_000_100), (2, 0, 90_000_200), (2, 0, 90_000_300)]);
    block.plain(&[(3, 10_000_000_000, 0), (4, 0, -1_810_000_000), (5, 900_000_000, 90_000_500)]);
    block.track(7, &[1, 2, 3, 4, 5, 1]);
    check(
        &block,
        &[(7, &[1, 2]), (7, &[5, 1])],
        &[
            ExtractDefect::ConflictingNode { node_id: 2 },
            ExtractDefect::OutOfRange { way_id: 7, points: 2 },
            ExtractDefect::Split { way_id: 7, roads: 2 },
        ],
    );
}

#[test]
fn granularity_and_offsets_are_heeded() {
    let mut block = BlockBuilder::new();
    block.dense(&[(1, 47, 9), (2, 47, 10)]);
    block.frame =
        [number(17, 1_000_000_000), number(19, 500_000_000), number(20, -250_000_000)].concat();
    block.track(7, &[1, 2]);
    let extract = read_bytes(&file(&block)).unwrap();
    let points: Vec<_> = extract.roads[0].line.points().iter().map(|p| (p.u, p.v)).collect();
    assert_eq!(points, [(87_500_000, 475_000_000), (97_500_000, 475_000_000)]);
}

#[test]
fn a_place_that_libosmium_did_not_know_is_a_missing_node() {
    // `osmium add-locations-to-ways --ignore-missing-nodes` writes this for node 2.
    let unknown = i64::from(i32::MAX);
    let mut block = BlockBuilder::new();
    let message = block.way_message(7, &[("highway", "track")], &[1, 2, 3, 4]);
    let lats = deltas(&[0, unknown, 0, 0]);
    let lons = deltas(&[90_000_100, unknown, 90_000_300, 90_000_400]);
    block.groups.push(field(3, &[message, field(9, &lats), field(10, &lons)].concat()));
    let missing = ExtractDefect::MissingNodes { way_id: 7, points: 1 };
    let stray = ExtractDefect::StrayPoints { way_id: 7, points: 1 };
    check(&block, &[(7, &[3, 4])], &[missing, stray]);
    assert_eq!(read_bytes(&file(&block)).unwrap().summary.nodes_missing, 1);
}

#[test]
fn texts_longer_than_osm_allows_are_cut_and_damaged_ones_mended() {
    #[track_caller]
    fn check(name: &[u8], expected: &str, reasons: &[&str]) {
        let mut block = BlockBuilder::with_row_of_nodes(2);
        let [key, value] = [block.text(b"name"), block.text(name)];
        let tags = [block.text(b"highway"), block.text(b"track")];
        let way = [
            number(1, 7),
            field(2, &[tags[0] as u8, key as u8]),
            field(3, &[tags[1] as u8, value as u8]),
            field(8, &deltas(&[1, 2])),
        ];
        block.groups.push(field(3, &way.concat()));
        let extract = read_bytes(&file(&block)).unwrap();
        assert_eq!(extract.roads[0].attributes.name, expected);
        assert_eq!(extract.reasons().into_keys().collect::<Vec<_>>(), reasons);
    }
    check("Fürst-Franz-Josef-Straße".as_bytes(), "Fürst-Franz-Josef-Straße", &[]);
    check("ß".repeat(255).as_bytes(), &"ß".repeat(255), &[]);
    check("ß".repeat(256).as_bytes(), &"ß".repeat(255), &["long text"]);
    check("\u{1f6e3}".repeat(255).as_bytes(), &"\u{1f6e3}".repeat(255), &[]);
    check("\u{1f6e3}".repeat(999).as_bytes(), &"\u{1f6e3}".repeat(255), &["long text"]);
    // The limit of 1020 bytes is within a letter of two bytes.
    check(
        format!("x{}", "ß".repeat(999)).as_bytes(),
        &format!("x{}", "ß".repeat(254)),
        &["long text"],
    );
    check(&vec![b'x'; 100_000], &"x".repeat(255), &["long text"]);
    check(b"Stra\xdfe", "Stra\u{fffd}e", &["damaged text"]);
    check(b"Stra\xc3", "Stra\u{fffd}", &["damaged text"]);
    check(&[0xff; 300], &"\u{fffd}".repeat(255), &["damaged text", "long text"]);
}

#[test]
fn a_defect_says_what_it_is_about() {
    #[track_caller]
    fn check(
        defect: &ExtractDefect,
        object: (&str, i64),
        count: Option<u32>,
        detail: Option<&str>,
    ) {
        assert_eq!((defect.object(), defect.count(), defect.detail()), (object, count, detail));
    }
    let value = "goat_trail".to_owned();
    check(
        &ExtractDefect::UnknownHighway { way_id: -3, value },
        ("way", -3),
        None,
        Some("goat_trail"),
    );
    check(&ExtractDefect::MissingNodes { way_id: 4, points: 2 }, ("way", 4), Some(2), None);
    check(&ExtractDefect::Split { way_id: 4, roads: 3 }, ("way", 4), Some(3), None);
    check(&ExtractDefect::TooFewNodes { way_id: 4, nodes: 0 }, ("way", 4), Some(0), None);
    check(&ExtractDefect::ConflictingNode { node_id: 5 }, ("node", 5), None, None);
    check(&ExtractDefect::NoLine { way_id: 6 }, ("way", 6), None, None);
}

/// A way of a random extract.
#[derive(Debug, Clone)]
struct MadeWay {
    id: i64,
    highway: Option<&'static str>,
    is_area: bool,
    node_ids: Vec<i64>,
}

fn made_way() -> impl Strategy<Value = MadeWay> {
    let highway = prop::sample::select(vec![
        Some("track"),
        Some("track"),
        Some("motorway_link"),
        Some("footway"),
        Some("construction"),
        Some("goat_trail"),
        Some(""),
        None,
    ]);
    let node_ids = prop::collection::vec(-2_i64..14, 0..7);
    (-4_i64..12, highway, prop::bool::weighted(0.2), node_ids)
        .prop_map(|(id, highway, is_area, node_ids)| MadeWay { id, highway, is_area, node_ids })
}

/// Generates latitude and longitude of a node on a small grid, so that positions coincide; some are
/// not on Earth.
fn made_node() -> impl Strategy<Value = (i64, i64, i64)> {
    let part = prop_oneof![20 => 0_i64..3, 1 => Just(2_000_000_000)];
    (-2_i64..12, part.clone(), part)
}

/// Computes the fate of the ways independently of the reader: in the file's order, of each id the
/// first road way.
fn expected(
    ways: &[MadeWay],
    nodes: &[(i64, i64, i64)],
) -> (BTreeMap<i64, usize>, BTreeMap<&'static str, u64>) {
    let on_earth = |&&(_, lat, lon): &&(i64, i64, i64)| lat <= 900_000_000 && lon <= 1_800_000_000;
    let place = |id: i64| {
        nodes.iter().filter(on_earth).find(|node| node.0 == id).map(|node| (node.1, node.2))
    };
    let (mut roads, mut lost) = (BTreeMap::new(), BTreeMap::new());
    let mut taken = BTreeSet::new();
    for way in ways {
        let mut lose = |reason| *lost.entry(reason).or_default() += 1;
        match way.highway {
            None => {}
            Some("goat_trail" | "") => lose("unknown"),
            Some("construction") => lose("listed"),
            Some(_) if way.is_area => lose("area"),
            Some("footway") => lose("class off"),
            Some(_) if !taken.insert(way.id) => lose("duplicate"),
            Some(_) => {
                let places: Vec<_> = way.node_ids.iter().map(|&id| place(id)).collect();
                let pieces = places
                    .split(Option::is_none)
                    .filter(|piece| piece.iter().any(|place| place != &piece[0]))
                    .count();
                if pieces > 0 {
                    roads.insert(way.id, pieces);
                } else {
                    lose("without line");
                }
            }
        }
    }
    (roads, lost)
}

fn read_made(
    ways: &[MadeWay],
    nodes: &[(i64, i64, i64)],
    per_block: usize,
    is_ways_first: bool,
) -> Extract {
    let mut blobs = Vec::new();
    for some in nodes.chunks(per_block) {
        let mut block = BlockBuilder::new();
        let half = some.len() / 2;
        block.dense(&some[..half]);
        block.plain(&some[half..]);
        blobs.push(packed_blob(b"OSMData", &block.bytes()));
    }
    let node_blobs = blobs.len();
    for some in ways.chunks(per_block) {
        let mut block = BlockBuilder::new();
        for way in some {
            let mut tags: Vec<(&str, &str)> =
                way.highway.map(|value| ("highway", value)).into_iter().collect();
            tags.extend(way.is_area.then_some(("area", "yes")));
            block.way(way.id, &tags, &way.node_ids);
        }
        blobs.push(raw(b"OSMData", &block.bytes()));
    }
    if is_ways_first {
        blobs.rotate_left(node_blobs);
    }
    read_bytes(&[plain_header(), blobs.concat()].concat()).unwrap()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn every_way_is_a_road_or_counted_under_the_one_right_reason(
        ways in prop::collection::vec(made_way(), 0..20),
        nodes in prop::collection::vec(made_node(), 0..25),
        per_block in 1_usize..9,
        is_ways_first: bool,
    ) {
        let extract = read_made(&ways, &nodes, per_block, is_ways_first);
        let (roads, lost) = expected(&ways, &nodes);
        let mut found = BTreeMap::new();
        for road in &extract.roads {
            *found.entry(road.way_id).or_insert(0) += 1;
        }
        prop_assert_eq!(found, roads);
        let left_out = extract.summary.left_out;
        let counts = [
            ("unknown", left_out.unknown),
            ("listed", left_out.listed),
            ("area", left_out.area),
            ("class off", left_out.class_off),
            ("duplicate", left_out.duplicate),
            ("without line", left_out.without_line),
        ];
        let counts: BTreeMap<_, _> = counts.into_iter().filter(|&(_, count)| count > 0).collect();
        prop_assert_eq!(counts, lost);
        prop_assert_eq!(extract.summary.ways_seen, ways.len() as u64);
    }
}
