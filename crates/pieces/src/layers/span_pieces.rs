//! Pieces of a layer's lines on bridges and in tunnels, by tile: with their positions along their
//! way, so that their heights can be solved like those of roads.

use corniche_geom::{LatticePoint, Polyline, TileId};
use corniche_roads::Structure;
use corniche_spec::artifacts::{self, ArtifactError, ArtifactKind, damaged};
use corniche_store::Artifacts;
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
    /// Whether it is a tunnel; otherwise it is a bridge.
    pub(crate) is_tunnel: bool,
}

/// A line along which positions are measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub(crate) enum CarriedLine {
    /// The road with this number.
    Road(u32),
    /// The part of a way that begins at a point: a way may have several parts.
    Way(i64, LatticePoint),
}

/// Consecutive segments of a line on a bridge or in a tunnel that may touch a tile.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct SpanPiece {
    pub way_id: i64,
    /// The first point of the line, from which positions are measured.
    pub start: LatticePoint,
    pub is_tunnel: bool,
    /// At least two points, as the section of the tile has them.
    pub points: Vec<LatticePoint>,
    /// The position of each point along the line, micrometres.
    pub along_um: Vec<u64>,
}

impl SpanPiece {
    /// Creates a piece of a way with a structure that is not the ground.
    pub(crate) fn new(
        (way_id, start): (i64, LatticePoint),
        structure: Structure,
        (points, along_um): (&[LatticePoint], &[u64]),
    ) -> Self {
        let is_tunnel = structure == Structure::Tunnel;
        Self { way_id, start, is_tunnel, points: points.to_vec(), along_um: along_um.to_vec() }
    }

    /// Returns the line with its lengths; `None` if points and positions do not match.
    fn run(self, slot: LayerSlot) -> Option<(SpanLineOf, SegmentRun)> {
        let Self { way_id, start, is_tunnel, points, along_um } = self;
        let count = points.len();
        let line = Polyline::new(points).ok()?;
        if line.points().len() != count || along_um.len() != count || !along_um.is_sorted() {
            return None;
        }
        let of = SpanLineOf {
            line: CarriedLine::Way(way_id, start),
            way_id,
            owner: RunOwner::Layer(slot),
            is_tunnel,
        };
        let segments_um = along_um.array_windows().map(|[from, to]| to - from).collect();
        Some((of, SegmentRun { line, segments_um, from_um: along_um[0], nodes: Vec::new() }))
    }
}

/// Stores the pieces of a layer in a tile.
///
/// # Errors
/// When the artifact cannot be stored.
pub(crate) fn put(
    store: &dyn Artifacts,
    (slot, tile): (LayerSlot, u64),
    pieces: &[SpanPiece],
) -> Result<(), ArtifactError> {
    artifacts::put(store, in_tile(ArtifactKind::LayerSpans, slot, tile), &pieces)
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
    let key = in_tile(ArtifactKind::LayerSpans, slot, pmtiles_order(id));
    let pieces: Vec<SpanPiece> = artifacts::get(store, key)?.unwrap_or_default();
    let runs: Option<Vec<_>> = pieces.into_iter().map(|piece| piece.run(slot)).collect();
    runs.ok_or_else(|| damaged(key, &"it does not hold pieces of lines"))
}
