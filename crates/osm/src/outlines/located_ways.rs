//! Ways of outlines with the positions of their nodes.

use std::io;

use corniche_roads::Structure;
use corniche_store::Sorted;

use crate::{
    location::Location,
    number_nodes::take_numbered,
    records::Stop,
    spool::{SpoolReader, damaged},
    way_bytes::structure_of_layer_way,
};

/// Ways in order of their ids, each with the positions of its nodes.
pub(crate) struct LocatedWays<'a> {
    pub(crate) ways: SpoolReader<'a>,
    pub(crate) stops: Sorted<'a, Stop>,
    /// The number of ways.
    pub(crate) count: u64,
    /// The way that was read last.
    pub(crate) last: Option<LocatedWay>,
}

pub(crate) struct LocatedWay {
    pub(crate) way_id: i64,
    /// The structure that carries the way, if the layer needs it.
    pub(crate) structure: Structure,
    pub(crate) places: Vec<Location>,
    /// Whether another way also contains the node, or this way contains it twice; one entry per
    /// node.
    pub(crate) is_shared: Vec<bool>,
}

impl LocatedWays<'_> {
    /// Returns the way with this id, if it is present. Ways must be requested in ascending order of
    /// ids.
    pub(crate) fn find(&mut self, way_id: i64) -> io::Result<Option<&LocatedWay>> {
        while self.last.as_ref().is_none_or(|way| way.way_id < way_id) {
            self.last = self.next()?;
            if self.last.is_none() {
                break;
            }
        }
        Ok(self.last.as_ref().filter(|way| way.way_id == way_id))
    }

    fn next(&mut self) -> io::Result<Option<LocatedWay>> {
        let take = |bytes: &mut &[u8]| {
            let (way_id, nodes, rest) = take_numbered(bytes)?;
            Some((way_id, nodes, structure_of_layer_way(rest)?))
        };
        let Some((way_id, nodes, structure)) = self.ways.next(take)? else { return Ok(None) };
        let (mut places, mut is_shared) = (Vec::new(), Vec::new());
        for _ in 0..nodes {
            let stop = self.stops.next().ok_or_else(damaged)??;
            places.push(stop.location);
            is_shared.push(stop.is_shared());
        }
        Ok(Some(LocatedWay { way_id, structure, places, is_shared }))
    }
}
