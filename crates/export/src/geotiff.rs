//! Georeferenced rasters: the heights of a level's TINs, and rendered images from above.
//!
//! Heights are written as a `GeoTIFF`, on request with the difference from the elevation files as a
//! second band.
//!
//! ```text
//!                          TINs of the tiles around ──► heights at nodes ──┬──► band 1
//!   a row of blocks ──► each block                                         ▼
//!                          elevation files ──► heights at nodes ──► TIN minus DEM ──► band 2, figures
//! ```
//!
//! Pixels are the grid nodes of the package's finest level, whichever level's TINs are used. If
//! they are samples, the second band is therefore the error at each sample, and rasters of two
//! levels can be subtracted. The middle of a pixel is its node, so the file declares
//! `PixelIsPoint`.
//!
//! Memory contains some rows of blocks, with 256 nodes along each side, and the TINs beneath them.

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
