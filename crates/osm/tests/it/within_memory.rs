//! Ways and nodes that do not fit in memory: the result is the same with any memory, blobs are read
//! no more often than necessary, and a failing disk causes an error.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::{
    cell::{Cell, RefCell},
    fs,
    io::{self, Cursor},
    path::Path,
    sync::atomic::{AtomicU64, Ordering},
};

use crate::common::{
    CountedBlobs, Extract, POOL, fixture, gather, made::made_extract, read_bytes_within, request,
    roads::read_roads_from, to_lattice,
};
use corniche_osm::{ReadOsmError, ReadRequest};
use corniche_store::{ScratchRange, ScratchSpace};
use corniche_testing::MemoryScratch;
use corniche_testing::{
    pbf::{BlockBuilder, plain_header, raw},
    real_data,
};
use proptest::prelude::*;

/// A quarter of the memory is for nodes, 18 bytes each.
const MEMORY_OF_A_NODE: u64 = 4 * 18;

/// Returns the result, or the words of the rejection.
fn read_within(memory_bytes: u64, bytes: &[u8]) -> Result<Extract, String> {
    let scratch = MemoryScratch::default();
    read_bytes_within(memory_bytes, &scratch, bytes).map_err(|error| error.to_string())
}

#[track_caller]
fn check_same(name: &Path, memories: &[u64]) {
    let bytes = fs::read(name).unwrap();
    let expected = read_within(u64::MAX, &bytes);
    for &memory_bytes in memories {
        assert_eq!(
            read_within(memory_bytes, &bytes),
            expected,
            "{} in {memory_bytes} bytes",
            name.display()
        );
    }
}

#[test]
fn real_extracts_are_the_same_with_any_memory() {
    for name in [
        "liechtenstein/liechtenstein-2021-10-28.osm.pbf",
        "liechtenstein/liechtenstein-2013-08-03.osm.pbf",
        "portland/portland-central-filtered.osm.pbf",
        "swellendam/swellendam-roads.osm.pbf",
        "nasty/osm/loc_on_ways.osm.pbf",
        "nasty/osm/nozlib_nodense.osm.pbf",
        "nasty/osm/r5-missing-nodes.osm.pbf",
        "nasty/osm/deleted_nodes.osh.pbf",
        "nasty/derived-osm/simple-extract-missing-nodes.osm.pbf",
    ] {
        if let Some(path) = real_data(name) {
            check_same(&path, &[100_000, 1 << 20, 16 << 20]);
        }
    }
}

#[test]
fn fixtures_are_the_same_with_any_memory() {
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
        check_same(&fixture(name), &[0, 1, 64, 300, 1000, 5000]);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    /// Roads, defects, counts and rejections are the same.
    #[test]
    fn a_random_extract_is_the_same_with_any_memory(extract in made_extract()) {
        let bytes = extract.bytes();
        let expected = read_within(u64::MAX, &bytes);
        for memory_bytes in [0, 700, 3000, 20_000] {
            prop_assert_eq!(&read_within(memory_bytes, &bytes), &expected, "{} bytes", memory_bytes);
        }
    }
}

fn blobs_read(memory_bytes: u64, bytes: &[u8]) -> (Extract, u64) {
    let (blobs, scratch) = (Cell::new(0), MemoryScratch::default());
    let request = request(Path::new("made.osm.pbf"), &POOL, &to_lattice, &scratch);
    let request = ReadRequest { memory_bytes, ..request };
    let source = CountedBlobs::new(bytes, &blobs);
    let extract =
        gather(|sink, on_defect| read_roads_from(source, &request, sink, on_defect, &|| false));
    (extract.unwrap(), blobs.into_inner())
}

/// Returns blobs of 100 nodes in a row; `ids` says which node is where. Five blobs of ways follow,
/// which reference the nodes from 2000 on.
fn row_of_blobs(ids: impl Iterator<Item = i64>) -> Vec<u8> {
    let (nodes, ways) = blobs_of_row(ids);
    [plain_header()].into_iter().chain(nodes).chain(ways).flatten().collect()
}

fn blobs_of_row(ids: impl Iterator<Item = i64>) -> (Vec<Vec<u8>>, Vec<Vec<u8>>) {
    let ids: Vec<i64> = ids.collect();
    let nodes = ids.chunks(100).map(|some| {
        let mut block = BlockBuilder::new();
        let nodes: Vec<_> = some.iter().map(|&id| (id, 0, 100 * id)).collect();
        block.dense(&nodes);
        raw(b"OSMData", &block.bytes())
    });
    let ways = (0..5).map(|blob| {
        let mut block = BlockBuilder::new();
        for way in 0..20 {
            let first = 2000 + 400 * blob + 20 * way;
            block.track(first, &(first..first + 20).collect::<Vec<_>>());
        }
        raw(b"OSMData", &block.bytes())
    });
    (nodes.collect(), ways.collect())
}

/// The first way is searched among 45 blobs, once the first blob is known to contain nodes.
const SOUGHT: u64 = 1 + 5;

#[test]
fn a_blob_of_a_sorted_extract_is_read_once_and_for_its_nodes_once_more_where_the_memory_ends() {
    let sorted = row_of_blobs(0..4000);
    let (expected, blobs) = blobs_read(u64::MAX, &sorted);
    assert_eq!((expected.roads.len(), expected.summary.nodes_missing), (100, 0));
    assert_eq!(blobs, SOUGHT + 45);
    // Parts of 300 nodes end where blobs end; every second part of 350 ends within a blob.
    for (nodes, again) in [(2000, 0), (1000, 0), (300, 0), (350, 3), (150, 7), (100, 0), (50, 20)] {
        let (extract, blobs) = blobs_read(nodes * MEMORY_OF_A_NODE, &sorted);
        assert_eq!(extract, expected, "{nodes} nodes at a time");
        // The 20 blobs with the nodes from 2000 on are needed again, except for the blobs of the
        // first part.
        let first = nodes.min(2000).div_ceil(100);
        assert_eq!(blobs, SOUGHT + 45 + 20 - first + again, "{nodes} nodes at a time");
        assert!(again < 2000_u64.div_ceil(nodes));
    }
}

/// The number of blobs in a file, and of blobs with nodes, was counted separately by a script. The
/// number of nodes of ways with a `highway` tag comes from `osmium tags-filter w/highway`. Ways
/// that do not become roads count, too, because their length is reported.
#[test]
fn blobs_of_real_extracts_are_read_as_seldom_as_those_of_made_ones() {
    for (name, all, with_nodes, highway_nodes) in [
        ("liechtenstein/liechtenstein-2021-10-28.osm.pbf", 42_u64, 37, 73_083_u64),
        ("liechtenstein/liechtenstein-2013-08-03.osm.pbf", 11, 9, 28_223),
        ("swellendam/swellendam-roads.osm.pbf", 3, 2, 8_624),
    ] {
        let Some(path) = real_data(name) else { return };
        let bytes = fs::read(path).unwrap();
        let (expected, once) = blobs_read(u64::MAX, &bytes);
        assert!((all..=all + u64::from(all.ilog2()) + 2).contains(&once), "{name}: {once} blobs");
        for nodes in [100, 1000, 10_000] {
            let (extract, blobs) = blobs_read(nodes * MEMORY_OF_A_NODE, &bytes);
            assert_eq!(extract, expected, "{name}: {nodes} nodes at a time");
            let parts = highway_nodes.div_ceil(nodes);
            assert!(
                blobs < once + with_nodes + parts,
                "{name}: {nodes} nodes at a time: {blobs} blobs"
            );
        }
    }
}

#[test]
fn blobs_of_an_extract_that_is_not_sorted_are_read_for_each_part_of_the_nodes() {
    let expected = blobs_read(u64::MAX, &row_of_blobs(0..4000)).0;
    // Each blob has nodes from the whole range.
    let scattered = row_of_blobs((0..4000).map(|number| number % 40 * 100 + number / 40));
    for (nodes, times) in [(1 << 40, 1), (2000, 1), (500, 4), (300, 7)] {
        let (extract, blobs) = blobs_read(nodes * MEMORY_OF_A_NODE, &scattered);
        assert_eq!(extract, expected, "{nodes} nodes at a time");
        assert_eq!(blobs, SOUGHT + 45 + (times - 1) * 40, "{nodes} nodes at a time");
    }
}

/// Bisection mistakes the end of the nodes for the beginning of most ways. The blob of ways before
/// it is noticed, and nothing is reported twice.
#[test]
fn ways_among_the_nodes_are_found() {
    let (expected, _) = blobs_read(u64::MAX, &row_of_blobs(0..4000));
    for at in 0..40 {
        let (mut blobs, mut ways) = blobs_of_row(0..4000);
        let mut of_nothing = BlockBuilder::new();
        of_nothing.way(9_999_999, &[("highway", "unheard_of")], &[2000, 2001]);
        ways.push(raw(b"OSMData", &of_nothing.bytes()));
        blobs.insert(at, ways.swap_remove(0));
        let bytes: Vec<u8> =
            [plain_header()].into_iter().chain(blobs).chain(ways).flatten().collect();
        for memory_bytes in [u64::MAX, 300 * MEMORY_OF_A_NODE, 0] {
            let (extract, _) = blobs_read(memory_bytes, &bytes);
            assert_eq!(extract.roads, expected.roads, "at {at}");
            assert_eq!(extract.summary.nodes_seen, 4000, "at {at}");
            assert_eq!(extract.defects.len(), 1, "at {at}: {:?}", extract.defects);
        }
    }
}

/// Scratch space in which one call fails.
struct Failing {
    space: MemoryScratch,
    calls_left: AtomicU64,
}

impl Failing {
    fn call(&self) -> io::Result<()> {
        let left = self.calls_left.fetch_sub(1, Ordering::Relaxed);
        if left == 1 { Err(io::ErrorKind::StorageFull.into()) } else { Ok(()) }
    }
}

impl ScratchSpace for Failing {
    fn append(&self, bytes: &[u8]) -> io::Result<ScratchRange> {
        self.call()?;
        self.space.append(bytes)
    }

    fn read(&self, span: ScratchRange) -> io::Result<Vec<u8>> {
        self.call()?;
        self.space.read(span)
    }
}

#[test]
fn a_disk_that_fails_at_any_call_is_an_error_that_names_the_extract() {
    let bytes = fs::read(fixture("classes-located.osm.pbf")).unwrap();
    let mut failures = 0;
    for call in 1.. {
        let scratch = Failing { space: MemoryScratch::default(), calls_left: AtomicU64::new(call) };
        match read_bytes_within(2000, &scratch, &bytes) {
            Err(error @ ReadOsmError::Scratch { .. }) => {
                let words = error.to_string();
                assert!(words.contains("made.osm.pbf") && words.contains("free space"), "{words}");
                failures += 1;
            }
            Err(error) => panic!("call {call}: {error}"),
            Ok(extract) => {
                assert_eq!(Ok(extract), read_within(u64::MAX, &bytes));
                assert!(scratch.calls_left.into_inner() > 0, "call {call} failed unseen");
                break;
            }
        }
    }
    assert!(failures > 2, "{failures}");
}

#[test]
fn all_in_memory_needs_no_scratch_space() {
    struct None;
    impl ScratchSpace for None {
        fn append(&self, _: &[u8]) -> io::Result<ScratchRange> {
            Err(io::ErrorKind::StorageFull.into())
        }
        fn read(&self, _: ScratchRange) -> io::Result<Vec<u8>> {
            Err(io::ErrorKind::NotFound.into())
        }
    }
    let bytes = row_of_blobs(0..4000);
    let extract = read_bytes_within(16 << 20, &None, &bytes).unwrap();
    assert_eq!(Ok(extract), read_within(u64::MAX, &bytes));
}

#[test]
fn progress_grows_from_step_to_step_up_to_twice_the_file() {
    let sorted = row_of_blobs(0..4000);
    let (nodes, ways) = blobs_of_row(0..4000);
    let unsorted = [plain_header()].into_iter().chain(ways).chain(nodes).flatten().collect();
    let empty = plain_header();
    for (bytes, memory_bytes) in
        [(&sorted, u64::MAX), (&unsorted, u64::MAX), (&unsorted, 20_000), (&empty, 1000)]
    {
        let (told, scratch) = (RefCell::new(Vec::new()), MemoryScratch::default());
        let on_progress = |done: u64, all: u64| told.borrow_mut().push((done, all));
        let request = request(Path::new("made.osm.pbf"), &POOL, &to_lattice, &scratch);
        let request = ReadRequest { memory_bytes, on_progress: Some(&on_progress), ..request };
        let source = Cursor::new(bytes);
        gather(|sink, on_defect| read_roads_from(source, &request, sink, on_defect, &|| false))
            .unwrap();
        let told = told.into_inner();
        let all = 2 * bytes.len() as u64;
        assert!(told.iter().all(|&(_, whole)| whole == all));
        assert!(told.is_sorted(), "{told:?}");
        assert_eq!(told.last(), Some(&(all, all)));
        if bytes.len() > empty.len() {
            // The reading may also stop within a step; the ways of the sorted file are read at
            // once.
            for step in u64::from(*bytes == sorted)..2 {
                let half = bytes.len() as u64;
                let within = step * half + 1..(step + 1) * half;
                assert!(told.iter().any(|(done, _)| within.contains(done)), "{step}: {told:?}");
            }
        }
    }
}

#[test]
fn it_stops_when_asked_at_any_time_also_between_the_passes() {
    let bytes = row_of_blobs(0..4000);
    for memory_bytes in [u64::MAX, 3000] {
        let mut stopped = 0;
        for allowed in 0.. {
            let (asked, scratch) = (AtomicU64::new(0), MemoryScratch::default());
            let should_stop = || asked.fetch_add(1, Ordering::Relaxed) >= allowed;
            let request = request(Path::new("made.osm.pbf"), &POOL, &to_lattice, &scratch);
            let request = ReadRequest { memory_bytes, ..request };
            let source = Cursor::new(&bytes);
            let read = gather(|sink, on_defect| {
                read_roads_from(source, &request, sink, on_defect, &should_stop)
            });
            match read {
                Err(ReadOsmError::Stopped { .. }) => stopped += 1,
                Err(error) => panic!("{error}"),
                Ok(_) => break,
            }
        }
        assert!(stopped > 6, "{stopped}");
    }
}
