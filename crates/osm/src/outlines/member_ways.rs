//! The ways that counting objects reference. Older versions of an object also reference ways, but
//! nothing needs those.

use std::io;

use corniche_store::{Sorted, append_record};

use super::records::MemberRecord;
use crate::{ahead::Ahead, records::WayRecord, spool::Spool};

/// The ways that members reference, in order of way ids; members are stored in the same order.
pub(crate) struct MemberWays<'a> {
    ways: Sorted<'a, WayRecord>,
    members: Ahead<Sorted<'a, MemberRecord>>,
    kept: Spool<'a>,
}

impl<'a> MemberWays<'a> {
    pub(crate) fn new(
        ways: Sorted<'a, WayRecord>,
        members: Sorted<'a, MemberRecord>,
        kept: Spool<'a>,
    ) -> Self {
        Self { ways, members: Ahead::new(members), kept }
    }

    /// Whether a member references a way. Ways must be requested in ascending order of ids.
    fn is_member(&mut self, way_id: i64) -> io::Result<bool> {
        while let Some(&record) = self.members.peek()? {
            if record.member.way_id >= way_id {
                return Ok(record.member.way_id == way_id);
            }
            self.kept.push(|bytes| append_record(bytes, record))?;
            self.members.take();
        }
        Ok(false)
    }

    /// Returns all members, in order of their way ids.
    pub(crate) fn into_members(mut self) -> io::Result<Spool<'a>> {
        while let Some(&record) = self.members.peek()? {
            self.kept.push(|bytes| append_record(bytes, record))?;
            self.members.take();
        }
        Ok(self.kept)
    }
}

impl Iterator for MemberWays<'_> {
    type Item = io::Result<WayRecord>;

    fn next(&mut self) -> Option<Self::Item> {
        loop {
            let way = self.ways.next()?;
            let member = way.and_then(|way| Ok(self.is_member(way.way_id)?.then_some(way)));
            if let Some(found) = member.transpose() {
                return Some(found);
            }
        }
    }
}
