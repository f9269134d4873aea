//! The roads that a number or a name means, where it means several.

use std::{collections::BTreeSet, fmt::Write as _};

use super::graph::RoadGraph;

/// So many ids of a road are written.
const MOST_IDS: usize = 20;

/// What belongs together of the ways that are meant.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct MatchedRoad {
    /// Its edges, ascending.
    pub(crate) edges: Vec<usize>,
    /// True length in plan of all its ways, metres.
    pub(crate) length_m: f64,
}

impl MatchedRoad {
    /// Its nodes, ascending.
    pub(crate) fn nodes(&self, graph: &RoadGraph<'_>) -> Vec<usize> {
        let ends = self.edges.iter().flat_map(|&edge| graph.edges[edge].ends);
        ends.collect::<BTreeSet<usize>>().into_iter().collect()
    }

    /// A line of a list: its length, its place and its ways.
    pub(crate) fn text(&self, graph: &RoadGraph<'_>) -> String {
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
