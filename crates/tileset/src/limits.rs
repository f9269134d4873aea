//! What a reader accepts, whatever the bytes say: bounds on memory and work, each with where it comes from.
//!
//! Writers keep to the same bounds and refuse what readers would. A count is checked against them, and against the
//! bytes that are left, before anything is allocated for it. `FORMAT.md`, section 11, has them in one table.

use corniche_geom::TILE_NODES;

/// Entries of one directory. The writer splits directories of tiles from 4096 entries on, or at a 3500th of all.
pub const MAX_DIRECTORY_ENTRIES: usize = 1 << 17;
/// Bytes of one directory, stored or decompressed. An entry has four varints of at most 10 + 5 + 5 + 10 bytes, so
/// 32 bytes an entry hold every directory of [`MAX_DIRECTORY_ENTRIES`].
pub const MAX_DIRECTORY_BYTES: usize = 32 * MAX_DIRECTORY_ENTRIES;
/// Directories may be nested this deep, root included; writers use two.
pub const MAX_DIRECTORY_DEPTH: usize = 4;
/// Entries of leaf directories that a package keeps in memory: 6 MiB, some 64 leaves as they are written.
pub const MAX_KEPT_ENTRIES: usize = 1 << 18;
/// Bytes of the metadata, stored or decompressed. The coordinate table takes at most 0.7 MiB, an input 150 bytes: a
/// hundred thousand elevation files fit. Lists of short texts take up to 16 times their JSON in memory.
pub const MAX_METADATA_BYTES: usize = 16 << 20;
/// Tiles that a package lists, 12 bytes each in memory; a country of 3.5 million square kilometres in tiles of 256 m
/// has as many.
pub const MAX_TILES: usize = 1 << 26;
/// A payload has a header and a checksum at least.
pub const MIN_PAYLOAD_BYTES: u32 = 20;
/// Bytes of a payload: four full sections that do not compress.
pub const MAX_PAYLOAD_BYTES: u32 = 4 * MAX_SECTION_BYTES as u32;

/// No section is larger than this before compression, nor as stored.
pub const MAX_SECTION_BYTES: usize = 64 << 20;
/// The most levels of texels of a photo finer than the tile's cell: a texture then has 17 million texels.
pub const MAX_PHOTO_LEVELS: u8 = 4;
/// Vertices of a tile's TIN: one for each node.
pub const MAX_VERTICES: usize = TILE_NODES * TILE_NODES;
/// Triangles of a tile's TIN: two for each cell.
pub const MAX_TRIANGLES: usize = 2 * (TILE_NODES - 1) * (TILE_NODES - 1);
/// Lines of one road section.
pub const MAX_LINES: usize = 1 << 20;
/// Points of all lines of one road section: 64 MiB in memory, and while a coded section is read 128 MiB more.
pub const MAX_POINTS: usize = 1 << 22;
/// Points of all runs of a spans section. Each becomes a piece of a deck, which costs a hundred times what a point of a road does.
pub const MAX_SPAN_POINTS: usize = 1 << 18;
/// Vertices of all lines of the GEO section, crossings included: 128 MiB in memory.
pub const MAX_LINE_VERTICES: usize = 1 << 22;
/// Parts of lines of one layer, such as boundaries, in one tile.
pub const MAX_CLASSED_LINES: usize = 1 << 18;
/// Areas in one tile.
pub const MAX_AREAS: usize = 1 << 18;
/// Rings of all areas of a tile, and so polygons.
pub const MAX_AREA_RINGS: usize = 1 << 19;
/// Ways with attributes in one tile.
pub const MAX_WAYS: usize = 1 << 20;
/// Bytes of all names of a tile's areas, and of all texts of its ways after each way got its own: as much as the section that they come from.
pub const MAX_TEXT_BYTES: usize = MAX_SECTION_BYTES;

/// Steps that the walk over the triangles may take: looking at a vertex, a row of vertices, 16 nodes near a gate or an edge is one.
///
/// The walk takes some tens of steps for each vertex and triangle of real tiles of every size; 1024 are allowed. The
/// constant part is for sparse tiles, where a few thousand vertices on borders and boundaries may all see each other:
/// a search then looks at most of them. Tests `real_tiles_stay_far_below_the_limits` (by a factor of 25) and
/// `hard_boundaries_stay_below_the_limits` (10) hold the distance. The largest tile may take 2.7 · 10^8 steps, a second or
/// two.
#[must_use]
pub const fn max_walk_steps(vertices: usize, triangles: usize) -> u64 {
    (1 << 26) + (1 << 10) * (vertices + triangles) as u64
}

/// Steps that following the roads of one tile may take: looking at a triangle around a point or at an edge around
/// a vertex is one.
///
/// Measured: 3.6 for each vertex of a line over real ground. The allowance is for [`MAX_LINE_VERTICES`] at 64 each.
pub const MAX_ROUTE_STEPS: u64 = 64 * MAX_LINE_VERTICES as u64;
