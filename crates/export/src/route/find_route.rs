//! Finds the route from place to place, or along a whole road.

use std::{collections::BTreeSet, fmt::Write as _};

use corniche_geom::{DisjointSets, LatticePoint};
use corniche_roads::FunctionalRoadClass;

use super::graph::{NONE, PlaceOnLink, RoadGraph, ShortestWays};
use crate::{
    error::RouteError,
    plane::{along, nearest_point},
    profile::{Course, CourseLeg},
    road_query::{NamedWays, RoadQuery},
};

/// The distance from a place within which a road is searched, metres.
const MOST_OFF_M: f64 = 500.0;
/// The longest interruption of a road by other roads, such as a roundabout or a square without its
/// number, metres.
const MOST_GAP_M: f64 = 300.0;
/// Roads with one number or name are one road if an end of one is this near to another: the
/// carriageways of a road, metres.
const BESIDE_M: f64 = 100.0;
/// Roads that are farther from a place than the nearest one by at most this are candidates as well,
/// metres: the two carriageways of a road.
const HARDLY_FARTHER_M: f64 = 25.0;
/// If several roads match, one of them is chosen if it has this share of the total length.
const MOST_OF_THEM: f64 = 0.9;
/// Pairs of ends are tried if their distance is at least this share of the largest one.
const ALMOST_FARTHEST: f64 = 0.95;
/// The number of ends from which routes to others are searched.
const MOST_STARTS: usize = 8;

/// The request for a route.
#[derive(Debug, Clone, PartialEq)]
pub struct RouteRequest {
    /// The level whose roads are followed; `None` means the finest.
    pub level: Option<u8>,
    /// The road, if the user names one.
    pub road: Option<RoadQuery>,
    /// Longitude and latitude of both ends; `None` for the whole named road.
    pub ends_deg: Option<[[f64; 2]; 2]>,
    /// Classes of roads that are followed.
    pub classes: Vec<FunctionalRoadClass>,
}

/// A route through a network.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct NetworkRoute {
    /// The lines that are followed.
    pub course: Course,
    /// True length in plan, metres.
    pub length_m: f64,
    /// The length of roads other than the named one, metres.
    pub others_m: f64,
    /// True length in plan of all ways of the road, if a whole road is requested, metres.
    pub road_m: Option<f64>,
    /// Other roads that have the same number or name, in words.
    pub same_name: Vec<String>,
    /// The distances of both ends from the given places, metres.
    pub off_m: [f64; 2],
}

/// Finds routes in a graph.
pub(crate) struct Finder<'a> {
    pub(crate) graph: &'a RoadGraph<'a>,
    pub(crate) roads: &'a NamedWays,
    pub(crate) road: Option<&'a RoadQuery>,
}

/// A stretch of an edge, from one distance to another; against its way if the first is larger.
#[derive(Clone, Copy)]
struct EdgeStretch {
    edge: usize,
    from_m: f64,
    to_m: f64,
}

impl Finder<'_> {
    /// Returns the shortest route between two places.
    pub(crate) fn between(&self, ends_deg: [[f64; 2]; 2]) -> Result<NetworkRoute, RouteError> {
        let [from_deg, to_deg] = ends_deg;
        let (from, to) = (self.near(from_deg)?, self.near(to_deg)?);
        // A road near the nearest one costs twice its additional distance: there and back.
        let cost_m = |place: &PlaceOnLink, of: &[PlaceOnLink]| 2.0 * (place.off_m - of[0].off_m);
        let mut starts = Vec::with_capacity(2 * from.len());
        for place in &from {
            let edge = &self.graph.edges[place.edge];
            let begun_m = cost_m(place, &from);
            starts.push((edge.ends[0], begun_m + edge.weight_m(place.along_m)));
            starts.push((edge.ends[1], begun_m + edge.weight_m(edge.length_m - place.along_m)));
        }
        let ways = self.graph.shortest(&starts, |_| true);
        let mut best: Option<(f64, Vec<EdgeStretch>, [f64; 2])> = None;
        let mut look = |cost_m: f64, stretches: Vec<EdgeStretch>, off_m: [f64; 2]| {
            if cost_m.is_finite() && best.as_ref().is_none_or(|(least_m, ..)| cost_m < *least_m) {
                best = Some((cost_m, stretches, off_m));
            }
        };
        for goal in &to {
            let edge = &self.graph.edges[goal.edge];
            let own_m = cost_m(goal, &to);
            for start in from.iter().filter(|start| start.edge == goal.edge) {
                let run_m = edge.weight_m((goal.along_m - start.along_m).abs());
                let stretch =
                    EdgeStretch { edge: goal.edge, from_m: start.along_m, to_m: goal.along_m };
                look(
                    cost_m(start, &from) + own_m + run_m,
                    vec![stretch],
                    [start.off_m, goal.off_m],
                );
            }
            for (end, end_m) in [(0, 0.0), (1, edge.length_m)] {
                let node = edge.ends[end];
                let far_m = ways.far_m[node] + own_m + edge.weight_m((goal.along_m - end_m).abs());
                if !far_m.is_finite() {
                    continue;
                }
                let start = ways.from[node] as usize;
                let place = &from[start / 2];
                let first_m = if start.is_multiple_of(2) {
                    0.0
                } else {
                    self.graph.edges[place.edge].length_m
                };
                let first = EdgeStretch { edge: place.edge, from_m: place.along_m, to_m: first_m };
                let last = EdgeStretch { edge: goal.edge, from_m: end_m, to_m: goal.along_m };
                let mut stretches = vec![first];
                stretches.extend(self.to_node(&ways, node));
                stretches.push(last);
                look(far_m, stretches, [place.off_m, goal.off_m]);
            }
        }
        let Some((_, stretches, off_m)) = best else {
            return Err(RouteError::NotConnected { of: self.of_text(), ends: ends_deg });
        };
        let route = self.route(&stretches)?;
        if route.course.legs.is_empty() {
            return Err(RouteError::OnePlace);
        }
        Ok(NetworkRoute { off_m, ..route })
    }

    /// Returns the route along the whole named road, from its western to its eastern end.
    pub(crate) fn whole(&self) -> Result<NetworkRoute, RouteError> {
        let matched = self.matched();
        let nothing = || RouteError::NothingToFollow { of: self.of_text() };
        let road = matched.first().ok_or_else(nothing)?;
        let all_m: f64 = matched.iter().map(|road| road.length_m).sum();
        let text = |road: &MatchedRoad| road.text(self.graph);
        if road.length_m < MOST_OF_THEM * all_m {
            let roads = matched.iter().map(text).collect();
            return Err(RouteError::SeveralRoads { query: self.query_text(), roads });
        }
        let same_name = matched[1..].iter().map(text).collect();
        let mut best: Option<(f64, Vec<EdgeStretch>)> = None;
        for (from, tos) in self.end_pairs(road) {
            let ways = self.graph.shortest(&[(from, 0.0)], |_| true);
            for to in tos {
                let far_m = ways.far_m[to];
                if far_m.is_finite() && best.as_ref().is_none_or(|(least_m, _)| far_m < *least_m) {
                    best = Some((far_m, self.to_node(&ways, to)));
                }
            }
        }
        let (_, stretches) = best.ok_or_else(nothing)?;
        let route = self.route(&stretches)?;
        Ok(NetworkRoute { road_m: Some(road.length_m), same_name, ..route })
    }

    fn query_text(&self) -> String {
        self.road.map(RoadQuery::text).unwrap_or_default()
    }

    fn of_text(&self) -> String {
        self.road.map_or_else(|| "roads".to_owned(), |road| format!("roads with {}", road.text()))
    }

    fn near(&self, place_deg: [f64; 2]) -> Result<Vec<PlaceOnLink>, RouteError> {
        let near = self.graph.near(place_deg, HARDLY_FARTHER_M);
        let [lon, lat] = place_deg;
        let (of, covered) = (self.of_text(), self.graph.places.manifest.covered_text(place_deg));
        match near.first().map(|place| place.off_m) {
            Some(off_m) if off_m <= MOST_OFF_M => Ok(near),
            Some(off_m) => Err(RouteError::FarFromRoads { of, lon, lat, off_m, covered }),
            None => Err(RouteError::NoRoadNear { of, lon, lat, covered }),
        }
    }

    /// Returns the edges by which a node is reached, from the beginning onwards.
    fn to_node(&self, ways: &ShortestWays, node: usize) -> Vec<EdgeStretch> {
        let mut stretches = Vec::new();
        let mut at = node;
        while ways.by[at] != NONE {
            let (number, end) = (ways.by[at] as usize / 2, ways.by[at] as usize % 2);
            let edge = &self.graph.edges[number];
            let [to_m, from_m] = if end == 0 { [0.0, edge.length_m] } else { [edge.length_m, 0.0] };
            stretches.push(EdgeStretch { edge: number, from_m, to_m });
            at = edge.ends[1 - end];
        }
        stretches.reverse();
        stretches
    }

    /// Groups the matching ways into roads, the longest first: ways that are connected, also over a
    /// short stretch of other roads, and ways next to these.
    fn matched(&self) -> Vec<MatchedRoad> {
        let graph = self.graph;
        let mut sets = DisjointSets::new(graph.node_count());
        let wanted = || (0..graph.edges.len()).filter(|&edge| graph.edges[edge].is_wanted);
        for edge in wanted() {
            let [one, other] = graph.edges[edge].ends;
            sets.join(one, other);
        }
        // Search from all of them at once, over other roads: where two searches meet, there is a
        // gap between roads.
        let starts: Vec<(usize, f64)> =
            wanted().flat_map(|edge| graph.edges[edge].ends).map(|node| (node, 0.0)).collect();
        let ways = graph.shortest(&starts, |edge| !edge.is_wanted);
        for edge in graph.edges.iter().filter(|edge| !edge.is_wanted) {
            let [one, other] = edge.ends;
            let gap_m = ways.far_m[one] + ways.far_m[other] + edge.weight_m(edge.length_m);
            if gap_m <= edge.weight_m(MOST_GAP_M) {
                let [one, other] = [one, other].map(|node| starts[ways.from[node] as usize].0);
                sets.join(one, other);
            }
        }
        let is_dead_end = |node: usize| self.wanted_at(node) == 1;
        let ends: Vec<usize> =
            starts.iter().map(|(node, _)| *node).filter(|&node| is_dead_end(node)).collect();
        for node in ends {
            for place in graph.near(self.place_deg(node), BESIDE_M) {
                sets.join(node, graph.edges[place.edge].ends[0]);
            }
        }
        let mut by_set: Vec<(usize, usize)> =
            wanted().map(|edge| (sets.first_of(graph.edges[edge].ends[0]), edge)).collect();
        by_set.sort_unstable();
        let road = |own: &[(usize, usize)]| {
            let edges: Vec<usize> = own.iter().map(|(_, edge)| *edge).collect();
            let length_m = edges.iter().map(|&edge| graph.edges[edge].length_m).sum();
            MatchedRoad { edges, length_m }
        };
        let by_set = by_set.chunk_by(|one, other| one.0 == other.0);
        let mut roads: Vec<MatchedRoad> = by_set.map(road).collect();
        roads.sort_by(|one, other| {
            other.length_m.total_cmp(&one.length_m).then(one.edges[0].cmp(&other.edges[0]))
        });
        roads
    }

    /// Counts the ends of matching edges at a node.
    fn wanted_at(&self, node: usize) -> usize {
        let is_wanted = |end: &&u32| self.graph.edges[**end as usize / 2].is_wanted;
        self.graph.ends_at(node).iter().filter(is_wanted).count()
    }

    fn place(&self, node: usize) -> [f64; 2] {
        let end = self.graph.ends_at(node)[0] as usize;
        let points = self.graph.points(&self.graph.edges[end / 2]);
        let point = if end.is_multiple_of(2) { points.first() } else { points.last() };
        point.map_or([f64::NAN; 2], |point| point.in_steps())
    }

    fn place_deg(&self, node: usize) -> [f64; 2] {
        self.graph.places.wgs84(self.place(node))
    }

    /// Returns pairs of ends of a road: nodes at which it may begin, with those at which it then
    /// ends. These are the pairs that are (almost) the farthest apart; ends are to the east of
    /// their beginning.
    fn end_pairs(&self, road: &MatchedRoad) -> Vec<(usize, Vec<usize>)> {
        let all = road.edges.iter().flat_map(|&edge| self.graph.edges[edge].ends);
        let nodes: Vec<usize> = all.collect::<BTreeSet<usize>>().into_iter().collect();
        let places: Vec<[f64; 2]> = nodes.iter().map(|&node| self.place(node)).collect();
        let far_m =
            |one: usize, other: usize| self.graph.places.distance_m(places[one], places[other]);
        let dead_ends: Vec<usize> =
            (0..nodes.len()).filter(|&at| self.wanted_at(nodes[at]) == 1).collect();
        let farthest_from = |from: usize| {
            let all = 0..nodes.len();
            all.max_by(|&one, &other| far_m(from, one).total_cmp(&far_m(from, other))).unwrap_or(0)
        };
        let one = farthest_from(0);
        let other = farthest_from(one);
        let mut ends = dead_ends;
        let mut most_m = 0.0_f64;
        for (k, &end) in ends.iter().enumerate() {
            most_m = ends[k + 1..].iter().map(|&to| far_m(end, to)).fold(most_m, f64::max);
        }
        // A road may end in its own roundabout, or be a ring.
        if ALMOST_FARTHEST * far_m(one, other) > most_m {
            ends.extend([one, other]);
            most_m = far_m(one, other);
        }
        ends.sort_unstable();
        ends.dedup();
        let mut pairs: Vec<(usize, Vec<usize>)> = Vec::new();
        for &from in &ends {
            let is_east = |to: usize| (places[from], from) < (places[to], to);
            let is_far = |to: usize| far_m(from, to) >= ALMOST_FARTHEST * most_m;
            let tos = ends.iter().copied().filter(|&to| is_east(to) && is_far(to));
            let tos: Vec<usize> = tos.map(|to| nodes[to]).collect();
            if !tos.is_empty() {
                pairs.push((nodes[from], tos));
            }
        }
        pairs.truncate(MOST_STARTS);
        pairs
    }

    /// Joins stretches into a course.
    fn route(&self, stretches: &[EdgeStretch]) -> Result<NetworkRoute, RouteError> {
        let (mut legs, mut length_m, mut others_m, mut gap_m) = (Vec::new(), 0.0, 0.0, 0.0);
        for stretch in stretches {
            let edge = &self.graph.edges[stretch.edge];
            let own_m = (stretch.to_m - stretch.from_m).abs();
            let points = self.points(*stretch);
            if points.len() < 2 {
                continue;
            }
            length_m += own_m;
            if edge.is_wanted {
                gap_m = 0.0;
            } else {
                others_m += own_m;
                gap_m += own_m;
                if gap_m > MOST_GAP_M {
                    let [lon, lat] = self.graph.places.wgs84(points[0].in_steps());
                    let query = self.query_text();
                    return Err(RouteError::RoadInterrupted { query, lon, lat });
                }
            }
            let way_id = self.graph.network.way_of(edge.link).way_id;
            let is_against = stretch.from_m > stretch.to_m;
            legs.push(CourseLeg { way_id, is_against, points });
        }
        let known = &self.roads.known;
        let way = |leg: &CourseLeg| Some((leg.way_id, known.get(&leg.way_id)?.clone()));
        let ways = legs.iter().filter_map(way).collect();
        let course = Course { legs, ways, is_of_ways: true, begins_deg: None };
        Ok(NetworkRoute { course, length_m, others_m, ..NetworkRoute::default() })
    }

    /// Returns the points of a stretch, in its direction.
    fn points(&self, EdgeStretch { edge, from_m, to_m }: EdgeStretch) -> Vec<LatticePoint> {
        let mut points = self.graph.points(&self.graph.edges[edge]);
        let along_m = self.graph.places.distances_m(points.iter().copied());
        let at = |at_m: f64| {
            let after = along_m.partition_point(|own_m| *own_m < at_m).min(points.len() - 1);
            let before = after.saturating_sub(1);
            let run_m = along_m[after] - along_m[before];
            let share = if run_m > 0.0 { (at_m - along_m[before]) / run_m } else { 1.0 };
            let [from, to] = [before, after].map(|index| points[index].in_steps());
            nearest_point(along(from, to, share))
        };
        let [low_m, high_m] = [from_m.min(to_m), from_m.max(to_m)];
        let [first, last] = [at(low_m), at(high_m)];
        let inner = points.iter().zip(&along_m);
        let inner = inner.filter(|(_, at_m)| **at_m > low_m && **at_m < high_m);
        points = [first].into_iter().chain(inner.map(|(point, _)| *point)).chain([last]).collect();
        points.dedup();
        if from_m > to_m {
            points.reverse();
        }
        points
    }
}

/// The number of way ids of a road that are printed.
const MOST_IDS: usize = 20;

/// Matching ways that form one road.
struct MatchedRoad {
    /// Its edges, ascending.
    edges: Vec<usize>,
    /// True length in plan of all its ways, metres.
    length_m: f64,
}

impl MatchedRoad {
    /// Returns a line of a list: the road's length, its place and its ways.
    fn text(&self, graph: &RoadGraph<'_>) -> String {
        let way_id = |&edge: &usize| graph.network.way_of(graph.edges[edge].link).way_id;
        let way_ids: BTreeSet<i64> = self.edges.iter().map(way_id).collect();
        let [lon, lat] = self.edges.first().map_or([f64::NAN; 2], |&edge| {
            graph.places.wgs84(graph.points(&graph.edges[edge])[0].in_steps())
        });
        let first: Vec<String> = way_ids.iter().take(MOST_IDS).map(i64::to_string).collect();
        let mut text = format!(
            "{:.2} km near {lon:.5},{lat:.5}: --way {}",
            self.length_m / 1e3,
            first.join(","),
        );
        if way_ids.len() > MOST_IDS {
            // Writing to a String cannot fail.
            let _ = write!(text, " and {} more", way_ids.len() - MOST_IDS);
        }
        text
    }
}
