//! What a build keeps in its store: the one list of kinds.
//!
//! | kind | key | what it holds | made by | read by |
//! |---|---|---|---|---|
//! | `InputHash` | input, by its place in the plan | size and SHA-256 of its content | hashes | merge |
//! | `RoadPieces` | tile | the pieces of roads that meet the tile, simplified for its level | roads | tiles, merge |
//! | `RoadLengths` | block of ordinals | way id, true length and length outside the data of each road | roads | merge |
//! | `Defects` | block of defects | the extract's defects, in the order in which they were found | roads | roads, merge |
//! | `RoadTotals` | 0 | counts, classes, defects, what the extract held | roads | merge |
//! | `Heights` | finest tile | heights of its nodes with one node of halo; which of them are filled voids | heights | tiles |
//! | `Patch` | tile, two levels above the finest | counts and range of its heights; what was seen of heights that cannot be | heights | tiles, merge |
//! | `Raster` | coarse tile | heights of its 257 × 257 nodes, borders included | heights, top | top, tiles |
//! | `Tin` | coarse tile | its TIN with normals; empty where it has no ground | top, tiles | tiles, merge |
//! | `Record` | tile | counts and sums, deviations of itself and its share in those of its ancestors | tiles, merge | merge |
//! | `Payload` | tile | its encoded bytes | tiles, merge | merge |
//! | `Subtree` | tile | nothing: the heights beneath it are there | heights | top |
//! | `Top` | 0 | nothing: all heights are there and can be heights | top | tiles, merge |
//! | `Ways` | share, block | road ways of a share of the extract, by id | ways | nodes, roads |
//! | `Located` | share, block | places that these ways give for their nodes, by node | ways | roads |
//! | `WayDefects` | share, block | the share's defects, in the order of the file | ways | roads |
//! | `WaysShare` | share | counts of the share, which of its blobs have nodes | ways | nodes, roads |
//! | `Places` | share, block | places of nodes that road ways name, by node | nodes | roads |
//! | `NodesShare` | share | how many blocks of places there are | nodes | roads |
//! | `PhotoTexture` | finest tile | its photo, encoded; empty where there is none | heights | tiles |
//! | `PhotoRaster` | tile | texels of its photo, one for each cell; empty where there is none | heights, top | top, tiles |
//! | `AreaSection` | tile | its areas section, encoded, with counts; nothing where it has none | roads | tiles |
//! | `AreaTotals` | 0 | counts of the extract's areas, after all their sections | roads | tiles, merge |
//! | `BoundarySection` | tile | its boundaries section, encoded, with counts; nothing where it has none | roads | tiles |
//! | `BoundaryTotals` | 0 | counts of the extract's boundaries, after all their sections | roads | merge |
//! | `SpanRoads` | block of roads | bridges and tunnels, whole, and the pieces of roads near them, of all classes | roads | merge |
//! | `SpanGround` | tile | its lines of bridges and tunnels on the ground; nothing where it has none | tiles, merge | merge |
//! | `SpanSection` | tile | its section of spans, encoded, with counts; nothing where it has none | merge | merge |
//! | `SpanTotals` | 0 | counts of bridges and tunnels, ground beyond the bounds, files that it needs; after all their sections | merge | merge |
//!
//! A tile is finished when its `Record` is there: it is put last. So is a patch when its `Patch` is there, and the roads when
//! `RoadTotals` is, and a share of the extract when its `WaysShare` or `NodesShare` is. Heights, rasters and TINs of tiles without any are kept as well, empty: what is not there was not made, and is
//! never taken for a void.

use corniche_geom::TileId;
use corniche_store::{Artifacts, Key, StoreError};
use corniche_tileset::{pmtiles_order, tile_of_order};
use serde::{Serialize, de::DeserializeOwned};

/// Why an artifact cannot be had.
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "each message documents its variant")]
#[non_exhaustive]
pub enum ArtifactError {
    #[error(transparent)]
    Store(#[from] StoreError),
    #[error(
        "intermediate results are damaged: {what}; remove the store and start again (build: with -O)"
    )]
    Damaged { what: String },
    #[error(
        "{what}: not in the store; run corniche part with --step {step}, or give the folder of its part with --store"
    )]
    Missing { what: String, step: &'static str },
}

impl ArtifactError {
    /// Whether the cause is a store that cannot be used, rather than a failure while it was.
    #[must_use]
    pub fn is_unusable_input(&self) -> bool {
        matches!(self, Self::Store(error) if error.is_unusable())
    }
}

/// What an artifact holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[expect(missing_docs, reason = "the table of this module documents each")]
#[repr(u8)]
pub enum Kind {
    InputHash,
    RoadPieces,
    RoadLengths,
    Defects,
    RoadTotals,
    Heights,
    Patch,
    Raster,
    Tin,
    Record,
    Payload,
    Subtree,
    Top,
    Ways,
    Located,
    WayDefects,
    WaysShare,
    Places,
    NodesShare,
    PhotoTexture,
    PhotoRaster,
    AreaSection,
    AreaTotals,
    BoundarySection,
    BoundaryTotals,
    SpanRoads,
    SpanGround,
    SpanSection,
    SpanTotals,
}

impl Kind {
    /// The one with the largest number.
    pub const LAST: Self = Self::SpanTotals;

    /// The key of what belongs to a tile.
    #[must_use]
    pub fn of_tile(self, id: TileId) -> Key {
        self.item(pmtiles_order(id))
    }

    /// The key of what has a number.
    #[must_use]
    pub fn item(self, item: u64) -> Key {
        Key { kind: self as u8, item }
    }
}

/// Keeps a value under a key.
///
/// # Errors
/// When it cannot be kept or read, or makes no sense.
pub fn put<T: Serialize>(store: &dyn Artifacts, key: Key, value: &T) -> Result<(), ArtifactError> {
    let bytes = bincode::serde::encode_to_vec(value, bincode::config::standard())
        .map_err(|error| damaged(key, &error))?;
    Ok(store.put(key, &bytes)?)
}

/// The value under a key; `None` if there is nothing.
///
/// # Errors
/// When it cannot be kept or read, or makes no sense.
pub fn get<T: DeserializeOwned>(
    store: &dyn Artifacts,
    key: Key,
) -> Result<Option<T>, ArtifactError> {
    let Some(bytes) = store.get(key)? else { return Ok(None) };
    match bincode::serde::decode_from_slice(&bytes, bincode::config::standard()) {
        Ok((value, used)) if used == bytes.len() => Ok(Some(value)),
        Ok(_) => Err(damaged(key, &"it is longer than what it holds")),
        Err(error) => Err(damaged(key, &error)),
    }
}

/// The tile that a key is of.
///
/// # Errors
/// When it cannot be kept or read, or makes no sense.
pub fn tile_of(key: Key) -> Result<TileId, ArtifactError> {
    tile_of_order(key.item).ok_or_else(|| damaged(key, &"there is no such tile"))
}

/// The error for an artifact whose bytes are as they were kept, but make no sense.
pub fn damaged(key: Key, what: &dyn std::fmt::Display) -> ArtifactError {
    ArtifactError::Damaged { what: format!("artifact {} of kind {}: {what}", key.item, key.kind) }
}
