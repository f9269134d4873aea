//! Pieces of a layer's lines on bridges and in tunnels, by tile: with their positions along their
//! way, so that their heights can be solved like those of roads.

use corniche_geom::{LatticePoint, TileId};
use corniche_roads::Structure;
use corniche_spec::artifacts::{ArtifactError, ArtifactKind, damaged};
use corniche_store::{ArtifactKey, Artifacts, record_bytes, take_record};
use corniche_tileset::{LayerSlot, RunOwner, pmtiles_order};
use serde::{Deserialize, Serialize};

use super::{in_tile, segment_run::SegmentRun};

/// What a line of a bridge or a tunnel is a part of.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct SpanLineOf {
    /// The road, or the line of a layer.
    pub(crate) line: CarriedLine,
    /// The way.
    pub way_id: i64,
    /// The road's class, or the layer.
    pub owner: RunOwner,
    /// Bridge or tunnel.
    pub(crate) structure: Structure,
}

/// A line along which positions are measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub(crate) enum CarriedLine {
    /// The road with this number.
    Road(u32),
    /// The part of a way that begins at a point: a way may have several parts.
    Way(i64, LatticePoint),
}

/// Encodes a piece of a line.
pub(crate) fn to_bytes(of: SpanLineOf, run: &SegmentRun) -> Vec<u8> {
    let mut bytes = record_bytes(of);
    run.push_to(&mut bytes, &mut LatticePoint::new(0, 0));
    bytes
}

/// The key of the encoded pieces of a layer in a tile.
pub(crate) fn key(slot: LayerSlot, tile: u64) -> ArtifactKey {
    in_tile(ArtifactKind::LayerSpans, slot, tile)
}

/// Reads the pieces of a layer in a tile.
///
/// # Errors
/// When the artifact cannot be read or is invalid.
pub(crate) fn get(
    store: &dyn Artifacts,
    slot: LayerSlot,
    id: TileId,
) -> Result<Vec<(SpanLineOf, SegmentRun)>, ArtifactError> {
    let key = key(slot, pmtiles_order(id));
    let bytes = store.get(key)?.unwrap_or_default();
    let mut rest = &bytes[..];
    let mut pieces = Vec::new();
    while !rest.is_empty() {
        let of = take_record(&mut rest);
        let piece = of.zip(SegmentRun::take(&mut rest, &mut LatticePoint::new(0, 0)));
        pieces.push(piece.ok_or_else(|| damaged(key, &"it does not hold pieces of lines"))?);
    }
    Ok(pieces)
}
