//! Records are sorted like by `Vec::sort`, however little memory there is.

use std::sync::{
    Mutex,
    atomic::{AtomicU64, Ordering},
};

use proptest::prelude::*;

use super::*;

/// Scratch space in memory. The type of `corniche_testing` belongs to another compilation of this
/// crate.
#[derive(Debug, Default)]
struct MemoryScratch(Mutex<Vec<u8>>);

impl ScratchSpace for MemoryScratch {
    fn append(&self, bytes: &[u8]) -> io::Result<ScratchRange> {
        let mut all = self.0.lock().unwrap();
        all.extend(bytes);
        let length = bytes.len() as u64;
        Ok(ScratchRange { offset: all.len() as u64 - length, length })
    }

    fn read(&self, span: ScratchRange) -> io::Result<Vec<u8>> {
        let from = span.offset as usize;
        let all = self.0.lock().unwrap();
        let read = all.get(from..from + span.length as usize);
        read.map(<[u8]>::to_vec).ok_or_else(|| io::ErrorKind::UnexpectedEof.into())
    }
}

/// A record of varying length.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
struct Line {
    tile: u64,
    points: Vec<u16>,
}

impl SortRecord for Line {
    fn encode(&self, bytes: &mut Vec<u8>) {
        bytes.extend(self.tile.to_le_bytes());
        bytes.extend(self.points.iter().flat_map(|point| point.to_le_bytes()));
    }

    fn decode(bytes: &mut &[u8]) -> Option<Self> {
        let (tile, rest) = bytes.split_first_chunk()?;
        let points = rest.chunks_exact(2).map(|point| u16::from_le_bytes([point[0], point[1]]));
        *bytes = &[];
        Some(Self { tile: u64::from_le_bytes(*tile), points: points.collect() })
    }

    fn extra_bytes(&self) -> usize {
        self.points.capacity() * 2
    }
}

/// Scratch space that counts the bytes that are read.
#[derive(Debug, Default)]
struct Counting {
    scratch: MemoryScratch,
    appends: AtomicU64,
    longest: AtomicU64,
    read_bytes: AtomicU64,
}

impl ScratchSpace for Counting {
    fn append(&self, bytes: &[u8]) -> io::Result<ScratchRange> {
        self.appends.fetch_add(1, Ordering::Relaxed);
        self.longest.fetch_max(bytes.len() as u64, Ordering::Relaxed);
        self.scratch.append(bytes)
    }

    fn read(&self, span: ScratchRange) -> io::Result<Vec<u8>> {
        self.read_bytes.fetch_add(span.length, Ordering::Relaxed);
        self.scratch.read(span)
    }
}

fn sorted<T: SortRecord>(
    records: impl IntoIterator<Item = T>,
    scratch: &dyn ScratchSpace,
    memory_bytes: u64,
) -> io::Result<Vec<T>> {
    let mut sorter = Sorter::new(scratch, memory_bytes);
    for record in records {
        sorter.push(record)?;
    }
    sorter.finish()?.collect()
}

fn lines() -> impl Strategy<Value = Vec<Line>> {
    let line = (0_u64..50, proptest::collection::vec(0_u16..5, 0..40))
        .prop_map(|(tile, points)| Line { tile, points });
    proptest::collection::vec(line, 0..600)
}

proptest! {
    /// The records are returned in the order of `Vec::sort`, however little memory there is.
    #[test]
    fn sorts_like_vec_sort(lines in lines(), memory_bytes in 0_u64..20_000) {
        let mut expected = lines.clone();
        expected.sort();
        prop_assert_eq!(sorted(lines, &MemoryScratch::default(), memory_bytes).unwrap(), expected);
    }

    /// A length round-trips, and is not read from bytes that end within it.
    #[test]
    fn a_length_comes_back(length in any::<usize>()) {
        let mut bytes = Vec::new();
        push_varint(&mut bytes, length as u64);
        prop_assert!(bytes.len() <= LONGEST_LENGTH);
        for cut in 0..bytes.len() {
            prop_assert_eq!(take_number::<usize>(&mut &bytes[..cut]), None);
        }
        let mut rest = &bytes[..];
        prop_assert_eq!(take_number(&mut rest), Some(length));
        prop_assert!(rest.is_empty());
    }
}

fn some_lines(count: u64) -> Vec<Line> {
    let line = |n: u64| Line { tile: n * 7919 % count, points: vec![n as u16; (n % 9) as usize] };
    (0..count).map(line).collect()
}

#[test]
fn what_fits_in_memory_never_touches_the_scratch_space() {
    let scratch = Counting::default();
    let lines = sorted(some_lines(1000), &scratch, 1 << 20).unwrap();
    assert_eq!(lines.len(), 1000);
    assert_eq!(scratch.appends.into_inner(), 0);
}

/// 2000 records of 32 to 48 bytes in 8 KiB: more runs than are merged at once.
#[test]
fn many_runs_are_merged_in_passes() {
    let scratch = Counting::default();
    let mut expected = some_lines(20_000);
    let lines = sorted(expected.clone(), &scratch, 8192).unwrap();
    expected.sort();
    assert_eq!(lines, expected);
    assert!(scratch.longest.into_inner() <= 8192);
    // Two of about 120 runs at once: about 7 passes over 12 to 28 bytes per record, and not one
    // pass per run.
    let read_bytes = scratch.read_bytes.into_inner();
    assert!((20_000 * 12 * 4..20_000 * 28 * 12).contains(&read_bytes), "{read_bytes}");
}

/// 75 runs, of which 64 are merged at once: only 12 of them are merged before, so a sixth of the
/// records is written twice.
#[test]
fn no_more_runs_are_merged_twice_than_must_be() {
    let scratch = Counting::default();
    let memory_bytes = (RUNS_AT_ONCE + 2) * SHORTEST_PAGE;
    let limit = memory_bytes - page_bytes(memory_bytes, 8);
    let count = (limit / size_of::<u64>() * 75) as u64;
    let numbers = (0..count).map(|n| n.wrapping_mul(0x9E37_79B9_7F4A_7C15));
    let lines = sorted(numbers, &scratch, memory_bytes as u64).unwrap();
    assert!(lines.is_sorted());
    assert_eq!(lines.len() as u64, count);
    let read_bytes = scratch.read_bytes.into_inner() as f64 / (9 * count) as f64;
    assert!((read_bytes - (1.0 + 12.0 / 75.0)).abs() < 0.01, "read {read_bytes} times");
}

impl SortRecord for u64 {
    fn encode(&self, bytes: &mut Vec<u8>) {
        bytes.extend(self.to_le_bytes());
    }

    fn decode(bytes: &mut &[u8]) -> Option<Self> {
        let (number, rest) = bytes.split_first_chunk()?;
        *bytes = rest;
        Some(Self::from_le_bytes(*number))
    }
}

#[test]
fn a_record_larger_than_the_memory_is_sorted_too() {
    let mut lines = some_lines(20);
    lines[3].points = vec![7; 50_000];
    let mut expected = lines.clone();
    expected.sort();
    assert_eq!(sorted(lines, &MemoryScratch::default(), 1000).unwrap(), expected);
}

/// The records in memory never take more than their limit, including the growth of the list.
#[test]
fn the_list_stays_within_its_share() {
    let scratch = MemoryScratch::default();
    let memory_bytes = 1_000_000;
    let mut sorter = Sorter::new(&scratch, memory_bytes);
    for line in some_lines(50_000) {
        sorter.push(line).unwrap();
        let used_bytes = sorter.records.len() * size_of::<Line>() + sorter.extra_bytes;
        assert!(used_bytes as u64 <= memory_bytes);
        let list_bytes = sorter.records.capacity() * size_of::<Line>();
        assert!(list_bytes as u64 <= memory_bytes);
    }
    assert!(sorter.runs.len() > 1);
}

/// Scratch space of which one call fails.
struct Failing {
    scratch: MemoryScratch,
    calls: AtomicU64,
    bad_call: u64,
}

impl Failing {
    fn call(&self) -> io::Result<()> {
        if self.calls.fetch_add(1, Ordering::Relaxed) == self.bad_call {
            return Err(io::ErrorKind::StorageFull.into());
        }
        Ok(())
    }
}

impl ScratchSpace for Failing {
    fn append(&self, bytes: &[u8]) -> io::Result<ScratchRange> {
        self.call()?;
        self.scratch.append(bytes)
    }

    fn read(&self, span: ScratchRange) -> io::Result<Vec<u8>> {
        self.call()?;
        self.scratch.read(span)
    }
}

/// Whichever call fails, the error is returned and no record is lost silently.
#[test]
fn any_failing_call_is_an_error() {
    for bad_call in 0.. {
        let (scratch, calls) = (MemoryScratch::default(), AtomicU64::new(0));
        let scratch = Failing { scratch, calls, bad_call };
        match sorted(some_lines(300), &scratch, 2000) {
            Err(error) => assert_eq!(error.kind(), io::ErrorKind::StorageFull),
            Ok(lines) => {
                assert_eq!(lines.len(), 300);
                assert!(bad_call > 20, "only {bad_call} calls");
                break;
            }
        }
    }
}

/// Scratch space that returns other bytes than were written is detected.
#[test]
fn damaged_scratch_space_is_an_error() {
    struct Cutting(MemoryScratch);
    impl ScratchSpace for Cutting {
        fn append(&self, bytes: &[u8]) -> io::Result<ScratchRange> {
            self.0.append(&bytes[..bytes.len() - 1])
        }

        fn read(&self, span: ScratchRange) -> io::Result<Vec<u8>> {
            self.0.read(span)
        }
    }
    let error = sorted(some_lines(300), &Cutting(MemoryScratch::default()), 2000).unwrap_err();
    assert_eq!(error.kind(), io::ErrorKind::InvalidData);
}
