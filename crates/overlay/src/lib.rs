//! Lines from users' own files, for drawing them over a package.
//!
//! ```text
//!  GeoJSON, GPX, GeoPackage, Shapefile ──read──► VectorLines (WGS84) ──place──► points on the package's lattice
//! ```
//!
//! Lines are drawn exactly as in the file: this crate does not simplify, join or move them.
//! [`LineFile`] is a file of lines that a user draws: unchanged lines are saved unchanged.

mod error;
mod line_file;
mod place_lines;
mod read;

pub use error::OverlayError;
pub use line_file::{LineFile, LineShape, SavedLine};
pub use place_lines::{EllipsoidHeights, LatticeLine, place};
pub use read::{MOST_POINTS, VectorLine, VectorLines, read};
