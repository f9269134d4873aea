//! Packages made to do harm, what a reader must make of each, and in how much memory.
#![allow(clippy::too_many_lines, reason = "tables of cases are as long as they are")]

mod case;
mod file_cases;
mod lie_cases;
mod metadata_cases;
mod parts;
mod road_cases;
mod span_cases;
mod text_cases;
mod tile_cases;

pub use case::{Case, Outcome};
pub use lie_cases::{COMMANDING, commanding_texts};
pub use span_cases::{ATTACKS as SPAN_ATTACKS, attack as span_attack};
pub use text_cases::{TextCase, text_cases};

/// A name, and how its cases are made.
type Family = (&'static str, fn() -> Vec<Case>);

/// The cases by what is wrong, each family made when it is asked for: some are large.
pub const FAMILIES: [Family; 6] = [
    ("file", file_cases::all),
    ("metadata", metadata_cases::all),
    ("tile", tile_cases::all),
    ("roads", road_cases::all),
    ("lies", lie_cases::all),
    ("spans", span_cases::all),
];
