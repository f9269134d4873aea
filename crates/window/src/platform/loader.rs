//! Tiles read and decoded beside the drawing.
//!
//! ```text
//!  frame ── request ──► queue ──► workers: TileSource::load ──► results ──► next frame
//! ```
//!
//! The thread that draws never waits: it leaves requests and takes what is there. How many tiles are under way is
//! bounded by whoever asks ([`corniche_viewer::stream::StreamBudget`]); the results have room for as many.

use std::{
    any::Any,
    collections::VecDeque,
    io,
    num::NonZeroUsize,
    panic::{AssertUnwindSafe, catch_unwind},
    sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError, mpsc},
    thread::{self, JoinHandle},
};

use corniche_geom::TileId;
use corniche_viewer::tiles::{LoadTileError, TileGeometry, TileSource};

/// More threads that decode would take turns with the one that draws.
const MOST_THREADS: usize = 4;

/// Where tiles come from, usable from any thread.
pub(crate) type SharedSource = Arc<dyn TileSource + Send + Sync>;

/// A tile that was asked for.
pub(crate) struct Loaded {
    /// Which.
    pub(crate) id: TileId,
    /// It, or why not.
    pub(crate) tile: Result<TileGeometry, LoadTileError>,
}

/// Threads that load tiles.
pub(crate) struct Loader {
    shared: Arc<Shared>,
    /// `None` once the workers are to end.
    results: Option<mpsc::Receiver<Loaded>>,
    workers: Vec<JoinHandle<()>>,
}

struct Shared {
    queue: Mutex<Queue>,
    has_changed: Condvar,
}

#[derive(Default)]
struct Queue {
    wanted: VecDeque<TileId>,
    is_closed: bool,
}

impl Shared {
    fn queue(&self) -> MutexGuard<'_, Queue> {
        // A list of ids is whole whoever panicked while holding it.
        self.queue.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The next tile to load; `None` when there will be no more.
    fn next(&self) -> Option<TileId> {
        let mut queue = self.queue();
        loop {
            if queue.is_closed {
                return None;
            }
            if let Some(id) = queue.wanted.pop_front() {
                return Some(id);
            }
            queue = self.has_changed.wait(queue).unwrap_or_else(PoisonError::into_inner);
        }
    }
}

impl Loader {
    /// How many workers this machine has use for: one core is left to the thread that draws.
    pub(crate) fn usual_threads() -> NonZeroUsize {
        let cores = thread::available_parallelism().map_or(2, NonZeroUsize::get);
        NonZeroUsize::new((cores - 1).clamp(1, MOST_THREADS)).unwrap_or(NonZeroUsize::MIN)
    }

    /// Starts `threads` workers, at most `room` tiles ahead of whoever takes them. `wake` is called from theirs
    /// whenever a tile is there.
    ///
    /// # Errors
    /// When the system gives no thread.
    pub(crate) fn new(
        source: &SharedSource,
        threads: NonZeroUsize,
        room: usize,
        wake: &Arc<dyn Fn() + Send + Sync>,
    ) -> io::Result<Self> {
        let shared =
            Arc::new(Shared { queue: Mutex::new(Queue::default()), has_changed: Condvar::new() });
        let (sender, results) = mpsc::sync_channel(room);
        let mut loader =
            Self { shared: Arc::clone(&shared), results: Some(results), workers: Vec::new() };
        for number in 0..threads.get() {
            let (source, shared) = (Arc::clone(source), Arc::clone(&shared));
            let (sender, wake) = (sender.clone(), Arc::clone(wake));
            let work = move || {
                while let Some(id) = shared.next() {
                    if sender.send(Loaded { id, tile: load(source.as_ref(), id) }).is_err() {
                        return;
                    }
                    wake();
                }
            };
            loader
                .workers
                .push(thread::Builder::new().name(format!("tiles {number}")).spawn(work)?);
        }
        Ok(loader)
    }

    /// Asks for tiles, in order, after those asked for before.
    pub(crate) fn request(&self, ids: &[TileId]) {
        self.shared.queue().wanted.extend(ids);
        self.shared.has_changed.notify_all();
    }

    /// Forgets what was asked for and is not yet begun.
    pub(crate) fn forget(&self) {
        self.shared.queue().wanted.clear();
    }

    /// What has arrived; never waits.
    pub(crate) fn arrivals(&self) -> impl Iterator<Item = Loaded> {
        self.results.iter().flat_map(mpsc::Receiver::try_iter)
    }
}

/// A tile, or why not. A defect of the decoder costs one tile and not the worker: whoever asked would wait for ever.
fn load(source: &dyn TileSource, id: TileId) -> Result<TileGeometry, LoadTileError> {
    // A source is only read: nothing of it is left half changed.
    catch_unwind(AssertUnwindSafe(|| source.load(id))).unwrap_or_else(|panic| {
        let source = format!("the program fails on it: {}", words_of(panic.as_ref())).into();
        Err(LoadTileError { id, source })
    })
}

fn words_of(panic: &(dyn Any + Send)) -> &str {
    let text = panic.downcast_ref::<String>().map(String::as_str);
    text.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("without a word")
}

impl Drop for Loader {
    fn drop(&mut self) {
        self.shared.queue().is_closed = true;
        self.shared.has_changed.notify_all();
        // A worker that waits for room finds out by its failing to send.
        self.results = None;
        for worker in self.workers.drain(..) {
            // It panicked, then; there is nobody left to tell.
            let _ = worker.join();
        }
    }
}

#[cfg(test)]
#[path = "loader_tests.rs"]
mod tests;
