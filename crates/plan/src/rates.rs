//! What a build costs per tile, thread and byte, as measured. All constants of the estimates are here;
//! `docs/lab/build-costs.md` says how they were measured.

use corniche_geom::TILE_CELLS;
use corniche_tileset::PHOTO_BORDER;

/// Program, libraries, the tables of PROJ and GDAL, buffers of the store: whatever does not depend on input or threads.
pub(crate) const BASE_BYTES: u64 = 80 << 20;
/// Heights of a patch, its TIN while it grows, a tile while it is encoded.
pub(crate) const THREAD_BYTES: u64 = 28 << 20;
/// What is remembered of each tile while the build runs.
pub(crate) const TILE_BYTES: u64 = 200;

/// Heights of a finest tile with one node of halo, four bytes each.
pub(crate) const HEIGHTS_BYTES: u64 = 259 * 259 * 4;
/// Heights of a coarse tile.
pub(crate) const RASTER_BYTES: u64 = 257 * 257 * 4;
/// Key, length and checksum of an artifact, in data and journal.
pub(crate) const ARTIFACT_BYTES: u64 = 64;
/// Artifacts of a tile: heights or raster, TIN, record, payload, pieces of roads.
pub(crate) const TILE_ARTIFACTS: u64 = 5;
/// A tile's record.
pub(crate) const RECORD_BYTES: u64 = 1 << 10;
/// A coarse tile's TIN: ten bytes a vertex, of which there are half as many as triangles, and twelve a triangle.
pub(crate) const TIN_BYTES_PER_TRIANGLE: f64 = 17.0;

/// Triangles of the finest level for each node, times the tolerance as a share of the cell: rough ground. Smooth ground has down to half as
/// many. With the usual tolerance of a 16th they are 0.68; twice the tolerance halves them.
pub(crate) const TRIANGLES_PER_NODE: f64 = 0.0425;
/// A TIN cannot have more.
pub(crate) const MOST_TRIANGLES_PER_NODE: f64 = 2.0;
/// Triangles of all levels, divided by those of the finest.
pub(crate) const ALL_PER_FINEST: f64 = 1.4;

/// Triangles of the finest level for each node. `tolerance_cells` is the tolerance as a share of the cell.
#[must_use]
pub fn triangles_per_node(tolerance_cells: f64) -> f64 {
    (TRIANGLES_PER_NODE / tolerance_cells).min(MOST_TRIANGLES_PER_NODE)
}

/// Bytes of encoded ground for each triangle, with normals: the denser the triangles, the fewer. The curve goes through the
/// measured points (0.16 triangles per node: 1.30), (0.28: 1.16), (0.54: 1.03); from 0.7 on it is 1.0. Sparse ones take 1.4 to 1.5.
pub(crate) fn payload_bytes_per_triangle(triangles_per_node: f64) -> f64 {
    (0.9 * triangles_per_node.powf(-0.21)).clamp(1.0, 1.5)
}

/// Bytes of a full tile's relief: 7 000 on smooth ground, 13 000 on rough.
pub(crate) const RELIEF_BYTES: u64 = 11_000;
/// Time to make a relief, on one core.
pub(crate) const SECONDS_PER_RELIEF: f64 = 0.01;

/// Pieces of roads of all levels, for each byte of the extract.
pub const PIECES_PER_EXTRACT_BYTE: f64 = 1.5;
/// The same while they are sorted into the order of tiles.
pub(crate) const SORTED_PER_EXTRACT_BYTE: f64 = 1.5;
/// Encoded roads of all levels, for each byte of the extract.
pub(crate) const ROADS_PER_EXTRACT_BYTE: f64 = 0.5;
/// Time to read an extract and cut its roads, on one core.
pub(crate) const SECONDS_PER_EXTRACT_BYTE: f64 = 0.5e-6;

/// Texels of the photo of a tile, border included, whose cells have 2^levels texels along each side.
#[must_use]
pub fn photo_texels(levels: u8) -> f64 {
    (((TILE_CELLS as usize) << levels) + 2 * PHOTO_BORDER).pow(2) as f64
}
/// Memory for each texel while a tile's photo is made: four bytes, the same of the part for the levels above, and three and the
/// coded ones while it is encoded.
pub(crate) const THREAD_BYTES_PER_PHOTO_TEXEL: u64 = 16;
/// Pixels that are read for it at once.
pub(crate) const PHOTO_PIXELS_BYTES: u64 = 16 << 20;
/// A tile's raster of its photo.
pub(crate) const PHOTO_RASTER_BYTES: u64 = 4 * (TILE_CELLS * TILE_CELLS) as u64;
/// Bytes of a photo for each texel, at the usual quality.
pub(crate) const PHOTO_BYTES_PER_TEXEL: f64 = 0.2;
/// Texels of the photos of all levels, divided by those of the finest.
pub(crate) const ALL_PER_FINEST_PHOTO: f64 = 1.4;
/// Time for each texel of a photo, on one core.
pub const SECONDS_PER_PHOTO_TEXEL: f64 = 0.3e-6;

/// Time for each node of the finest level, on one core: to read it and to compare TINs with it.
pub const SECONDS_PER_NODE: f64 = 0.18e-6;
/// Time for each triangle of any level, on one core.
pub const SECONDS_PER_TRIANGLE: f64 = 2.3e-6;
/// Time for each node on top of that where nodes are not the DEM's samples, on one core: to interpolate it, and to find the
/// places of the samples near it on the TINs.
pub(crate) const SECONDS_PER_RESAMPLED_NODE: f64 = 0.65e-6;

/// Time for the tiles of a build that takes the terrain of a package, for each triangle, on one core.
pub const SECONDS_PER_RECORDED_TRIANGLE: f64 = 1.0e-6;
/// Time of all steps on all levels, divided by the time to triangulate the finest level.
pub(crate) const STEPS_PER_MESH: f64 = 3.3;
/// Share of the cores' time that the steps use.
pub(crate) const CORES_BUSY: f64 = 0.9;

/// What follows are times of single steps, for jobs: to start a process with its libraries, and to open an input beside the disk. A part is
/// worth its start if its work takes many times as long.
pub const PART_START_SECONDS: f64 = 0.07;
/// Seconds to look at an input when a part begins.
pub const START_SECONDS_PER_INPUT: f64 = 0.5e-3;
/// A part is worth so many starts at least.
pub const PART_WORTH_STARTS: u64 = 20;
/// Time to hash a byte.
pub const SECONDS_PER_HASHED_BYTE: f64 = 1.5e-9;
/// Times of the steps *ways*, *nodes* and *roads* for each byte of an extract of roads alone, the most that there can be.
pub const WAY_SECONDS_PER_EXTRACT_BYTE: f64 = 0.055e-6;
/// Seconds of the pass for nodes, for each byte of the extract.
pub const NODE_SECONDS_PER_EXTRACT_BYTE: f64 = 0.022e-6;
/// Seconds of the step *roads*, for each byte of the extract.
pub const ROAD_SECONDS_PER_EXTRACT_BYTE: f64 = 0.09e-6;
/// Shares of an extract with less than this are not worth the start of their processes.
pub const LEAST_SHARE_BYTES: f64 = 16.0e6;
/// Part of [`SECONDS_PER_NODE`] in the step *heights*: to read a node and to keep it. Between 0.05e-6 for plain files and 0.18e-6 for packed ones.
pub const HEIGHT_SECONDS_PER_NODE: f64 = 0.1e-6;
/// Time for each node of a coarse raster.
pub const RASTER_SECONDS_PER_NODE: f64 = 0.01e-6;
/// Time of a step for a tile without data: to find that there is none, and to keep that.
pub const VOID_TILE_SECONDS: f64 = 1.0e-3;
/// Time to triangulate a coarse tile.
pub const COARSE_TIN_SECONDS: f64 = 0.05;
/// Time of the step *tiles* for each byte of road pieces.
pub const TILE_SECONDS_PER_PIECE_BYTE: f64 = 0.6e-6;
/// Time of the merge for each tile and for each byte of road pieces.
pub const MERGE_SECONDS_PER_TILE: f64 = 0.3e-3;
/// Seconds of the merge, for each byte of pieces.
pub const MERGE_SECONDS_PER_PIECE_BYTE: f64 = 2.0e-9;
