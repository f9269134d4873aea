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
        // The folder may be missing, because git keeps no empty folders.
        let Ok(entries) = fs::read_dir(&folder) else { continue };
        for entry in entries {
            let path = entry.unwrap().path();
            let data = fs::read(&path).unwrap();
            // So the name of a failing input stands before the message of the panic.
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
fn every_extract_is_read_or_refused() {
    replay("osm", corniche_fuzz::osm);
}

#[test]
fn every_settings_file_table_and_style_is_read_or_refused() {
    replay("config", corniche_fuzz::config);
}

#[test]
fn every_line_is_laid_in_order_on_its_ground() {
    replay("drape", corniche_fuzz::drape);
}
