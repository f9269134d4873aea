//! Small extracts written by hand (`tests/fixtures/*.osm`, converted to PBF by osmium) with a known
//! result.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::{
    collections::BTreeMap,
    sync::atomic::{AtomicUsize, Ordering},
};

use crate::common::{Extract, fixture, read, read_with, request, roads::read_roads, to_lattice};
use corniche_geom::LatticePoint;
use corniche_osm::{ExtractDefect, ReadOsmError};
use corniche_roads::{Form, Oneway, Road, Structure};
use corniche_testing::MemoryScratch;

fn road(extract: &Extract, way_id: i64) -> &Road {
    extract.roads.iter().find(|road| road.way_id == way_id).unwrap()
}

fn points(road: &Road) -> Vec<(i64, i64)> {
    // The unit is a hundredth of a degree: the fixtures use no finer coordinates.
    road.line.points().iter().map(|p| (p.u / 100_000, p.v / 100_000)).collect()
}

#[test]
fn every_class_comes_out_as_the_table_says() {
    let extract = read(&fixture("classes.osm.pbf")).unwrap();
    let classes: Vec<(i64, u8)> =
        extract.roads.iter().map(|road| (road.way_id, road.class.number())).collect();
    let expected =
        [(10, 0), (11, 0), (12, 1), (13, 2), (14, 3), (15, 4), (16, 5), (17, 6), (18, 7), (19, 6)];
    assert_eq!(classes, expected);

    let summary = &extract.summary;
    assert_eq!((summary.nodes_seen, summary.nodes_needed, summary.nodes_missing), (8, 8, 0));
    assert_eq!((summary.ways_seen, summary.highway_ways, summary.road_ways), (15, 14, 10));
    let left_out = summary.left_out;
    assert_eq!(
        (left_out.listed, left_out.class_off, left_out.unknown, left_out.area),
        (1, 1, 1, 1)
    );
    assert_eq!(summary.unknown_highways, BTreeMap::from([("goat_trail".to_owned(), 1)]));
    let residential = summary.highways["residential"];
    assert_eq!((residential.class.unwrap().number(), residential.ways), (6, 2));
    assert_eq!(summary.highways["construction"].class, None);
    assert_eq!(summary.generator.as_deref(), Some("osmium"));
    assert_eq!(
        extract.defects,
        [
            ExtractDefect::Area { way_id: 21 },
            ExtractDefect::UnknownHighway { way_id: 23, value: "goat_trail".into() }
        ]
    );
}

#[test]
fn tags_and_places_come_through() {
    let extract = read(&fixture("classes.osm.pbf")).unwrap();
    let attributes = |way_id| &road(&extract, way_id).attributes;
    assert_eq!(points(road(&extract, 10)), [(950, 4710), (951, 4710), (952, 4710)]);
    assert_eq!(
        (attributes(10).reference.as_str(), attributes(10).oneway),
        ("A 13", Oneway::Forward)
    );
    assert_eq!(attributes(11).form, Form::Link);
    assert_eq!((attributes(12).structure, attributes(12).layer), (Structure::Bridge, 1));
    assert_eq!((attributes(13).structure, attributes(13).layer), (Structure::Tunnel, -1));
    assert_eq!((&*attributes(14).name, &*attributes(14).surface), ("Landstraße", "asphalt"));
    assert_eq!(attributes(19).form, Form::Roundabout);
}

#[test]
fn nodes_that_roads_share_are_fixed() {
    let extract = read(&fixture("classes.osm.pbf")).unwrap();
    // Ways 10, 11 and 16 share node 2; ways 11 and 18 share node 4; way 19 shares nodes 6 and 7
    // with ways 13 and 14.
    assert_eq!(road(&extract, 10).fixed, [0, 1, 2]);
    assert_eq!(road(&extract, 11).fixed, [0, 1, 2]);
    assert_eq!(road(&extract, 19).fixed, [0, 1, 2, 3]);
    // In the other file, only a duplicate of way 30, which is skipped, shares its node 2.
    let crossing = read(&fixture("crossing.osm.pbf")).unwrap();
    assert_eq!(road(&crossing, 30).fixed, [0, 2, 3]);
}

#[test]
fn one_file_written_in_four_ways_gives_the_same_roads() {
    let dense = read(&fixture("classes.osm.pbf")).unwrap();
    let plain = read(&fixture("classes-plain-raw.osm.pbf")).unwrap();
    assert_eq!(dense, plain);
    let located = read(&fixture("classes-located.osm.pbf")).unwrap();
    assert_eq!((&dense.roads, &dense.defects), (&located.roads, &located.defects));
    assert_eq!(located.summary.nodes_seen, 0, "its nodes are in its ways alone");
}

#[test]
fn missing_nodes_cut_a_way_and_never_join_it() {
    let extract = read(&fixture("defects.osm.pbf")).unwrap();
    let roads: Vec<_> = extract.roads.iter().map(|road| (road.way_id, points(road))).collect();
    assert_eq!(
        roads,
        [
            (-16, vec![(951, 4710), (953, 4710), (100, 100), (953, 4711)]),
            (-15, vec![(950, 4710), (953, 4711)]),
            (-13, vec![(950, 4710), (951, 4710)]),
            (-10, vec![(950, 4710), (951, 4710)]),
            (-10, vec![(952, 4710), (953, 4710)]),
        ]
    );
    assert_eq!(
        extract.defects,
        [
            ExtractDefect::TooFewNodes { way_id: -17, nodes: 0 },
            // On its way back from node -7, the way passes (952.8, 4710), between nodes -2 and -4.
            ExtractDefect::SelfCrossing { way_id: -16, crossings: 1 },
            ExtractDefect::MissingNodes { way_id: -15, points: 2 },
            ExtractDefect::DuplicatePoints { way_id: -14, points: 1 },
            ExtractDefect::NoLine { way_id: -14 },
            ExtractDefect::DuplicatePoints { way_id: -13, points: 2 },
            ExtractDefect::MissingNodes { way_id: -12, points: 2 },
            ExtractDefect::NoLine { way_id: -12 },
            ExtractDefect::TooFewNodes { way_id: -11, nodes: 1 },
            ExtractDefect::MissingNodes { way_id: -10, points: 1 },
            ExtractDefect::Split { way_id: -10, roads: 2 },
        ]
    );
    assert_eq!((extract.summary.nodes_needed, extract.summary.nodes_missing), (10, 3));
    assert_eq!((extract.summary.road_ways, extract.summary.left_out.without_line), (4, 4));
}

#[test]
fn points_that_the_projection_has_no_place_for_cut_a_way() {
    let near = |positions_deg: &[[f64; 2]]| {
        let far = |p: &[f64; 2]| p[0] < 9.0;
        let placed = to_lattice(positions_deg);
        positions_deg.iter().zip(placed).map(|(p, point)| point.filter(|_| !far(p))).collect()
    };
    let extract = read_with(&fixture("defects.osm.pbf"), 2, &near).unwrap();
    assert_eq!(points(road(&extract, -16)), [(951, 4710), (953, 4710)]);
    assert!(extract.defects.contains(&ExtractDefect::OutsideProjection { way_id: -16, points: 1 }));
    assert!(extract.defects.contains(&ExtractDefect::StrayPoints { way_id: -16, points: 1 }));
}

#[test]
fn of_ways_with_one_id_the_first_stays() {
    let extract = read(&fixture("crossing.osm.pbf")).unwrap();
    let roads: Vec<_> = extract.roads.iter().map(|r| (r.way_id, r.line.points().len())).collect();
    assert_eq!(roads, [(29, 2), (30, 4)]);
    assert_eq!(
        extract.defects,
        [
            ExtractDefect::DuplicateWay { way_id: 30 },
            ExtractDefect::SelfCrossing { way_id: 30, crossings: 1 }
        ]
    );
    assert_eq!(extract.summary.left_out.duplicate, 1);
}

#[test]
fn names_a_compression_that_it_does_not_know() {
    let error = read(&fixture("classes-lz4.osm.pbf")).unwrap_err();
    assert!(matches!(error, ReadOsmError::Compression { method: "LZ4", .. }), "{error}");
    assert!(error.to_string().contains("osmium cat"), "{error}");
}

#[test]
fn a_history_is_refused() {
    let error = read(&fixture("history.osh.pbf")).unwrap_err();
    assert!(matches!(error, ReadOsmError::History { .. }), "{error}");
}

#[test]
fn refuses_a_place_that_loses_points() {
    let error = read_with(&fixture("classes.osm.pbf"), 2, &|_| Vec::<Option<LatticePoint>>::new());
    assert!(matches!(error, Err(ReadOsmError::Place { got: 0, .. })));
}

#[test]
fn stops_when_asked_at_any_time() {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(2).build().unwrap();
    let (path, scratch) = (fixture("classes.osm.pbf"), MemoryScratch::default());
    let request = request(&path, &pool, &to_lattice, &scratch);
    for allowed in 0..3 {
        let asked = AtomicUsize::new(0);
        let should_stop = || asked.fetch_add(1, Ordering::Relaxed) >= allowed;
        let result = read_roads(&request, &mut |_| {}, &mut |_| {}, &should_stop);
        assert!(matches!(result, Err(ReadOsmError::Stopped { .. })), "after {allowed}");
    }
}
