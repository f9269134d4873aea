//! The memory that the roads of a large extract take. The test runs alone in its process, whose
//! peak memory it reads.

#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test may unwrap and says what it skips"
)]

#[path = "it/common/mod.rs"]
mod common;

use std::{
    fs::{self, File},
    io::{self, Cursor, Read, Seek, SeekFrom, Write},
    path::Path,
    sync::Mutex,
};

use common::{POOL, request, roads::read_roads_from, to_lattice};
use corniche_osm::ReadRequest;
use corniche_store::{ScratchRange, ScratchSpace};
use corniche_testing::pbf::{BlockBuilder, plain_header, raw};

const NODES: i64 = 3_000_000;
const NODES_OF_WAY: i64 = 20;

/// A file and its length.
struct FileScratch(Mutex<(File, u64)>);

impl ScratchSpace for FileScratch {
    fn append(&self, bytes: &[u8]) -> io::Result<ScratchRange> {
        let mut own = self.0.lock().unwrap();
        let span = ScratchRange { offset: own.1, length: bytes.len() as u64 };
        own.0.seek(SeekFrom::Start(span.offset))?;
        own.0.write_all(bytes)?;
        own.1 += span.length;
        Ok(span)
    }

    fn read(&self, span: ScratchRange) -> io::Result<Vec<u8>> {
        let mut own = self.0.lock().unwrap();
        own.0.seek(SeekFrom::Start(span.offset))?;
        let mut bytes = vec![0; span.length as usize];
        own.0.read_exact(&mut bytes)?;
        Ok(bytes)
    }
}

/// Returns ways one after another; each begins where the previous one ends, so every node is
/// needed.
fn long_row() -> Vec<u8> {
    let mut file = plain_header();
    for first in (0..NODES).step_by(8000) {
        let mut block = BlockBuilder::new();
        let nodes = (first..NODES.min(first + 8000)).map(|id| (id, id % 1000, id));
        block.dense(&nodes.collect::<Vec<_>>());
        file.extend(raw(b"OSMData", &block.bytes()));
    }
    let firsts: Vec<i64> = (0..NODES - 1).step_by(NODES_OF_WAY as usize).collect();
    for some in firsts.chunks(8000) {
        let mut block = BlockBuilder::new();
        for first in some {
            let last = (first + NODES_OF_WAY).min(NODES - 1);
            block.track(*first, &(*first..=last).collect::<Vec<_>>());
        }
        file.extend(raw(b"OSMData", &block.bytes()));
    }
    file
}

/// Returns a line of the system's statistics of this process, MiB; `None` if the system has none.
fn memory_mib(name: &str) -> Option<u64> {
    let status = fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with(name))?;
    line.split_whitespace().nth(1)?.parse::<u64>().ok().map(|kib| kib / 1024)
}

#[test]
fn three_million_nodes_of_roads_are_read_within_eight_mebibytes_and_those_of_blobs() {
    let bytes = long_row();
    let scratch = FileScratch(Mutex::new((tempfile::tempfile().unwrap(), 0)));
    let request = request(Path::new("made.osm.pbf"), &POOL, &to_lattice, &scratch);
    let request = ReadRequest { memory_bytes: 8 << 20, ..request };
    let is_reset = fs::write("/proc/self/clear_refs", "5").is_ok();
    let before = memory_mib("VmRSS:").filter(|_| is_reset);
    let (mut points, mut roads, mut shared) = (0, 0, 0);
    let summary = read_roads_from(
        Cursor::new(&bytes),
        &request,
        &mut |road| {
            roads += 1;
            points += road.line.points().len() as i64;
            shared += road.fixed.len() as i64;
        },
        &mut |defect| panic!("{defect:?}"),
        &|| false,
    );
    let summary = summary.unwrap();
    assert_eq!((summary.nodes_needed, summary.nodes_missing), (NODES as u64, 0));
    assert_eq!(roads, (NODES - 1 + NODES_OF_WAY - 1) / NODES_OF_WAY);
    assert_eq!((points, shared), (NODES + roads - 1, 2 * roads));
    let written_mib = scratch.0.into_inner().unwrap().1 >> 20;
    assert!(written_mib > 50, "the data was to be on disk: {written_mib} MiB");
    let Some((before, peak)) = before.zip(memory_mib("VmHWM:")) else {
        corniche_testing::skip(
            "this system does not report the peak memory of a process, or cannot reset it",
        );
        return;
    };
    let grown = peak.saturating_sub(before);
    println!("{grown} MiB more, {written_mib} MiB written");
    // Without a limit, ids, positions and references of so many nodes take 100 MiB.
    assert!(grown <= 40, "{grown} MiB");
}
