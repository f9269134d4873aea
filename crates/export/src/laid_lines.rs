//! Lines that are not roads of the package, draped on the ground of a level.

use corniche_drape::OwnedBorders;
use corniche_geom::{LatticeBounds, LatticePoint, Polyline, StepBudget, TileId};
use corniche_tileset::{FilePackage, Sections};
use corniche_work::{Observer, Stage, workers::one_by_one};

use crate::{
    error::{ProfileError, TileError},
    piece::Vertex,
    read,
};

/// The work that draping lines may take, in steps; a vertex counts 32 steps, so this is eight
/// million vertices.
const MOST_STEPS: u64 = 1 << 28;

/// The part of a line on one tile.
struct LaidOnTile {
    line: usize,
    /// The distance along the line at which the part begins, lattice steps.
    along: f64,
    vertices: Vec<Vertex>,
}

/// Returns the parts of each line that are on ground, in order. Parts that meet on a tile border
/// are joined.
pub(crate) fn laid_lines(
    package: &FilePackage,
    lines: &[&[LatticePoint]],
    level: u8,
    observer: &dyn Observer,
) -> Result<Vec<Vec<Vec<Vertex>>>, ProfileError> {
    let path_of = |line: &&[LatticePoint]| {
        let mut points = line.to_vec();
        points.dedup();
        Polyline::new(points).ok()
    };
    let paths: Vec<Option<Polyline>> = lines.iter().map(path_of).collect();
    let tiles = read::tiles(package, level, None)?;
    let mut laid = Vec::new();
    let work = StepBudget::new(MOST_STEPS);
    one_by_one((observer, Stage::ExportTiles), &tiles, |&id| {
        lay_on(package, id, &paths, &work, &mut laid)
    })?;
    laid.sort_by(|one, other| (one.line.cmp(&other.line)).then(one.along.total_cmp(&other.along)));
    // A part along a border is on both of its tiles.
    let end = |laid: &LaidOnTile| laid.vertices.last().map(|vertex| vertex.at.map(f64::to_bits));
    laid.dedup_by(|later, one| {
        (later.line, later.along.to_bits(), end(later)) == (one.line, one.along.to_bits(), end(one))
    });
    let mut parts: Vec<Vec<Vec<Vertex>>> = vec![Vec::new(); lines.len()];
    for LaidOnTile { line, vertices, .. } in laid {
        let ends_at = |part: &Vec<Vertex>| part.last().map(|vertex| vertex.at);
        match parts[line].last_mut() {
            Some(part) if ends_at(part) == vertices.first().map(|vertex| vertex.at) => {
                part.extend(vertices.into_iter().skip(1));
            }
            _ => parts[line].push(vertices),
        }
    }
    Ok(parts)
}

fn lay_on(
    package: &FilePackage,
    id: TileId,
    paths: &[Option<Polyline>],
    work: &StepBudget,
    laid: &mut Vec<LaidOnTile>,
) -> Result<(), ProfileError> {
    let manifest = package.manifest();
    let tile = manifest.frame.tile_lattice_bounds(id);
    let is_near = |path: &Polyline| {
        LatticeBounds::around(path.points()).is_some_and(|bounds| bounds.intersects(&tile))
    };
    if !paths.iter().flatten().any(is_near) {
        return Ok(());
    }
    let Some(payload) = package.payload(id, Sections::TERRAIN)? else { return Ok(()) };
    let Some(terrain) = &payload.terrain else { return Ok(()) };
    let surface = manifest.surface(id, &terrain.tin);
    for (line, path) in paths.iter().enumerate() {
        let Some(path) = path else { continue };
        let starts = starts_of(path);
        for part in corniche_drape::clip_parts(path, &tile, OwnedBorders::ALL) {
            for draped in corniche_drape::drape_within(&part.line, &surface, work)?.lines {
                let failed = |source| TileError::Line { tile: id, source };
                let vertices = read::vertices(&draped, &surface).map_err(failed)?;
                let sources = corniche_drape::source_segments(&draped);
                let (Some(first), Some(source)) = (vertices.first(), sources.first()) else {
                    continue;
                };
                let points = part.line.points();
                let own = points.windows(2).position(|pair| pair == source);
                let segment = own.and_then(|own| part.segments.get(own)).copied();
                let Some(segment) = segment else { continue };
                let from = path.points()[segment];
                let beyond = (first.at[0] - from.u as f64).hypot(first.at[1] - from.v as f64);
                laid.push(LaidOnTile { line, along: starts[segment] + beyond, vertices });
            }
        }
    }
    Ok(())
}

/// The distance along the line at which each segment begins, lattice steps.
fn starts_of(path: &Polyline) -> Vec<f64> {
    let mut along = 0.0;
    path.points()
        .array_windows()
        .map(|[from, to]| {
            let start = along;
            along += from.distance_steps(*to);
            start
        })
        .collect()
}
