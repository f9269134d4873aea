//! Hostile packages with an invalid header or invalid directories.

use corniche_tileset::limits::MAX_DIRECTORY_ENTRIES;

use crate::{
    package,
    pmtiles::{RawDirectoryEntry, directory, gzip, put_varint},
};

use super::{
    case::{Case, ReadOutcome, refused},
    parts::PackageParts,
};

/// A directory of at most one entry, followed by the tiles of the good package.
fn with_root(entries: &[RawDirectoryEntry]) -> Vec<u8> {
    let root = gzip(&directory(entries));
    PackageParts { root, tiles: 0, ..PackageParts::good() }.assemble()
}

/// Leaf directories under a root with one leaf entry for tile 0.
fn with_leaves(leaves: Vec<u8>, first_length: u64) -> Vec<u8> {
    let root = directory(&[RawDirectoryEntry { step: 0, run: 0, length: first_length, offset: 1 }]);
    PackageParts { root: gzip(&root), leaves, tiles: 0, ..PackageParts::good() }.assemble()
}

fn tile_entry(step: u64) -> RawDirectoryEntry {
    RawDirectoryEntry { step, run: 1, length: 20, offset: 1 }
}

/// A gzip leaf whose only entry points to the given offset and length, without padding.
fn leaf_to(offset: u64, length: u64) -> Vec<u8> {
    gzip(&directory(&[RawDirectoryEntry { step: 0, run: 0, length, offset: offset + 1 }]))
}

pub(crate) fn all() -> Vec<Case> {
    let good = PackageParts::good;
    let number = |value: u64| value.to_le_bytes();
    let mut cases = vec![
        Case {
            name: "the good package, by the specification",
            bytes: good().assemble(),
            outcome: ReadOutcome::Read,
            limit_mib: 2,
        },
        Case {
            name: "the good package, by the writer",
            bytes: package::written(),
            outcome: ReadOutcome::Read,
            limit_mib: 2,
        },
        refused("no bytes", vec![], "not a PMTiles file"),
        refused("another file", b"\x89PNG\r\n".repeat(50), "not a PMTiles file"),
        refused("PMTiles 4", good().with_header(7, &[4]), "version 4 is not supported"),
        refused("tiles that are pictures", good().with_header(99, &[2]), "ordinary PMTiles"),
        refused("root beyond the end", good().with_header(8, &number(1 << 40)), "truncated"),
        refused("root that wraps around", good().with_header(8, &number(u64::MAX)), "the header"),
        refused("root of 2^63 bytes", good().with_header(16, &number(1 << 63)), "truncated"),
        refused("root inside the header", good().with_header(8, &number(100)), "overlap"),
        refused(
            "root on top of the metadata",
            good().with_header(8, &number(127 + good().root.len() as u64)),
            "overlap",
        ),
        refused(
            "one tile too many in the header",
            good().with_header(72, &number(5)),
            "fewer or more",
        ),
        refused(
            "root of 5 MiB",
            {
                let root = vec![0; 5 << 20];
                PackageParts { root, ..good() }.assemble()
            },
            "is larger than readers accept",
        ),
        refused(
            "root that is no gzip",
            PackageParts { root: vec![7; 40], ..good() }.assemble(),
            "the root directory",
        ),
    ];
    let mut endless = Vec::new();
    put_varint(&mut endless, 1 << 63);
    let raw = |bytes: &[u8]| PackageParts { root: gzip(bytes), ..good() }.assemble();
    let too_many: Vec<RawDirectoryEntry> = (0..=MAX_DIRECTORY_ENTRIES as u64)
        .map(|k| RawDirectoryEntry {
            step: k.min(1),
            run: 1,
            length: 20,
            offset: u64::from(k == 0),
        })
        .collect();
    cases.push(refused("2^63 entries", raw(&endless), "the root directory"));
    cases.push(Case {
        limit_mib: 4,
        ..refused("an entry too many", raw(&directory(&too_many)), "the root directory")
    });
    cases.push(Case {
        limit_mib: 20,
        ..refused("a directory of 256 MiB of zeros", raw(&vec![0; 256 << 20]), "the root directory")
    });
    let entry = |run, length, offset| [RawDirectoryEntry { step: 0, run, length, offset }];
    cases.extend([
        refused(
            "a run of 2^32 tiles",
            with_root(&entry(u64::from(u32::MAX), 20, 1)),
            "the root directory",
        ),
        refused("a run of 2^64 tiles", with_root(&entry(u64::MAX, 20, 1)), "the root directory"),
        refused("a tile of no bytes", with_root(&entry(1, 0, 1)), "the root directory"),
        refused("an offset of 2^64", with_root(&entry(1, 20, u64::MAX)), "the root directory"),
        refused("a tile outside the tiles", with_root(&entry(1, 20, 1 << 40)), "a directory"),
        refused("a tile of 4 GiB", with_root(&entry(1, u64::from(u32::MAX), 1)), "a directory"),
        refused(
            "a leaf outside the leaves",
            with_root(&entry(0, 20, 1)),
            "outside the leaf directories",
        ),
        refused(
            "tiles that share bytes",
            with_root(&[tile_entry(0), tile_entry(1)]),
            "the root directory",
        ),
        refused("a tile beyond all levels", with_root(&[tile_entry(u64::MAX / 2)]), "a directory"),
        refused("a tile beyond the finest level", with_root(&[tile_entry(21)]), "a directory"),
    ]);
    // A leaf contains its own length: try until both agree.
    let own_length = (20..60).find(|&length| leaf_to(0, length).len() as u64 == length).unwrap();
    let itself = leaf_to(0, own_length);
    cases.push(refused(
        "a leaf that points at itself",
        with_leaves(itself, own_length),
        "a directory",
    ));
    // Readers ignore bytes after the end of gzip data, so every leaf can claim to be 64 bytes long.
    let chain: Vec<u8> = (0..6_u64)
        .flat_map(|depth| {
            let mut leaf = leaf_to(64 * (depth + 1), 64);
            leaf.resize(64, 0);
            leaf
        })
        .collect();
    cases.push(refused("leaves nested six deep", with_leaves(chain, 64), "a directory"));
    let elsewhere = gzip(&directory(&[tile_entry(3)]));
    let length = elsewhere.len() as u64;
    cases.push(refused(
        "a leaf that begins elsewhere",
        with_leaves(elsewhere, length),
        "a leaf directory",
    ));
    let empty = gzip(&[0]);
    let length = empty.len() as u64;
    cases.push(refused("an empty leaf", with_leaves(empty, length), "a leaf directory"));
    // Many leaves, each with as many tiles as a directory may list, without bytes for these tiles.
    let mut leaves = Vec::new();
    let mut root = Vec::new();
    let tiles = MAX_DIRECTORY_ENTRIES as u64;
    for k in 0..64 {
        let entries: Vec<RawDirectoryEntry> = (0..tiles)
            .map(|n| RawDirectoryEntry {
                step: if n == 0 { k * tiles } else { 1 },
                run: 1,
                length: 20,
                offset: if n == 0 { k * tiles * 20 + 1 } else { 0 },
            })
            .collect();
        let leaf = gzip(&directory(&entries));
        root.push(RawDirectoryEntry {
            step: if k == 0 { 0 } else { tiles },
            run: 0,
            length: leaf.len() as u64,
            offset: leaves.len() as u64 + 1,
        });
        leaves.extend(leaf);
    }
    let bytes =
        PackageParts { root: gzip(&directory(&root)), leaves, tiles: 0, ..good() }.assemble();
    cases.push(Case {
        limit_mib: 8,
        ..refused("eight million tiles in small leaves", bytes, "a directory")
    });
    cases
}
