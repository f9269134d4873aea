//! Gives each object the ways of its outline, with their places.

use corniche_store::{Sorted, Sorter};

use crate::{
    ReadOsmError,
    outlines::{
        located_ways::{LocatedWay, LocatedWays},
        records::{MemberRecord, OutlineLine, OutlineWayRecord},
    },
    reading::Reading,
};

/// Members and ways come in order of way ids. A member whose way is not in the file gets a part that says so.
pub(crate) fn hand_parts<'a>(
    reading: &Reading<'a>,
    members: Sorted<'a, MemberRecord>,
    mut located: LocatedWays<'a>,
) -> Result<Sorter<'a, OutlineWayRecord>, ReadOsmError> {
    let failed = |error| reading.scratch_failed(error);
    let mut parts = Sorter::new(reading.request.scratch, reading.shares().way_ids);
    let mut way: Option<LocatedWay> = None;
    for (count, record) in (0..).zip(members) {
        let MemberRecord { member, object_number } = record.map_err(failed)?;
        let way_id = member.way_id;
        reading.check_stop_at(count)?;
        while way.as_ref().is_none_or(|way| way.way_id < way_id) {
            way = located.next(reading)?;
            if way.is_none() {
                break;
            }
        }
        let line = match &way {
            Some(way) if way.way_id == way_id => OutlineLine::of(way.places.clone()),
            _ => OutlineLine::NoWay,
        };
        parts.push(OutlineWayRecord { object_number, member, line }).map_err(failed)?;
    }
    Ok(parts)
}
