//! Numbers objects that ways outline.

use corniche_areas::AreaObject;
use corniche_store::{Sorter, append_record};

use super::records::{MemberRecord, ObjectRecord};
use crate::{
    AreaLoss, ExtractDefect, ReadOsmError,
    failed::Failed,
    reading::ExtractReading,
    spool::Spool,
    versions::{known_version, two_versions},
};

/// Objects in the order of their numbers, and the ways that they need.
pub(crate) struct NumberedObjects<'a> {
    /// Each object, without its ways.
    pub(crate) known: Spool<'a>,
    pub(crate) count: u64,
    /// The number of further objects that have the id of another one.
    pub(crate) duplicates: u64,
    pub(crate) members: Sorter<'a, MemberRecord>,
}

/// Numbers the objects consecutively. Of objects with the same id, the newest is kept, or else the
/// first.
///
/// Fails if one extract contains an object in two versions.
pub(crate) fn number_objects<'a>(
    reading: &ExtractReading<'a>,
    objects: Sorter<'a, ObjectRecord>,
    on_defect: &mut dyn FnMut(ExtractDefect),
) -> Result<NumberedObjects<'a>, Failed> {
    let (request, shares) = (reading.request, reading.shares());
    let mut numbered = NumberedObjects {
        known: Spool::new(request.scratch, shares.spool),
        count: 0,
        duplicates: 0,
        members: Sorter::new(request.scratch, shares.way_ids),
    };
    let mut last: Option<(AreaObject, u32, Option<i32>)> = None;
    for (count, object) in (0..).zip(objects.finish()?) {
        reading.check_stop_at(count)?;
        let mut object = object?;
        let version = known_version(object.origin.version);
        if let Some((before, file, first)) = last
            && before == object.object
        {
            if file != object.origin.file {
                // This object is from another extract, and is older or the same.
                continue;
            }
            let (kind, id) = object.object.parts();
            if let (Some(first), Some(second)) = (first, version)
                && first != second
            {
                let reason = two_versions(kind, id, [first, second]);
                return Err(ReadOsmError::History { path: request.extract(file), reason }.into());
            }
            numbered.duplicates += 1;
            let (is_relation, loss) = (kind == "relation", AreaLoss::Duplicate);
            on_defect(ExtractDefect::LostArea { is_relation, id, loss });
            continue;
        }
        last = Some((object.object, object.origin.file, version));
        let ways = std::mem::take(&mut object.ways);
        numbered.known.push(|bytes| append_record(bytes, object))?;
        for &member in &ways {
            let record = MemberRecord { member, object_number: numbered.count };
            numbered.members.push(record)?;
        }
        numbered.count += 1;
    }
    Ok(numbered)
}
