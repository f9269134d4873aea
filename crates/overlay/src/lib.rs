//! Lines of people's own files, for drawing them over a package.
//!
//! ```text
//!  GeoJSON, GPX, GeoPackage, Shapefile ──read──► VectorLines (WGS84) ──place──► points on the package's lattice
//! ```
//!
//! What is drawn is what the file has: lines are not simplified, joined or moved here. [`LineFile`]
//! is a file of lines that a person draws: what was not changed is saved as it was.

mod error;
mod line_file;
mod place_lines;
mod read;

pub use error::OverlayError;
pub use line_file::{LineFile, SavedLine, Shape};
pub use place_lines::{EllipsoidHeights, Placed, place};
pub use read::{MOST_POINTS, VectorLine, VectorLines, read};
