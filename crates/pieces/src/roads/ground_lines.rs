//! The ground beneath bridges and tunnels, by tile: the draped lines of their ways, with the
//! position of each vertex along its way.

use corniche_drape::{ClippedPart, Drape, DrapedLine, DrapedVertex, positions};
use corniche_geom::{LatticePoint, TileId, along};
use corniche_spans::SpanKind;
use corniche_spec::{
    artifacts::{self, ArtifactError, ArtifactKind},
    true_lengths::{TrueLengths, starts_um},
};
use corniche_store::Artifacts;
use corniche_tin::Surface;
use serde::{Deserialize, Serialize};

use crate::layers::{segment_run::SegmentRun, span_pieces::SpanLineOf};

/// A line of a bridge or a tunnel on the ground of a tile.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SpanGroundLine {
    /// What it is a part of.
    pub of: SpanLineOf,
    /// Vertices in the direction of the way; at least two.
    pub vertices: Vec<SpanGroundPoint>,
}

/// A point on the ground.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct SpanGroundPoint {
    pub(crate) at: LatticePoint,
    /// The triangle of the tile from which the height is taken.
    pub(crate) triangle: u32,
    /// The triangle beneath the line to the next vertex.
    pub(crate) next_triangle: u32,
    /// Height of the ground, metres.
    pub height_m: f64,
    /// Distance along the road, micrometres.
    pub(crate) along_um: u64,
    /// Whether it is a point of the line, rather than a crossing of the line with an edge of the
    /// TIN.
    pub(crate) is_source: bool,
}

impl SpanGroundLine {
    /// The kind of span (bridge or tunnel) above or below the line.
    #[must_use]
    pub fn kind(&self) -> SpanKind {
        SpanKind::from_structure(self.of.structure).unwrap_or(SpanKind::Bridge)
    }
}

/// Converts the draped lines of a part of a run of a bridge or a tunnel, except those with less
/// than two vertices that have a position on the lattice.
pub(crate) fn lines_of(
    of: SpanLineOf,
    (run, part): (&SegmentRun, &ClippedPart),
    draped: &Drape,
    (surface, lengths): (&Surface, &TrueLengths<'_>),
) -> Vec<SpanGroundLine> {
    if draped.lines.is_empty() {
        return Vec::new();
    }
    let starts_um = starts_um(run.from_um, &run.segments_um);
    let points = part.line.points();
    let line_of = |(line, &begun): (&DrapedLine, &usize)| {
        // The point of the part that was passed last.
        let mut passed = begun;
        let mut vertices: Vec<SpanGroundPoint> = Vec::with_capacity(line.vertices.len());
        for (vertex, position) in line.vertices.iter().zip(positions(line, surface).ok()?) {
            let at = match vertex {
                DrapedVertex::Source { point, .. } => *point,
                _ => LatticePoint::new(position[0].round() as i64, position[1].round() as i64),
            };
            let is_source = matches!(vertex, DrapedVertex::Source { .. });
            // A point belongs to the segment that ends there; only the first point of the part has
            // none.
            let segment = passed.min(part.segments.len().checked_sub(1)?);
            if is_source && points.get(passed + 1) == Some(&at) {
                passed += 1;
            }
            let of_run = *part.segments.get(segment)?;
            let ends = [run.line.points()[of_run], run.line.points()[of_run + 1]];
            let own_um = lengths.along_um(ends, at, *run.segments_um.get(of_run)?);
            let along_um = starts_um[of_run] + own_um;
            // The choice of the triangle must not depend on the direction of the line.
            let Some(triangle) = surface.locate(at) else { continue };
            let is_behind = |last: &mut SpanGroundPoint| last.at == at || last.along_um >= along_um;
            if is_source {
                // A crossing with an edge of the TIN that is less than a step before a point is
                // dropped in favour of the point.
                while vertices.pop_if(is_behind).is_some() {}
            } else if vertices.last_mut().is_some_and(is_behind) {
                continue;
            }
            let height_m = surface.height_at_point_m(triangle, at);
            if let Some(last) = vertices.last_mut() {
                let middle = between([last.at, at], 0.5);
                last.next_triangle = surface.locate(middle).unwrap_or(triangle);
            }
            let next_triangle = triangle;
            vertices.push(SpanGroundPoint {
                at,
                triangle,
                next_triangle,
                height_m,
                along_um,
                is_source,
            });
        }
        (vertices.len() >= 2).then_some(SpanGroundLine { of, vertices })
    };
    draped.lines.iter().zip(&draped.starts).filter_map(line_of).collect()
}

/// The lattice point at a fraction of the way from one point to another.
pub(crate) fn between(ends: [LatticePoint; 2], share: f64) -> LatticePoint {
    let [from, to] = ends.map(LatticePoint::in_steps);
    let [u, v] = along(from, to, share).map(|part| part.round() as i64);
    LatticePoint::new(u, v)
}

/// Stores the lines of a tile, if it has any.
///
/// # Errors
/// When the artifact cannot be stored.
pub fn put(
    lines: &[SpanGroundLine],
    store: &dyn Artifacts,
    id: TileId,
) -> Result<(), ArtifactError> {
    if lines.is_empty() {
        return Ok(());
    }
    artifacts::put(store, ArtifactKind::SpanGround.of_tile(id), &lines)
}

/// Reads the lines of a tile.
///
/// # Errors
/// When the artifact cannot be read or is invalid.
pub fn get(store: &dyn Artifacts, id: TileId) -> Result<Vec<SpanGroundLine>, ArtifactError> {
    Ok(artifacts::get(store, ArtifactKind::SpanGround.of_tile(id))?.unwrap_or_default())
}
