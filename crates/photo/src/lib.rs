//! Resamples aerial images (photos) to texels on a package's grid.
//!
//! ```text
//!   files ──► Photos::open ──► Photos::on ──► PhotoReader::window ──► Texels ──► halved … coarser levels
//!            (bands, CRS)     (grid, levels)  (PROJ, filter, mosaic)            (exact, in whole numbers)
//! ```
//!
//! A texel has the same colour, bit for bit, whichever window it is read through: its place follows
//! from its global index, its colour from the pixels around that place.
//!
//! This crate never encodes, never triangulates, and never guesses the georeference of an image or
//! the meaning of its values.

mod error;
mod photos;
mod reader;

mod bands;
mod filter;
mod photo_file;
mod positions;
mod texel_grid;
mod texels;

pub use error::PhotoError;
pub use photo_file::PhotoGrid;
pub use photos::{LevelChoice, Photos};
pub use reader::PhotoReader;
pub use texel_grid::{MAX_LEVELS, TexelGrid, TexelWindow};
pub use texels::Texels;
