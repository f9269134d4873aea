//! Sorted ids to look for, as many at a time as fit in memory.

use std::io;

use corniche_store::{Sorted, Sorter};

use crate::{ahead::Ahead, failed::Failed, reading::ExtractReading, records::SoughtId};

/// Ids of nodes or ways to look for. An id that is requested twice may occur twice in the sorted
/// input.
pub(crate) struct SoughtIds<'a>(Ahead<Sorted<'a, SoughtId>>);

impl<'a> SoughtIds<'a> {
    pub(crate) fn from_sorter(ids: Sorter<'a, SoughtId>) -> io::Result<Self> {
        Ok(Self(Ahead::new(ids.finish()?)))
    }

    /// Returns the next different ids in ascending order, up to a maximum number; empty after the
    /// last id.
    pub(crate) fn next(
        &mut self,
        reading: &ExtractReading<'_>,
        most: usize,
    ) -> Result<Vec<i64>, Failed> {
        let mut ids: Vec<i64> = Vec::new();
        let mut count = 0;
        while let Some(&SoughtId(id)) = self.0.peek()? {
            if ids.last() != Some(&id) {
                if ids.len() == most {
                    break;
                }
                if ids.len() == ids.capacity() {
                    // The doubling that lists do by themselves would take up to three times the
                    // memory.
                    ids.reserve_exact(ids.len().max(1 << 10).min(most - ids.len()));
                }
                ids.push(id);
            }
            self.0.take();
            reading.check_stop_at(count)?;
            count += 1;
        }
        Ok(ids)
    }
}
