//! Numbers objects that ways outline.

use std::collections::BTreeMap;

use corniche_layers::OsmObject;
use corniche_store::{Sorter, append_record};

use super::{
    records::{MemberRecord, ObjectRecord},
    wanted::WantedObjects,
};
use crate::{
    AreaLoss, ExtractDefect, ReadOsmError,
    failed::Failed,
    reading::ExtractReading,
    spool::Spool,
    versions::{known_version, two_versions},
};

/// Objects in the order of their numbers, and the ways that they need.
pub(crate) struct NumberedObjects<'a> {
    /// Each way, and each relation without its ways.
    pub(crate) known: [Spool<'a>; 2],
    /// The numbers of ways and of relations.
    pub(crate) counts: [u64; 2],
    /// The number of further objects that have the id of another one.
    pub(crate) duplicates: u64,
    pub(crate) members: Sorter<'a, MemberRecord>,
    /// Values that are not of the kinds of their attributes, by key.
    pub(crate) unread: BTreeMap<String, u64>,
}

/// Numbers the objects consecutively. Of objects with the same id, the newest is kept, or else the
/// first.
///
/// Fails if one extract contains an object in two versions.
pub(crate) fn number_objects<'a>(
    reading: &ExtractReading<'a>,
    (objects, wanted): (Sorter<'a, ObjectRecord>, WantedObjects<'_>),
    on_defect: &mut dyn FnMut(ExtractDefect),
) -> Result<NumberedObjects<'a>, Failed> {
    let (request, shares) = (reading.request, reading.shares());
    let mut numbered = NumberedObjects {
        known: [(); 2].map(|()| Spool::new(request.scratch, shares.spool / 2)),
        counts: [0; 2],
        duplicates: 0,
        members: Sorter::new(request.scratch, shares.way_ids),
        unread: BTreeMap::new(),
    };
    let mut last: Option<(OsmObject, u32, Option<i32>)> = None;
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
            let (object, loss) = (object.object, AreaLoss::Duplicate);
            on_defect(ExtractDefect::LostArea { object, loss });
            continue;
        }
        last = Some((object.object, object.origin.file, version));
        for number in std::mem::take(&mut object.unread) {
            let key = wanted.table.attributes().nth(number.into()).map(|(key, _)| key.to_owned());
            let Some(key) = key else { continue };
            *numbered.unread.entry(key.clone()).or_default() += 1;
            on_defect(ExtractDefect::UnreadValue { object: object.object, key });
        }
        let object_number = numbered.counts.iter().sum();
        for member in std::mem::take(&mut object.ways) {
            numbered.members.push(MemberRecord { member, object_number })?;
        }
        let kind = usize::from(matches!(object.object, OsmObject::Relation(_)));
        numbered.known[kind].push(|bytes| append_record(bytes, object))?;
        numbered.counts[kind] += 1;
    }
    Ok(numbered)
}
