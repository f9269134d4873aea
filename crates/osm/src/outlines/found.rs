//! What is found of one kind of outlined objects while an extract is read.

use std::io;

use corniche_store::Sorter;

use super::{
    judge::OfBlock,
    member_ways::MemberWays,
    number_objects::{NumberedObjects, number_objects},
    records::ObjectRecord,
    wanted::Wanted,
};
use crate::{
    AreaLoss, Defect, ExtractSummary,
    deferred::Deferred,
    failed::Failed,
    looked::check_held,
    number_nodes::{NumberedNodes, number_nodes},
    reading::Reading,
    records::{SoughtId, WayRecord},
    sought_ids::SoughtIds,
    spool::{Spool, SpoolReader},
    way_facts::WayFacts,
};

/// The objects and ways of one kind that were found so far.
pub(crate) struct Outlines<'a> {
    pub(crate) wanted: Wanted<'a>,
    objects: Sorter<'a, ObjectRecord>,
    objects_count: u64,
    ways: Sorter<'a, WayRecord>,
    ways_count: u64,
    /// The ways that are still to be looked for, by the objects that were found before them.
    way_ids: Sorter<'a, SoughtId>,
    /// Ways with the tags of an area that are not closed.
    open_ways: u64,
    defects: Deferred<'a>,
    /// What all this takes, by an estimate that is not too low.
    held_bytes: u64,
    /// What goes with each way where it may be in several extracts: of those that have it, the newest version counts.
    facts: Box<[u8]>,
}

impl<'a> Outlines<'a> {
    pub(crate) fn new(reading: &Reading<'a>, wanted: Wanted<'a>) -> Self {
        let (shares, scratch) = (reading.shares(), reading.request.scratch);
        let mut facts: Box<[u8]> = Box::default();
        if reading.is_of_several() {
            facts = WayFacts::default().to_bytes();
        }
        Self {
            wanted,
            objects: reading.sorter(shares.objects),
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

    /// Takes what is in a block of one of the extracts. `is_before_ways`: the ways of its objects are looked for later.
    pub(crate) fn take(
        &mut self,
        reading: &Reading<'_>,
        file: u32,
        of_block: OfBlock,
        is_before_ways: bool,
    ) -> Result<(), Failed> {
        self.held_bytes += of_block.held_bytes;
        check_held(reading, self.held_bytes)?;
        for id in of_block.open_ways {
            self.open_ways += 1;
            let (is_relation, loss) = (false, AreaLoss::OpenWay);
            self.defects.push(&Defect::LostArea { is_relation, id, loss });
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

    /// Numbers the objects, and the nodes of the ways that those name which count.
    pub(crate) fn number(
        self,
        reading: &Reading<'a>,
    ) -> Result<(OutlineObjects<'a>, NumberedNodes<'a>), Failed> {
        let Self { objects, ways, open_ways, mut defects, held_bytes, .. } = self;
        let on_defect = &mut |defect: Defect| defects.push(&defect);
        let NumberedObjects { known, count, duplicates, members } =
            number_objects(reading, objects, on_defect)?;
        let kept = Spool::new(reading.request.scratch, reading.shares().spool);
        let members = members.finish()?;
        let mut ways = MemberWays::new(ways.finish()?, members, kept);
        // What these count is of roads.
        let none = &mut ExtractSummary::default();
        let numbered = number_nodes(reading, &mut ways, none, on_defect, None)?;
        let members = ways.into_members()?.read();
        let known = known.read();
        let objects =
            OutlineObjects { known, count, duplicates, members, open_ways, defects, held_bytes };
        Ok((objects, numbered))
    }

    /// The ways that are to be looked for; from now on none is added.
    pub(crate) fn take_way_ids(&mut self, reading: &Reading<'a>) -> io::Result<SoughtIds<'a>> {
        SoughtIds::of(std::mem::replace(&mut self.way_ids, reading.sorter(0)))
    }
}

/// Objects of one kind, all that is known of them but for the places of their ways.
pub(crate) struct OutlineObjects<'a> {
    /// [`ObjectRecord`] of each object, without its ways, in the order of their numbers.
    pub(crate) known: SpoolReader<'a>,
    pub(crate) count: u64,
    /// How many more have the id of another one.
    pub(crate) duplicates: u64,
    /// [`super::records::MemberRecord`] of each way that they need, in order of the ids of ways.
    pub(crate) members: SpoolReader<'a>,
    /// Ways with the tags of an area that are not closed.
    pub(crate) open_ways: u64,
    pub(crate) defects: Deferred<'a>,
    /// What all this takes, by an estimate that is not too low.
    pub(crate) held_bytes: u64,
}
