//! What a build costs per tile, thread and byte, as measured. All constants of the estimates are here;
//! `docs/measured.md` says how they were measured.

/// Program, libraries, the tables of PROJ and GDAL, buffers of the store: whatever does not depend on input or threads.
pub(super) const BASE_BYTES: u64 = 80 << 20;
/// Heights of an area, its TIN while it grows, a tile while it is encoded.
pub(super) const THREAD_BYTES: u64 = 28 << 20;
/// What is remembered of each tile while the build runs.
pub(super) const TILE_BYTES: u64 = 200;

/// Heights of a finest tile with one node of halo, four bytes each.
pub(super) const HEIGHTS_BYTES: u64 = 259 * 259 * 4;
/// Heights of a coarse tile without the east and south border.
pub(super) const RASTER_BYTES: u64 = 256 * 256 * 4;
/// Key, length and checksum of an artifact, in data and journal.
pub(super) const ARTIFACT_BYTES: u64 = 64;
/// Artifacts of a tile: heights or raster, TIN, record, payload, pieces of roads.
pub(super) const TILE_ARTIFACTS: u64 = 5;
/// A tile's record.
pub(super) const RECORD_BYTES: u64 = 1 << 10;
/// A coarse tile's TIN: ten bytes a vertex, of which there are half as many as triangles, and twelve a triangle.
pub(super) const TIN_BYTES_PER_TRIANGLE: f64 = 17.0;

/// Triangles of a tile with ground everywhere, at the usual tolerance of a quarter of the cell.
pub(super) const TRIANGLES_PER_TILE: f64 = 15_000.0;
/// Encoded ground, with normals.
pub(super) const PAYLOAD_BYTES_PER_TRIANGLE: f64 = 1.9;

/// Pieces of roads of all levels, for each byte of the extract.
pub(super) const PIECES_PER_EXTRACT_BYTE: f64 = 1.5;
/// The same while they are sorted into the order of tiles.
pub(super) const SORTED_PER_EXTRACT_BYTE: f64 = 1.5;
/// Encoded roads of all levels, for each byte of the extract.
pub(super) const ROADS_PER_EXTRACT_BYTE: f64 = 0.5;
/// Time to read an extract and cut its roads, on one core.
pub(super) const SECONDS_PER_EXTRACT_BYTE: f64 = 1.0e-6;

/// Time that all steps together take for a tile of any level, on one core, on the machine of `docs/measured.md`.
pub(super) const SECONDS_PER_TILE: f64 = 0.25;
/// Time for the tiles of a build that takes the terrain of a package, for each triangle, on one core.
pub(super) const SECONDS_PER_RECORDED_TRIANGLE: f64 = 3.0e-6;
/// Time of all steps, divided by the time to triangulate the tile once.
pub(super) const STEPS_PER_MESH: f64 = 4.0;
/// Share of the cores' time that the steps use.
pub(super) const CORES_BUSY: f64 = 0.9;
