//! Rasters that know their place: the heights of a level's TINs, and pictures from above.
//!
//! Heights are a `GeoTIFF`, on request with the difference from the elevation files as a second band.
//!
//! ```text
//!                          TINs of the tiles around ──► heights at nodes ──┬──► band 1
//!   a row of blocks ──► each block                                         ▼
//!                          elevation files ──► heights at nodes ──► TIN minus DEM ──► band 2, figures
//! ```
//!
//! Pixels are the nodes of the package's finest level, whichever level's TINs are taken: where nodes are samples, the second band is the error at each
//! sample, and rasters of two levels can be subtracted. A pixel's middle is its node, so the file says `PixelIsPoint`.
//!
//! Memory holds some rows of blocks, of 256 nodes along each side, and the TINs beneath them.

mod block;
mod file;
mod grid;
mod place_of_picture;
mod write_picture;
mod write_raster;

pub use self::{
    place_of_picture::PlaceOfPicture,
    write_picture::{PictureFacts, export_picture},
    write_raster::{GeoTiffRequest, GeoTiffSummary, export_geotiff},
};
