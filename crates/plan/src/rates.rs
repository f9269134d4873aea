//! Measured costs of a build per tile, thread and byte. All constants of the estimates are here;
//! `docs/lab/build-costs.md` says how they were measured.

use corniche_geom::TILE_CELLS;
use corniche_tileset::PHOTO_BORDER;

/// Memory for the program, its libraries, the tables of PROJ and GDAL, and the store's buffers:
/// everything that does not depend on input or threads.
pub(crate) const BASE_BYTES: u64 = 80 << 20;
/// Memory for the heights of a patch, its TIN while it grows, and a tile while it is encoded.
pub(crate) const THREAD_BYTES: u64 = 28 << 20;
/// Memory for the data kept about each tile while the build runs.
pub(crate) const TILE_BYTES: u64 = 200;

/// Heights of a finest tile with two nodes of halo on each side, four bytes each.
pub(crate) const HEIGHTS_BYTES: u64 = 261 * 261 * 4;
/// Heights of a coarse tile.
pub(crate) const RASTER_BYTES: u64 = 257 * 257 * 4;
/// Key, length and checksum of an artifact, in data and journal.
pub(crate) const ARTIFACT_BYTES: u64 = 64;
/// Artifacts of a tile: heights or raster, TIN, record, payload, pieces of roads.
pub(crate) const TILE_ARTIFACTS: u64 = 5;
/// A tile's record.
pub(crate) const RECORD_BYTES: u64 = 1 << 10;
/// A coarse tile's TIN: ten bytes a vertex, of which there are half as many as triangles, and
/// twelve a triangle.
pub(crate) const TIN_BYTES_PER_TRIANGLE: f64 = 17.0;

/// Triangles of the finest level for each node, times the tolerance as a fraction of the cell, for
/// rough ground. Smooth ground has down to half as many. With the default tolerance of a 16th there
/// are 0.68 triangles per node; twice the tolerance halves this number.
pub(crate) const TRIANGLES_PER_NODE: f64 = 0.0425;
/// The largest possible number of triangles for each node of a TIN.
pub(crate) const MOST_TRIANGLES_PER_NODE: f64 = 2.0;
/// Triangles of all levels, divided by those of the finest.
pub(crate) const ALL_PER_FINEST: f64 = 1.4;

/// Triangles of the finest level for each node. `tolerance_cells` is the tolerance as a fraction of
/// the cell.
#[must_use]
pub fn triangles_per_node(tolerance_cells: f64) -> f64 {
    (TRIANGLES_PER_NODE / tolerance_cells).min(MOST_TRIANGLES_PER_NODE)
}

/// Bytes of encoded ground for each triangle, with normals: the denser the triangles, the fewer
/// bytes. The curve goes through the measured points (0.16 triangles per node: 1.30), (0.28: 1.16),
/// (0.54: 1.03); from 0.7 on it is 1.0. Sparse triangles take 1.4 to 1.5 bytes.
pub(crate) fn payload_bytes_per_triangle(triangles_per_node: f64) -> f64 {
    (0.9 * triangles_per_node.powf(-0.21)).clamp(1.0, 1.5)
}

/// Bytes of a full tile's relief: 7 000 on smooth ground, 13 000 on rough.
pub(crate) const RELIEF_BYTES: u64 = 11_000;
/// Time to create a relief, on one core.
pub(crate) const SECONDS_PER_RELIEF: f64 = 0.01;

/// Pieces of roads of all levels, for each byte of the extract.
pub const PIECES_PER_EXTRACT_BYTE: f64 = 1.5;
/// Pieces of roads while they are sorted into the order of tiles, for each byte of the extract.
pub(crate) const SORTED_PER_EXTRACT_BYTE: f64 = 1.5;
/// Encoded roads of all levels, for each byte of the extract.
pub(crate) const ROADS_PER_EXTRACT_BYTE: f64 = 0.5;
/// Time to read an extract and cut its roads, on one core.
pub(crate) const SECONDS_PER_EXTRACT_BYTE: f64 = 0.5e-6;

/// Texels of the photo of a tile, border included, if its cells have 2^levels texels along each
/// side.
#[must_use]
pub fn photo_texels(levels: u8) -> f64 {
    (((TILE_CELLS as usize) << levels) + 2 * PHOTO_BORDER).pow(2) as f64
}
/// Memory for each texel while a tile's photo is created: four bytes, another four in the part for
/// the coarser levels, and, during encoding, three bytes and the encoded bytes.
pub(crate) const THREAD_BYTES_PER_PHOTO_TEXEL: u64 = 16;
/// Bytes of photo pixels that are read at once.
pub(crate) const PHOTO_PIXELS_BYTES: u64 = 16 << 20;
/// Bytes of a photo's raster in one tile.
pub(crate) const PHOTO_RASTER_BYTES: u64 = 4 * (TILE_CELLS * TILE_CELLS) as u64;
/// Bytes of a photo for each texel, at the default quality.
pub(crate) const PHOTO_BYTES_PER_TEXEL: f64 = 0.2;
/// Texels of the photos of all levels, divided by those of the finest.
pub(crate) const ALL_PER_FINEST_PHOTO: f64 = 1.4;
/// Time for each texel of a photo, on one core.
pub const SECONDS_PER_PHOTO_TEXEL: f64 = 0.3e-6;

/// Time for each node of the finest level, on one core: to read it and to compare TINs with it.
pub const SECONDS_PER_NODE: f64 = 0.18e-6;
/// Time for each triangle of any level, on one core.
pub const SECONDS_PER_TRIANGLE: f64 = 2.3e-6;
/// Additional time for each node if nodes are not the DEM's samples, on one core: to interpolate
/// the node, and to locate the samples near it on the TINs.
pub(crate) const SECONDS_PER_RESAMPLED_NODE: f64 = 0.65e-6;

/// Time for the tiles of a build that reuses the terrain of a package, for each triangle, on one
/// core.
pub const SECONDS_PER_RECORDED_TRIANGLE: f64 = 1.0e-6;
/// Time of all steps on all levels, divided by the time to triangulate the finest level.
pub(crate) const STEPS_PER_MESH: f64 = 3.3;
/// Fraction of the cores' time that the steps use.
pub(crate) const CORES_BUSY: f64 = 0.9;

/// The following constants are times of single steps, for jobs. This one is the time to start a
/// process with its libraries, without opening inputs. A part is worth its own process if its work
/// takes many times as long.
pub const PART_START_SECONDS: f64 = 0.07;
/// Seconds to check an input when a part starts.
pub const START_SECONDS_PER_INPUT: f64 = 0.5e-3;
/// A part must take at least this many times as long as the start of its process.
pub const PART_WORTH_STARTS: u64 = 20;
/// Time to hash a byte.
pub const SECONDS_PER_HASHED_BYTE: f64 = 1.5e-9;
/// Time of the step *ways* for each byte of an extract of roads alone, the largest possible time.
pub const WAY_SECONDS_PER_EXTRACT_BYTE: f64 = 0.055e-6;
/// Seconds of the pass for nodes, for each byte of the extract.
pub const NODE_SECONDS_PER_EXTRACT_BYTE: f64 = 0.022e-6;
/// Seconds of the step *roads*, for each byte of the extract.
pub const ROAD_SECONDS_PER_EXTRACT_BYTE: f64 = 0.09e-6;
/// Shares (chunks) of an extract with fewer bytes than this are not worth the start of their own
/// processes.
pub const LEAST_SHARE_BYTES: f64 = 16.0e6;
/// Part of [`SECONDS_PER_NODE`] in the step *heights*: to read and store a node. Between 0.05e-6
/// for plain files and 0.18e-6 for compressed ones.
pub const HEIGHT_SECONDS_PER_NODE: f64 = 0.1e-6;
/// Time for each node of a coarse raster.
pub const RASTER_SECONDS_PER_NODE: f64 = 0.01e-6;
/// Time of a step for a tile without data: to find that it has none, and to store this result.
pub const VOID_TILE_SECONDS: f64 = 1.0e-3;
/// Time to triangulate a coarse tile.
pub const COARSE_TIN_SECONDS: f64 = 0.05;
/// Time of the step *tiles* for each byte of road pieces.
pub const TILE_SECONDS_PER_PIECE_BYTE: f64 = 0.6e-6;
/// Time of the merge for each tile.
pub const MERGE_SECONDS_PER_TILE: f64 = 0.3e-3;
/// Seconds of the merge, for each byte of pieces.
pub const MERGE_SECONDS_PER_PIECE_BYTE: f64 = 2.0e-9;
