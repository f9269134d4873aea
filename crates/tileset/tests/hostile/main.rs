//! Packages made to do harm: each is refused for the right reason, or read, within a stated memory. Prints a table; run with
//! `--nocapture`.
//!
//! One test alone, so that the memory it measures is that of one reader.
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test may unwrap, and this one prints figures"
)]
#![allow(clippy::too_many_lines, reason = "tables of cases are as long as they are")]

mod file_cases;
mod metadata_cases;
mod parts;
mod road_cases;
mod tile_cases;

use std::time::Instant;

use corniche_tileset::{MemorySource, Package, Sections};
use peak_alloc::PeakAlloc;

#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

/// The expected result for a package.
pub(crate) enum Outcome {
    /// An error whose text has this in it.
    Refused(&'static str),
    /// It is read to its end.
    Read,
}

/// A package, the expected result, and the memory that reading it may take beyond its own bytes.
pub(crate) struct Case {
    pub(crate) name: &'static str,
    pub(crate) bytes: Vec<u8>,
    pub(crate) outcome: Outcome,
    pub(crate) limit_mib: usize,
}

/// Most cases: an error long before anything large.
pub(crate) fn refused(name: &'static str, bytes: Vec<u8>, reason: &'static str) -> Case {
    Case { name, bytes, outcome: Outcome::Refused(reason), limit_mib: 4 }
}

/// Opens a package, lists its tiles and reads all of them; gives their number, or the text of the error.
fn read(bytes: Vec<u8>) -> Result<usize, String> {
    pollster::block_on(async {
        let package = Package::open(MemorySource::new(bytes)).await.map_err(|e| e.to_string())?;
        let ids = package.tile_ids().await.map_err(|e| e.to_string())?;
        for &id in &ids {
            let tile = package.payload(id, Sections::ALL).await.map_err(|e| e.to_string())?;
            tile.ok_or(format!("{id} is listed but absent"))?;
        }
        Ok(ids.len())
    })
}

#[test]
fn hostile_packages_are_refused_within_the_limits() {
    type Family = (&'static str, fn() -> Vec<Case>);
    let families: [Family; 4] = [
        ("file", file_cases::all),
        ("metadata", metadata_cases::all),
        ("tile", tile_cases::all),
        ("roads", road_cases::all),
    ];
    println!("| package | outcome | peak MiB | limit MiB | ms |\n|---|---|---|---|---|");
    let mut broken = Vec::new();
    let mut number = 0;
    for (family, cases) in families {
        for Case { name, bytes, outcome, limit_mib } in cases() {
            let before = MEMORY.current_usage();
            MEMORY.reset_peak_usage();
            let start = Instant::now();
            let result = read(bytes);
            let elapsed_ms = start.elapsed().as_secs_f64() * 1e3;
            let peak_mib = MEMORY.peak_usage().saturating_sub(before) as f64 / f64::from(1 << 20);
            let told =
                result.as_ref().map_or_else(Clone::clone, |tiles| format!("{tiles} tiles read"));
            println!(
                "| {family}: {name} | {told} | {peak_mib:.1} | {limit_mib} | {elapsed_ms:.1} |"
            );
            let as_expected = match (&outcome, &result) {
                (Outcome::Refused(reason), Err(error)) => error.contains(reason),
                (Outcome::Read, Ok(_)) => true,
                _ => false,
            };
            if !as_expected || peak_mib > limit_mib as f64 {
                broken.push(format!("{family}: {name}: {told}, {peak_mib:.1} MiB"));
            }
            number += 1;
        }
    }
    println!("{number} packages");
    assert!(broken.is_empty(), "not as expected:\n{}", broken.join("\n"));
}
