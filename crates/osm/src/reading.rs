//! What every step of a reading needs.

use std::io;

use corniche_store::{SortRecord, Sorter};
use rayon::prelude::*;

use crate::{ReadOsmError, kept_error::KeptError, nodes::Precedence, read_request::ReadRequest};

/// What takes of the memory, as a part of the whole. At no time is there more than the whole, in sixteenths:
///
/// | | ways | mentions | located | defects | spool | ids | visits | stops | all |
/// |---|---|---|---|---|---|---|---|---|---|
/// | ways are read | 8 | | ½ | ½ | | | | | 9 |
/// | nodes are numbered | 8 | 4 | ½ | ½ | 1 | | | | 14 |
/// | nodes are located | | 4 | ½ | ½ | 1 | 4 | 2 | 4 | 16 |
/// | roads are handed out | | | | | 1 | | | 4 | 5 |
#[derive(Debug, Clone, Copy)]
pub(crate) struct Shares {
    /// Road ways that are sorted by id, bytes; so are all of these.
    pub(crate) ways: u64,
    /// Nodes of ways that are sorted by id.
    pub(crate) mentions: u64,
    /// The same with the places that the ways give.
    pub(crate) located: u64,
    /// Defects that are not told yet.
    pub(crate) defects: u64,
    /// What the roads are, in their order.
    pub(crate) spool: u64,
    /// Nodes whose places are sought.
    pub(crate) ids: u64,
    /// Where the ways name them.
    pub(crate) visits: u64,
    /// Nodes of ways with their places, which are sorted by way.
    pub(crate) stops: u64,
}

/// The steps that [`crate::read_request::OnProgress`] counts the file's bytes in.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Step {
    Ways,
    Nodes,
    Roads,
}

const STEPS: u64 = 3;

/// A request, what the steps ask of it, and the size of the file.
#[derive(Clone, Copy)]
pub(crate) struct Reading<'a> {
    pub(crate) request: &'a ReadRequest<'a>,
    pub(crate) should_stop: &'a (dyn Fn() -> bool + Sync),
    pub(crate) len_bytes: u64,
}

impl<'a> Reading<'a> {
    /// Sorts within so much memory, in the pool.
    pub(crate) fn sorter<T: SortRecord + 'a>(&self, memory_bytes: u64) -> Sorter<'a, T> {
        let ReadRequest { scratch, pool, .. } = *self.request;
        let sort = move |records: &mut [T]| pool.install(|| records.par_sort_unstable());
        Sorter::new(scratch, memory_bytes).sorted_by(sort)
    }

    pub(crate) fn shares(&self) -> Shares {
        let sixteenth = self.request.memory_bytes / 16;
        Shares {
            ways: 8 * sixteenth,
            mentions: 4 * sixteenth,
            located: sixteenth / 2,
            defects: sixteenth / 2,
            spool: sixteenth,
            ids: 4 * sixteenth,
            visits: 2 * sixteenth,
            stops: 4 * sixteenth,
        }
    }

    /// Whether an object may be in two extracts.
    pub(crate) fn is_of_several(&self) -> bool {
        !self.request.others.is_empty()
    }

    /// Which of several places of a node counts.
    pub(crate) fn precedence(&self) -> Precedence {
        if self.is_of_several() { Precedence::Newest } else { Precedence::First }
    }

    /// Fails if the caller wants no more.
    pub(crate) fn check_stop(&self) -> Result<(), ReadOsmError> {
        if (self.should_stop)() { Err(self.stopped()) } else { Ok(()) }
    }

    pub(crate) fn stopped(&self) -> ReadOsmError {
        ReadOsmError::Stopped { path: self.request.path.to_path_buf() }
    }

    /// The same, for loops over small things: asks once in a while. `count` counts them.
    pub(crate) fn check_stop_at(&self, count: u64) -> Result<(), ReadOsmError> {
        const OFTEN: u64 = 1 << 16;
        if count.is_multiple_of(OFTEN) { self.check_stop() } else { Ok(()) }
    }

    /// The scratch space failed, or what shares kept could not be read.
    pub(crate) fn scratch_failed(&self, source: io::Error) -> ReadOsmError {
        match source.downcast() {
            Ok(kept) => self.kept_failed(kept),
            Err(source) => ReadOsmError::Scratch { path: self.request.path.to_path_buf(), source },
        }
    }

    /// What shares keep could not be kept or read.
    pub(crate) fn kept_failed(&self, source: KeptError) -> ReadOsmError {
        ReadOsmError::Kept { path: self.request.path.to_path_buf(), source }
    }

    /// Tells that `done` of `all` of a step are done, and the steps before it.
    pub(crate) fn tell(&self, step: Step, done: u64, all: u64) {
        if let Some(on_progress) = self.request.on_progress {
            let of_step =
                u128::from(self.len_bytes) * u128::from(done.min(all)) / u128::from(all.max(1));
            on_progress(step as u64 * self.len_bytes + of_step as u64, STEPS * self.len_bytes);
        }
    }
}
