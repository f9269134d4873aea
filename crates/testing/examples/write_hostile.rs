//! Writes every hostile package into a folder, for tests of other programs: `write_hostile FOLDER`.
#![allow(clippy::unwrap_used, reason = "a tool of developers")]

use std::{fs, path::PathBuf};

use corniche_testing::hostile::{Case, FAMILIES};

fn main() {
    let folder = PathBuf::from(std::env::args_os().nth(1).unwrap());
    fs::create_dir_all(&folder).unwrap();
    for (family, cases) in FAMILIES {
        for (number, Case { bytes, .. }) in cases().into_iter().enumerate() {
            fs::write(folder.join(format!("{family}-{number:03}.pmtiles")), bytes).unwrap();
        }
    }
}
