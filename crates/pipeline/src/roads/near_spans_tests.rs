//! What lies near a bridge is kept: a road that goes on at its end, and one that crosses it.

use std::sync::Arc;

use corniche_geom::TileId;
use corniche_store::MemoryStore;

use super::*;
use crate::roads::pieces::{Run, TilePiecesWriter};

fn piece(way_id: i64, structure: Structure, points: &[(i64, i64, Option<i64>)]) -> RoadPiece {
    let line: Vec<LatticePoint> = points.iter().map(|&(u, v, _)| LatticePoint::new(u, v)).collect();
    let nodes = points.iter().enumerate().filter_map(|(at, (.., id))| Some((at as u32, (*id)?)));
    RoadPiece {
        way_id,
        class: FunctionalRoadClass::new(3).unwrap(),
        attributes: Arc::new(RoadAttributes { structure, ..RoadAttributes::default() }),
        source_points: 0,
        simplified_points: 0,
        runs: vec![Run {
            segments_um: vec![1000; line.len() - 1],
            line: Polyline::new(line).unwrap(),
            from_um: 500,
            nodes: nodes.collect(),
        }],
    }
}

/// A bridge, a road that goes on at its end, one that crosses it, and one far away.
#[test]
fn what_lies_near_a_bridge_is_kept() {
    let roads = [
        piece(1, Structure::Ground, &[(-9000, 0, None), (-500, 0, None), (0, 0, Some(7))]),
        piece(2, Structure::Bridge, &[(0, 0, Some(7)), (1000, 0, None), (2000, 0, Some(8))]),
        piece(3, Structure::Ground, &[(1500, -900, None), (1500, 900, None), (1500, 5000, None)]),
        piece(4, Structure::Ground, &[(0, 800, None), (2000, 800, None)]),
    ];
    let store = MemoryStore::default();
    let id = TileId::new(2, 1, 1).unwrap();
    let mut writer = TilePiecesWriter::default();
    for (ordinal, road) in (10..).zip(&roads) {
        writer.push(ordinal, &road.to_bytes());
    }
    let key = Kind::RoadPieces.of_tile(id);
    store.put(key, &writer.into_bytes()).unwrap();
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    let kept_within = |memory_bytes: u64| {
        keep((&BTreeSet::from([key.item]), &[]), &store, 100.0, (&pool, memory_bytes)).unwrap();
        let mut kept = Vec::new();
        for_each(&store, |road| kept.push(road)).unwrap();
        kept
    };
    let kept = kept_within(u64::MAX);
    for roads in [0, 1, 2, 3] {
        let memory_bytes = roads * (ROAD_BYTES + 2 * SEGMENT_BYTES);
        assert_eq!(kept_within(memory_bytes), kept, "{roads} roads at once");
    }
    let found: Vec<(u32, usize, u64)> =
        kept.iter().map(|road| (road.ordinal, road.points.len(), road.from_um)).collect();
    // Of the first road the segment at the bridge's end, of the third the one that crosses.
    assert_eq!(found, [(10, 2, 1500), (11, 3, 500), (12, 2, 500)]);
    let bridge = kept[1].road().unwrap();
    assert_eq!((bridge.fixed, bridge.node_ids), (vec![0, 2], vec![Some(7), Some(8)]));
    let before = kept[0].road().unwrap();
    assert_eq!((before.fixed, before.node_ids), (vec![0, 1], vec![None, Some(7)]));
}
