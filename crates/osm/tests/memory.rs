//! The memory and the time that a hostile extract can take. The test runs alone in its process,
//! whose peak memory it reads.

#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test may unwrap and says what it skips"
)]

#[path = "it/common/mod.rs"]
mod common;

use std::{fs, time::Instant};

use common::read_bytes_in;
use corniche_testing::pbf::{BlockBuilder, field, frame, number, packed_blob, plain_header, zlib};

/// Returns a line of the system's statistics of this process, MiB; `None` if the system has none.
fn memory_mib(name: &str) -> Option<u64> {
    let status = fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with(name))?;
    line.split_whitespace().nth(1)?.parse::<u64>().ok().map(|kib| kib / 1024)
}

/// Resets the peak, and returns the memory in use now.
fn reset_peak() -> Option<u64> {
    fs::write("/proc/self/clear_refs", "5").ok()?;
    memory_mib("VmRSS:")
}

/// Reads with eight threads, and checks by how many MiB the peak grew. The words are of the error;
/// `None` for an extract without roads.
#[track_caller]
fn check(what: &str, bytes: &[u8], words: Option<&str>, most_mib: u64) {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(8).build().unwrap();
    let before = reset_peak();
    let start = Instant::now();
    match (read_bytes_in(&pool, bytes), words) {
        (Ok(extract), None) => assert_eq!(extract.roads, []),
        (Err(error), Some(words)) => assert!(error.to_string().contains(words), "{error}"),
        (found, _) => panic!("{what}: {found:?}"),
    }
    println!("{what}: {} KiB, {:.2?}", bytes.len() / 1024, start.elapsed());
    let Some((before, peak)) = before.zip(memory_mib("VmHWM:")) else {
        corniche_testing::skip(
            "this system does not report the peak memory of a process, or cannot reset it",
        );
        return;
    };
    let grown = peak.saturating_sub(before);
    println!("{what}: {grown} MiB more");
    assert!(grown <= most_mib, "{what}: {grown} MiB");
}

#[test]
fn no_extract_takes_more_memory_than_the_limits_allow() {
    let data = |blob: Vec<u8>| [plain_header(), frame(b"OSMData", &blob)].concat();
    let bomb = zlib(&vec![0; 64 << 20]);
    check("64 MiB of zeros", &data(field(3, &bomb)), Some("more than 33554431"), 80);
    let lying = data([number(2, 1000), field(3, &bomb)].concat());
    check("64 MiB of zeros, said to be 1000", &lying, Some("more than 1000 bytes"), 80);

    let many = |message: &[u8], count: usize| {
        let mut block = BlockBuilder::new();
        block.groups.push(message.repeat(count));
        packed_blob(b"OSMData", &block.bytes())
    };
    let of = |blobs: Vec<u8>| [plain_header(), blobs].concat();
    let relations = many(&field(4, &[8, 0]), 1_000_000);
    check("a million relations", &of(relations.clone()), None, 512);
    // Only one of them is unpacked at a time, with any number of threads.
    check("four times that", &of(relations.repeat(4)), None, 320);
    let nodes = many(&field(1, &[8, 0, 64, 0, 72, 0]), 2_000_000);
    check("two million nodes", &of(nodes), Some("takes more memory than allowed"), 80);
    // There is little to decode, and much is found: each of many roads has its own names.
    let mut block = BlockBuilder::new();
    let name = "\u{1f6e3}".repeat(255);
    let tags = [("highway", "track"), ("name", &name), ("ref", &name), ("surface", &name)];
    let message = block.way_message(1, &tags, &[1, 2]);
    block.groups.push(field(3, &message).repeat(60_000));
    let names = packed_blob(b"OSMData", &block.bytes());
    check("60 000 roads with long names, 12 times", &of(names.repeat(12)), Some("fill"), 512);
}
