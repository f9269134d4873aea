//! The context that every step of a reading needs.

use corniche_store::{SortRecord, Sorter};

use crate::{ReadOsmError, nodes::Precedence, read_request::ReadRequest};

/// The parts of the memory for each purpose. At no time do they exceed the whole: sixteen
/// sixteenths, or twenty twentieths if there are objects with outlines:
///
/// | | ways | mentions | located | defects | spool | ids | visits | stops | objects | all |
/// |---|---|---|---|---|---|---|---|---|---|---|
/// | ways are read | 8 | (ids of ways, twice) 8 | ½ | ½ | | | | | 4 | 21, for a moment |
/// | nodes are numbered | 8 | 4 | ½ | ½ | 1 | | | | 4 | 18 |
/// | nodes are located | | 4 | ½ | ½ | 1 | 4 | 2 | 4 | 4 | 20 |
/// | a layer is delivered | (parts) 4 | (members) 4 | | | 1 | | | 4 | 4 | 17 |
///
/// Data that exists for each layer has an equal part of this for each layer. A layer of points
/// shares its part for objects between nodes and other objects.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Shares {
    /// The memory for ways that are sorted by id, bytes; all fields are in bytes.
    pub(crate) ways: u64,
    /// The memory for ids of ways that objects reference, and later for the members of objects.
    pub(crate) way_ids: u64,
    /// The memory for objects with outlines.
    pub(crate) objects: u64,
    /// The memory for references to nodes, sorted by id.
    pub(crate) mentions: u64,
    /// The memory for node positions that ways give, sorted by id.
    pub(crate) located: u64,
    /// The memory for defects that are not reported yet.
    pub(crate) defects: u64,
    /// The memory for the properties of roads, in their order.
    pub(crate) spool: u64,
    /// The memory for nodes whose positions are looked for.
    pub(crate) ids: u64,
    /// The memory for the places in ways that reference those nodes.
    pub(crate) visits: u64,
    /// The memory for nodes of ways with their positions, sorted by way.
    pub(crate) stops: u64,
}

/// The steps in which [`crate::read_request::OnProgress`] counts the file's bytes.
#[derive(Debug, Clone, Copy)]
pub(crate) enum ReadingStep {
    Ways,
    Nodes,
}

const STEPS: u64 = 2;

/// A request, the caller's wish to stop, the size of the file, and the number of layers.
#[derive(Clone, Copy)]
pub(crate) struct ExtractReading<'a> {
    pub(crate) request: &'a ReadRequest<'a>,
    pub(crate) should_stop: &'a (dyn Fn() -> bool + Sync),
    pub(crate) len_bytes: u64,
    pub(crate) layers: LayerCount,
}

/// Sorts in place, in up to 2 to the power of `halvings` parts in parallel. Records that compare
/// equal are the same.
///
/// The standard library's sort, applied to parts, takes three quarters of the time of `rayon`'s
/// sort.
fn sort_halves<T: Ord + Send>(records: &mut [T], halvings: u32) {
    /// Fewer records are not worth a task.
    const LEAST: usize = 1 << 12;
    // The ways of a sorted extract are already in order.
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

/// The number of layers to read.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LayerCount {
    pub(crate) all: u64,
    /// The number of layers whose objects have outlines.
    pub(crate) outlines: u64,
}

impl LayerCount {
    pub(crate) const ROADS: Self = Self { all: 1, outlines: 0 };
}

impl<'a> ExtractReading<'a> {
    /// Creates a sorter that takes at most `memory_bytes` and uses the pool.
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

    /// Returns the rule that decides which of several positions of a node counts.
    pub(crate) fn precedence(&self) -> Precedence {
        if self.is_of_several() { Precedence::Newest } else { Precedence::First }
    }

    /// Fails if the caller wants to stop.
    pub(crate) fn check_stop(&self) -> Result<(), ReadOsmError> {
        if (self.should_stop)() { Err(self.stopped()) } else { Ok(()) }
    }

    pub(crate) fn stopped(&self) -> ReadOsmError {
        ReadOsmError::Stopped { path: self.request.path.to_path_buf() }
    }

    /// Does the same in loops over small items, but asks the caller only once in a while. `count`
    /// counts the items.
    pub(crate) fn check_stop_at(&self, count: u64) -> Result<(), ReadOsmError> {
        const OFTEN: u64 = 1 << 16;
        if count.is_multiple_of(OFTEN) { self.check_stop() } else { Ok(()) }
    }

    /// Reports that `done` of `all` in a step are done, and all earlier steps.
    pub(crate) fn tell(&self, step: ReadingStep, done: u64, all: u64) {
        if let Some(on_progress) = self.request.on_progress {
            let of_step =
                u128::from(self.len_bytes) * u128::from(done.min(all)) / u128::from(all.max(1));
            on_progress(step as u64 * self.len_bytes + of_step as u64, STEPS * self.len_bytes);
        }
    }
}
