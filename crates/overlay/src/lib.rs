//! Lines of people's own files, for drawing them over a package.
//!
//! ```text
//!  GeoJSON, GPX, GeoPackage, Shapefile ──read──► VectorLines (WGS84) ──place──► points on the package's lattice
//! ```
//!
//! What is drawn is what the file has: lines are not simplified, joined or moved here.

mod error;
mod place;
mod read;

pub use error::OverlayError;
pub use place::{Placed, place};
pub use read::{VectorLine, VectorLines, read};
