//! A reader that does not request SV roads reads a tile without the bytes of the SV roads at its
//! end.
#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::sync::Mutex;

use corniche_drape::SvLine;
use corniche_geom::{GridFrame, LatticePoint, NodeIndex, TileId};
use corniche_roads::{FunctionalRoadClass, RoadAttributes};
use corniche_testing::package;
use corniche_tileset::{
    ByteSource, Damage, LayerSlot, Manifest, MemorySource, Package, PayloadContext, Photo,
    RoadRecord, Sections, SourceError, SvRoad, SvTail, SvTails, TilePayload, TileTerrain, decode,
    decode_photo, decode_spans, encode, encode_photo, payload_sizes, terrain_summary,
};
use corniche_tin::{Tin, TinVertex};

/// A package in memory that records the number of bytes of each read.
struct Noting {
    memory: MemorySource,
    lengths: Mutex<Vec<usize>>,
}

impl ByteSource for Noting {
    async fn length(&self) -> Result<u64, SourceError> {
        self.memory.length().await
    }

    async fn read(&self, offset: u64, length: usize) -> Result<Vec<u8>, SourceError> {
        self.lengths.lock().unwrap().push(length);
        self.memory.read(offset, length).await
    }
}

fn manifest() -> Manifest {
    let frame = GridFrame::new([0.0; 2], 10.0, NodeIndex { i: 0, j: 256 }, 0).unwrap();
    package::manifest_of(frame)
}

/// A tile of one triangle with `roads` SV roads of points that do not compress well.
fn payload(roads: u32) -> TilePayload {
    let vertex = |row, column| TinVertex { row, column, height_q: 0 };
    let tin = Tin::new(vec![vertex(0, 0), vertex(0, 256), vertex(256, 0)], &[[0, 2, 1]]).unwrap();
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    let mut random = || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        LatticePoint::new((state % 2_000_000) as i64, (state >> 40) as i64 % 2_000_000)
    };
    let mut road = |way_id| SvRoad {
        way_id,
        part: 0,
        class: FunctionalRoadClass::new(3).unwrap(),
        line: SvLine { points: vec![random(), random()], ground_range_m: vec![[0.0, 1.0]] },
    };
    TilePayload {
        id: TileId::ROOT,
        terrain: Some(TileTerrain {
            normals: vec![[0, 0]; 3],
            tin,
            geometric_error_m: 0.0,
            height_range_m: [0.0, 8.0],
            uncovered_nodes: 0,
        }),
        relief: None,
        roads_geo: vec![],
        roads_sv: (0..i64::from(roads)).map(&mut road).collect(),
        attributes: (0..i64::from(roads))
            .map(|way_id| RoadRecord { way_id, attributes: RoadAttributes::default() })
            .collect(),
    }
}

/// The payload of a tile with a photo, which is added to it last.
fn with_a_photo(manifest: &Manifest, roads: u32) -> Vec<u8> {
    let encoded = encode(&payload(roads), &PayloadContext::from_manifest(manifest)).unwrap().bytes;
    let mut photo = Photo { levels: 0, rgba: Vec::new() };
    photo.rgba = vec![200; photo.side() * photo.side() * 4];
    let photo = encode_photo(TileId::ROOT, &photo, 80).unwrap().unwrap();
    package::with_section(&encoded, TileId::ROOT, photo)
}

#[test]
fn a_tile_is_read_without_sv_roads_at_its_end() {
    let sound = manifest();
    let bytes = with_a_photo(&sound, 2000);
    let tail = payload_sizes(&bytes, TileId::ROOT).unwrap().sv_tail;
    assert!(tail > 4096, "{tail}");
    let mut tails = SvTails::new();
    tails.add(TileId::ROOT, tail);
    let sv_tails = tails.list();
    assert_eq!(sv_tails, [SvTail { tile: TileId::ROOT, bytes: tail as u32 }]);
    let (length, tail) = (bytes.len(), tail as usize);

    // Once as read by readers that do not know the list, and once as read by readers that do.
    for (sv_tails, left_out) in [(Vec::new(), 0), (sv_tails, tail)] {
        let manifest = Manifest { sv_tails, ..sound.clone() };
        let package = package::written_with(&manifest, [(TileId::ROOT, bytes.clone())]);
        let source = Noting { memory: MemorySource::new(package), lengths: Mutex::default() };
        let package = pollster::block_on(Package::open(source)).unwrap();
        package.source().lengths.lock().unwrap().clear();
        let wanted = Sections::TERRAIN | Sections::ATTRIBUTES | Sections::PHOTO;
        let read = pollster::block_on(package.payload(TileId::ROOT, wanted)).unwrap().unwrap();
        let (frame, quantum_m) = (&manifest.frame, manifest.vertical.quantum_m);
        let whole = decode(&bytes, TileId::ROOT, frame, quantum_m, wanted).unwrap();
        assert_eq!(read, whole);
        let sv = pollster::block_on(package.payload(TileId::ROOT, Sections::ROADS_SV));
        assert_eq!(sv.unwrap().unwrap().roads_sv.len(), 2000);
        let part = pollster::block_on(package.tile_for(TileId::ROOT, wanted)).unwrap().unwrap();
        assert_eq!(part, bytes[..length - left_out]);
        // Everything that reads a payload accepts the shortened one.
        let id = TileId::ROOT;
        assert_eq!(decode_photo(&part, id), decode_photo(&bytes, id));
        let slot = LayerSlot::new(0).unwrap();
        let layer = |bytes: &[u8]| manifest.decode_layer(bytes, id, slot);
        assert_eq!(layer(&part), layer(&bytes));
        let spans = |bytes: &[u8]| decode_spans(bytes, id, frame, quantum_m);
        assert_eq!(spans(&part), spans(&bytes));
        let summary = |bytes: &[u8]| terrain_summary(bytes, id, frame, quantum_m);
        assert_eq!(summary(&part), summary(&bytes));
        assert!(summary(&part).is_ok_and(|ground| ground.is_some()));
        let lengths = package.source().lengths.lock().unwrap().clone();
        assert_eq!(lengths, [length - left_out, length, length - left_out]);
    }
}

/// Only the SV roads section at the end may be missing from a payload, and only as a whole.
#[test]
fn nothing_else_may_be_missing() {
    let manifest = manifest();
    let bytes = with_a_photo(&manifest, 300);
    let tail = payload_sizes(&bytes, TileId::ROOT).unwrap().sv_tail as usize;
    let (frame, quantum_m) = (&manifest.frame, manifest.vertical.quantum_m);
    let read = |length: usize, wanted| {
        decode(&bytes[..length], TileId::ROOT, frame, quantum_m, wanted).map_err(|e| e.damage)
    };
    let without = bytes.len() - tail;
    for length in 0..bytes.len() {
        let found = read(length, Sections::TERRAIN);
        assert_eq!(found.is_ok(), length == without, "{length} bytes of {}", bytes.len());
        assert!(payload_sizes(&bytes[..length], TileId::ROOT).is_err(), "{length}");
    }
    assert_eq!(read(without, Sections::ROADS_SV), Err(Damage::TooShort));
    assert_eq!(read(without, Sections::ALL), Err(Damage::TooShort));
    // Without roads, a photo is the last section, and nothing may be missing.
    let bare = with_a_photo(&manifest, 0);
    assert_eq!(payload_sizes(&bare, TileId::ROOT).unwrap().sv_tail, 0);
    for length in 0..bare.len() {
        let found = decode(&bare[..length], TileId::ROOT, frame, quantum_m, Sections::TERRAIN);
        assert!(found.is_err(), "{length}");
    }
}

/// A list that does not match the tile causes an error for the wanted sections, and never another
/// tile.
#[test]
fn a_wrong_list_is_an_error() {
    let sound = manifest();
    let bytes = with_a_photo(&sound, 2000);
    let tail = payload_sizes(&bytes, TileId::ROOT).unwrap().sv_tail as u32;
    for wrong in [tail - 1, tail + 1, bytes.len() as u32, u32::MAX] {
        let sv_tails = vec![SvTail { tile: TileId::ROOT, bytes: wrong }];
        let manifest = Manifest { sv_tails, ..sound.clone() };
        let package = package::written_with(&manifest, [(TileId::ROOT, bytes.clone())]);
        let package = pollster::block_on(Package::open(MemorySource::new(package))).unwrap();
        pollster::block_on(package.payload(TileId::ROOT, Sections::TERRAIN)).unwrap_err();
        pollster::block_on(package.payload(TileId::ROOT, Sections::ALL)).unwrap();
    }
}
