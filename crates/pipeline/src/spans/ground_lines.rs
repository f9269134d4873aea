//! The ground beneath bridges and tunnels, by tile: the lines of their roads as they are laid, with where along their road each vertex lies.

use corniche_drape::{ClippedPart, DrapedLine, DrapedVertex, positions};
use corniche_geom::{LatticePoint, TileId};
use corniche_roads::{FunctionalRoadClass, Structure};
use corniche_store::Artifacts;
use corniche_tin::Surface;
use serde::{Deserialize, Serialize};

use crate::{
    BuildError,
    artifacts::{self, Kind},
    roads::pieces::{RoadPiece, Run},
    true_lengths::{cut_um, share},
};

/// A line of a bridge or a tunnel on the ground of a tile.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct GroundLine {
    /// The number of its road.
    pub(crate) ordinal: u32,
    pub(crate) way_id: i64,
    pub(crate) class: FunctionalRoadClass,
    /// Whether it is a tunnel, or a bridge.
    pub(crate) is_tunnel: bool,
    /// In the direction of the way; two at least.
    pub(crate) vertices: Vec<GroundVertex>,
}

/// A place on the ground.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(crate) struct GroundVertex {
    pub(crate) at: LatticePoint,
    /// The triangle of the tile that gives it its height.
    pub(crate) triangle: u32,
    pub(crate) height_m: f64,
    /// How far along its road it is, micrometres.
    pub(crate) along_um: u64,
    /// Whether it is a point of the line, and not where this crosses an edge of the TIN.
    pub(crate) is_source: bool,
}

impl GroundLine {
    pub(crate) fn structure(&self) -> Structure {
        if self.is_tunnel { Structure::Tunnel } else { Structure::Bridge }
    }

    /// The ground at a distance along the road; `None` where the line does not reach.
    pub(crate) fn height_m(&self, along_um: u64) -> Option<f64> {
        let after = self.vertices.partition_point(|vertex| vertex.along_um < along_um);
        let to = self.vertices.get(after)?;
        if to.along_um == along_um {
            return Some(to.height_m);
        }
        let from = self.vertices.get(after.checked_sub(1)?)?;
        let share = (along_um - from.along_um) as f64 / (to.along_um - from.along_um) as f64;
        Some(from.height_m + share * (to.height_m - from.height_m))
    }
}

/// The line of a part of a run that is laid on the ground; `None` where less than two vertices have a place on the lattice. `after` is the point of
/// the part after which it goes on: lines come in their order.
pub(crate) fn line_of(
    (ordinal, road): (u32, &RoadPiece),
    (run, part): (&Run, &ClippedPart),
    (line, surface): (&DrapedLine, &Surface),
    after: &mut usize,
) -> Option<GroundLine> {
    let points = part.line.points();
    let first = line.lead_in.or(match line.vertices.first() {
        Some(DrapedVertex::Source { point, .. }) => Some(*point),
        _ => None,
    })?;
    *after += points[*after..].iter().position(|point| *point == first)?;
    let mut vertices: Vec<GroundVertex> = Vec::with_capacity(line.vertices.len());
    for (vertex, position) in line.vertices.iter().zip(positions(line, surface).ok()?) {
        let at = match vertex {
            DrapedVertex::Source { point, .. } => *point,
            _ => LatticePoint::new(position[0].round() as i64, position[1].round() as i64),
        };
        let is_source = matches!(vertex, DrapedVertex::Source { .. });
        if is_source && points.get(*after + 1) == Some(&at) {
            *after += 1;
        }
        // A vertex at a point belongs to the segment before it, but for the first one.
        let segment = match points.get(*after) {
            Some(point) if is_source && *point == at && *after > 0 => *after - 1,
            _ => *after,
        };
        let of_run = *part.segments.get(segment)?;
        let ends = [run.line.points()[of_run], run.line.points()[of_run + 1]];
        let before_um: u64 = run.segments_um.iter().take(of_run).sum();
        let own_um = cut_um(share(ends, at), run.segments_um[of_run]);
        // Which triangle it is must not depend on where the line comes from.
        let Some(triangle) = surface.locate(at) else { continue };
        let along_um = run.from_um + before_um + own_um;
        if vertices.last().is_some_and(|last| last.at == at || last.along_um >= along_um) {
            continue;
        }
        let height_m = surface.height_at_point_m(triangle, at);
        vertices.push(GroundVertex { at, triangle, height_m, along_um, is_source });
    }
    (vertices.len() >= 2).then(|| GroundLine {
        ordinal,
        way_id: road.way_id,
        class: road.class,
        is_tunnel: road.attributes.structure == Structure::Tunnel,
        vertices,
    })
}

/// Keeps the lines of a tile, if it has any.
pub(crate) fn put(
    lines: &[GroundLine],
    store: &dyn Artifacts,
    id: TileId,
) -> Result<(), BuildError> {
    if lines.is_empty() {
        return Ok(());
    }
    artifacts::put(store, Kind::SpanGround.of_tile(id), &lines)
}

/// The lines of a tile.
pub(crate) fn get(store: &dyn Artifacts, id: TileId) -> Result<Vec<GroundLine>, BuildError> {
    Ok(artifacts::get(store, Kind::SpanGround.of_tile(id))?.unwrap_or_default())
}
