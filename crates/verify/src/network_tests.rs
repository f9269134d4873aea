//! Parts of roads have the nodes of the whole road.

use corniche_geom::{LatticePoint, Polyline};
use corniche_roads::{FunctionalRoadClass, MetNodes, RoadAttributes};

use super::*;

#[test]
fn parts_of_a_road_keep_its_nodes_and_end_at_none() {
    let at = |u: i64, v: i64| LatticePoint::new(u, v);
    let road = Road {
        way_id: 7,
        class: FunctionalRoadClass::new(3).unwrap(),
        attributes: RoadAttributes::default(),
        line: Polyline::new(vec![
            at(-50, 0),
            at(10, 0),
            at(20, 0),
            at(40, 0),
            at(40, 200),
            at(60, 200),
            at(60, 10),
        ])
        .unwrap(),
        fixed: vec![0, 1, 3, 6],
        node_ids: vec![Some(100), Some(101), Some(103), Some(106)],
        same_places: Vec::new(),
        met: MetNodes::default(),
    };
    let data = LatticeBounds { min: at(0, -100), max: at(100, 100) };
    let parts: Vec<Road> = corniche_drape::clip_parts(&road.line, &data, OwnedBorders::ALL)
        .into_iter()
        .map(|part| road_of_part(&road, part))
        .collect();
    let expected = [
        (
            vec![at(0, 0), at(10, 0), at(20, 0), at(40, 0), at(40, 100)],
            vec![0, 1, 3, 4],
            vec![None, Some(101), Some(103), None],
        ),
        (vec![at(60, 100), at(60, 10)], vec![0, 1], vec![None, Some(106)]),
    ];
    assert_eq!(parts.len(), expected.len());
    for (part, (points, fixed, node_ids)) in parts.into_iter().zip(expected) {
        assert_eq!((part.fixed, part.node_ids), (fixed, node_ids));
        assert_eq!(part.line.into_points(), points);
    }
}
