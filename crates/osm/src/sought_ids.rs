//! Ids that are looked for, sorted: as many at a time as fit in memory.

use std::io;

use corniche_store::{Sorted, Sorter};

use crate::{ahead::Ahead, failed::Failed, reading::Reading, records::SoughtId};

/// Ids of nodes or ways that are looked for; one that is wanted twice may come twice in what is sorted.
pub(crate) struct SoughtIds<'a>(Ahead<Sorted<'a, SoughtId>>);

impl<'a> SoughtIds<'a> {
    pub(crate) fn of(ids: Sorter<'a, SoughtId>) -> io::Result<Self> {
        Ok(Self(Ahead::new(ids.finish()?)))
    }

    /// The next different ids, ascending, at most so many; empty after the last.
    pub(crate) fn next(&mut self, reading: &Reading<'_>, most: usize) -> Result<Vec<i64>, Failed> {
        let mut ids: Vec<i64> = Vec::new();
        let mut count = 0;
        while let Some(&SoughtId(id)) = self.0.peek()? {
            if ids.last() != Some(&id) {
                if ids.len() == most {
                    break;
                }
                if ids.len() == ids.capacity() {
                    // Doubling as lists do it would take up to three times the memory.
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
