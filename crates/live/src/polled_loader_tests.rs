//! Tiles that nothing waits for: their bytes are in memory and arrive late, and their futures are
//! polled by hand. A tile that is loaded without threads arrives in a later frame.

use std::{
    future::poll_fn,
    pin::{Pin, pin},
    sync::Arc,
    task::{Context, Poll, Waker},
};

use corniche_geom::TileId;
use corniche_testing::package;
use corniche_tileset::{ByteSource, MemorySource, Package, SourceError};
use corniche_viewer::tiles::{LoadTileError, PackageTiles, TileGeometry};

use crate::tiles::{Loaded, TileLoader};

/// The number of polls of a read until its bytes arrive.
const POLLS: u32 = 3;

/// Bytes in memory. Each read is pending at first.
pub(crate) struct LateBytes(MemorySource);

impl ByteSource for LateBytes {
    async fn length(&self) -> Result<u64, SourceError> {
        self.0.length().await
    }

    async fn read(&self, offset: u64, length: usize) -> Result<Vec<u8>, SourceError> {
        let mut polls = 0;
        let until_there = poll_fn(|_| {
            polls += 1;
            if polls > POLLS { Poll::Ready(()) } else { Poll::Pending }
        });
        until_there.await;
        self.0.read(offset, length).await
    }
}

fn poll<T>(work: Pin<&mut (impl Future<Output = T> + ?Sized)>) -> Poll<T> {
    work.poll(&mut Context::from_waker(Waker::noop()))
}

/// Polls a future until it is done.
///
/// # Panics
/// When the future is not done after many polls.
pub(crate) fn polled<T>(work: impl Future<Output = T>) -> T {
    let mut work = pin!(work);
    for _ in 0..100_000 {
        if let Poll::Ready(done) = poll(work.as_mut()) {
            return done;
        }
    }
    panic!("the work never gets ready")
}

/// Opens a package whose tiles arrive late.
///
/// # Panics
/// When `bytes` are not a package.
pub(crate) fn late_package(bytes: Vec<u8>) -> Arc<PackageTiles<LateBytes>> {
    let package = polled(Package::open(LateBytes(MemorySource::new(bytes))));
    let tiles = package.map(|package| polled(PackageTiles::new(package)));
    Arc::new(tiles.and_then(|tiles| tiles).unwrap_or_else(|error| panic!("{error}")))
}

type Loading = Pin<Box<dyn Future<Output = Result<TileGeometry, LoadTileError>>>>;

/// Loads tiles in the drawing thread, without waiting for one: each is polled once per frame.
pub(crate) struct PolledLoader {
    tiles: Arc<PackageTiles<LateBytes>>,
    under_way: Vec<(TileId, Loading)>,
}

impl PolledLoader {
    /// Creates the loader for the tiles of a package.
    pub(crate) fn new(tiles: &Arc<PackageTiles<LateBytes>>) -> Self {
        Self { tiles: Arc::clone(tiles), under_way: Vec::new() }
    }
}

impl TileLoader for PolledLoader {
    fn request(&mut self, ids: &[TileId]) {
        for id in ids.iter().copied() {
            let tiles = Arc::clone(&self.tiles);
            self.under_way.push((id, Box::pin(async move { tiles.tile(id).await })));
        }
    }

    fn forget(&mut self) {
        self.under_way.clear();
    }

    fn arrivals(&mut self) -> Vec<Loaded> {
        let mut arrived = Vec::new();
        self.under_way.retain_mut(|(id, load)| match poll(load.as_mut()) {
            Poll::Ready(tile) => {
                arrived.push(Loaded { id: *id, tile });
                false
            }
            Poll::Pending => true,
        });
        arrived
    }
}

#[test]
fn a_tile_comes_in_a_later_frame_and_nothing_waits_for_it() {
    let mut loader = PolledLoader::new(&late_package(package::written()));
    loader.request(&[TileId::ROOT]);
    for _ in 0..POLLS {
        assert!(loader.arrivals().is_empty());
    }
    assert_eq!(loader.arrivals().len(), 1);
    loader.request(&[TileId::ROOT]);
    loader.forget();
    assert!(loader.arrivals().is_empty() && loader.under_way.is_empty());
}
