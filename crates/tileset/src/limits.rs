//! The limits of what a reader accepts, whatever the bytes say: bounds on memory and work, each
//! with its reason.
//!
//! Writers stay within the same limits and reject what readers would reject. A count is checked
//! against its limit, and against the remaining bytes, before memory is allocated for it.
//! `FORMAT.md`, section 11, lists the limits in one table.

use corniche_geom::TILE_NODES;

/// Entries of one directory. The writer splits larger directories into leaves of 4096 entries, or
/// of a 3500th of all entries if that is more.
pub const MAX_DIRECTORY_ENTRIES: usize = 1 << 17;
/// Bytes of one directory, stored or decompressed. An entry has four varints of at most 10, 5, 5
/// and 10 bytes, so 32 bytes per entry are enough for every directory of [`MAX_DIRECTORY_ENTRIES`].
pub const MAX_DIRECTORY_BYTES: usize = 32 * MAX_DIRECTORY_ENTRIES;
/// The largest nesting depth of directories, root included; writers use two.
pub const MAX_DIRECTORY_DEPTH: usize = 4;
/// Entries of leaf directories that a package caches in memory: 6 MiB, about 64 leaves of the size
/// that writers write.
pub const MAX_KEPT_ENTRIES: usize = 1 << 18;
/// Bytes of the metadata, stored or decompressed. The coordinate table takes at most 0.7 MiB, and
/// an input takes 150 bytes: a hundred thousand elevation files fit. Lists of short texts take up
/// to 16 times their JSON in memory.
pub const MAX_METADATA_BYTES: usize = 16 << 20;
/// Tiles that a package lists, with 12 bytes each in memory; a country of 3.5 million square
/// kilometres in tiles of 256 m has this number of tiles.
pub const MAX_TILES: usize = 1 << 26;
/// The smallest payload: a header and a checksum.
pub const MIN_PAYLOAD_BYTES: u32 = 20;
/// Bytes of a payload: four sections of the largest size that do not compress.
pub const MAX_PAYLOAD_BYTES: u32 = 4 * MAX_SECTION_BYTES as u32;

/// Bytes of a section before compression, and as stored.
pub const MAX_SECTION_BYTES: usize = 64 << 20;
/// Levels of texels of a photo finer than the tile's cell: a texture then has 17 million texels.
pub const MAX_PHOTO_LEVELS: u8 = 4;
/// Vertices of a tile's TIN: one per node.
pub const MAX_VERTICES: usize = TILE_NODES * TILE_NODES;
/// Triangles of a tile's TIN: two per cell.
pub const MAX_TRIANGLES: usize = 2 * (TILE_NODES - 1) * (TILE_NODES - 1);
/// Lines of one road section.
pub const MAX_LINES: usize = 1 << 20;
/// Points of all lines of one road section: 64 MiB in memory, and 128 MiB more while a coded
/// section is read.
pub const MAX_POINTS: usize = 1 << 22;
/// Points of all runs of a spans section. Each of them becomes a piece of a deck, which costs a
/// hundred times as much as a point of a road.
pub const MAX_SPAN_POINTS: usize = 1 << 18;
/// Vertices of all lines of the GEO section, crossings included: 128 MiB in memory.
pub const MAX_LINE_VERTICES: usize = 1 << 22;
/// Objects of one layer in one tile.
pub const MAX_LAYER_OBJECTS: usize = 1 << 18;
/// Attribute values of all objects of one layer in one tile, missing values included: 64 MiB in
/// memory.
pub const MAX_LAYER_VALUES: usize = 1 << 21;
/// Different texts of one layer in one tile.
pub const MAX_LAYER_TEXTS: usize = 1 << 20;
/// Names in all languages of all objects of one layer in one tile, for each attribute: 48 MiB in
/// memory.
pub const MAX_LAYER_NAMES: usize = 1 << 20;
/// Rings, and thus polygons, of all areas of one layer in one tile.
pub const MAX_RINGS: usize = 1 << 19;
/// Ways with attributes in one tile.
pub const MAX_WAYS: usize = 1 << 20;
/// Bytes of all texts of a layer's objects, and of all texts of a tile's ways, counting a shared
/// text for each object: as much as the section that contains them.
pub const MAX_TEXT_BYTES: usize = MAX_SECTION_BYTES;

/// Steps of the walk over the triangles; each examined vertex, row of vertices or edge is a step,
/// and so are 16 nodes near a gate.
///
/// The walk takes some tens of steps for each vertex and triangle of real tiles of every size; 1024
/// are allowed. The constant part is for sparse tiles, where a few thousand vertices on borders and
/// boundaries may all see each other: a search then examines most of them. The tests
/// `real_tiles_stay_far_below_the_limits` (by a factor of 25) and
/// `hard_boundaries_stay_below_the_limits` (10) check the margin. The largest tile may take 2.7 ·
/// 10^8 steps, which is a second or two.
#[must_use]
pub const fn max_walk_steps(vertices: usize, triangles: usize) -> u64 {
    (1 << 26) + (1 << 10) * (vertices + triangles) as u64
}

/// Steps of following the roads of one tile; each examined triangle around a point, or edge around
/// a vertex, is a step.
///
/// Measured: 3.6 steps for each vertex of a line over real ground. The limit allows 64 steps for
/// each of [`MAX_LINE_VERTICES`] vertices.
pub const MAX_ROUTE_STEPS: u64 = 64 * MAX_LINE_VERTICES as u64;
