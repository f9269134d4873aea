//! How much memory and time a hostile extract can cost. Alone in its process, whose peak it reads.

#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test may unwrap and says what it skips"
)]

mod common;

use std::{fs, time::Instant};

use common::{
    read_bytes,
    writer::{Block, field, frame, number, packed_blob, plain_header, zlib},
};

/// A line of the system's account of this process, MiB; `None` where it keeps none.
fn memory_mib(name: &str) -> Option<u64> {
    let status = fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with(name))?;
    line.split_whitespace().nth(1)?.parse::<u64>().ok().map(|kib| kib / 1024)
}

/// Forgets the peak so far; says what is in use now.
fn reset_peak() -> Option<u64> {
    fs::write("/proc/self/clear_refs", "5").ok()?;
    memory_mib("VmRSS:")
}

/// Reads and says by how many MiB the peak grew. The words are of the error; none for an extract without roads.
#[track_caller]
fn check(what: &str, bytes: &[u8], words: Option<&str>, most_mib: u64) {
    let Some(before) = reset_peak() else {
        println!("skipped: this system does not tell the peak of a process, or not anew");
        return;
    };
    let start = Instant::now();
    match (read_bytes(bytes), words) {
        (Ok(extract), None) => assert_eq!(extract.roads, []),
        (Err(error), Some(words)) => assert!(error.to_string().contains(words), "{error}"),
        (found, _) => panic!("{what}: {found:?}"),
    }
    let grown = memory_mib("VmHWM:").unwrap().saturating_sub(before);
    println!("{what}: {} KiB, {grown} MiB more, {:.2?}", bytes.len() / 1024, start.elapsed());
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
        let mut block = Block::new();
        block.groups.push(message.repeat(count));
        packed_blob(b"OSMData", &block.bytes())
    };
    let of = |blobs: Vec<u8>| [plain_header(), blobs].concat();
    let relations = many(&field(4, &[8, 0]), 1_000_000);
    check("a million relations", &of(relations.clone()), None, 512);
    // One block per thread at a time, two threads; the others wait packed.
    check("eight times that", &of(relations.repeat(8)), None, 1024);
    let nodes = many(&field(1, &[8, 0, 64, 0, 72, 0]), 2_000_000);
    check("two million nodes", &of(nodes), Some("more than fits 512 MiB"), 80);
}
