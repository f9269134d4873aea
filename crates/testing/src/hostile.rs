//! Hostile packages, with the expected outcome of reading each of them, and its memory limit.
#![allow(clippy::too_many_lines, reason = "tables of cases are long")]

mod case;
mod file_cases;
mod layer_cases;
mod lie_cases;
mod metadata_cases;
mod parts;
mod road_cases;
mod span_cases;
mod text_cases;
mod tile_cases;

pub use case::{Case, ReadOutcome};
pub use lie_cases::{COMMANDING, commanding_texts};
pub use span_cases::{ATTACKS as SPAN_ATTACKS, attack as span_attack};
pub use text_cases::{TextCase, text_cases};

/// A name, and the function that creates its cases.
type Family = (&'static str, fn() -> Vec<Case>);

/// The cases by kind of damage; each family is created on request, because some are large.
pub const FAMILIES: [Family; 7] = [
    ("file", file_cases::all),
    ("metadata", metadata_cases::all),
    ("tile", tile_cases::all),
    ("roads", road_cases::all),
    ("lies", lie_cases::all),
    ("spans", span_cases::all),
    ("layers", layer_cases::all),
];
