//! Pass 1: ways and relations with the tags of an area, and coastlines; or those of boundaries.

use std::io::{Read, Seek};

use corniche_areas::AreaObject;
use corniche_store::Sorter;
use osmpbf::{PrimitiveBlock, RelMemberType, Relation, Way};

use super::{
    records::{Member, ObjectRecord},
    wanted::Wanted,
};
use crate::{
    AreaLoss, Defect, ReadOsmError,
    blobs::Decoding,
    extracts::Extracts,
    find_ways::{NodeBlob, append_versions, check_held},
    id_range::IdRange,
    reading::{Reading, Step},
    records::age,
    text::Text,
    versions::{Versions, known_version},
};

/// What the first pass finds.
pub(crate) struct FoundObjects<'a> {
    pub(crate) objects: Sorter<'a, ObjectRecord>,
    pub(crate) node_blobs: Vec<NodeBlob>,
    /// Numbers of the blobs with ways.
    pub(crate) way_blobs: Vec<usize>,
    /// Ways with the tags of an area that are not closed.
    pub(crate) open_ways: u64,
    /// What all this takes, by an estimate that is not too low.
    pub(crate) held_bytes: u64,
}

/// Looks through all blobs.
pub(crate) fn find_objects<'a, R: Read + Seek>(
    reading: &Reading<'a>,
    file: &mut Extracts<R>,
    wanted: Wanted<'_>,
    on_defect: &mut dyn FnMut(Defect),
) -> Result<FoundObjects<'a>, ReadOsmError> {
    let request = reading.request;
    let mut found = FoundObjects {
        objects: Sorter::new(request.scratch, reading.shares().ways),
        node_blobs: Vec::new(),
        way_blobs: Vec::new(),
        open_ways: 0,
        held_bytes: 0,
    };
    let mut versions = Versions::default();
    let all: Vec<usize> = (0..file.len()).collect();
    let data_bytes = file.bytes_of(&all);
    let decoding = Decoding {
        pool: request.pool,
        should_stop: reading.should_stop,
        on_bytes: &|bytes| reading.tell(Step::Ways, bytes, 2 * data_bytes),
    };
    let is_of_several = reading.is_of_several();
    let mut order = 0;
    file.for_each(
        &all,
        &decoding,
        |block| (Versions::scan(block), IdRange::scan(block)),
        |block, most_bytes| OfBlock::scan(block, wanted, most_bytes),
        |[file, number], (versions_of_block, ids), of_block| {
            let file = file as u32;
            append_versions(reading, &mut versions, versions_of_block.of_file(file))?;
            found.held_bytes += of_block.held_bytes;
            check_held(reading, found.held_bytes)?;
            found.node_blobs.extend(ids.map(|ids| NodeBlob { number, ids }));
            if of_block.has_ways {
                found.way_blobs.push(number);
            }
            for way_id in of_block.open_ways {
                found.open_ways += 1;
                let (is_relation, loss) = (false, AreaLoss::OpenWay);
                on_defect(Defect::LostArea { is_relation, id: way_id, loss });
            }
            for mut object in of_block.objects {
                object.order = order;
                order += 1;
                object.file = file;
                object.age = if is_of_several { age(object.version) } else { 0 };
                found.objects.push(object).map_err(|error| reading.scratch_failed(error))?;
            }
            Ok(())
        },
    )?;
    Ok(found)
}

/// The objects of a block, in its order.
#[derive(Default)]
struct OfBlock {
    objects: Vec<ObjectRecord>,
    open_ways: Vec<i64>,
    has_ways: bool,
    held_bytes: u64,
}

/// What counts for each object, besides its texts and lists.
const OBJECT_BYTES: usize = 200;

/// A ring has three different points, and the first again.
const LEAST_REFS: usize = 4;

impl OfBlock {
    /// Finds the objects of a block; `None` if they take more than `most_bytes`.
    fn scan(block: &PrimitiveBlock, wanted: Wanted<'_>, most_bytes: u64) -> Option<Self> {
        let mut found = Self::default();
        for group in block.groups() {
            for way in group.ways() {
                found.has_ways = true;
                found.take_way(&way, wanted);
            }
            for relation in group.relations() {
                found.take_relation(&relation, wanted);
            }
            if found.held_bytes > most_bytes {
                return None;
            }
        }
        Some(found)
    }

    fn take_way(&mut self, way: &Way<'_>, wanted: Wanted<'_>) {
        let strings = way.raw_stringtable();
        let Some(tags) = Tags::of(strings, way.raw_tags(), wanted) else { return };
        // Closed ways may be lines, such as hedges around a field; the tags of the table are those of areas.
        let mut class = tags.class.filter(|_| wanted.has_open_ways() || !tags.is("area", "no"));
        let first = way.refs().next();
        let is_open = way.raw_refs().len() < LEAST_REFS || way.refs().last() != first;
        if class.is_some() && is_open && !wanted.has_open_ways() {
            self.open_ways.push(way.id());
            self.held_bytes += 16;
            class = None;
        }
        let is_coastline = wanted.has_sea() && tags.is("natural", "coastline");
        if class.is_none() && !is_coastline {
            return;
        }
        let version = way.info().version();
        self.push(
            AreaObject::Way(way.id()),
            version,
            (class, is_coastline),
            &tags,
            Box::new([Member { way_id: way.id(), is_inner: false }]),
        );
    }

    fn take_relation(&mut self, relation: &Relation<'_>, wanted: Wanted<'_>) {
        let strings = relation.raw_stringtable();
        let Some(tags) = Tags::of(strings, relation.raw_tags(), wanted) else { return };
        if !tags.is("type", "multipolygon") && !tags.is("type", "boundary") {
            return;
        }
        let Some(class) = tags.class else { return };
        let class = (Some(class), false);
        let ways = relation.members().filter(|member| member.member_type == RelMemberType::Way);
        let is_inner = |role: i32| {
            let role = usize::try_from(role).ok().and_then(|role| strings.get(role));
            role.is_some_and(|role| role == b"inner")
        };
        let is_outline = |role: i32| {
            let role = usize::try_from(role).ok().and_then(|role| strings.get(role));
            wanted.is_outline(role.map_or(&[], Vec::as_slice))
        };
        let mut ways: Vec<Member> = ways
            .filter(|way| is_outline(way.role_sid))
            .map(|way| Member { way_id: way.member_id, is_inner: is_inner(way.role_sid) })
            .collect();
        // A way that is named twice counts once, as in libosmium.
        ways.sort_unstable();
        ways.dedup_by_key(|way| way.way_id);
        let version = relation.info().version();
        self.push(AreaObject::Relation(relation.id()), version, class, &tags, ways.into());
    }

    fn push(
        &mut self,
        object: AreaObject,
        version: Option<i32>,
        (class, is_coastline): (Option<u8>, bool),
        tags: &Tags<'_>,
        ways: Box<[Member]>,
    ) {
        let name: Box<str> = tags.value("name").unwrap_or_default().into();
        // Each way is sorted twice more.
        self.held_bytes += (OBJECT_BYTES + name.len() + 80 * ways.len()) as u64;
        let version = version.and_then(known_version).unwrap_or_default();
        self.objects.push(ObjectRecord {
            object,
            age: 0,
            order: 0,
            version,
            file: 0,
            class,
            is_coastline,
            name,
            ways,
        });
    }
}

/// The tags of an object that has one of the table's keys.
struct Tags<'a> {
    texts: Vec<[Text<'a>; 2]>,
    /// The number of its class.
    class: Option<u8>,
}

impl<'a> Tags<'a> {
    /// `None` without one of the keys: most objects have none, and their tags need no decoding.
    fn of(
        strings: &'a [Vec<u8>],
        raw: impl Iterator<Item = (u32, u32)> + Clone,
        wanted: Wanted<'_>,
    ) -> Option<Self> {
        let bytes = |number: u32| strings.get(number as usize).map_or(&[][..], Vec::as_slice);
        let is_known = |(key, _): (u32, u32)| wanted.is_key(bytes(key));
        if !raw.clone().any(is_known) {
            return None;
        }
        let texts: Vec<[Text<'_>; 2]> =
            raw.map(|pair| [pair.0, pair.1].map(|number| Text::new(bytes(number)))).collect();
        let plain: Vec<(&str, &str)> =
            texts.iter().map(|[key, value]| (&*key.text, &*value.text)).collect();
        let class = wanted.classify(&plain);
        Some(Self { texts, class })
    }

    fn value(&self, key: &str) -> Option<&str> {
        self.texts.iter().find(|[own, _]| own.text == key).map(|[_, value]| &*value.text)
    }

    fn is(&self, key: &str, value: &str) -> bool {
        self.value(key) == Some(value)
    }
}
