//! The ground beneath bridges and tunnels, by tile: the lines of their roads as they are laid, with where along their road each vertex lies.

use corniche_drape::{ClippedPart, DrapedLine, DrapedVertex, positions};
use corniche_geom::{LatticePoint, TileId};
use corniche_roads::{FunctionalRoadClass, Structure};
use corniche_spans::SpanKind;
use corniche_spec::{
    artifacts::{self, ArtifactError, Kind},
    true_lengths::TrueLengths,
};
use corniche_store::Artifacts;
use corniche_tin::Surface;
use serde::{Deserialize, Serialize};

use super::pieces::{RoadPiece, Run};

/// A line of a bridge or a tunnel on the ground of a tile.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct GroundLine {
    /// The number of its road.
    pub ordinal: u32,
    /// The way of the road.
    pub way_id: i64,
    /// The class of the road.
    pub class: FunctionalRoadClass,
    /// Whether it is a tunnel; else it is a bridge.
    pub(crate) is_tunnel: bool,
    /// In the direction of the way; two at least.
    pub vertices: Vec<GroundVertex>,
}

/// A place on the ground.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct GroundVertex {
    pub(crate) at: LatticePoint,
    /// The triangle of the tile that gives it its height.
    pub(crate) triangle: u32,
    /// The triangle beneath the line to the next vertex.
    pub(crate) next_triangle: u32,
    /// Height of the ground, metres.
    pub height_m: f64,
    /// How far along its road it is, micrometres.
    pub(crate) along_um: u64,
    /// Whether it is a point of the line, and not where this crosses an edge of the TIN.
    pub(crate) is_source: bool,
}

impl GroundLine {
    /// What kind of span it lies beneath.
    #[must_use]
    pub fn kind(&self) -> SpanKind {
        if self.is_tunnel { SpanKind::Tunnel } else { SpanKind::Bridge }
    }

    pub(crate) fn structure(&self) -> Structure {
        if self.is_tunnel { Structure::Tunnel } else { Structure::Bridge }
    }
}

/// A part of a run of a bridge or a tunnel, and where each segment of the run begins along its road.
pub(crate) struct PartOfRun<'a> {
    pub(crate) run: &'a Run,
    pub(crate) starts_um: &'a [u64],
    pub part: &'a ClippedPart,
}

/// A line of a part that is laid on the ground and begins on segment `begun` of it; `None` where less than two vertices have a place on the lattice.
pub(crate) fn line_of(
    (ordinal, road): (u32, &RoadPiece),
    PartOfRun { run, starts_um, part }: &PartOfRun<'_>,
    (line, begun): (&DrapedLine, usize),
    (surface, lengths): (&Surface, &TrueLengths<'_>),
) -> Option<GroundLine> {
    let points = part.line.points();
    // The point of the part that was passed last.
    let mut passed = begun;
    let mut vertices: Vec<GroundVertex> = Vec::with_capacity(line.vertices.len());
    for (vertex, position) in line.vertices.iter().zip(positions(line, surface).ok()?) {
        let at = match vertex {
            DrapedVertex::Source { point, .. } => *point,
            _ => LatticePoint::new(position[0].round() as i64, position[1].round() as i64),
        };
        let is_source = matches!(vertex, DrapedVertex::Source { .. });
        // A point ends the segment that comes to it; only the first point of the part has none.
        let segment = passed.min(part.segments.len().checked_sub(1)?);
        if is_source && points.get(passed + 1) == Some(&at) {
            passed += 1;
        }
        let of_run = *part.segments.get(segment)?;
        let ends = [run.line.points()[of_run], run.line.points()[of_run + 1]];
        let own_um = lengths.along_um(ends, at, *run.segments_um.get(of_run)?);
        let along_um = starts_um[of_run] + own_um;
        // Which triangle it is must not depend on where the line comes from.
        let Some(triangle) = surface.locate(at) else { continue };
        let is_behind = |last: &mut GroundVertex| last.at == at || last.along_um >= along_um;
        if is_source {
            // Edges of the TIN that are less than a step before a point are crossed at the point.
            while vertices.pop_if(is_behind).is_some() {}
        } else if vertices.last_mut().is_some_and(is_behind) {
            continue;
        }
        let height_m = surface.height_at_point_m(triangle, at);
        if let Some(last) = vertices.last_mut() {
            last.next_triangle = surface.locate(between([last.at, at], 0.5)).unwrap_or(triangle);
        }
        let next_triangle = triangle;
        let vertex = GroundVertex { at, triangle, next_triangle, height_m, along_um, is_source };
        vertices.push(vertex);
    }
    (vertices.len() >= 2).then(|| GroundLine {
        ordinal,
        way_id: road.way_id,
        class: road.class,
        is_tunnel: road.attributes.structure == Structure::Tunnel,
        vertices,
    })
}

/// The lattice point at a share of the way from one point to another.
pub(crate) fn between(ends: [LatticePoint; 2], share: f64) -> LatticePoint {
    let [from, to] = ends.map(LatticePoint::in_steps);
    let mix = |axis: usize| (from[axis] + share * (to[axis] - from[axis])).round() as i64;
    LatticePoint::new(mix(0), mix(1))
}

/// Keeps the lines of a tile, if it has any.
///
/// # Errors
/// When it cannot be kept or read, or makes no sense.
pub fn put(lines: &[GroundLine], store: &dyn Artifacts, id: TileId) -> Result<(), ArtifactError> {
    if lines.is_empty() {
        return Ok(());
    }
    artifacts::put(store, Kind::SpanGround.of_tile(id), &lines)
}

/// The lines of a tile.
///
/// # Errors
/// When it cannot be kept or read, or makes no sense.
pub fn get(store: &dyn Artifacts, id: TileId) -> Result<Vec<GroundLine>, ArtifactError> {
    Ok(artifacts::get(store, Kind::SpanGround.of_tile(id))?.unwrap_or_default())
}
