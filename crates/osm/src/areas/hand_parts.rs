//! Gives each object the ways of its outline, with their places.

use corniche_store::{Sorter, take_record};

use crate::{
    failed::Failed,
    outlines::{
        located_ways::LocatedWays,
        records::{MemberRecord, OutlineLine, OutlineWayRecord},
    },
    reading::Reading,
    spool::SpoolReader,
};

/// Members and ways come in order of way ids. A member whose way is not in the file gets a part that says so.
pub(crate) fn hand_parts<'a>(
    reading: &Reading<'a>,
    mut members: SpoolReader<'a>,
    mut located: LocatedWays<'a>,
) -> Result<Sorter<'a, OutlineWayRecord>, Failed> {
    let mut parts = Sorter::new(reading.request.scratch, reading.shares().way_ids);
    let mut count = 0;
    while let Some(record) = members.next(take_record)? {
        let MemberRecord { member, object_number } = record;
        let way_id = member.way_id;
        reading.check_stop_at(count)?;
        count += 1;
        let line = match located.find(way_id)? {
            Some(way) => OutlineLine::of(way.places.clone()),
            None => OutlineLine::NoWay,
        };
        parts.push(OutlineWayRecord { object_number, member, line })?;
    }
    Ok(parts)
}
