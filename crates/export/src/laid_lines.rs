//! Lines that are no roads of the package, on the ground of a level.

use corniche_drape::OwnedBorders;
use corniche_geom::{LatticeBounds, LatticePoint, Polyline, TileId, Work};
use corniche_tileset::{FilePackage, Sections};
use corniche_work::{Observer, Stage, workers::one_by_one};

use crate::{
    error::{ProfileError, TileError},
    piece::Vertex,
    read,
};

/// Steps that laying lines may take, of which a vertex counts for 32: eight million vertices.
const MOST_STEPS: u64 = 1 << 28;

/// What lies on one tile.
struct Laid {
    line: usize,
    /// How far along the line it begins, steps of the lattice.
    along: f64,
    vertices: Vec<Vertex>,
}

/// The parts of each line that lie on ground, in order. Parts that meet on a border of tiles are one.
pub(crate) fn laid_lines(
    package: &FilePackage,
    lines: &[&[LatticePoint]],
    level: u8,
    observer: &dyn Observer,
) -> Result<Vec<Vec<Vec<Vertex>>>, ProfileError> {
    let paths: Vec<Option<Polyline>> = lines.iter().map(|line| path_of(line)).collect();
    let tiles = read::tiles(package, level, None)?;
    let mut laid = Vec::new();
    let work = Work::new(MOST_STEPS);
    one_by_one((observer, Stage::ExportTiles), &tiles, |&id| {
        lay_on(package, id, &paths, &work, &mut laid)
    })?;
    laid.sort_by(|one, other| (one.line.cmp(&other.line)).then(one.along.total_cmp(&other.along)));
    // What runs along a border lies on both of its tiles.
    let end = |laid: &Laid| laid.vertices.last().map(|vertex| vertex.at.map(f64::to_bits));
    laid.dedup_by(|later, one| {
        (later.line, later.along.to_bits(), end(later)) == (one.line, one.along.to_bits(), end(one))
    });
    let mut parts: Vec<Vec<Vec<Vertex>>> = vec![Vec::new(); lines.len()];
    for Laid { line, vertices, .. } in laid {
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

fn path_of(points: &[LatticePoint]) -> Option<Polyline> {
    let mut points = points.to_vec();
    points.dedup();
    Polyline::new(points).ok()
}

fn lay_on(
    package: &FilePackage,
    id: TileId,
    paths: &[Option<Polyline>],
    work: &Work,
    laid: &mut Vec<Laid>,
) -> Result<(), ProfileError> {
    let manifest = package.manifest();
    let tile = manifest.frame.tile_lattice_bounds(id);
    let is_near = |path: &Polyline| {
        LatticeBounds::of(path.points()).is_some_and(|bounds| bounds.intersects(&tile))
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
                laid.push(Laid { line, along: starts[segment] + beyond, vertices });
            }
        }
    }
    Ok(())
}

/// How far along a line each of its segments begins, steps of the lattice.
fn starts_of(path: &Polyline) -> Vec<f64> {
    let mut along = 0.0;
    path.points()
        .array_windows()
        .map(|[from, to]| {
            let start = along;
            along += ((to.u - from.u) as f64).hypot((to.v - from.v) as f64);
            start
        })
        .collect()
}
