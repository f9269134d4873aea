//! Ways of outlines with the places of their nodes.

use corniche_store::Sorted;

use crate::{
    ReadOsmError,
    location::Location,
    reading::Reading,
    records::Stop,
    spool::{SpoolReader, damaged},
    wire::{varint, zigzag},
};

/// Ways in order of their ids, each with the places of its nodes.
pub(crate) struct LocatedWays<'a> {
    pub(crate) ways: SpoolReader<'a>,
    pub(crate) stops: Sorted<'a, Stop>,
    /// How many ways there are.
    pub(crate) count: u64,
}

pub(crate) struct LocatedWay {
    pub(crate) way_id: i64,
    pub(crate) places: Vec<Location>,
    /// Whether another of the ways has each node too, or this one twice.
    pub(crate) is_shared: Vec<bool>,
}

impl LocatedWays<'_> {
    pub(crate) fn next(
        &mut self,
        reading: &Reading<'_>,
    ) -> Result<Option<LocatedWay>, ReadOsmError> {
        let failed = |error| reading.scratch_failed(error);
        let take_way = |bytes: &mut &[u8]| {
            let (way_id, nodes) = (zigzag(varint(bytes).ok()?), varint(bytes).ok()?);
            // Nothing is asked of what they are.
            let length = varint(bytes).ok()?.try_into().ok()?;
            *bytes = bytes.get(length..)?;
            Some((way_id, nodes))
        };
        let Some((way_id, nodes)) = self.ways.next(take_way).map_err(failed)? else {
            return Ok(None);
        };
        let (mut places, mut is_shared) = (Vec::new(), Vec::new());
        for _ in 0..nodes {
            let stop = self.stops.next().ok_or_else(damaged).map_err(failed)?.map_err(failed)?;
            places.push(stop.location);
            is_shared.push(stop.is_shared());
        }
        Ok(Some(LocatedWay { way_id, places, is_shared }))
    }
}
