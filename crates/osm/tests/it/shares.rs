//! An extract that is read in shares gives the same roads, defects, counts and rejections as one
//! that is read at once.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::{fs, path::Path};

use crate::common::{
    Extract, POOL, fixture, gather_kept, kept,
    made::{MadeExtract, made_extract},
    read, request, to_lattice, written,
};
use corniche_osm::{KeptError, ReadOsmError, ReadRequest, Share, keep_nodes, keep_ways};
use corniche_store::{ArtifactKey, Artifacts, MemoryStore, ScratchSpace};
use corniche_testing::MemoryScratch;
use corniche_testing::{
    pbf::{BlockBuilder, field, number, plain_header, raw},
    real_data, sample,
};
use proptest::prelude::*;

fn request_within<'a>(
    path: &'a Path,
    memory_bytes: u64,
    scratch: &'a dyn ScratchSpace,
) -> ReadRequest<'a> {
    ReadRequest { memory_bytes, ..request(path, &POOL, &to_lattice, scratch) }
}

/// Creates all shares of both steps, as processes would that know nothing of each other: the last
/// ones first.
fn keep(path: &Path, of: u16, memory_bytes: u64, store: &MemoryStore) -> Result<(), ReadOsmError> {
    let scratch = MemoryScratch::default();
    let request = request_within(path, memory_bytes, &scratch);
    let shares: Vec<Share> = Share::all(of).collect();
    assert_eq!(shares.len(), usize::from(of));
    for &share in shares.iter().rev() {
        keep_ways(&request, share, kept(store), &|| false)?;
    }
    for &share in shares.iter().rev() {
        assert_eq!(kept(store).complete(), None);
        keep_nodes(&request, share, kept(store), &|| false)?;
    }
    assert_eq!(kept(store).complete(), Some(of));
    Ok(())
}

fn read_kept(
    path: &Path,
    of: u16,
    memory_bytes: u64,
    store: &MemoryStore,
) -> Result<Extract, ReadOsmError> {
    let scratch = MemoryScratch::default();
    let request = request_within(path, memory_bytes, &scratch);
    gather_kept(&request, of, store)
}

fn read_in_shares(path: &Path, of: u16, memory_bytes: u64) -> Result<Extract, ReadOsmError> {
    let store = MemoryStore::default();
    keep(path, of, memory_bytes, &store)?;
    read_kept(path, of, memory_bytes, &store)
}

/// Compares any number of shares with the reading at once; a rejection must have the same words.
#[track_caller]
fn check_same(path: &Path, counts: &[u16]) {
    let words = |read: Result<Extract, ReadOsmError>| read.map_err(|error| error.to_string());
    let expected = words(read(path));
    for &of in counts {
        for memory_bytes in [1 << 30, 200_000] {
            let found = words(read_in_shares(path, of, memory_bytes));
            assert!(found == expected, "{} in {of} shares: {:?}", path.display(), found.err());
        }
    }
}

#[track_caller]
fn check_bytes(bytes: &[u8], counts: &[u16]) {
    let (_folder, path) = written("made.osm.pbf", bytes);
    check_same(&path, counts);
}

#[test]
fn samples_are_the_same_in_shares() {
    for name in ["liechtenstein/liechtenstein-2013-08-03.osm.pbf", "pass/pass.osm.pbf"] {
        check_same(&sample(name), &[1, 2, 3, 7, 40]);
    }
}

#[test]
fn real_extracts_are_the_same_in_shares() {
    for name in [
        "liechtenstein/liechtenstein-2021-10-28.osm.pbf",
        "portland/portland-central-filtered.osm.pbf",
        "swellendam/swellendam-roads.osm.pbf",
        "nasty/osm/loc_on_ways.osm.pbf",
        "nasty/osm/nozlib_nodense.osm.pbf",
        "nasty/osm/r5-missing-nodes.osm.pbf",
        "nasty/osm/deleted_nodes.osh.pbf",
        "nasty/derived-osm/simple-extract-missing-nodes.osm.pbf",
    ] {
        if let Some(path) = real_data(name) {
            check_same(&path, &[1, 2, 3, 7]);
        }
    }
}

#[test]
fn fixtures_are_the_same_in_shares() {
    for name in [
        "classes.osm.pbf",
        "classes-plain-raw.osm.pbf",
        "classes-located.osm.pbf",
        "classes-lz4.osm.pbf",
        "crossing.osm.pbf",
        "defects.osm.pbf",
        "versions.osm.pbf",
        "history.osh.pbf",
    ] {
        check_same(&fixture(name), &[1, 2, 3, 7]);
    }
}

/// Returns a blob of ways, each with its id, version (0: none) and nodes.
fn ways(ways: &[(i64, i64, &[i64])]) -> Vec<u8> {
    let mut block = BlockBuilder::new();
    for &(id, version, nodes) in ways {
        let mut message = block.way_message(id, &[("highway", "track")], nodes);
        if version > 0 {
            message.extend(field(4, &number(1, version)));
        }
        block.groups.push(field(3, &message));
    }
    raw(b"OSMData", &block.bytes())
}

/// Returns a blob of nodes: id, latitude, longitude.
fn nodes(nodes: &[(i64, i64, i64)]) -> Vec<u8> {
    let mut block = BlockBuilder::new();
    block.dense(nodes);
    raw(b"OSMData", &block.bytes())
}

fn file(blobs: &[Vec<u8>]) -> Vec<u8> {
    [plain_header(), blobs.concat()].concat()
}

/// With as many shares as blobs or more, each blob has its own share.
const COUNTS: [u16; 6] = [1, 2, 3, 4, 9, 20];

#[test]
fn duplicates_in_several_shares_are_told_in_order() {
    check_bytes(
        &file(&[
            nodes(&[(1, 0, 0), (2, 0, 9), (3, 9, 9)]),
            ways(&[(5, 1, &[1, 2]), (6, 0, &[2, 3])]),
            ways(&[(6, 0, &[3, 1]), (5, 1, &[1, 3])]),
            ways(&[(4, 0, &[1, 3]), (5, 0, &[2, 3]), (5, 1, &[3, 3])]),
        ]),
        &COUNTS,
    );
}

#[test]
fn a_history_that_no_share_sees_alone_is_refused() {
    let apart = [
        nodes(&[(1, 0, 0), (2, 0, 9)]),
        ways(&[(5, 1, &[1, 2]), (6, 1, &[1, 2])]),
        ways(&[(7, 1, &[2, 1])]),
        ways(&[(8, 1, &[2, 1]), (5, 2, &[1, 2])]),
    ];
    let border =
        [nodes(&[(1, 0, 0), (2, 0, 9)]), ways(&[(5, 1, &[1, 2])]), ways(&[(5, 2, &[1, 2])])];
    for blobs in [&apart[..], &border[..]] {
        let bytes = file(blobs);
        check_bytes(&bytes, &COUNTS);
        let (_folder, path) = written("made.osm.pbf", &bytes);
        let (store, of) = (MemoryStore::default(), 9);
        keep(&path, of, 1 << 30, &store).unwrap();
        let error = read_kept(&path, of, 1 << 30, &store).unwrap_err();
        assert!(matches!(error, ReadOsmError::History { .. }), "{error}");
    }
}

/// The first position on Earth is kept, whichever blob gives it; only nodes on roads matter.
#[test]
fn places_of_a_node_in_several_shares_are_compared() {
    let far = 2_000_000_000;
    check_bytes(
        &file(&[
            ways(&[(1, 0, &[1, 2, 3, 4, 5, 6, 7])]),
            nodes(&[
                (1, far, 0),
                (2, 1, 1),
                (3, 1, 1),
                (4, far, 0),
                (5, 2, 2),
                (7, 3, 3),
                (8, 1, 1),
            ]),
            nodes(&[
                (1, 5, 5),
                (2, 1, 1),
                (3, 2, 2),
                (4, far, 1),
                (5, far, 0),
                (7, 3, 3),
                (8, 2, 2),
            ]),
            nodes(&[(1, 5, 6), (2, 1, 1), (3, 1, 1), (5, 2, 2), (7, 3, 4)]),
        ]),
        &COUNTS,
    );
}

#[test]
fn a_damaged_blob_fails_its_share_with_the_words_of_the_whole() {
    let good = ways(&[(5, 0, &[1, 2])]);
    let mut bad = BlockBuilder::new();
    bad.groups.push(field(3, &[number(1, 7), field(2, &[9]), field(3, &[])].concat()));
    let bytes = file(&[
        nodes(&[(1, 0, 0), (2, 0, 9)]),
        good.clone(),
        raw(b"OSMData", &bad.bytes()),
        ways(&[(6, 0, &[2, 1])]),
    ]);
    check_bytes(&bytes, &COUNTS);
    let (_folder, path) = written("made.osm.pbf", &bytes);
    let (store, scratch) = (MemoryStore::default(), MemoryScratch::default());
    let request = request_within(&path, 1 << 30, &scratch);
    let failed: Vec<u16> = Share::all(9)
        .filter(|&share| keep_ways(&request, share, kept(&store), &|| false).is_err())
        .map(Share::number)
        .collect();
    assert_eq!(failed.len(), 1, "{failed:?}");
    // Its ways are missing: no share of nodes can be created, and nothing is complete.
    let error =
        keep_nodes(&request, Share::new(1, 9).unwrap(), kept(&store), &|| false).unwrap_err();
    assert!(
        matches!(error, ReadOsmError::Kept { source: KeptError::Missing { .. }, .. }),
        "{error}"
    );
    assert_eq!(kept(&store).missing_ways(9).map(Share::number), failed.first().copied());
    assert_eq!(kept(&store).complete(), None);
    // The file is truncated: no share can be created, because the list of blobs has no end.
    fs::write(&path, &bytes[..bytes.len() - 3]).unwrap();
    check_same(&path, &[1, 5]);
}

#[test]
fn an_extract_without_roads_or_blobs_can_be_shared() {
    check_bytes(&plain_header(), &COUNTS);
    check_bytes(&file(&[nodes(&[(1, 0, 0)])]), &COUNTS);
}

/// The stored results depend on the extract and the share, not on memory or threads: parts that are
/// created twice are equal.
#[test]
fn what_a_share_keeps_is_the_same_with_any_memory() {
    let path = sample("liechtenstein/liechtenstein-2013-08-03.osm.pbf");
    let all = |memory_bytes: u64| {
        let store = MemoryStore::default();
        keep(&path, 3, memory_bytes, &store).unwrap();
        let items = (10..16_u8).flat_map(|kind| {
            store
                .items(kind)
                .into_iter()
                .map(move |item| ArtifactKey { kind, item })
                .collect::<Vec<_>>()
        });
        items.map(|key| (key, store.get(key).unwrap())).collect::<Vec<_>>()
    };
    let expected = all(1 << 30);
    assert!(expected.len() > 9);
    assert!(all(100_000) == expected);
}

/// Shares of another division do not disturb, and an existing share is not created again.
#[test]
fn shares_of_several_numbers_lie_beside_each_other() {
    let path = sample("pass/pass.osm.pbf");
    let store = MemoryStore::default();
    let scratch = MemoryScratch::default();
    let expected = read(&path).unwrap();
    keep(&path, 3, 1 << 30, &store).unwrap();
    keep_ways(
        &request_within(&path, 1 << 30, &scratch),
        Share::new(2, 2).unwrap(),
        kept(&store),
        &|| false,
    )
    .unwrap();
    assert_eq!(kept(&store).complete(), Some(3));
    assert!(read_kept(&path, 3, 1 << 30, &store).unwrap() == expected);
    // Nothing is read for existing results: the file need not exist.
    let gone = request_within(Path::new("gone.osm.pbf"), 1 << 30, &scratch);
    for share in Share::all(3) {
        keep_ways(&gone, share, kept(&store), &|| false).unwrap();
        keep_nodes(&gone, share, kept(&store), &|| false).unwrap();
    }
    assert!(keep_ways(&gone, Share::WHOLE, kept(&store), &|| false).is_err());
}

/// A store may lack an artifact, or have another in its place.
#[test]
fn what_is_lost_or_damaged_is_an_error() {
    let path = fixture("classes-located.osm.pbf");
    let whole = MemoryStore::default();
    keep(&path, 2, 1 << 30, &whole).unwrap();
    let keys: Vec<ArtifactKey> = (10..16_u8)
        .flat_map(|kind| {
            whole
                .items(kind)
                .into_iter()
                .map(move |item| ArtifactKey { kind, item })
                .collect::<Vec<_>>()
        })
        .collect();
    for &broken in &keys {
        for instead in [None, Some(vec![0xff; 3])] {
            let store = MemoryStore::default();
            for &key in &keys {
                match (&instead, key == broken) {
                    (None, true) => {}
                    (Some(bytes), true) => store.put(key, bytes).unwrap(),
                    (_, false) => store.put(key, &whole.get(key).unwrap().unwrap()).unwrap(),
                }
            }
            let error = read_kept(&path, 2, 1 << 30, &store).unwrap_err();
            assert!(matches!(error, ReadOsmError::Kept { .. }), "{broken:?}: {error}");
        }
    }
}

/// Two versions make a history if one follows the other, whatever the blobs and shares are;
/// otherwise only two versions of roads do.
#[test]
fn versions_with_another_way_between_them_are_no_history_in_any_blob_or_share() {
    let ways = [(18, "track", 8), (5, "track", 7), (18, "footway", 7)];
    for per_block in 1..=3 {
        let bytes = MadeExtract::of_bare_ways(&ways, per_block).bytes();
        let (_folder, path) = written("made.osm.pbf", &bytes);
        let whole = read(&path).unwrap();
        assert_eq!(whole.summary.highway_ways, 3, "{per_block} a block");
        check_same(&path, &COUNTS);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    /// If several facts make a file a history, each way of reading may report another one first.
    #[test]
    fn a_random_extract_is_the_same_in_shares(
        extract in made_extract(),
        of in 1_u16..30,
        memory_bytes in prop::sample::select(vec![0, 700, 3000, 1 << 30]),
    ) {
        let (_folder, path) = written("made.osm.pbf", &extract.bytes());
        match (read(&path), read_in_shares(&path, of, memory_bytes)) {
            (Ok(expected), Ok(found)) => prop_assert_eq!(found, expected),
            (Err(ReadOsmError::History { .. }), Err(ReadOsmError::History { .. })) => {}
            (expected, found) => prop_assert!(false, "{:?} and not {:?}", found, expected),
        }
    }
}
