//! Numbers objects, and pass 2: the ways of their outlines.

use std::io::{Read, Seek};

use corniche_store::{SortRecord as _, Sorted, Sorter};
use osmpbf::PrimitiveBlock;

use super::{
    records::{MemberRecord, ObjectRecord},
    summary::AreaSummary,
};
use crate::{
    AreaLoss, Defect, ExtractSummary, ReadOsmError,
    ahead::Ahead,
    blobs::Decoding,
    extracts::Extracts,
    find_ways::check_held,
    location::{Location, location_from_nano},
    reading::{Reading, Step},
    records::{Located, WayRecord, age},
    spool::Spool,
    versions::{known_version, two_versions},
    way_bytes::node_bytes,
    way_facts::WayFacts,
};

/// Objects in the order of their numbers, and the ways that they need.
pub(crate) struct NumberedObjects<'a> {
    /// [`super::records::Known`] of each object.
    pub(crate) known: Spool<'a>,
    pub(crate) count: u64,
    pub(crate) members: Sorter<'a, MemberRecord>,
}

/// Numbers the objects through. Of objects with one id the newest stays, or the first.
///
/// Fails if one extract has an object in two versions.
pub(crate) fn number_objects<'a>(
    reading: &Reading<'a>,
    objects: Sorter<'a, ObjectRecord>,
    summary: &mut AreaSummary,
    on_defect: &mut dyn FnMut(Defect),
) -> Result<NumberedObjects<'a>, ReadOsmError> {
    let (request, shares) = (reading.request, reading.shares());
    let failed = |error| reading.scratch_failed(error);
    let mut numbered = NumberedObjects {
        known: Spool::new(request.scratch, shares.spool),
        count: 0,
        members: Sorter::new(request.scratch, shares.mentions),
    };
    let mut last: Option<(ObjectId, u32, Option<i32>)> = None;
    for (count, object) in (0..).zip(objects.finish().map_err(failed)?) {
        reading.check_stop_at(count)?;
        let object = object.map_err(failed)?;
        let version = known_version(object.version);
        if let Some((before, file, first)) = last
            && before == object.object
        {
            if file != object.file {
                // That of another extract, which is older or the same.
                continue;
            }
            let (kind, id) = object.object.parts();
            if let (Some(first), Some(second)) = (first, version)
                && first != second
            {
                let reason = two_versions(kind, id, [first, second]);
                return Err(ReadOsmError::History { path: request.extract(file), reason });
            }
            summary.objects += 1;
            *summary.lost.entry(AreaLoss::Duplicate).or_default() += 1;
            let (is_relation, loss) = (kind == "relation", AreaLoss::Duplicate);
            on_defect(Defect::LostArea { is_relation, id, loss });
            continue;
        }
        last = Some((object.object, object.file, version));
        let (known, ways) = object.into_known();
        numbered.known.push(|bytes| known.encode(bytes)).map_err(failed)?;
        for &member in &ways {
            let record = MemberRecord { member, object_number: numbered.count };
            numbered.members.push(record).map_err(failed)?;
        }
        numbered.count += 1;
    }
    summary.objects += numbered.count;
    Ok(numbered)
}

type ObjectId = corniche_areas::AreaObject;

/// The ways that objects need, as far as the file has them.
pub(crate) struct FoundOutlines<'a> {
    pub(crate) ways: Sorter<'a, WayRecord>,
    pub(crate) located: Sorter<'a, Located>,
    /// The members again, by way id.
    pub(crate) members: Spool<'a>,
}

/// Reads the blobs with ways, once for each so many ways as fit in memory.
pub(crate) fn find_outlines<'a, R: Read + Seek>(
    reading: &Reading<'a>,
    file: &mut Extracts<R>,
    way_blobs: &[usize],
    members: Sorter<'a, MemberRecord>,
    held_bytes: &mut u64,
) -> Result<FoundOutlines<'a>, ReadOsmError> {
    let (request, shares) = (reading.request, reading.shares());
    let failed = |error| reading.scratch_failed(error);
    let mut found = FoundOutlines {
        ways: Sorter::new(request.scratch, shares.ways),
        located: Sorter::new(request.scratch, shares.located),
        members: Spool::new(request.scratch, shares.spool),
    };
    let data_bytes = file.bytes_of(way_blobs);
    let (mut order, mut located_order) = (0, 0);
    let mut members = Ahead::new(members.finish().map_err(failed)?);
    let most_ids = (shares.ids / size_of::<i64>() as u64).max(1) as usize;
    let mut facts: Box<[u8]> = Box::default();
    if reading.is_of_several() {
        // Of ways that have them, that of the newest version counts.
        facts = WayFacts::of(ExtractSummary::default(), Vec::new()).to_bytes();
    }
    loop {
        let ids = next_ids(reading, &mut members, most_ids, &mut found.members)?;
        if ids.is_empty() {
            return Ok(found);
        }
        let decoding = Decoding {
            pool: request.pool,
            should_stop: reading.should_stop,
            on_bytes: &|bytes| reading.tell(Step::Ways, data_bytes + bytes, 2 * data_bytes),
        };
        let scan = |block: &PrimitiveBlock, most_bytes| Outlines::scan(block, &ids, most_bytes);
        file.for_each(
            way_blobs,
            &decoding,
            |_| (),
            scan,
            |[file, _], (), of_block| {
                *held_bytes += of_block.held_bytes;
                check_held(reading, *held_bytes)?;
                for mut way in of_block.ways {
                    way.order = order;
                    order += 1;
                    way.file = file as u32;
                    way.age = if reading.is_of_several() { age(way.version) } else { 0 };
                    way.facts.clone_from(&facts);
                    found.ways.push(way).map_err(failed)?;
                }
                for (node_id, location) in of_block.located {
                    let located = Located { node_id, order: located_order, location };
                    located_order += 1;
                    found.located.push(located).map_err(failed)?;
                }
                Ok(())
            },
        )?;
    }
}

/// The next different way ids, ascending, at most so many; their members go to `spool`.
fn next_ids<'a>(
    reading: &Reading<'a>,
    members: &mut Ahead<Sorted<'a, MemberRecord>>,
    most: usize,
    spool: &mut Spool<'a>,
) -> Result<Vec<i64>, ReadOsmError> {
    let failed = |error| reading.scratch_failed(error);
    let mut ids = Vec::new();
    let mut count = 0;
    while let Some(&member) = members.peek().map_err(failed)? {
        let way_id = member.member.way_id;
        if ids.last() != Some(&way_id) {
            if ids.len() == most {
                break;
            }
            ids.push(way_id);
        }
        spool.push(|bytes| member.encode(bytes)).map_err(failed)?;
        members.take();
        reading.check_stop_at(count)?;
        count += 1;
    }
    Ok(ids)
}

/// The ways of a block that are asked for.
#[derive(Default)]
struct Outlines {
    ways: Vec<WayRecord>,
    /// Where nodes lie, in files that say so in their ways (`LocationsOnWays`).
    located: Vec<(i64, Location)>,
    held_bytes: u64,
}

impl Outlines {
    /// `None` if they take more than `most_bytes`.
    fn scan(block: &PrimitiveBlock, ids: &[i64], most_bytes: u64) -> Option<Self> {
        const WAY_BYTES: usize = 160;
        let mut found = Self::default();
        let mut node_ids = Vec::new();
        for way in block.groups().flat_map(|group| group.ways()) {
            if ids.binary_search(&way.id()).is_err() {
                continue;
            }
            node_ids.clear();
            node_ids.extend(way.refs());
            let locations = way.node_locations();
            let located = locations
                .map(|location| location_from_nano(location.nano_lon(), location.nano_lat()));
            found.located.extend(node_ids.iter().copied().zip(located));
            // Ids and places, each sorted twice.
            found.held_bytes += (WAY_BYTES + 48 * node_ids.len()) as u64;
            found.ways.push(WayRecord {
                way_id: way.id(),
                age: 0,
                order: 0,
                version: way.info().version().and_then(known_version).unwrap_or_default(),
                file: 0,
                bytes: node_bytes(&node_ids),
                facts: Box::default(),
            });
            if found.held_bytes > most_bytes {
                return None;
            }
        }
        Some(found)
    }
}
