//! Lines in plan, laid on the ground of a level: those of layers, and lines that are not in the
//! package.

use std::collections::BTreeMap;

use corniche_drape::OwnedBorders;
use corniche_geom::{LatticeBounds, LatticePoint, Polyline, StepBudget, TileId, TooMuchWork};
use corniche_tileset::{FilePackage, Manifest, ReadError, Sections};
use corniche_tin::Surface;
use corniche_work::{Observer, Stage, workers::one_by_one};
use serde::{Deserialize, Serialize};

use crate::{
    error::{ProfileError, TileError},
    piece::Vertex,
    plane::distance,
    read,
};

/// The work that draping lines may take, in steps; a vertex counts 32 steps, so this is eight
/// million vertices.
pub(crate) const MOST_STEPS: u64 = 1 << 28;

/// The ground of a tile, on which lines are laid.
pub(crate) struct TileGround {
    id: TileId,
    bounds: LatticeBounds,
    surface: Surface,
}

/// A stretch of a segment of a line that is on the ground of one tile.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct LaidStretch {
    /// The ends of the segment.
    pub(crate) segment: [LatticePoint; 2],
    /// At least two vertices.
    pub(crate) vertices: Vec<Vertex>,
}

impl TileGround {
    /// Reads the ground from the bytes of a tile; `None` if it has none.
    pub(crate) fn decode(
        manifest: &Manifest,
        id: TileId,
        bytes: &[u8],
    ) -> Result<Option<Self>, ReadError> {
        let terrain = manifest.decode(bytes, id, Sections::TERRAIN)?.terrain;
        Ok(terrain.map(|terrain| Self {
            id,
            bounds: manifest.frame.tile_lattice_bounds(id),
            surface: manifest.surface(id, &terrain.tin),
        }))
    }

    /// Returns the stretches of a line on the ground, segment by segment. A stretch along a border
    /// is on both of its tiles.
    pub(crate) fn lay<E: From<TileError> + From<TooMuchWork>>(
        &self,
        line: &[LatticePoint],
        work: &StepBudget,
    ) -> Result<Vec<LaidStretch>, E> {
        let mut laid = Vec::new();
        for &segment in line.array_windows::<2>() {
            let around = LatticeBounds::around(&segment);
            if !around.is_some_and(|around| around.intersects(&self.bounds)) {
                continue;
            }
            let Ok(path) = Polyline::new(segment.to_vec()) else { continue };
            for part in corniche_drape::clip(&path, &self.bounds, OwnedBorders::ALL) {
                for draped in corniche_drape::drape_within(&part, &self.surface, work)?.lines {
                    let failed = |source| TileError::Line { tile: self.id, source };
                    let vertices = read::vertices(&draped, &self.surface).map_err(failed)?;
                    laid.push(LaidStretch { segment, vertices });
                }
            }
        }
        Ok(laid)
    }

    /// Returns a point at the height of the ground; `None` if there is none.
    pub(crate) fn vertex(&self, point: LatticePoint) -> Option<Vertex> {
        let z_m = self.surface.height_at_point_m(self.surface.locate(point)?, point);
        Some(Vertex { at: point.in_steps(), z_m, is_source: true })
    }
}

/// Returns the parts of each line that are on ground, in order, from the stretches of all lines on
/// all tiles in any order.
pub(crate) fn parts_on_ground<'a, L: AsRef<[LatticePoint]>>(
    lines: &[L],
    stretches: impl Iterator<Item = &'a LaidStretch>,
) -> Vec<Vec<Vec<Vertex>>> {
    let mut laid = BySegment::new();
    for LaidStretch { segment, vertices } in stretches {
        laid.entry(*segment).or_default().push(vertices);
    }
    lines.iter().map(|line| joined(line.as_ref(), &laid)).collect()
}

/// Stretches by the ends of their segments. A segment that occurs twice has each stretch twice.
type BySegment<'a> = BTreeMap<[LatticePoint; 2], Vec<&'a [Vertex]>>;

/// Returns the parts of a line that are on ground. Stretches that meet on a tile border are joined.
fn joined(line: &[LatticePoint], laid: &BySegment<'_>) -> Vec<Vec<Vertex>> {
    let mut parts: Vec<Vec<Vertex>> = Vec::new();
    for segment in line.array_windows() {
        let from = segment[0].in_steps();
        let along = |vertex: &Vertex| distance(from, vertex.at);
        let ends = |vertices: &[Vertex]| {
            [vertices.first(), vertices.last()].map(|end| end.map_or(0.0, along))
        };
        let mut stretches = laid.get(segment).cloned().unwrap_or_default();
        stretches.sort_by(|one, other| {
            let ([one, one_end], [other, other_end]) = (ends(one), ends(other));
            one.total_cmp(&other).then(other_end.total_cmp(&one_end))
        });
        // The distance along the segment that the last part has reached.
        let last = parts.last().and_then(|part| part.last());
        let mut reached = last.map(along).filter(|off| *off <= 0.0);
        for vertices in stretches {
            let [first, last] = ends(vertices);
            let goes_on = reached.filter(|reached| first <= *reached);
            let is_new = |vertex: &&Vertex| goes_on.is_none_or(|reached| along(vertex) > reached);
            let new = vertices.iter().filter(is_new).copied();
            match parts.last_mut().filter(|_| goes_on.is_some()) {
                Some(part) => part.extend(new),
                None => parts.push(new.collect()),
            }
            reached = Some(goes_on.map_or(last, |reached| reached.max(last)));
        }
    }
    parts
}

/// Returns the parts of each line that are on ground, in order.
pub(crate) fn laid_lines(
    package: &FilePackage,
    lines: &[&[LatticePoint]],
    level: u8,
    observer: &dyn Observer,
) -> Result<Vec<Vec<Vec<Vertex>>>, ProfileError> {
    let manifest = package.manifest();
    let tiles = read::tiles(package, level, None)?;
    let mut laid = Vec::new();
    let work = StepBudget::new(MOST_STEPS);
    one_by_one((observer, Stage::ExportTiles), &tiles, |&id| {
        let tile = manifest.frame.tile_lattice_bounds(id);
        let is_near = |line: &&[LatticePoint]| {
            LatticeBounds::around(line).is_some_and(|bounds| bounds.intersects(&tile))
        };
        if !lines.iter().any(is_near) {
            return Ok(());
        }
        let Some(bytes) = package.tile(id)? else { return Ok(()) };
        let Some(ground) = TileGround::decode(manifest, id, &bytes)? else { return Ok(()) };
        for line in lines {
            laid.extend(ground.lay::<ProfileError>(line, &work)?);
        }
        Ok::<(), ProfileError>(())
    })?;
    Ok(parts_on_ground(lines, laid.iter()))
}
