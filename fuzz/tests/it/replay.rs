//! Runs every input in `corpus/` and `regressions/`, and versions with some changed bytes, with the
//! function that its folder is named after.

#![allow(
    clippy::unwrap_used,
    clippy::print_stderr,
    reason = "a test may unwrap, and says what it replays"
)]

use std::{
    fs,
    path::Path,
    time::{Duration, Instant},
};

use corniche_testing::{Random, cases};

fn replay(target: &str, run: fn(&[u8])) {
    let mut inputs = 0;
    for kind in ["corpus", "regressions"] {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(kind).join(target);
        // The folder may be missing, because git keeps no empty folders.
        let Ok(entries) = fs::read_dir(&folder) else { continue };
        for entry in entries {
            let path = entry.unwrap().path();
            let data = fs::read(&path).unwrap();
            // This prints the name of a failing input before the message of the panic.
            eprintln!("{}", path.display());
            run(&data);
            inputs += 1;
        }
    }
    assert!(inputs > 0, "corpus/{target} is empty");
}

#[test]
fn every_package_is_opened_or_refused() {
    replay("package", corniche_fuzz::package);
}

#[test]
fn every_payload_is_decoded_or_refused() {
    replay("payload", corniche_fuzz::payload);
}

#[test]
fn every_section_of_a_layer_is_decoded_or_refused() {
    replay("layers", corniche_fuzz::layers);
}

#[test]
fn every_extract_is_read_or_refused() {
    replay("osm", corniche_fuzz::osm);
}

#[test]
fn every_settings_file_and_table_is_read_or_refused() {
    replay("settings", corniche_fuzz::settings);
}

#[test]
fn every_style_is_read_or_refused() {
    replay("styles", corniche_fuzz::styles);
}

#[test]
fn every_vector_file_is_read_as_lines_or_refused() {
    replay("overlay", corniche_fuzz::overlay);
}

#[test]
fn every_vector_file_is_read_as_polygons_or_refused() {
    replay("polygon", corniche_fuzz::polygon);
}

#[test]
fn every_line_is_laid_in_order_on_its_ground() {
    replay("drape", corniche_fuzz::drape);
}

/// Runs inputs of a target with some bytes changed, removed or repeated. `CORNICHE_FUZZ_SECONDS`
/// sets how long it runs.
fn change(target: &str, run: fn(&[u8])) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("corpus").join(target);
    let mut paths: Vec<_> =
        fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    let inputs: Vec<Vec<u8>> = paths.iter().map(|path| fs::read(path).unwrap()).collect();
    let given = std::env::var("CORNICHE_FUZZ_SECONDS").ok().and_then(|text| text.parse().ok());
    let seconds = Duration::from_secs(given.unwrap_or(0));
    let (begun, mut random) = (Instant::now(), Random::new(38));
    let least = cases(40, 200, 5000);
    for number in 0.. {
        if number >= least && begun.elapsed() > seconds {
            break;
        }
        let mut data = inputs[random.below(inputs.len() as i64) as usize].clone();
        for _ in 0..=random.below(6) {
            let at = random.below(data.len().max(1) as i64) as usize;
            let end = data.len().min(at + random.below(12) as usize);
            match random.below(4) {
                0 => drop(data.drain(at.min(end)..end)),
                1 => data.splice(at..at, data[at.min(end)..end].to_vec()).for_each(drop),
                2 => data.splice(at..at, *b"1e308").for_each(drop),
                _ => data.iter_mut().skip(at).take(1).for_each(|byte| *byte = random.bits() as u8),
            }
        }
        // This writes the input of a failing run.
        if let Err(panic) = std::panic::catch_unwind(|| run(&data)) {
            eprintln!("{target}: {}", data.escape_ascii());
            std::panic::resume_unwind(panic);
        }
    }
}

#[test]
fn changed_sections_of_layers_are_decoded_or_refused() {
    change("layers", corniche_fuzz::layers);
}

#[test]
fn changed_overlays_are_read_or_refused() {
    change("overlay", corniche_fuzz::overlay);
}

#[test]
fn changed_polygons_are_read_or_refused() {
    change("polygon", corniche_fuzz::polygon);
}

#[test]
fn changed_settings_and_tables_are_read_or_refused() {
    change("settings", corniche_fuzz::settings);
}

#[test]
fn changed_styles_are_read_or_refused() {
    change("styles", corniche_fuzz::styles);
}
