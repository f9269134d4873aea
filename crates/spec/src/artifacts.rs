//! The kinds of artifacts that a build keeps in its store: the only list of them.
//!
//! | kind | key | what it holds | created by | read by |
//! |---|---|---|---|---|
//! | `InputHash` | input, by its index in the plan | size and SHA-256 of its content | hashes | merge |
//! | `RoadPieces` | tile | the pieces of roads that meet the tile, simplified for its level | roads | tiles, merge |
//! | `RoadLengths` | block of ordinals | way id, true length and length outside the data of each road | roads | merge |
//! | `Defects` | block of defects | the extract's defects, in the order in which they were found | roads | roads, merge |
//! | `RoadTotals` | 0 | counts, classes, defects, content of the extract | roads | merge |
//! | `Heights` | finest tile | heights of its nodes with two nodes of halo; which nodes are filled voids | heights | tiles |
//! | `Patch` | tile, two levels above the finest | counts and range of its heights; implausible heights that were found | heights | tiles, merge |
//! | `Raster` | coarse tile | heights of its 257 × 257 nodes, borders included | heights, top | top, tiles |
//! | `Tin` | coarse tile | its TIN with normals; empty where it has no ground | top, tiles | tiles, merge |
//! | `Record` | tile | counts and sums; its own deviation, and its contribution to those of its ancestors | tiles, merge | merge |
//! | `Payload` | tile | its encoded bytes | tiles, merge | merge |
//! | `Subtree` | tile | nothing: means that the heights beneath it are complete | heights | top |
//! | `Top` | 0 | the height step: means that all heights are complete and plausible | top | tiles, merge |
//! | `Ways` | share, block | road ways of a share of the extract, by id | ways | nodes, roads |
//! | `Located` | share, block | positions of nodes that these ways contain, by node | ways | roads |
//! | `WayDefects` | share, block | the share's defects, in the order of the file | ways | roads |
//! | `WaysShare` | share | counts of the share, and which of its blobs have nodes | ways | nodes, roads |
//! | `Places` | share, block | positions of nodes that road ways refer to, by node | nodes | roads |
//! | `NodesShare` | share | the number of blocks of positions | nodes | roads |
//! | `PhotoTexture` | finest tile | its photo, encoded; empty if it has none | heights | tiles |
//! | `PhotoRaster` | tile | texels of its photo, one for each cell; empty if it has none | heights, top | top, tiles |
//! | `LayerSection` | layer, tile | the layer's section of the tile, encoded, with counts; missing if it has none | roads | tiles |
//! | `LayerSpans` | layer, tile | the pieces of the layer's lines on bridges and in tunnels that meet the tile; missing if it has none | roads | tiles, merge |
//! | `LayerTotals` | layer | counts of the layer's objects; written after all their sections | roads | merge |
//! | `SpanRoads` | block of roads | whole bridges and tunnels, and the pieces of roads of all classes near them | roads | merge |
//! | `SpanGround` | tile | the parts of its bridges and tunnels on the ground; empty if it has none | tiles, merge | merge |
//! | `SpanSection` | tile | its section of spans (bridges and tunnels), encoded, with counts; empty if it has none | merge | merge |
//! | `SpanTotals` | 0 | counts of bridges and tunnels; ground beyond the bounds and the files that it needs; written after all their sections | merge | merge |
//!
//! A tile is finished when its `Record` is in the store, because the record is written last. In the
//! same way, a patch is finished when its `Patch` is there, the roads when `RoadTotals` is, and a
//! share of the extract when its `WaysShare` or `NodesShare` is. Empty heights, rasters and TINs
//! are stored, too: a missing artifact therefore always means "not computed", never "void".

use corniche_geom::TileId;
use corniche_store::{ArtifactKey, Artifacts, StoreError};
use corniche_tileset::{pmtiles_order, tile_of_order};
use serde::{Serialize, de::DeserializeOwned};

/// Why an artifact cannot be read or written.
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
        "the store lacks {what}; run corniche part with --step {step}, or pass the folder of its part with --store"
    )]
    Missing { what: String, step: &'static str },
}

impl ArtifactError {
    /// Whether the cause is an unusable store, rather than a failure while the store was used.
    #[must_use]
    pub fn is_unusable_input(&self) -> bool {
        matches!(self, Self::Store(error) if error.is_unusable())
    }
}

/// The kind of an artifact: what it holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[expect(missing_docs, reason = "the table of this module documents each")]
#[repr(u8)]
pub enum ArtifactKind {
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
    LayerSection,
    LayerSpans,
    LayerTotals,
    SpanRoads,
    SpanGround,
    SpanSection,
    SpanTotals,
}

impl ArtifactKind {
    /// The kind with the largest number.
    pub const LAST: Self = Self::SpanTotals;

    /// The key of the artifact that belongs to a tile.
    #[must_use]
    pub fn of_tile(self, id: TileId) -> ArtifactKey {
        self.item(pmtiles_order(id))
    }

    /// The key of the artifact with a number.
    #[must_use]
    pub fn item(self, item: u64) -> ArtifactKey {
        ArtifactKey { kind: self as u8, item }
    }
}

/// Stores a value under a key.
///
/// # Errors
/// When the value cannot be encoded or stored.
pub fn put<T: Serialize>(
    store: &dyn Artifacts,
    key: ArtifactKey,
    value: &T,
) -> Result<(), ArtifactError> {
    let bytes = bincode::serde::encode_to_vec(value, bincode::config::standard())
        .map_err(|error| damaged(key, &error))?;
    Ok(store.put(key, &bytes)?)
}

/// Returns the value under a key; `None` if the store has no such artifact.
///
/// # Errors
/// When the artifact cannot be read or is invalid.
pub fn get<T: DeserializeOwned>(
    store: &dyn Artifacts,
    key: ArtifactKey,
) -> Result<Option<T>, ArtifactError> {
    let Some(bytes) = store.get(key)? else { return Ok(None) };
    match bincode::serde::decode_from_slice(&bytes, bincode::config::standard()) {
        Ok((value, used)) if used == bytes.len() => Ok(Some(value)),
        Ok(_) => Err(damaged(key, &"it has surplus bytes at its end")),
        Err(error) => Err(damaged(key, &error)),
    }
}

/// Returns the tile to which a key belongs.
///
/// # Errors
/// When there is no such tile.
pub fn tile_of(key: ArtifactKey) -> Result<TileId, ArtifactError> {
    tile_of_order(key.item).ok_or_else(|| damaged(key, &"there is no such tile"))
}

/// The error for an artifact whose bytes are intact but whose content is invalid.
pub fn damaged(key: ArtifactKey, what: &dyn std::fmt::Display) -> ArtifactError {
    ArtifactError::Damaged { what: format!("artifact {} of kind {}: {what}", key.item, key.kind) }
}
