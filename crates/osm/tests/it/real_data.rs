//! Real extracts of the developers' data set have the counts that osmium-tool 1.15.0 gives.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::collections::BTreeMap;

use crate::common::{Extract, read, read_with, to_lattice};
use corniche_osm::ReadOsmError;
use corniche_testing::real_data;

/// Checks the ways per `highway` value, from `osmium tags-filter -R FILE w/highway` and
/// `osmium tags-count`.
#[track_caller]
fn check_counts(extract: &Extract, expected: &[(&str, u64)]) {
    let counts: BTreeMap<&str, u64> = extract
        .summary
        .highways
        .iter()
        .map(|(value, count)| (value.as_str(), count.ways))
        .collect();
    assert_eq!(counts, expected.iter().copied().collect());
    assert_eq!(extract.summary.unknown_highways, BTreeMap::new());
    assert_eq!(extract.summary.highway_ways, counts.values().sum::<u64>());
}

#[test]
fn liechtenstein_2021_is_counted_as_osmium_counts_it() {
    let Some(path) = real_data("liechtenstein/liechtenstein-2021-10-28.osm.pbf") else { return };
    let extract = read(&path).unwrap();
    let expected = [
        ("service", 1637),
        ("track", 1246),
        ("residential", 1177),
        ("path", 950),
        ("footway", 647),
        ("secondary", 426),
        ("unclassified", 298),
        ("cycleway", 238),
        ("steps", 156),
        ("tertiary", 87),
        ("primary", 79),
        ("pedestrian", 16),
        ("platform", 12),
        ("bridleway", 4),
        ("living_street", 3),
        ("secondary_link", 3),
        ("raceway", 2),
        ("primary_link", 1),
        ("rest_area", 1),
        ("road", 1),
    ];
    check_counts(&extract, &expected);
    let summary = &extract.summary;
    assert_eq!((summary.nodes_seen, summary.ways_seen), (295_005, 29_874));
    assert_eq!((summary.highway_ways, summary.nodes_missing), (6984, 0));
    assert_eq!(summary.roads, summary.road_ways, "no way lacks a node");
    let bounds_deg = summary.header_bounds_deg.unwrap();
    for (bound, expected) in
        bounds_deg.into_iter().zip([9.471_078, 47.047_74, 9.636_217, 47.271_28])
    {
        assert!((bound - expected).abs() < 1e-9);
    }
}

/// The contents of an extract, and what becomes of them.
///
/// Nodes, ways and highways are osmium's own counts (`osmium fileinfo -e`,
/// `osmium tags-filter -R FILE w/highway`); the others were counted separately in the text that
/// `osmium cat -f opl` writes.
struct Figures {
    nodes: u64,
    ways: u64,
    highways: u64,
    nodes_needed: u64,
    nodes_missing: u64,
    ways_cut: usize,
    roads: u64,
    ways_without_line: u64,
}

#[track_caller]
fn check_figures(name: &str, expected: &Figures) {
    let Some(path) = real_data(name) else { return };
    let extract = read(&path).unwrap();
    let summary = &extract.summary;
    assert_eq!((summary.nodes_seen, summary.ways_seen), (expected.nodes, expected.ways), "{name}");
    assert_eq!(summary.highway_ways, expected.highways, "{name}");
    let nodes = (summary.nodes_needed, summary.nodes_missing);
    assert_eq!(nodes, (expected.nodes_needed, expected.nodes_missing), "{name}");
    let cut = extract.reasons().get("missing nodes").copied().unwrap_or_default();
    assert_eq!(cut, expected.ways_cut, "{name}");
    assert_eq!(summary.roads, expected.roads, "{name}");
    assert_eq!(summary.left_out.without_line, expected.ways_without_line, "{name}");
    assert_eq!((summary.left_out.duplicate, summary.blobs_passed_over), (0, 0), "{name}");
}

#[test]
fn every_extract_of_the_data_set_gives_the_figures_counted_apart() {
    let whole = |nodes, ways, highways, nodes_needed, roads| Figures {
        nodes,
        ways,
        highways,
        nodes_needed,
        nodes_missing: 0,
        ways_cut: 0,
        roads,
        ways_without_line: 0,
    };
    for (name, expected) in [
        (
            "liechtenstein/liechtenstein-2021-10-28.osm.pbf",
            whole(295_005, 29_874, 6984, 41_952, 4964),
        ),
        ("liechtenstein/liechtenstein-2013-08-03.osm.pbf", whole(65_733, 7121, 2753, 20_215, 2186)),
        ("portland/portland-central-filtered.osm.pbf", whole(42_293, 7188, 7182, 28_214, 4555)),
        ("swellendam/swellendam-roads.osm.pbf", whole(8624, 717, 717, 5979, 675)),
        ("nasty/osm/empty.osm.pbf", whole(0, 0, 0, 0, 0)),
        ("nasty/osm/loc_on_ways.osm.pbf", whole(0, 1, 0, 0, 0)),
        ("nasty/osm/nozlib_nodense.osm.pbf", whole(3, 1, 0, 0, 0)),
        (
            "nasty/osm/r5-missing-nodes.osm.pbf",
            Figures { nodes_missing: 1, ways_cut: 1, ..whole(4, 2, 1, 5, 1) },
        ),
        (
            "nasty/derived-osm/simple-extract-missing-nodes.osm.pbf",
            Figures {
                nodes_missing: 99,
                ways_cut: 16,
                ways_without_line: 4,
                ..whole(5300, 644, 431, 2269, 316)
            },
        ),
    ] {
        check_figures(name, &expected);
    }
}

#[test]
fn portland_is_read_although_it_is_not_sorted() {
    let Some(path) = real_data("portland/portland-central-filtered.osm.pbf") else { return };
    let extract = read(&path).unwrap();
    assert_eq!((extract.summary.nodes_seen, extract.summary.ways_seen), (42_293, 7188));
    assert_eq!(
        (extract.summary.highways["motorway_link"].ways, extract.summary.highway_ways),
        (161, 7182)
    );
    assert_eq!(extract.summary.nodes_missing, 0);
}

#[test]
fn every_number_of_threads_gives_the_same() {
    for name in [
        "liechtenstein/liechtenstein-2021-10-28.osm.pbf",
        "portland/portland-central-filtered.osm.pbf",
    ] {
        let Some(path) = real_data(name) else { return };
        let alone = read_with(&path, 1, &to_lattice).unwrap();
        assert_eq!(alone, read_with(&path, 2, &to_lattice).unwrap());
        assert_eq!(alone, read_with(&path, 8, &to_lattice).unwrap());
    }
}

#[test]
fn extracts_that_cannot_be_read_are_refused_with_the_reason() {
    let error = |name: &str| Some(read(&real_data(name)?).unwrap_err());
    if let Some(error) = error("nasty/osm/deleted_nodes.osh.pbf") {
        assert!(matches!(error, ReadOsmError::History { .. }), "{error}");
    }
    if let Some(error) = error("nasty/osm/monaco-latest.lz4.osm.pbf") {
        assert!(matches!(error, ReadOsmError::Compression { method: "LZ4", .. }), "{error}");
    }
    if let Some(error) = error("nasty/derived-osm/truncated-half.osm.pbf") {
        assert!(matches!(error, ReadOsmError::Truncated { .. }), "{error}");
    }
    if let Some(error) = error("nasty/derived-osm/zero-bytes.osm.pbf") {
        assert!(matches!(error, ReadOsmError::Empty { .. }), "{error}");
    }
}
