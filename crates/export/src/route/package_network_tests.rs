//! Roads join where their lines share a point, if they are on one level or one of them ends there.

use corniche_roads::{FunctionalRoadClass, MetNodes, RoadAttributes, Structure};

use super::*;

fn road(way_id: i64, points: &[[i64; 2]], structure: Structure) -> Road {
    let points = points.iter().map(|&[u, v]| LatticePoint::new(u, v)).collect();
    Road {
        way_id,
        class: FunctionalRoadClass::new(4).unwrap(),
        attributes: RoadAttributes { structure, ..RoadAttributes::default() },
        line: Polyline::new(points).unwrap(),
        fixed: Vec::new(),
        node_ids: Vec::new(),
        same_places: Vec::new(),
        met: MetNodes::default(),
    }
}

#[test]
fn a_bridge_joins_roads_only_where_one_of_them_ends() {
    let across = road(1, &[[0, 0], [5, 0], [10, 0]], Structure::Ground);
    let below = road(2, &[[5, -5], [5, 0], [5, 5]], Structure::Bridge);
    let from = road(3, &[[10, 0], [20, 0]], Structure::Bridge);
    let mut roads = [across, below, from];
    join(&mut roads);
    assert_eq!(roads.clone().map(|road| road.fixed), [vec![0, 2], vec![0, 2], vec![0, 1]]);
    assert_eq!(roads[0].node_ids[1], roads[2].node_ids[0]);
    // The same roads on the ground cross at a junction.
    roads[1].attributes.structure = Structure::Ground;
    join(&mut roads);
    assert_eq!(roads[0].fixed, [0, 1, 2]);
    assert_eq!(roads[0].node_ids[1], roads[1].node_ids[1]);
}
