//! Every input in `corpus/` and `regressions/`, through the function that its folder is named after.

#![allow(
    clippy::unwrap_used,
    clippy::print_stderr,
    reason = "a test may unwrap, and says what it replays"
)]

use std::{fs, path::Path};

fn replay(target: &str, run: fn(&[u8])) {
    let mut inputs = 0;
    for kind in ["corpus", "regressions"] {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(kind).join(target);
        // No folder: nothing was found yet. Git keeps no empty ones.
        let Ok(entries) = fs::read_dir(&folder) else { continue };
        for entry in entries {
            let path = entry.unwrap().path();
            let data = fs::read(&path).unwrap();
            // The name of the input that breaks a promise stands before the panic's own words.
            eprintln!("{}", path.display());
            run(&data);
            inputs += 1;
        }
    }
    assert!(inputs > 0, "corpus/{target} is empty");
}

#[test]
fn packages() {
    replay("package", corniche_fuzz::package);
}

#[test]
fn payloads() {
    replay("payload", corniche_fuzz::payload);
}

#[test]
fn extracts() {
    replay("osm", corniche_fuzz::osm);
}

#[test]
fn settings_and_tables() {
    replay("config", corniche_fuzz::config);
}

#[test]
fn drapes() {
    replay("drape", corniche_fuzz::drape);
}
