//! Packages made to do harm, what a reader must make of each, and in how much memory.
#![allow(clippy::too_many_lines, reason = "tables of cases are as long as they are")]

mod file_cases;
mod lie_cases;
mod metadata_cases;
mod parts;
mod road_cases;
mod tile_cases;

pub use lie_cases::{COMMANDING, commanding_texts};

/// What must come of reading a package.
#[derive(Debug, Clone, Copy)]
pub enum Outcome {
    /// An error whose text has this in it.
    Refused(&'static str),
    /// It is read to its end.
    Read,
}

/// A package, what must come of reading it, and the memory that this may take beyond its own bytes.
#[derive(Debug)]
#[expect(missing_docs, reason = "the names say what they are")]
pub struct Case {
    pub name: &'static str,
    pub bytes: Vec<u8>,
    pub outcome: Outcome,
    pub limit_mib: usize,
}

/// Most cases: an error long before anything large.
fn refused(name: &'static str, bytes: Vec<u8>, reason: &'static str) -> Case {
    Case { name, bytes, outcome: Outcome::Refused(reason), limit_mib: 4 }
}

/// A name, and how its cases are made.
type Family = (&'static str, fn() -> Vec<Case>);

/// The cases by what is wrong, each family made when it is asked for: some are large.
pub const FAMILIES: [Family; 5] = [
    ("file", file_cases::all),
    ("metadata", metadata_cases::all),
    ("tile", tile_cases::all),
    ("roads", road_cases::all),
    ("lies", lie_cases::all),
];
