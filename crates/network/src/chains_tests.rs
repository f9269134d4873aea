//! Chains of small hand-drawn networks are as expected, however their ways are split, turned and
//! numbered.

use corniche_geom::Polyline;
use corniche_roads::{FunctionalRoadClass, MetNodes, Road, RoadAttributes, Structure};
use proptest::prelude::*;

use super::*;
use crate::NetworkBuilder;

/// Returns a road through nodes; each node has its own position, and all are fixed.
fn road(way_id: i64, node_ids: &[i64], structure: Structure) -> Road {
    let points = node_ids.iter().map(|&id| LatticePoint::new(id * 1000, id * id)).collect();
    Road {
        way_id,
        class: FunctionalRoadClass::new(5).unwrap(),
        attributes: RoadAttributes { structure, ..RoadAttributes::default() },
        line: Polyline::new(points).unwrap(),
        fixed: (0..node_ids.len() as u32).collect(),
        node_ids: node_ids.iter().copied().map(Some).collect(),
        same_places: Vec::new(),
        met: MetNodes::default(),
    }
}

fn network(roads: &[Road]) -> Network {
    let mut builder = NetworkBuilder::default();
    for road in roads {
        builder.push(road);
    }
    builder.finish()
}

/// Returns the nodes of each chain, smaller end first; in rings and loops, the smaller neighbour
/// comes second.
fn nodes_of(network: &Network, breaks: Breaks) -> Vec<Vec<i64>> {
    let chains = Chains::from_network(network, breaks);
    let mut all: Vec<Vec<i64>> = chains
        .numbers()
        .map(|number| {
            let points = network.points_of_chain(&chains.get(number));
            let mut nodes: Vec<i64> = points.iter().map(|point| point.u / 1000).collect();
            let mut back = nodes.clone();
            back.reverse();
            nodes = nodes.min(back);
            nodes
        })
        .collect();
    all.sort();
    all
}

/// Returns the points of all chains in their order and direction, without rings that have no
/// junction, because these begin where a way does.
fn in_order(network: &Network) -> Vec<Vec<LatticePoint>> {
    let chains = Chains::from_network(network, Breaks::Junctions);
    let all = chains.numbers().map(|number| chains.get(number));
    all.filter(|chain| !chain.is_closed() || network.degree(chain.ends[0]) > 2)
        .map(|chain| network.points_of_chain(&chain))
        .collect()
}

/// Two ways between the same two nodes are ordered by their points, whatever their ids.
#[test]
fn chains_between_the_same_nodes_do_not_have_the_order_of_ways() {
    let ground = Structure::Ground;
    let orders = [[1, 2, 3], [3, 2, 1], [2, 3, 1], [2, 1, 3]].map(|ids: [i64; 3]| {
        let shapes: [&[i64]; 3] = [&[1, 5, 2], &[2, 3, 1], &[1, 4, 2]];
        let mut roads: Vec<Road> =
            ids.into_iter().zip(shapes).map(|(id, nodes)| road(id, nodes, ground)).collect();
        roads.sort_by_key(|road| road.way_id);
        in_order(&network(&roads))
    });
    let middles: Vec<i64> = orders[0].iter().map(|points| points[1].u / 1000).collect();
    assert_eq!(middles, [3, 4, 5]);
    assert!(orders.iter().all(|order| *order == orders[0]));
}

/// Where roads are cut, ends have no node: they are numbered by their positions.
#[test]
fn ends_without_a_node_do_not_have_the_order_of_ways() {
    let orders = [[1, 2], [2, 1]].map(|ids: [i64; 2]| {
        let mut roads: Vec<Road> = ids
            .into_iter()
            .zip([[2, 7], [3, 6]])
            .map(|(id, nodes)| Road {
                node_ids: vec![None; 2],
                ..road(id, &nodes, Structure::Ground)
            })
            .collect();
        roads.sort_by_key(|road| road.way_id);
        in_order(&network(&roads))
    });
    assert_eq!(orders[0], orders[1]);
    assert_eq!(orders[0].iter().map(|points| points[0].u / 1000).collect::<Vec<_>>(), [2, 3]);
}

#[test]
fn a_chain_goes_through_ends_of_ways_and_ends_at_junctions() {
    let ground = Structure::Ground;
    let roads = [
        road(7, &[1, 2, 3], ground),
        road(8, &[5, 4, 3], ground),
        road(9, &[2, 6], ground),
        // One ring stands alone, and one hangs on node 6.
        road(10, &[20, 21, 22, 20], ground),
        road(11, &[6, 31, 30, 6], ground),
    ];
    let network = network(&roads);
    let expected: [&[i64]; 5] =
        [&[1, 2], &[2, 3, 4, 5], &[2, 6], &[6, 30, 31, 6], &[20, 21, 22, 20]];
    assert_eq!(nodes_of(&network, Breaks::Junctions), expected);
    let chains = Chains::from_network(&network, Breaks::Junctions);
    let degree =
        |id: i64| network.degree(NodeNumber(network.node_ids.binary_search(&id).unwrap() as u32));
    assert_eq!([1, 2, 3, 6, 20].map(degree), [1, 3, 2, 3, 2]);
    // Way 8 is in the second chain, against the chain's direction.
    let of_road: Vec<_> = chains.of_road(&network.ways()[1]).collect();
    assert_eq!(of_road.len(), 2);
    for (number, link) in of_road {
        let chain = chains.get(number);
        assert!(chain.links[link].is_against);
        assert_eq!(network.way_of(chain.links[link]).way_id, 8);
    }
}

/// Loops and rings run counterclockwise however they were drawn, and the places of their links are
/// known. Those that enclose no area are the same in both directions.
#[test]
fn what_comes_back_runs_counterclockwise() {
    // The nodes are on a parabola: a line through ascending ids turns to the left.
    let shapes: [&[i64]; 4] = [&[1, 2, 3, 4, 1], &[1, 4, 5, 6, 9, 1], &[1, 2, 1], &[3, 2, 1, 2, 3]];
    for shape in shapes {
        let mut back = shape.to_vec();
        back.reverse();
        let found = [shape.to_vec(), back].map(|nodes| {
            let network = network(&[road(1, &nodes, Structure::Ground)]);
            let chains = Chains::from_network(&network, Breaks::Junctions);
            for number in chains.numbers() {
                for (index, &link) in chains.get(number).links.iter().enumerate() {
                    assert_eq!(chains.of_link(link), (number, index));
                }
            }
            let lines: Vec<Vec<i64>> = chains
                .numbers()
                .map(|number| {
                    let points = network.points_of_chain(&chains.get(number));
                    points.iter().map(|point| point.u / 1000).collect()
                })
                .collect();
            lines
        });
        assert_eq!(found[0], found[1]);
        if shape.len() > 4 && shape[0] == 1 {
            assert_eq!(found[0], [shape]);
        }
    }
}

#[test]
fn structures_are_chains_of_their_own_where_that_is_wanted() {
    let roads = [
        road(1, &[1, 2], Structure::Ground),
        road(2, &[2, 3], Structure::Bridge),
        road(3, &[3, 4], Structure::Bridge),
        road(4, &[4, 5], Structure::Ground),
    ];
    let network = network(&roads);
    assert_eq!(nodes_of(&network, Breaks::Junctions), [[1, 2, 3, 4, 5]]);
    let expected: [&[i64]; 3] = [&[1, 2], &[2, 3, 4], &[4, 5]];
    assert_eq!(nodes_of(&network, Breaks::JunctionsAndStructures), expected);
}

/// Two nodes of a way at the same point are one node, whichever of them other ways join.
#[test]
fn nodes_that_a_way_has_at_one_place_are_one() {
    let mut way = road(1, &[1, 2, 4], Structure::Ground);
    way.same_places = vec![[2, 3]];
    let mut other = road(3, &[2, 6], Structure::Ground);
    other.node_ids[0] = Some(3);
    let network = network(&[way, road(2, &[2, 5], Structure::Ground), other]);
    let expected: [&[i64]; 4] = [&[1, 2], &[2, 4], &[2, 5], &[2, 6]];
    assert_eq!(nodes_of(&network, Breaks::Junctions), expected);
}

#[test]
fn roads_in_the_same_place_meet_only_in_the_same_node() {
    let mut other = road(2, &[2, 9], Structure::Ground);
    other.node_ids[0] = Some(77);
    let mut cut = road(3, &[2, 8], Structure::Ground);
    cut.node_ids[0] = None;
    let network = network(&[road(1, &[1, 2, 3], Structure::Ground), other, cut]);
    let expected: [&[i64]; 3] = [&[1, 2, 3], &[2, 8], &[2, 9]];
    assert_eq!(nodes_of(&network, Breaks::Junctions), expected);
    assert_eq!(network.node_id(NodeNumber(network.node_count() as u32 - 1)), None);
}

proptest! {
    #[test]
    fn splitting_turning_and_naming_ways_changes_no_chain(
        lines in prop::collection::vec(prop::collection::vec(1..14_i64, 2..7), 1..6),
        cuts in prop::collection::vec((any::<prop::sample::Index>(), any::<bool>()), 30),
    ) {
        let lines: Vec<Vec<i64>> = lines
            .into_iter()
            .map(|mut line| { line.dedup(); line })
            .filter(|line| line.len() >= 2)
            .collect();
        prop_assume!(!lines.is_empty());
        let whole: Vec<Road> =
            (1..).zip(&lines).map(|(id, line)| road(id, line, Structure::Ground)).collect();
        let mut parts: Vec<Vec<i64>> = Vec::new();
        for line in &lines {
            let (at, is_turned) = &cuts[parts.len() % cuts.len()];
            let at = at.index(line.len());
            let mut own = vec![line.clone()];
            if at > 0 && at + 1 < line.len() {
                own = vec![line[at..].to_vec(), line[..=at].to_vec()];
            }
            if *is_turned {
                for part in &mut own {
                    part.reverse();
                }
            }
            parts.extend(own);
        }
        parts.reverse();
        let split: Vec<Road> =
            (1..).zip(&parts).map(|(id, line)| road(id, line, Structure::Ground)).collect();
        let both = [network(&whole), network(&split)];
        let [one, other] = both.each_ref().map(|network| nodes_of(network, Breaks::Junctions));
        // A ring without a junction may be walked in either direction; `nodes_of` removes the
        // difference.
        prop_assert_eq!(one, other);
        let [one, other] = both.each_ref().map(in_order);
        prop_assert_eq!(one, other);
    }
}
