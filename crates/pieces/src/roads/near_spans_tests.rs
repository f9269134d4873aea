//! Roads near a bridge are stored: a road that continues at its end, and one that crosses it,
//! whatever its class.

use corniche_store::MemoryStore;
use corniche_testing::MemoryScratch;
use corniche_work::Silent;

use super::*;

/// Points with the ids of their nodes.
type Points<'a> = &'a [(i64, i64, Option<i64>)];

fn road(way_id: i64, structure: Structure, points: Points<'_>) -> Road {
    let line: Vec<LatticePoint> = points.iter().map(|&(u, v, _)| LatticePoint::new(u, v)).collect();
    Road {
        way_id,
        class: FunctionalRoadClass::new(3).unwrap(),
        attributes: RoadAttributes { structure, ..RoadAttributes::default() },
        fixed: (0..line.len() as u32).collect(),
        node_ids: points.iter().map(|&(.., id)| id).collect(),
        line: Polyline::new(line).unwrap(),
        same_places: Vec::new(),
        met: MetNodes::default(),
    }
}

/// The stored roads, of which some reach the requested region.
fn kept(roads: &[(Option<u32>, Road, bool)]) -> Vec<NearRoad> {
    let store = MemoryStore::default();
    let scratch = MemoryScratch::default();
    let mut writer = NearRoadsWriter::new(&scratch, 1 << 20);
    for (ordinal, road, is_reached) in roads {
        let segments_um = vec![1000; road.line.points().len() - 1];
        writer.push(NearRoad::from_road(road, *ordinal, &segments_um, *is_reached)).unwrap();
    }
    writer.finish((&store, &Silent), 100.0).unwrap();
    let mut kept = Vec::new();
    for_each(&store, |road| kept.push(road)).unwrap();
    kept
}

const BRIDGE: Points<'_> = &[(0, 0, Some(7)), (1000, 0, None), (2000, 0, Some(8))];

/// A bridge, a road that continues at its end, one that crosses it and has no requested class, and
/// one far away. They are read in any order.
#[test]
fn what_lies_near_a_bridge_is_kept() {
    let crossing = [(1500, -900, None), (1500, 900, None), (1500, 5000, None)];
    let kept = kept(&[
        (None, road(3, Structure::Ground, &crossing), true),
        (Some(11), road(2, Structure::Bridge, BRIDGE), true),
        (Some(12), road(4, Structure::Ground, &[(0, 800, None), (2000, 800, None)]), true),
        (
            Some(10),
            road(1, Structure::Ground, &[(-9000, 0, None), (-500, 0, None), (0, 0, Some(7))]),
            true,
        ),
    ]);
    let found: Vec<(i64, Option<u32>, usize)> =
        kept.iter().map(|road| (road.way_id, road.ordinal, road.points.len())).collect();
    // Of the first road, the segment at the bridge's end is stored; of the third, the segment that
    // crosses.
    assert_eq!(found, [(1, Some(10), 2), (2, Some(11), 3), (3, None, 2)]);
    let bridge = kept[1].road().unwrap();
    assert_eq!((bridge.fixed, bridge.node_ids), (vec![0, 2], vec![Some(7), Some(8)]));
    let before = kept[0].road().unwrap();
    assert_eq!((before.fixed, before.node_ids), (vec![0, 1], vec![None, Some(7)]));
}

/// Bridges beyond the requested region are stored if one that reaches it depends on them: it
/// continues in them, or crosses them.
#[test]
fn bridges_that_others_depend_on_are_kept() {
    let beyond = [(2000, 0, Some(8)), (5000, 0, Some(9))];
    let above = [(4000, -500, None), (4000, 500, None)];
    let far = [(9000, 0, None), (9900, 0, None)];
    let kept = kept(&[
        (Some(0), road(1, Structure::Bridge, BRIDGE), true),
        (Some(1), road(2, Structure::Bridge, &beyond), false),
        (Some(2), road(3, Structure::Bridge, &above), false),
        (Some(3), road(4, Structure::Bridge, &far), false),
    ]);
    assert_eq!(kept.iter().map(|road| road.way_id).collect::<Vec<_>>(), [1, 2, 3]);
}

/// A node counts even if only ways of other classes join there.
#[test]
fn nodes_of_other_classes_count() {
    let met = MetNodes { nodes: vec![(1, 5)], same_places: vec![[5, 6]] };
    let bridge = Road { met, ..road(1, Structure::Bridge, BRIDGE) };
    let kept = kept(&[(Some(0), bridge, true)]);
    let road = kept[0].road().unwrap();
    assert_eq!(road.node_ids, [Some(7), Some(5), Some(8)]);
    assert_eq!(road.same_places, [[5, 6]]);
}
