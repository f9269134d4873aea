//! Railways are delivered beside roads where bridges and tunnels are requested, each once, also
//! with a `highway` tag that is not that of a road.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::{io::Cursor, path::Path};

use corniche_osm::{
    ExtractDefect, ExtractSummary, LayerSink, Layers, ReadRequest, read_extract_from,
};
use corniche_roads::{Railway, Road, Structure};
use corniche_testing::{
    MemoryScratch,
    pbf::{BlockBuilder, file},
};

use crate::common::{POOL, request, to_lattice};

/// The ids of roads, and the other ways with their kinds and structures.
#[derive(Debug, Default, PartialEq)]
struct Ways {
    roads: Vec<i64>,
    carriers: Vec<(i64, Option<Railway>, Structure, i8)>,
    summary: ExtractSummary,
}

impl LayerSink<Road, ExtractSummary> for Ways {
    fn take(&mut self, road: Road) {
        self.roads.push(road.way_id);
    }

    fn take_carrier(&mut self, road: Road, railway: Option<Railway>) {
        let attributes = &road.attributes;
        self.carriers.push((road.way_id, railway, attributes.structure, attributes.layer));
    }

    fn end(&mut self, summary: ExtractSummary) {
        self.summary = summary;
    }
}

fn read(block: &BlockBuilder, node_ids: bool) -> (Ways, Vec<ExtractDefect>) {
    let scratch = MemoryScratch::default();
    let path = Path::new("made.osm.pbf");
    let request = ReadRequest { node_ids, ..request(path, &POOL, &to_lattice, &scratch) };
    let (mut ways, mut defects) = (Ways::default(), Vec::new());
    let layers = Layers { roads: Some(&mut ways), ..Layers::default() };
    let on_defect = &mut |defect| defects.push(defect);
    read_extract_from(Cursor::new(file(block)), &request, layers, on_defect, &|| false).unwrap();
    (ways, defects)
}

fn block() -> BlockBuilder {
    let mut block = BlockBuilder::with_row_of_nodes(6);
    let bridge = [("railway", "rail"), ("bridge", "yes"), ("layer", "1")];
    for (id, tags) in [
        (1, &[("highway", "primary")][..]),
        (2, &bridge),
        (3, &[("railway", "tram"), ("tunnel", "yes")]),
        (4, &[("railway", "abandoned")]),
        (5, &[("railway", "tram"), ("highway", "construction"), ("bridge", "yes")]),
        (6, &[("highway", "construction"), ("bridge", "yes")]),
        (7, &[("railway", "rail"), ("area", "yes")]),
    ] {
        block.way(id, tags, &[1, 2, 3]);
    }
    // A railway that is twice in the file counts once.
    block.way(2, &bridge, &[1, 2, 3]);
    block
}

#[test]
fn railways_are_delivered_with_their_kinds_and_structures() {
    let (ways, defects) = read(&block(), true);
    assert_eq!(ways.roads, [1]);
    let expected = [
        (2, Some(Railway::Rail), Structure::Bridge, 1),
        (3, Some(Railway::Tram), Structure::Tunnel, 0),
        (5, Some(Railway::Tram), Structure::Bridge, 0),
    ];
    assert_eq!(ways.carriers, expected);
    // They are counted nowhere: only ways with a `highway` tag are.
    assert_eq!((ways.summary.highway_ways, ways.summary.left_out.listed), (3, 2));
    assert!(defects.is_empty(), "{defects:?}");
}

#[test]
fn without_bridges_and_tunnels_no_railway_is_read() {
    let [(with, _), (without, _)] = [true, false].map(|node_ids| read(&block(), node_ids));
    assert_eq!((without.roads, without.carriers), (vec![1], Vec::new()));
    assert_eq!(with.summary.left_out, without.summary.left_out);
}
