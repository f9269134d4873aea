//! Builds a network from roads, one after the other.

use std::collections::BTreeMap;

use corniche_geom::{IndexLists, LatticePoint};
use corniche_roads::{Railway, Road};

use crate::network::{Network, NetworkWay};

/// Builds a network from roads, which must come in ascending order of way ids, with the ids of
/// their nodes.
#[derive(Debug, Default)]
pub struct NetworkBuilder {
    ways: Vec<NetworkWay>,
    points: Vec<LatticePoint>,
    stop_points: Vec<u32>,
    stop_ids: Vec<Option<i64>>,
    highways: BTreeMap<String, u32>,
    /// For two nodes at the same point, the larger id maps to the smaller one, which represents
    /// both. Another node may in turn represent the smaller one.
    stands_for: BTreeMap<i64, i64>,
}

impl NetworkBuilder {
    /// Adds a road. Ends without an id meet no other road.
    pub fn push(&mut self, road: &Road) {
        self.push_way(road, None);
    }

    /// Adds a road, or a railway with the line and the nodes of `road`.
    pub fn push_way(&mut self, road: &Road, railway: Option<Railway>) {
        for &[one, other] in &road.same_places {
            let [one, other] = [one, other].map(|id| self.representative(id));
            if one != other {
                self.stands_for.insert(one.max(other), one.min(other));
            }
        }
        let [first_point, first_stop] = [self.points.len(), self.stop_points.len()];
        self.points.extend(road.line.points());
        for (index, &point) in road.fixed.iter().enumerate() {
            self.stop_points.push(point);
            self.stop_ids.push(road.node_ids.get(index).copied().flatten());
        }
        let known = self.highways.get(&road.attributes.highway).copied();
        let highway = known.unwrap_or_else(|| {
            let count = self.highways.len() as u32;
            self.highways.insert(road.attributes.highway.clone(), count);
            count
        });
        self.ways.push(NetworkWay {
            way_id: road.way_id,
            class: road.class,
            railway,
            structure: road.attributes.structure,
            layer: road.attributes.layer,
            oneway: road.attributes.oneway,
            points: first_point..self.points.len(),
            stops: first_stop..self.stop_points.len(),
            highway,
        });
    }

    /// Returns the smallest known id of all nodes at the point of a node.
    fn representative(&self, mut id: i64) -> i64 {
        while let Some(&smaller) = self.stands_for.get(&id) {
            id = smaller;
        }
        id
    }

    /// Builds the network: finds out which roads meet.
    #[must_use]
    pub fn finish(mut self) -> Network {
        let mut stop_ids = std::mem::take(&mut self.stop_ids);
        if !self.stands_for.is_empty() {
            for id in stop_ids.iter_mut().flatten() {
                *id = self.representative(*id);
            }
        }
        let Self { ways, points, stop_points, highways, .. } = self;
        let mut node_ids: Vec<i64> = stop_ids.iter().copied().flatten().collect();
        node_ids.sort_unstable();
        node_ids.dedup();
        let number = |id: &Option<i64>| {
            id.map_or(0, |id| node_ids.partition_point(|&known| known < id) as u32)
        };
        let mut stop_nodes: Vec<u32> = stop_ids.iter().map(number).collect();
        // Places that are not nodes come after the nodes, ordered by their position and not by
        // their ways.
        let mut others: Vec<(LatticePoint, usize)> = Vec::new();
        for way in &ways {
            let without_id = way.stops.clone().filter(|&stop| stop_ids[stop].is_none());
            others.extend(
                without_id
                    .map(|stop| (points[way.points.start + stop_points[stop] as usize], stop)),
            );
        }
        others.sort_unstable();
        for (number, &(_, stop)) in (node_ids.len()..).zip(&others) {
            stop_nodes[stop] = number as u32;
        }
        let nodes = node_ids.len() + others.len();
        // The last stop of a road begins no stretch.
        let mut begins = vec![true; stop_points.len()];
        for way in &ways {
            if let Some(last) = way.stops.clone().next_back() {
                begins[last] = false;
            }
        }
        let ends = |end: usize| {
            let node = begins[end / 2].then(|| stop_nodes[end / 2 + end % 2] as usize);
            node.into_iter()
        };
        let ends_at = IndexLists::new(nodes, 2 * stop_points.len(), ends);
        let mut texts = vec![String::new(); highways.len()];
        for (text, number) in highways {
            texts[number as usize] = text;
        }
        let (highways, of_spans) = (texts, None);
        Network {
            ways,
            points,
            stop_points,
            stop_nodes,
            node_ids,
            nodes,
            ends_at,
            highways,
            of_spans,
        }
    }
}
