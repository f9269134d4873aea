//! The findings for the objects of a layer while an extract is read.

use std::{collections::BTreeMap, io};

use corniche_layers::OsmObject;
use corniche_store::Sorter;

use super::{
    judge::OfBlock,
    member_ways::MemberWays,
    number_objects::{NumberedObjects, number_objects},
    records::ObjectRecord,
    wanted::WantedObjects,
};
use crate::{
    AreaLoss, ExtractDefect, ExtractSummary,
    deferred::Deferred,
    failed::Failed,
    looked::check_held,
    number_nodes::{NumberedNodes, number_nodes},
    reading::ExtractReading,
    records::{SoughtId, WayRecord},
    sought_ids::SoughtIds,
    spool::{Spool, SpoolReader},
    way_facts::WayFacts,
};

/// The objects of a layer and their ways that were found so far.
pub(crate) struct Outlines<'a> {
    pub(crate) wanted: WantedObjects<'a>,
    objects: Sorter<'a, ObjectRecord>,
    objects_count: u64,
    ways: Sorter<'a, WayRecord>,
    ways_count: u64,
    /// The ways still to look for, because objects found before them reference them.
    way_ids: Sorter<'a, SoughtId>,
    /// The number of ways with area tags that are not closed.
    open_ways: u64,
    defects: Deferred<'a>,
    /// The memory of all this, bytes, by an estimate that is never too low.
    held_bytes: u64,
    /// The facts stored with each way if it may be in several extracts, of which the newest version
    /// counts.
    facts: Box<[u8]>,
}

impl<'a> Outlines<'a> {
    pub(crate) fn new(reading: &ExtractReading<'a>, wanted: WantedObjects<'a>) -> Self {
        let (shares, scratch) = (reading.shares(), reading.request.scratch);
        let mut facts: Box<[u8]> = Box::default();
        if reading.is_of_several() {
            facts = WayFacts::default().to_bytes();
        }
        Self {
            wanted,
            // Nodes of the layer get the other half.
            objects: reading.sorter(shares.objects / if wanted.has_nodes() { 2 } else { 1 }),
            objects_count: 0,
            ways: reading.sorter(shares.ways),
            ways_count: 0,
            way_ids: reading.sorter(shares.mentions),
            open_ways: 0,
            defects: Deferred::new(scratch, shares.defects),
            held_bytes: 0,
            facts,
        }
    }

    /// Adds the contents of a block of one of the extracts. With `is_before_ways`, the ways of its
    /// objects are looked for later.
    pub(crate) fn take(
        &mut self,
        reading: &ExtractReading<'_>,
        file: u32,
        of_block: OfBlock,
        is_before_ways: bool,
    ) -> Result<(), Failed> {
        self.held_bytes += of_block.held_bytes;
        check_held(reading, self.held_bytes)?;
        for id in of_block.open_ways {
            self.open_ways += 1;
            let (object, loss) = (OsmObject::Way(id), AreaLoss::OpenWay);
            self.defects.push(&ExtractDefect::LostArea { object, loss });
        }
        for mut object in of_block.objects {
            object.origin.place(reading, file, &mut self.objects_count);
            if is_before_ways {
                for way in &object.ways {
                    self.way_ids.push(SoughtId(way.way_id))?;
                }
            }
            self.objects.push(object)?;
        }
        for mut way in of_block.ways {
            way.origin.place(reading, file, &mut self.ways_count);
            way.facts.clone_from(&self.facts);
            self.ways.push(way)?;
        }
        Ok(())
    }

    /// Numbers the objects, and the nodes of the ways that the counting objects reference.
    pub(crate) fn number(
        self,
        reading: &ExtractReading<'a>,
    ) -> Result<(OutlineObjects<'a>, NumberedNodes<'a>), Failed> {
        let Self { wanted, objects, ways, open_ways, mut defects, held_bytes, .. } = self;
        let on_defect = &mut |defect: ExtractDefect| defects.push(&defect);
        let NumberedObjects { known, counts, duplicates, members, unread } =
            number_objects(reading, (objects, wanted), on_defect)?;
        let kept = Spool::new(reading.request.scratch, reading.shares().spool);
        let members = members.finish()?;
        let mut ways = MemberWays::new(ways.finish()?, members, kept);
        // These counts describe roads, so they are not used.
        let none = &mut ExtractSummary::default();
        let numbered = number_nodes(reading, &mut ways, none, on_defect, None)?;
        let members = ways.into_members()?.read();
        let known = known.map(Spool::read);
        let objects = OutlineObjects {
            known,
            counts,
            duplicates,
            members,
            open_ways,
            unread,
            defects,
            nodes: None,
            held_bytes,
        };
        Ok((objects, numbered))
    }

    /// Returns the ways to look for. No way may be added afterwards.
    pub(crate) fn take_way_ids(
        &mut self,
        reading: &ExtractReading<'a>,
    ) -> io::Result<SoughtIds<'a>> {
        SoughtIds::from_sorter(std::mem::replace(&mut self.way_ids, reading.sorter(0)))
    }
}

/// The objects of a layer, with all their data except the positions of their ways.
pub(crate) struct OutlineObjects<'a> {
    /// The [`ObjectRecord`] of each way and of each relation, without their ways, in the order of
    /// their numbers. Ways come first.
    pub(crate) known: [SpoolReader<'a>; 2],
    /// The numbers of ways and of relations.
    pub(crate) counts: [u64; 2],
    /// The number of further objects that have the id of another one.
    pub(crate) duplicates: u64,
    /// The [`super::records::MemberRecord`] of each way that the objects need, in order of way ids.
    pub(crate) members: SpoolReader<'a>,
    /// The number of ways with area tags that are not closed.
    pub(crate) open_ways: u64,
    /// Values that are not of the kinds of their attributes, by key.
    pub(crate) unread: BTreeMap<String, u64>,
    pub(crate) defects: Deferred<'a>,
    /// The nodes of a layer of points, when they have been read.
    pub(crate) nodes: Option<NumberedObjects<'a>>,
    /// The memory of all this, bytes, by an estimate that is never too low.
    pub(crate) held_bytes: u64,
}
