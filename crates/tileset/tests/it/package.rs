//! Packages read back as they were written; other files and damaged packages are rejected.
#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::{fs, io::Cursor};

use corniche_geom::{Cell, GridFrame, NodeIndex, TileId};
use corniche_testing::package;
use corniche_tileset::{
    FilePackage, LevelRecord, Manifest, MemorySource, OpenError, Package, PackageWriter,
    PayloadContext, ReadError, Sections, SettingsRecord, TilePayload, TileTerrain, VerticalRecord,
    WriteError, encode, pmtiles_order,
};
use corniche_tin::{Tin, TinVertex};

fn manifest(max_level: u8) -> Manifest {
    let frame =
        GridFrame::new([0.1, 0.7], 1.0 / 3.0, NodeIndex { i: 0, j: 256 << max_level }, max_level)
            .unwrap();
    let sound = package::manifest_of(frame);
    let level = |record: LevelRecord| LevelRecord {
        cell_m: Cell::from(1.0),
        max_error_m: 0.3,
        least_class: None,
        ..record
    };
    Manifest {
        point_scale: 0.999_7,
        vertical: VerticalRecord { quantum_m: 0.125, range_m: [0.0, 8.0], ..sound.vertical },
        levels: sound.levels.into_iter().map(level).collect(),
        settings: SettingsRecord {
            max_error_m: 0.1 + 0.2,
            cell_m: Some(Cell { east_m: 1.0 / 3.0, north_m: 0.5 }),
            ..sound.settings
        },
        attribution: vec!["© OpenStreetMap contributors".to_owned(), "SRTM".to_owned()],
        ..sound
    }
}

fn tile(text: &str) -> TileId {
    text.parse().unwrap()
}

fn payload(id: TileId) -> TilePayload {
    let vertex = |row, column| TinVertex { row, column, height_q: 8 * id.x() as i32 };
    let tin = Tin::new(vec![vertex(0, 0), vertex(0, 256), vertex(256, 0)], &[[0, 2, 1]]).unwrap();
    let normals = vec![[0, 0]; 3];
    let terrain = TileTerrain {
        tin,
        normals,
        geometric_error_m: 0.0,
        height_range_m: [0.0, 8.0],
        uncovered_nodes: 0,
    };
    TilePayload {
        id,
        terrain: Some(terrain),
        relief: None,
        roads_geo: vec![],
        roads_sv: vec![],
        attributes: vec![],
    }
}

/// A package with three tiles.
fn three_tiles() -> Vec<u8> {
    let manifest = manifest(2);
    let context = PayloadContext::from_manifest(&manifest);
    let encoded = |id| (id, encode(&payload(id), &context).unwrap().bytes);
    package::written_with(&manifest, ["0/0/0", "1/1/0", "2/3/1"].map(tile).map(encoded))
}

fn open(bytes: Vec<u8>) -> Result<Package<MemorySource>, OpenError> {
    pollster::block_on(Package::open(MemorySource::new(bytes)))
}

#[test]
fn three_tiles_come_back_from_memory_and_from_a_file() {
    let bytes = three_tiles();
    let from_memory = open(bytes.clone()).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("three.pmtiles");
    fs::write(&path, bytes).unwrap();
    let from_file = FilePackage::open(&path).unwrap();
    assert_eq!(*from_memory.manifest(), manifest(2));
    assert_eq!(*from_file.manifest(), manifest(2));
    let ids = ["0/0/0", "1/1/0", "2/3/1"].map(tile);
    assert_eq!(pollster::block_on(from_memory.tile_ids()).unwrap(), ids);
    assert_eq!(from_file.tile_ids().unwrap(), ids);
    for id in ids {
        let read = pollster::block_on(from_memory.payload(id, Sections::ALL)).unwrap();
        assert_eq!(read, Some(payload(id)));
        assert_eq!(from_file.payload(id, Sections::ALL).unwrap(), read);
    }
    for absent in ["1/0/0", "2/0/0", "9/0/0"].map(tile) {
        assert_eq!(from_file.payload(absent, Sections::ALL).unwrap(), None);
    }
}

#[test]
fn a_created_file_is_what_is_written_to_memory() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("three.pmtiles");
    let manifest = manifest(2);
    let context = PayloadContext::from_manifest(&manifest);
    let mut writer =
        PackageWriter::of_file(std::fs::File::create(&path).unwrap(), &manifest, usize::MAX)
            .unwrap();
    for id in ["0/0/0", "1/1/0", "2/3/1"].map(tile) {
        writer.add(id, &encode(&payload(id), &context).unwrap().bytes).unwrap();
    }
    assert!(FilePackage::open(&path).is_err(), "it is no package before it is finished");
    writer.finish().unwrap();
    assert_eq!(fs::read(&path).unwrap(), three_tiles());
}

#[test]
fn a_package_is_a_clustered_pmtiles_file_with_true_bounds() {
    let bytes = three_tiles();
    let header = pmtiles::Header::try_from_bytes(bytes[..127].to_vec().into()).unwrap();
    assert!(header.clustered());
    assert_eq!(header.tile_type, pmtiles::TileType::Unknown);
    assert_eq!(header.tile_compression, pmtiles::Compression::None);
    assert_eq!((header.min_zoom, header.max_zoom), (0, 2));
    assert!((header.min_longitude - 9.4).abs() < 1e-7 && (header.max_latitude - 47.3).abs() < 1e-7);
    assert_eq!(header.n_addressed_tiles().map(std::num::NonZero::get), Some(3));
}

/// A package of few tiles does not reserve 16 KB for their directory, and is otherwise the same.
#[test]
fn few_tiles_keep_little_for_their_directory() {
    let wide = three_tiles();
    let mut bytes = Cursor::new(Vec::new());
    let mut writer = PackageWriter::new(&mut bytes, &manifest(2), 3).unwrap();
    let package = open(wide.clone()).unwrap();
    for id in pollster::block_on(package.tile_ids()).unwrap() {
        writer.add(id, &pollster::block_on(package.tile(id)).unwrap().unwrap()).unwrap();
    }
    writer.finish().unwrap();
    let close = bytes.into_inner();
    assert!(close.len() + 15_900 < wide.len(), "{} of {} bytes", close.len(), wide.len());
    let close = open(close).unwrap();
    assert_eq!(close.manifest(), package.manifest());
    for id in ["0/0/0", "1/1/0", "2/3/1"].map(tile) {
        let [one, other] = [&close, &package].map(|package| pollster::block_on(package.tile(id)));
        assert!(one.unwrap().unwrap() == other.unwrap().unwrap());
    }
}

#[test]
fn many_tiles_need_leaf_directories_and_are_all_found() {
    let manifest = manifest(8);
    let mut bytes = Cursor::new(Vec::new());
    let mut writer = PackageWriter::new(&mut bytes, &manifest, usize::MAX).unwrap();
    let every = (0..256).flat_map(|x| (0..256).map(move |y| TileId::new(8, x, y).unwrap()));
    let mut ids: Vec<TileId> = every.filter(|id| (id.x() * 31 + id.y() * 17) % 3 != 0).collect();
    ids.sort_by_key(|&id| pmtiles_order(id));
    for id in &ids {
        // Lengths differ, so that the directory does not become very small when compressed.
        let length = 4 + (id.x() * 7919 + id.y() * 104_729) % 37;
        writer.add(*id, &id.to_string().repeat(length as usize).into_bytes()).unwrap();
    }
    writer.finish().unwrap();
    let package = open(bytes.into_inner()).unwrap();
    assert_eq!(pollster::block_on(package.tile_ids()).unwrap(), ids);
    for id in ids.iter().step_by(997) {
        let bytes = pollster::block_on(package.tile(*id)).unwrap().unwrap();
        assert!(bytes.starts_with(id.to_string().as_bytes()));
        let error = pollster::block_on(package.payload(*id, Sections::ALL)).unwrap_err();
        assert!(error.to_string().contains(&format!("tile {id}")), "{error}");
    }
    assert!(pollster::block_on(package.tile(tile("8/0/0"))).unwrap().is_none());
}

#[test]
fn order_is_level_then_hilbert_curve() {
    // The table is from the tile ids in the PMTiles specification.
    for (text, order) in
        [("0/0/0", 0), ("1/0/0", 1), ("1/0/1", 2), ("1/1/1", 3), ("1/1/0", 4), ("2/0/0", 5)]
    {
        assert_eq!(pmtiles_order(tile(text)), order);
    }
}

#[test]
fn tiles_out_of_order_or_beyond_the_levels_are_refused() {
    let mut bytes = Cursor::new(Vec::new());
    let mut writer = PackageWriter::new(&mut bytes, &manifest(2), usize::MAX).unwrap();
    let payload = [7; 20];
    writer.add(tile("1/1/1"), &payload).unwrap();
    assert!(matches!(writer.add(tile("1/0/0"), &payload), Err(WriteError::Order { .. })));
    assert!(matches!(writer.add(tile("1/1/1"), &payload), Err(WriteError::Order { .. })));
    assert!(matches!(writer.add(tile("3/0/0"), &payload), Err(WriteError::Tile { .. })));
    assert!(matches!(writer.add(tile("2/3/3"), &payload[..19]), Err(WriteError::Tile { .. })));
    let mut bad = manifest(2);
    bad.point_scale = f64::NAN;
    assert!(matches!(
        PackageWriter::new(Cursor::new(Vec::new()), &bad, usize::MAX),
        Err(WriteError::Manifest { .. })
    ));
}

#[test]
fn ordinary_pmtiles_and_other_files_are_refused() {
    let ordinary = |kind, metadata: &str| {
        let mut bytes = Cursor::new(Vec::new());
        let mut writer =
            pmtiles::PmTilesWriter::new(kind).metadata(metadata).create(&mut bytes).unwrap();
        writer.add_tile(pmtiles::TileCoord::new(0, 0, 0).unwrap(), b"tile").unwrap();
        writer.finalize().unwrap();
        open(bytes.into_inner()).map(|_| ()).unwrap_err()
    };
    assert!(matches!(ordinary(pmtiles::TileType::Png, "{}"), OpenError::OrdinaryPmtiles));
    assert!(matches!(ordinary(pmtiles::TileType::Unknown, "{}"), OpenError::OrdinaryPmtiles));
    assert!(matches!(
        ordinary(pmtiles::TileType::Unknown, r#"{"name":7}"#),
        OpenError::OrdinaryPmtiles
    ));
    let newer = ordinary(pmtiles::TileType::Unknown, r#"{"corniche":{"format_version":7}}"#);
    assert!(matches!(newer, OpenError::Version { found: 7 }), "{newer}");
    let older = ordinary(pmtiles::TileType::Unknown, r#"{"corniche":{"format_version":1}}"#);
    assert!(matches!(older, OpenError::Version { found: 1 }), "{older}");
    let broken = ordinary(pmtiles::TileType::Unknown, r#"{"corniche":{"format_version":2}}"#);
    assert!(matches!(broken, OpenError::Manifest { .. }), "{broken}");
    assert!(matches!(open(Vec::new()), Err(OpenError::NotPmtiles)));
    assert!(matches!(open(b"\x89PNG and so on".to_vec()), Err(OpenError::NotPmtiles)));
    // A device or a pipe has no length; opening a pipe would even make the reader wait.
    #[cfg(unix)]
    {
        let source = FilePackage::open("/dev/null".as_ref()).unwrap_err();
        let source = std::error::Error::source(&source).unwrap().to_string();
        assert!(source.contains("not a regular file"), "{source}");
    }
    let missing = FilePackage::open("no/such.pmtiles".as_ref()).unwrap_err();
    assert!(missing.to_string().contains("no/such.pmtiles"));
}

#[test]
fn every_cut_is_noticed_when_opening() {
    let bytes = three_tiles();
    // The last bytes of the file are tiles; only the header gives their length.
    for length in (0..bytes.len()).rev().step_by(7).chain(0..200) {
        let error = open(bytes[..length].to_vec()).map(|_| ()).expect_err("a cut file");
        let clear = matches!(error, OpenError::NotPmtiles | OpenError::Truncated { .. });
        assert!(clear, "cut to {length} bytes: {error}");
    }
}

#[test]
fn a_flipped_bit_in_a_tile_is_an_error_that_names_it() {
    let mut bytes = three_tiles();
    let last = bytes.len() - 1;
    bytes[last] ^= 4;
    let package = open(bytes).unwrap();
    let id = tile("2/3/1");
    let error = pollster::block_on(package.payload(id, Sections::ALL)).unwrap_err();
    assert!(matches!(error, ReadError::Decode(_)));
    assert!(error.to_string().contains("tile 2/3/1, terrain section"), "{error}");
    assert!(pollster::block_on(package.payload(tile("1/1/0"), Sections::ALL)).unwrap().is_some());
}

/// Each flipped bit of header and root directory causes an error, or a reading that still ends.
#[test]
fn no_flipped_bit_of_header_or_directory_panics() {
    let bytes = three_tiles();
    for bit in 0..8 * 260 {
        let mut damaged = bytes.clone();
        damaged[bit / 8] ^= 1 << (bit % 8);
        if let Ok(package) = open(damaged) {
            let ids = pollster::block_on(package.tile_ids()).unwrap_or_default();
            for id in ids.iter().take(10) {
                let _ = pollster::block_on(package.payload(*id, Sections::ALL));
            }
        }
    }
}
