//! Threads load tiles in the requested order, and a corrupt tile does not stop the others.

use std::{
    sync::atomic::{AtomicUsize, Ordering},
    time::{Duration, Instant},
};

use corniche_geom::{GridFrame, NodeIndex};
use corniche_viewer::tiles::{TileCatalog, TileLines};

use super::*;

/// Tiles without ground; those of level 3 are corrupt, and the decoder fails on those of level 2.
struct Bare {
    frame: GridFrame,
    loaded: AtomicUsize,
}

impl TileCatalog for Bare {
    fn frame(&self) -> &GridFrame {
        &self.frame
    }

    fn exists(&self, _: TileId) -> bool {
        true
    }
}

impl TileSource for Bare {
    fn load(&self, id: TileId) -> Result<TileGeometry, LoadTileError> {
        self.loaded.fetch_add(1, Ordering::SeqCst);
        assert!(id.z() != 2, "no such tile was thought of");
        if id.z() == 3 {
            return Err(LoadTileError { id, source: "damaged".into() });
        }
        Ok(TileGeometry::assemble(id, None, &TileLines::default(), &self.frame, 0.5))
    }
}

fn bare() -> Arc<Bare> {
    let frame = GridFrame::new([0.0; 2], 10.0, NodeIndex { i: 0, j: 256 << 4 }, 4);
    let frame = frame.unwrap_or_else(|error| panic!("{error}"));
    Arc::new(Bare { frame, loaded: AtomicUsize::new(0) })
}

fn loader(
    source: &Arc<Bare>,
    threads: usize,
    room: usize,
    woken: &Arc<AtomicUsize>,
) -> LoaderThreads {
    let woken = Arc::clone(woken);
    let wake: Arc<dyn Fn() + Send + Sync> = Arc::new(move || {
        woken.fetch_add(1, Ordering::SeqCst);
    });
    let threads = NonZeroUsize::new(threads).unwrap_or(NonZeroUsize::MIN);
    LoaderThreads::new(source, threads, room, &wake).unwrap_or_else(|error| panic!("{error}"))
}

fn take(loader: &mut LoaderThreads, count: usize) -> Vec<Loaded> {
    let begun = Instant::now();
    let mut taken = Vec::new();
    while taken.len() < count {
        taken.extend(loader.arrivals());
        assert!(begun.elapsed() < Duration::from_secs(30), "{} of {count}", taken.len());
        thread::sleep(Duration::from_millis(1));
    }
    taken
}

fn level_4(count: u32) -> Vec<TileId> {
    (0..count).map(|x| TileId::new(4, x, 3).unwrap_or(TileId::ROOT)).collect()
}

#[test]
fn one_worker_loads_in_the_order_asked_and_wakes_for_each() {
    let (source, woken) = (bare(), Arc::new(AtomicUsize::new(0)));
    let mut loader = loader(&source, 1, 8, &woken);
    let ids = level_4(12);
    loader.request(&ids[..5]);
    loader.request(&ids[5..]);
    let arrived: Vec<TileId> = take(&mut loader, 12).iter().map(|loaded| loaded.id).collect();
    assert_eq!(arrived, ids);
    drop(loader);
    assert_eq!(woken.load(Ordering::SeqCst), 12);
}

#[test]
fn a_damaged_tile_says_so_and_the_next_ones_arrive() {
    let (source, woken) = (bare(), Arc::new(AtomicUsize::new(0)));
    let mut loader = loader(&source, 2, 8, &woken);
    let damaged = TileId::new(3, 1, 1).unwrap();
    loader.request(&[&[damaged], &level_4(4)[..]].concat());
    let arrived = take(&mut loader, 5);
    let failed: Vec<TileId> =
        arrived.iter().filter(|loaded| loaded.tile.is_err()).map(|loaded| loaded.id).collect();
    assert_eq!(failed, [damaged]);
}

#[test]
fn a_tile_that_the_decoder_fails_on_says_so_and_the_worker_goes_on() {
    let (source, woken) = (bare(), Arc::new(AtomicUsize::new(0)));
    let mut loader = loader(&source, 1, 8, &woken);
    let bad = TileId::new(2, 1, 1).unwrap();
    loader.request(&[&[bad], &level_4(2)[..]].concat());
    let arrived = take(&mut loader, 3);
    let error = arrived[0].tile.as_ref().unwrap_err();
    assert_eq!(error.id, bad);
    assert!(error.source.to_string().contains("no such tile was thought of"), "{error:?}");
    assert!(arrived[1..].iter().all(|loaded| loaded.tile.is_ok()));
}

#[test]
fn it_ends_while_nobody_takes_what_has_arrived() {
    let (source, woken) = (bare(), Arc::new(AtomicUsize::new(0)));
    let mut loader = loader(&source, 2, 1, &woken);
    loader.request(&level_4(10));
    let begun = Instant::now();
    while source.loaded.load(Ordering::SeqCst) < 3 {
        assert!(begun.elapsed() < Duration::from_secs(30), "nothing was loaded");
        thread::sleep(Duration::from_millis(1));
    }
    drop(loader);
    assert!(source.loaded.load(Ordering::SeqCst) < 10, "the rest was not loaded");
}

#[test]
fn what_is_forgotten_is_not_loaded() {
    let (source, woken) = (bare(), Arc::new(AtomicUsize::new(0)));
    let mut loader = loader(&source, 1, 1, &woken);
    // One is in the results, one waits for space, and the others are in the queue.
    loader.request(&level_4(10));
    let begun = Instant::now();
    while source.loaded.load(Ordering::SeqCst) < 2 {
        assert!(begun.elapsed() < Duration::from_secs(30), "nothing was loaded");
        thread::sleep(Duration::from_millis(1));
    }
    loader.forget();
    take(&mut loader, 2);
    thread::sleep(Duration::from_millis(20));
    assert_eq!(source.loaded.load(Ordering::SeqCst), 2);
}
