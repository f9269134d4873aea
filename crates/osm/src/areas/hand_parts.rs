//! Gives each object the ways of its outline, with their places.

use corniche_store::{SortRecord as _, Sorted, Sorter};

use super::records::{MemberRecord, PartLine, PartRecord};
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
}

struct LocatedWay {
    way_id: i64,
    places: Vec<Location>,
}

/// Members and ways come in order of way ids. A member whose way is not in the file gets a part that says so.
pub(crate) fn hand_parts<'a>(
    reading: &Reading<'a>,
    mut members: SpoolReader<'a>,
    mut located: LocatedWays<'a>,
) -> Result<Sorter<'a, PartRecord>, ReadOsmError> {
    let failed = |error| reading.scratch_failed(error);
    let mut parts = Sorter::new(reading.request.scratch, reading.shares().ways);
    let mut way: Option<LocatedWay> = None;
    let mut count = 0;
    while let Some(record) = members.next(MemberRecord::decode).map_err(failed)? {
        let MemberRecord { member, object_number } = record;
        let way_id = member.way_id;
        reading.check_stop_at(count)?;
        count += 1;
        while way.as_ref().is_none_or(|way| way.way_id < way_id) {
            way = located.next(reading)?;
            if way.is_none() {
                break;
            }
        }
        let line = match &way {
            Some(way) if way.way_id == way_id => PartLine::of(way.places.clone()),
            _ => PartLine::NoWay,
        };
        parts.push(PartRecord { object_number, member, line }).map_err(failed)?;
    }
    Ok(parts)
}

impl LocatedWays<'_> {
    fn next(&mut self, reading: &Reading<'_>) -> Result<Option<LocatedWay>, ReadOsmError> {
        let failed = |error| reading.scratch_failed(error);
        let take_way = |bytes: &mut &[u8]| Some((zigzag(varint(bytes).ok()?), varint(bytes).ok()?));
        let Some((way_id, nodes)) = self.ways.next(take_way).map_err(failed)? else {
            return Ok(None);
        };
        let mut places = Vec::new();
        for _ in 0..nodes {
            let stop = self.stops.next().ok_or_else(damaged).map_err(failed)?;
            places.push(stop.map_err(failed)?.location);
        }
        Ok(Some(LocatedWay { way_id, places }))
    }
}
