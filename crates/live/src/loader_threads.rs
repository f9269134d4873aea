//! Threads that read and decode tiles while another thread draws.
//!
//! ```text
//!  frame ── request ──► queue ──► workers: TileSource::load ──► results ──► next frame
//! ```
//!
//! The drawing thread never waits: it adds requests and takes the tiles that have arrived. The
//! caller limits the number of tiles being loaded ([`corniche_viewer::stream::StreamBudget`]); the
//! queue of results has space for this number.

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
use corniche_viewer::tiles::{LoadTileError, MOST_LOADERS, TileGeometry, TileSource};

use crate::tiles::{Loaded, TileLoader};

/// Threads that load tiles.
pub struct LoaderThreads {
    shared: Arc<Shared>,
    /// The receiver of loaded tiles; `None` once the workers must end.
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
        // A panic with the lock held cannot leave a list of ids half changed.
        self.queue.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The next tile to load; `None` if there will be no more.
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

impl LoaderThreads {
    /// The number of useful workers on this machine: one core is left to the drawing thread.
    pub fn usual_number() -> NonZeroUsize {
        let cores = thread::available_parallelism().map_or(2, NonZeroUsize::get);
        NonZeroUsize::new((cores - 1).clamp(1, MOST_LOADERS)).unwrap_or(NonZeroUsize::MIN)
    }

    /// Starts `threads` workers, which load at most `room` tiles ahead of those taken. They call
    /// `wake` whenever a tile has arrived.
    ///
    /// # Errors
    /// When the system cannot start a thread.
    pub fn new<S: TileSource + Send + Sync + ?Sized + 'static>(
        source: &Arc<S>,
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
}

impl TileLoader for LoaderThreads {
    fn request(&mut self, ids: &[TileId]) {
        self.shared.queue().wanted.extend(ids);
        self.shared.has_changed.notify_all();
    }

    fn forget(&mut self) {
        self.shared.queue().wanted.clear();
    }

    fn abandon(&mut self, ids: &[TileId]) -> Vec<TileId> {
        // Workers finish the tiles that they have started.
        let mut queue = self.shared.queue();
        let is_waiting = |id: &&TileId| queue.wanted.contains(id);
        let dropped: Vec<TileId> = ids.iter().filter(is_waiting).copied().collect();
        queue.wanted.retain(|id| !dropped.contains(id));
        dropped
    }

    fn arrivals(&mut self) -> Vec<Loaded> {
        self.results.iter().flat_map(mpsc::Receiver::try_iter).collect()
    }
}

/// Loads a tile. If the decoder panics, only that tile is lost and not the worker: otherwise the
/// caller would wait for the tile forever.
fn load<S: TileSource + ?Sized>(source: &S, id: TileId) -> Result<TileGeometry, LoadTileError> {
    // A source is only read, so a panic leaves no half-changed state in it.
    catch_unwind(AssertUnwindSafe(|| source.load(id))).unwrap_or_else(|panic| {
        let source = format!("the decoder panicked: {}", words_of(panic.as_ref())).into();
        Err(LoadTileError { id, source })
    })
}

fn words_of(panic: &(dyn Any + Send)) -> &str {
    let text = panic.downcast_ref::<String>().map(String::as_str);
    text.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("no message")
}

impl Drop for LoaderThreads {
    fn drop(&mut self) {
        self.shared.queue().is_closed = true;
        self.shared.has_changed.notify_all();
        // Workers that wait for space in the queue of results end because they can no longer send.
        self.results = None;
        for worker in self.workers.drain(..) {
            // Joining fails only if the worker panicked; there is nothing left to report.
            let _ = worker.join();
        }
    }
}

#[cfg(test)]
#[path = "loader_threads_tests.rs"]
mod tests;
