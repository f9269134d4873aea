//! Ways of outlines with the places of their nodes.

use std::io;

use corniche_store::Sorted;

use crate::{
    location::Location,
    number_nodes::take_numbered,
    records::Stop,
    spool::{SpoolReader, damaged},
};

/// Ways in order of their ids, each with the places of its nodes.
pub(crate) struct LocatedWays<'a> {
    pub(crate) ways: SpoolReader<'a>,
    pub(crate) stops: Sorted<'a, Stop>,
    /// How many ways there are.
    pub(crate) count: u64,
    /// The way that was read last.
    pub(crate) last: Option<LocatedWay>,
}

pub(crate) struct LocatedWay {
    pub(crate) way_id: i64,
    pub(crate) places: Vec<Location>,
    /// Whether another of the ways has each node too, or this one twice.
    pub(crate) is_shared: Vec<bool>,
}

impl LocatedWays<'_> {
    /// The way with this id, if it is one of them. Ways are asked for in ascending order of their ids.
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
        // Nothing is asked of what they are.
        let take =
            |bytes: &mut &[u8]| take_numbered(bytes).map(|(way_id, nodes, _)| (way_id, nodes));
        let Some((way_id, nodes)) = self.ways.next(take)? else { return Ok(None) };
        let (mut places, mut is_shared) = (Vec::new(), Vec::new());
        for _ in 0..nodes {
            let stop = self.stops.next().ok_or_else(damaged)??;
            places.push(stop.location);
            is_shared.push(stop.is_shared());
        }
        Ok(Some(LocatedWay { way_id, places, is_shared }))
    }
}
