//! Delivers areas and their defects in the order of the objects.

use corniche_store::{Sorter, take_record};

use super::{
    layer_area::{AreaSummary, LayerArea},
    make_areas::make_areas,
};
use crate::{
    AreaLoss, ExtractDefect,
    failed::Failed,
    layer_sink::LayerSink,
    outlines::{
        found::OutlineObjects,
        located_ways::LocatedWays,
        records::{MemberRecord, OutlinePoints, OutlineWayRecord},
    },
    reading::ExtractReading,
    spool::SpoolReader,
};

/// Delivers areas and their defects.
pub(crate) fn hand_out_areas<'a>(
    reading: &ExtractReading<'a>,
    (objects, located): (OutlineObjects<'a>, LocatedWays<'a>),
    sink: &mut dyn LayerSink<LayerArea, AreaSummary>,
    on_defect: &mut dyn FnMut(ExtractDefect),
) -> Result<(), Failed> {
    let OutlineObjects {
        known,
        counts,
        duplicates,
        members,
        open_ways,
        unread,
        defects,
        held_bytes,
        ..
    } = objects;
    let ([ways, relations], count) = (known, counts.iter().sum::<u64>());
    let known = ways.followed_by(relations);
    sink.begin();
    defects.tell(on_defect)?;
    let all = open_ways + duplicates + count;
    let mut summary = AreaSummary { objects: all, unread, ..AreaSummary::default() };
    for (loss, count) in [(AreaLoss::OpenWay, open_ways), (AreaLoss::Duplicate, duplicates)] {
        if count > 0 {
            summary.lost.insert(loss, count);
        }
    }
    let parts = hand_parts(reading, members, located)?.finish()?;
    make_areas(reading, (known, count), parts, held_bytes, &mut summary, sink, on_defect)?;
    sink.end(summary);
    Ok(())
}

/// Assigns to each object the ways of its outline, with their coordinates. Members and ways arrive
/// in the order of way ids. A member whose way is missing from the file gets a part that says so.
fn hand_parts<'a>(
    reading: &ExtractReading<'a>,
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
            Some(way) => OutlinePoints::from_locations(&way.places),
            None => Err(AreaLoss::MissingWays),
        };
        parts.push(OutlineWayRecord { object_number, member, line })?;
    }
    Ok(parts)
}
