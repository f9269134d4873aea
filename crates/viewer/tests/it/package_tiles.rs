//! Tiles from bytes that arrive later, as from a server: no call waits for the bytes.
#![allow(clippy::unwrap_used, reason = "this is test code, helpers included")]

use std::{
    cell::Cell,
    collections::BTreeMap,
    fs,
    pin::{Pin, pin},
    task::{Context, Poll, Waker},
};

use crate::support::package::package;
use corniche_geom::TileId;
use corniche_tileset::{ByteSource, MemorySource, Package, SourceError};
use corniche_viewer::{
    CameraRequest, RoadMethod, SightedGround,
    camera::Camera,
    gpu::tile_bytes,
    lod::{DrawnTile, Quality},
    stream::{StreamBudget, Streamer, TileFacts},
    tiles::{
        MapPackage as _, PackageSource, PackageTiles, TileCatalog, TileDecoder, TileGeometry,
        TileSource as _, TileStore, may_have_roads,
    },
};

/// The state of requested bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Line {
    Waiting,
    Open,
    Broken,
}

struct Server<'a> {
    bytes: MemorySource,
    line: &'a Cell<Line>,
    asked: &'a Cell<u32>,
}

impl ByteSource for Server<'_> {
    async fn length(&self) -> Result<u64, SourceError> {
        self.bytes.length().await
    }

    async fn read(&self, offset: u64, length: usize) -> Result<Vec<u8>, SourceError> {
        self.asked.set(self.asked.get() + 1);
        let answer = std::future::poll_fn(|_| match self.line.get() {
            Line::Waiting => Poll::Pending,
            line => Poll::Ready(line),
        });
        if answer.await == Line::Broken {
            let (name, reason) = ("https://example.org".to_owned(), "no answer".to_owned());
            return Err(SourceError { name, offset, length, reason, may_pass: false });
        }
        self.bytes.read(offset, length).await
    }
}

/// Polls a future once.
fn poll<T>(work: Pin<&mut impl Future<Output = T>>) -> Poll<T> {
    work.poll(&mut Context::from_waker(Waker::noop()))
}

fn done<T>(work: impl Future<Output = T>) -> T {
    match poll(pin!(work)) {
        Poll::Ready(result) => result,
        Poll::Pending => panic!("the future is still pending"),
    }
}

fn tile(id: &str) -> TileId {
    id.parse().unwrap()
}

#[test]
fn several_tiles_are_under_way_at_once_and_each_is_one_request() {
    let folder = tempfile::tempdir().unwrap();
    let path = package(folder.path());
    let (line, asked) = (Cell::new(Line::Open), Cell::new(0));
    let bytes = MemorySource::new(fs::read(&path).unwrap());
    let server = Server { bytes, line: &line, asked: &asked };
    let tiles = done(PackageTiles::new(done(Package::open(server)).unwrap())).unwrap();

    line.set(Line::Waiting);
    asked.set(0);
    let ids = ["0/0/0", "1/0/1", "2/3/2"].map(tile);
    let [mut first, mut second, mut third] = ids.map(|id| Box::pin(tiles.tile(id)));
    assert!(poll(first.as_mut()).is_pending());
    assert!(poll(second.as_mut()).is_pending());
    line.set(Line::Open);
    // The responses arrive in another order than the requests.
    let loaded = [&mut third, &mut second, &mut first].map(|load| match poll(load.as_mut()) {
        Poll::Ready(tile) => tile.unwrap(),
        Poll::Pending => panic!("its bytes have arrived"),
    });
    assert_eq!(asked.get(), 3);

    let on_disk = PackageSource::open(&path).unwrap();
    for tile in &loaded {
        assert!(*tile == on_disk.load(tile.id).unwrap(), "{}", tile.id);
        assert!(tile.summary.is_some(), "{} has ground", tile.id);
    }
    assert!(tiles.exists(ids[2]) && !tiles.exists(tile("9/0/0")));
}

#[test]
fn what_does_not_come_costs_one_tile() {
    let folder = tempfile::tempdir().unwrap();
    let (line, asked) = (Cell::new(Line::Open), Cell::new(0));
    let bytes = MemorySource::new(fs::read(package(folder.path())).unwrap());
    let server = Server { bytes, line: &line, asked: &asked };
    let tiles = done(PackageTiles::new(done(Package::open(server)).unwrap())).unwrap();
    let tiles = tiles.with_decoder(TileDecoder::default().for_method(RoadMethod::None));

    line.set(Line::Broken);
    let error = done(tiles.tile(tile("1/0/1"))).unwrap_err();
    assert_eq!(error.id, tile("1/0/1"));
    let cause = std::error::Error::source(&error).unwrap().to_string();
    assert!(cause.contains("https://example.org") && cause.contains("no answer"), "{cause}");
    line.set(Line::Open);
    let loaded = done(tiles.tile(tile("1/0/1"))).unwrap();
    assert!(
        loaded.roads.segments.all().is_empty() && loaded.roads.volumes.all().is_empty(),
        "without roads, as requested"
    );
}

/// Streams tiles for one view until no tile is missing. `load` is called once per frame with the
/// requested tiles, and returns the tiles that have arrived. Returns the drawn tiles and the tiles
/// on the GPU.
fn settled(
    catalog: &dyn TileCatalog,
    camera: &Camera,
    mut load: impl FnMut(&[TileId]) -> Vec<TileGeometry>,
) -> (Vec<DrawnTile>, BTreeMap<TileId, TileGeometry>) {
    let budget =
        StreamBudget { tiles_in_flight: 4, upload_bytes_per_frame: 1 << 30, gpu_bytes: 1 << 30 };
    let quality = Quality::by_error(0.1, 1.0);
    let mut streamer = Streamer::new(budget);
    let (mut decoded, mut resident) = (BTreeMap::new(), BTreeMap::new());
    for _ in 0..200 {
        let plan = streamer.plan(catalog, camera, None, quality);
        for id in &plan.upload {
            resident.extend(decoded.remove(id).map(|tile| (*id, tile)));
        }
        for tile in load(&plan.load) {
            let facts = TileFacts { ground: tile.summary, gpu_bytes: tile_bytes(&tile) };
            streamer.arrived(tile.id, facts);
            decoded.insert(tile.id, tile);
        }
        if plan.missing == 0 && !plan.drawn.is_empty() {
            return (plan.drawn, resident);
        }
    }
    panic!("something is still missing after 200 frames");
}

/// The first view is searched where roads are, if there are some and they are read.
#[test]
fn roads_that_are_not_read_are_not_sought() {
    let folder = tempfile::tempdir().unwrap();
    let path = package(folder.path());
    let reads = |method| {
        let decoder = TileDecoder::default().for_method(method);
        PackageSource::open(&path).unwrap().with_decoder(decoder).may_have_roads()
    };
    assert!(PackageSource::open(&path).unwrap().may_have_roads());
    assert_eq!(
        [RoadMethod::Geometry, RoadMethod::ShadowVolumes, RoadMethod::None].map(reads),
        [true, true, false]
    );
    let mut manifest = PackageSource::open(&path).unwrap().manifest().clone();
    manifest.counts.roads_kept = 0;
    assert!(!may_have_roads(&manifest, TileDecoder::default().sections()));
}

/// The streamer only needs to know which tiles exist, so it works with tiles that nothing waits
/// for.
#[test]
fn a_streamer_chooses_the_same_from_tiles_that_come_later() {
    let folder = tempfile::tempdir().unwrap();
    let path = package(folder.path());
    let on_disk = PackageSource::open(&path).unwrap();
    let manifest = on_disk.manifest();
    let extent = TileStore::new(&on_disk).map_extent(manifest.data_bounds).unwrap().unwrap();
    let ground = SightedGround { extent, heights_m: extent.heights_m, at_place_m: None };
    let camera = CameraRequest::Overview.camera(manifest, ground, 1.0, [640, 480]).unwrap();
    let expected =
        settled(&on_disk, &camera, |ids| ids.iter().map(|id| on_disk.load(*id).unwrap()).collect());

    let (line, asked) = (Cell::new(Line::Open), Cell::new(0));
    let bytes = MemorySource::new(fs::read(&path).unwrap());
    let server = Server { bytes, line: &line, asked: &asked };
    let tiles = done(PackageTiles::new(done(Package::open(server)).unwrap())).unwrap();
    let mut under_way = Vec::new();
    let (mut frames, mut waits) = (0, 0);
    let found = settled(&tiles, &camera, |ids| {
        under_way.extend(ids.iter().map(|id| Box::pin(tiles.tile(*id))));
        // The server responds only in every third frame.
        frames += 1;
        line.set(if frames % 3 == 0 { Line::Open } else { Line::Waiting });
        let mut arrived = Vec::new();
        under_way.retain_mut(|load| match poll(load.as_mut()) {
            Poll::Ready(tile) => {
                arrived.push(tile.unwrap());
                false
            }
            Poll::Pending => {
                waits += 1;
                true
            }
        });
        arrived
    });
    assert!(waits > 0 && found.1.len() > 4, "{waits} waits for {} tiles", found.1.len());
    assert!(found == expected, "{:?} instead of {:?}", found.0, expected.0);
}
