//! A package that is truncated at any length, or in which any single bit is flipped, is rejected,
//! or its content is unchanged.
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test may unwrap, and this one prints figures"
)]

use corniche_geom::TileId;
use corniche_testing::package::{encoded, ids, written};
use corniche_testing::some_of;
use corniche_tileset::{Manifest, MemorySource, Package, Sections, TilePayload};

type Content = (Manifest, Vec<TileId>, Vec<TilePayload>);

/// The whole content of a package, or the text of the error.
fn read(bytes: Vec<u8>) -> Result<Content, String> {
    pollster::block_on(async {
        let package = Package::open(MemorySource::new(bytes)).await.map_err(|e| e.to_string())?;
        let ids = package.tile_ids().await.map_err(|e| e.to_string())?;
        let mut tiles = Vec::new();
        for &id in &ids {
            let tile = package.payload(id, Sections::ALL).await.map_err(|e| e.to_string())?;
            tiles.push(tile.ok_or(format!("{id} is listed but absent"))?);
        }
        Ok((package.manifest().clone(), ids, tiles))
    })
}

#[test]
fn every_cut_is_refused() {
    let whole = written();
    assert_eq!(read(whole.clone()).unwrap().1, ids());
    for length in 0..whole.len() {
        assert!(read(whole[..length].to_vec()).is_err(), "cut to {length} bytes");
    }
}

/// No flipped bit changes the content: it causes an error, or is in bytes that are not read.
#[test]
fn no_flipped_bit_changes_the_content() {
    let whole = written();
    let content = read(whole.clone()).unwrap();
    let number = |at: usize| u64::from_le_bytes(whole[at..at + 8].try_into().unwrap()) as usize;
    let (root, metadata, data) =
        ([number(8), number(16)], [number(24), number(32)], [number(56), number(64)]);
    let regions = [
        ("header", 0..127, 1),
        ("root directory", root[0]..root[0] + root[1], 1),
        ("padding", root[0] + root[1]..metadata[0], 997),
        ("metadata", metadata[0]..metadata[0] + metadata[1], 7),
        ("tiles", data[0]..data[0] + data[1], 1),
    ];
    let covered: usize = regions.iter().map(|(_, range, _)| range.len()).sum();
    assert_eq!(covered, whole.len(), "the regions are all of the file");
    println!("| bits of | tried | refused | content equal |\n|---|---|---|---|");
    // Odd steps reach every bit of a byte.
    for (name, range, step) in regions {
        let mut outcomes = [0_u32; 2];
        for bit in some_of((8 * range.start..8 * range.end).step_by(step), [61, 9, 1]) {
            let mut damaged = whole.clone();
            damaged[bit / 8] ^= 1 << (bit % 8);
            match read(damaged) {
                Ok(other) => {
                    assert!(other == content, "bit {} of byte {} of the {name}", bit % 8, bit / 8);
                    outcomes[1] += 1;
                }
                Err(_) => outcomes[0] += 1,
            }
        }
        println!("| {name} | {} | {} | {} |", outcomes[0] + outcomes[1], outcomes[0], outcomes[1]);
        if name == "tiles" {
            assert_eq!(outcomes[1], 0, "every bit of a tile is covered");
        }
    }
}

/// A payload in the position of another tile is detected by the id of the tile that it contains.
#[test]
fn tiles_exchanged_are_refused() {
    let ids = ids();
    let (first, second) = (encoded(ids[2]), encoded(ids[3]));
    assert_eq!(first.len(), second.len(), "else they cannot change places");
    let whole = written();
    let find = |tile: &[u8]| whole.windows(tile.len()).position(|at| at == tile).unwrap();
    let (at_first, at_second) = (find(&first), find(&second));
    let mut exchanged = whole.clone();
    exchanged[at_first..at_first + first.len()].copy_from_slice(&second);
    exchanged[at_second..at_second + second.len()].copy_from_slice(&first);
    let error = read(exchanged).unwrap_err();
    let expected = format!("tile {}, header: the bytes belong to tile {}", ids[2], ids[3]);
    assert!(error.starts_with(&expected), "{error}");
}
