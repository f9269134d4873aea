//! Packages that are created to do harm: each of them is rejected for the right reason, or is read,
//! within a stated memory. Prints a table; run with `--nocapture`.
//!
//! This is a single test, so that the measured memory is that of one reader.
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test may unwrap, and this one prints figures"
)]

use std::time::Instant;

use corniche_testing::hostile::{Case, FAMILIES, ReadOutcome};
use corniche_tileset::{MemorySource, Package, Sections};
use peak_alloc::PeakAlloc;

#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

/// Opens a package, lists its tiles and reads all of them; returns their number, or the text of the
/// error.
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
    println!("| package | outcome | peak MiB | limit MiB | ms |\n|---|---|---|---|---|");
    let mut broken = Vec::new();
    let mut number = 0;
    for (family, cases) in FAMILIES {
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
                (ReadOutcome::Refused(reason), Err(error)) => error.contains(reason),
                (ReadOutcome::Read, Ok(_)) => true,
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
