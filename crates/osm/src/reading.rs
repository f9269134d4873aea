//! What every step of a reading needs.

use corniche_store::{SortRecord, Sorter};

use crate::{
    ReadOsmError, failed::Failed, kept_error::KeptError, nodes::Precedence,
    read_request::ReadRequest,
};

/// What takes of the memory, as a part of the whole. At no time is there more than the whole, in sixteenths, or where there are objects that
/// ways outline, in twentieths:
///
/// | | ways | mentions | located | defects | spool | ids | visits | stops | objects | all |
/// |---|---|---|---|---|---|---|---|---|---|---|
/// | ways are read | 8 | (ids of ways, twice) 8 | ½ | ½ | | | | | 4 | 21, for a moment |
/// | nodes are numbered | 8 | 4 | ½ | ½ | 1 | | | | 4 | 18 |
/// | nodes are located | | 4 | ½ | ½ | 1 | 4 | 2 | 4 | 4 | 20 |
/// | a layer is handed out | (parts) 4 | (members) 4 | | | 1 | | | 4 | 4 | 17 |
///
/// What is there for each layer has its part of that, in equal parts.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Shares {
    /// Ways that are sorted by id, bytes; so are all of these.
    pub(crate) ways: u64,
    /// Ways that objects name and that are looked for, and later whose they are.
    pub(crate) way_ids: u64,
    /// Objects that ways outline.
    pub(crate) objects: u64,
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
}

const STEPS: u64 = 2;

/// A request, what the steps ask of it, and the size of the file.
#[derive(Clone, Copy)]
pub(crate) struct Reading<'a> {
    pub(crate) request: &'a ReadRequest<'a>,
    pub(crate) should_stop: &'a (dyn Fn() -> bool + Sync),
    pub(crate) len_bytes: u64,
    pub(crate) layers: LayerCount,
}

/// Sorts in place, in up to two to the power of `halvings` parts side by side. Records that compare equal are the same.
///
/// The standard library's sort, in parts, takes three quarters of the time that `rayon`'s takes.
fn sort_halves<T: Ord + Send>(records: &mut [T], halvings: u32) {
    /// Fewer are not worth a task.
    const LEAST: usize = 1 << 12;
    // Ways of a sorted extract are in order already.
    if records.is_sorted() {
        return;
    }
    if halvings == 0 || records.len() < LEAST {
        records.sort_unstable();
        return;
    }
    let (low, _, high) = records.select_nth_unstable(records.len() / 2);
    rayon::join(|| sort_halves(low, halvings - 1), || sort_halves(high, halvings - 1));
}

/// How many layers are read.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LayerCount {
    pub(crate) all: u64,
    /// How many of them are of objects that ways outline.
    pub(crate) outlines: u64,
}

impl LayerCount {
    pub(crate) const ROADS: Self = Self { all: 1, outlines: 0 };
}

impl<'a> Reading<'a> {
    /// Sorts within so much memory, in the pool.
    pub(crate) fn sorter<T: SortRecord + 'a>(&self, memory_bytes: u64) -> Sorter<'a, T> {
        let ReadRequest { scratch, pool, .. } = *self.request;
        let halvings = 1 + pool.current_num_threads().ilog2();
        let sort = move |records: &mut [T]| pool.install(|| sort_halves(records, halvings));
        Sorter::new(scratch, memory_bytes).sorted_by(sort)
    }

    pub(crate) fn shares(&self) -> Shares {
        let LayerCount { all, outlines } = self.layers;
        let unit = self.request.memory_bytes / if outlines > 0 { 20 } else { 16 };
        let (all, outlines) = (all.max(1), outlines.max(1));
        Shares {
            ways: 8 * unit / all,
            way_ids: 4 * unit / outlines,
            objects: 4 * unit / outlines,
            mentions: 4 * unit / all,
            located: unit / 2,
            defects: unit / 2 / all,
            spool: unit / all,
            ids: 4 * unit,
            visits: 2 * unit / all,
            stops: 4 * unit / all,
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

    /// A step failed: of which extract.
    pub(crate) fn failed(&self, failed: impl Into<Failed>) -> ReadOsmError {
        failed.into().of(self.request.path)
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
