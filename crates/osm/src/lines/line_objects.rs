//! The objects that give ways of a layer of lines their classes and values.

use std::{io, iter};

use corniche_layers::{AttributeValue, OsmObject};
use corniche_store::{ScratchRange, take_record};

use crate::{
    ahead::Ahead,
    failed::Failed,
    looked::check_held,
    outlines::records::{ObjectRecord, take_values},
    reading::ExtractReading,
    spool::SpoolReader,
};

/// The class and the values of an object; `None` without an object.
pub(crate) type ClassAndValues = Option<(u8, Vec<Option<AttributeValue>>)>;

/// Ways in order of ids, and all relations.
pub(crate) struct LineObjects<'a, I: Iterator> {
    reading: &'a ExtractReading<'a>,
    ways: Ahead<I>,
    ways_count: u64,
    relations: Vec<LineRelation>,
}

/// A relation whose ways are lines.
struct LineRelation {
    class: Option<u8>,
    values: KeptBytes,
}

/// The values of a relation, which many ways may need.
enum KeptBytes {
    InMemory(Box<[u8]>),
    InScratch(ScratchRange),
}

/// Reads ways and relations; relations are read to their end.
pub(crate) fn line_objects<'a>(
    reading: &'a ExtractReading<'a>,
    [mut ways, mut relations]: [SpoolReader<'a>; 2],
    counts: [u64; 2],
    held_bytes: u64,
) -> Result<LineObjects<'a, impl Iterator<Item = io::Result<ObjectRecord>> + 'a>, Failed> {
    let list_bytes = counts[1].saturating_mul(size_of::<LineRelation>() as u64);
    check_held(reading, held_bytes + list_bytes)?;
    let mut list = Vec::with_capacity(counts[1] as usize);
    let mut room_bytes = reading.shares().objects;
    while let Some(object) = relations.next(take_record::<ObjectRecord>)? {
        reading.check_stop_at(list.len() as u64)?;
        let length = object.values.len() as u64;
        let values = if length <= room_bytes {
            room_bytes -= length;
            KeptBytes::InMemory(object.values)
        } else {
            KeptBytes::InScratch(reading.request.scratch.append(&object.values)?)
        };
        list.push(LineRelation { class: object.class, values });
    }
    let ways = Ahead::new(iter::from_fn(move || ways.next(take_record).transpose()));
    Ok(LineObjects { reading, ways, ways_count: counts[0], relations: list })
}

impl<I: Iterator<Item = io::Result<ObjectRecord>>> LineObjects<'_, I> {
    /// Returns the first class that the way itself and the relations with these numbers give the
    /// way, and the values of the first object that gives it. Ways must be requested in ascending
    /// order of ids.
    pub(crate) fn class_and_values(
        &mut self,
        way_id: i64,
        numbers: &[u64],
    ) -> io::Result<ClassAndValues> {
        while self.ways.peek()?.is_some_and(|way| way.object < OsmObject::Way(way_id)) {
            self.ways.take();
        }
        let own = self.ways.peek()?.filter(|way| way.object == OsmObject::Way(way_id));
        let own_class = own.and_then(|way| way.class);
        let relations = numbers.iter().filter_map(|&number| {
            let index = number.checked_sub(self.ways_count)?;
            let relation = self.relations.get(usize::try_from(index).ok()?)?;
            Some((relation.class?, number, &relation.values))
        });
        let first = relations.min_by_key(|&(class, number, _)| (class, number));
        match (own_class, first) {
            (_, Some((class, _, values))) if own_class.is_none_or(|own| class < own) => {
                let values = match values {
                    KeptBytes::InMemory(values) => take_values(values),
                    &KeptBytes::InScratch(range) => {
                        take_values(&self.reading.request.scratch.read(range)?)
                    }
                };
                Ok(Some((class, values?)))
            }
            (Some(class), _) => {
                let values = self.ways.peek()?.map(|way| take_values(&way.values));
                Ok(Some((class, values.transpose()?.unwrap_or_default())))
            }
            _ => Ok(None),
        }
    }
}
