//! One tile's payload from its mesh, its errors and its roads; and the sums over all tiles.

use std::collections::BTreeMap;

use corniche_drape::{Neighbours, OwnedBorders};
use corniche_geom::{LatticeBounds, TileId};
use corniche_roads::{FunctionalRoadClass, Road};
use corniche_tileset::{
    EncodedTile, GeoRoad, PayloadContext, RoadRecord, SvRoad, Terrain, TilePayload, VerticalRecord,
    pmtiles_order,
};
use corniche_tin::{Placement, Surface};

use super::{
    errors::TileErrors,
    heights::Pyramid,
    lengths::{TrueLengths, gaps_um, pieces_um},
    levels::Levels,
    mesh::{self, Meshes},
    road_log::RoadLog,
    roads::ReadRoads,
};
use crate::{BuildError, Observer, Stage, Storage, storage::Kind, storage::Span, workers};

/// Tiles whose lists of roads are in memory at once.
const BATCH: usize = 1024;

/// What the tiles of a run came to.
pub(crate) struct Tiles {
    /// Payloads in package order.
    pub(crate) payloads: Vec<(TileId, Span)>,
    pub(crate) levels: BTreeMap<u8, LevelSums>,
    pub(crate) classes: BTreeMap<(u8, u8), ClassSums>,
    /// Per road, at the finest level.
    pub(crate) roads: Vec<RoadFate>,
}

/// Sums over the tiles of a level.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct LevelSums {
    pub(crate) tiles: u64,
    pub(crate) vertices: u64,
    pub(crate) triangles: u64,
    pub(crate) terrain_bytes: u64,
    /// Stored errors of its tiles.
    pub(crate) errors_m: Vec<f64>,
    /// Stored over true errors of its tiles, where those can be measured.
    pub(crate) tightness: Vec<f64>,
    pub(crate) uncovered_nodes: u64,
}

/// Sums over the roads of a class on a level.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct ClassSums {
    /// Points of the source lines that lie in tiles with ground.
    pub(crate) source_vertices: u64,
    /// The same of the level's simplified lines.
    pub(crate) simplified_vertices: u64,
    pub(crate) geo_vertices: u64,
    pub(crate) sv_vertices: u64,
    pub(crate) geo_stored_bytes: u64,
    pub(crate) sv_stored_bytes: u64,
}

/// What became of a road at the finest level.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct RoadFate {
    /// True length that lies on a TIN, micrometres.
    pub(crate) kept_um: u64,
    /// True length on the data's tiles, but where there is no ground, micrometres.
    pub(crate) void_um: u64,
}

/// What every tile needs.
pub(crate) struct TileInput<'a> {
    pub(crate) levels: &'a Levels,
    pub(crate) lengths: &'a TrueLengths<'a>,
    pub(crate) meshes: &'a Meshes,
    pub(crate) errors: &'a TileErrors,
    pub(crate) pyramid: &'a Pyramid<'a>,
    /// The finest tiles on which the data's rectangle lies.
    pub(crate) data_tiles: &'a [TileId],
    pub(crate) storage: &'a dyn Storage,
    pub(crate) threads: usize,
}

/// A tile as a worker made it.
struct Made {
    /// `None` where there is no ground, and so no payload.
    kept: Option<Kept>,
    fates: Vec<(u32, RoadFate)>,
}

/// A payload in storage and what it came to.
struct Kept {
    span: Span,
    vertices: u64,
    triangles: u64,
    terrain_bytes: u64,
    classes: BTreeMap<u8, ClassSums>,
}

/// Makes and keeps all payloads.
pub(crate) fn make(
    input: &TileInput<'_>,
    roads: Option<&mut ReadRoads<'_>>,
    observer: &dyn Observer,
) -> Result<Tiles, BuildError> {
    let mut ids: Vec<TileId> = input.meshes.keys().copied().collect();
    if roads.is_some() {
        // Roads on tiles of the data without any ground are lost there, and counted there.
        ids.extend(input.data_tiles.iter().filter(|id| !input.meshes.contains_key(id)));
    }
    ids.sort_unstable_by_key(|&id| pmtiles_order(id));
    observer.begin(Stage::Tiles, Some(ids.len() as u64));
    let road_count = roads.as_ref().map_or(0, |roads| roads.log.len());
    let mut tiles = Tiles::of_roads(road_count);
    let mut roads = roads;
    // In batches, so that the lists of roads in memory stay few.
    for batch in ids.chunks(BATCH) {
        let mut lists = Vec::with_capacity(batch.len());
        for &id in batch {
            lists.push(match &mut roads {
                Some(roads) => roads.by_tile.roads_of(id)?,
                None => Vec::new(),
            });
        }
        let log = roads.as_ref().map(|roads| &roads.log);
        workers::in_order(
            input.threads,
            batch.len(),
            || Ok(()),
            |(), index| {
                if observer.is_cancelled() {
                    return Err(BuildError::Interrupted);
                }
                make_tile(input, batch[index], log, &lists[index])
            },
            |index, made| {
                tiles.add(batch[index], &made, input);
                observer.advance(Stage::Tiles, 1);
                Ok(())
            },
        )?;
    }
    observer.end(Stage::Tiles);
    Ok(tiles)
}

impl Tiles {
    fn add(&mut self, id: TileId, made: &Made, input: &TileInput<'_>) {
        if let Some(kept) = &made.kept {
            self.payloads.push((id, kept.span));
            let errors = input.errors.of(id);
            let level = self.levels.entry(id.z()).or_default();
            level.tiles += 1;
            level.vertices += kept.vertices;
            level.triangles += kept.triangles;
            level.terrain_bytes += kept.terrain_bytes;
            level.errors_m.push(errors.geometric_error_m);
            let least_m = VerticalRecord::least_measured_error_m(input.levels.quantum_m());
            if errors.true_error_m >= least_m {
                level.tightness.push(errors.geometric_error_m / errors.true_error_m);
            }
            level.uncovered_nodes += errors.uncovered_nodes;
            for (&class, counted) in &kept.classes {
                let sums = self.classes.entry((id.z(), class)).or_default();
                sums.source_vertices += counted.source_vertices;
                sums.simplified_vertices += counted.simplified_vertices;
                sums.geo_vertices += counted.geo_vertices;
                sums.sv_vertices += counted.sv_vertices;
                sums.geo_stored_bytes += counted.geo_stored_bytes;
                sums.sv_stored_bytes += counted.sv_stored_bytes;
            }
        }
        self.add_fates(&made.fates);
    }

    /// Adds what became of roads in one tile.
    pub(crate) fn add_fates(&mut self, fates: &[(u32, RoadFate)]) {
        for &(ordinal, fate) in fates {
            let road = &mut self.roads[ordinal as usize];
            road.kept_um += fate.kept_um;
            road.void_um += fate.void_um;
        }
    }

    /// Before the first tile, for so many roads.
    pub(crate) fn of_roads(count: usize) -> Self {
        Self {
            payloads: Vec::new(),
            levels: BTreeMap::new(),
            classes: BTreeMap::new(),
            roads: vec![RoadFate::default(); count],
        }
    }
}

fn make_tile(
    input: &TileInput<'_>,
    id: TileId,
    log: Option<&RoadLog<'_>>,
    ordinals: &[u32],
) -> Result<Made, BuildError> {
    let levels = input.levels;
    let frame = levels.frame();
    let Some(span) = input.meshes.get(&id) else {
        return lost_roads(input, id, log, ordinals);
    };
    let meshed = mesh::load(input.storage, id, *span)?;
    let surface = Surface::new(&meshed.tin, Placement::of_tile(frame, id, levels.quantum_m()));
    let mut laid = Laid::default();
    let on = Ground { id, surface: &surface, owned: owned_borders(input, id, ordinals)? };
    for &ordinal in ordinals {
        if let Some(log) = log {
            laid.lay(&log.load(ordinal)?, ordinal, &on, levels, input.lengths);
        }
    }
    let fates = std::mem::take(&mut laid.fates);
    let laid_classes = std::mem::take(&mut laid.classes);
    let errors = input.errors.of(id);
    let counts = (meshed.tin.vertices().len() as u64, meshed.tin.triangles().len() as u64);
    let terrain = Terrain {
        tin: meshed.tin,
        normals: meshed.normals,
        geometric_error_m: errors.geometric_error_m,
        height_range_m: errors.height_range_m,
        uncovered_nodes: errors.uncovered_nodes,
    };
    let payload = laid.into_payload(id, terrain);
    let context = PayloadContext { frame: *frame, quantum_m: levels.quantum_m() };
    let encoded = corniche_tileset::encode(&payload, &context)?;
    let classes = class_sums(laid_classes, &payload, &encoded);
    let span = input.storage.append(Kind::Payloads, &encoded.bytes).map_err(BuildError::Storage)?;
    let (vertices, triangles) = counts;
    let kept = Kept { span, vertices, triangles, terrain_bytes: encoded.terrain.stored, classes };
    Ok(Made { kept: Some(kept), fates })
}

/// What roads of a tile are laid on.
pub(crate) struct Ground<'a> {
    pub(crate) id: TileId,
    pub(crate) surface: &'a Surface,
    /// What of its borders is the tile's.
    pub(crate) owned: OwnedBorders,
}

/// What the tile owns of its borders, by the ground on both sides of them.
///
/// A neighbour that no one asks (beside the data, or without ground above the finest level) owns nothing.
fn owned_borders(
    input: &TileInput<'_>,
    id: TileId,
    ordinals: &[u32],
) -> Result<OwnedBorders, BuildError> {
    if ordinals.is_empty() {
        return Ok(OwnedBorders::ALL);
    }
    let is_asked = |east, south| {
        id.neighbour(east, south).is_some_and(|other| {
            input.meshes.contains_key(&other) || is_among(input.data_tiles, other)
        })
    };
    let neighbours = Neighbours { east: is_asked(1, 0), south: is_asked(0, 1) };
    let heights = input.pyramid.tile(id, 1)?;
    Ok(OwnedBorders::among(neighbours).where_ground(|column, row| {
        heights.cell_has_ground((column + 1) as usize, (row + 1) as usize)
    }))
}

/// Whether a tile is one of the data's: they are a rectangle, row by row, so the first and the last are its corners.
fn is_among(data_tiles: &[TileId], id: TileId) -> bool {
    let (Some(first), Some(last)) = (data_tiles.first(), data_tiles.last()) else { return false };
    id.z() == first.z()
        && (first.x()..=last.x()).contains(&id.x())
        && (first.y()..=last.y()).contains(&id.y())
}

/// What a finest tile without ground costs the roads on it.
fn lost_roads(
    input: &TileInput<'_>,
    id: TileId,
    log: Option<&RoadLog<'_>>,
    ordinals: &[u32],
) -> Result<Made, BuildError> {
    let bounds = input.levels.frame().tile_lattice_bounds(id);
    let owned = owned_borders(input, id, ordinals)?;
    let mut fates = Vec::new();
    for &ordinal in ordinals {
        let Some(log) = log else { continue };
        fates.push((ordinal, lost_road(&log.load(ordinal)?, &bounds, owned, input.lengths)));
    }
    Ok(Made { kept: None, fates })
}

/// What becomes of a road on a finest tile without ground.
pub(crate) fn lost_road(
    road: &Road,
    bounds: &LatticeBounds,
    owned: OwnedBorders,
    lengths: &TrueLengths<'_>,
) -> RoadFate {
    let segments_um = lengths.segments_um(&road.line);
    let void_um = corniche_drape::clip_parts(&road.line, bounds, owned)
        .iter()
        .flat_map(|part| pieces_um(&road.line, part, &segments_um))
        .map(|[from, to]| to - from)
        .sum();
    RoadFate { kept_um: 0, void_um }
}

/// The roads of one tile as they are laid.
#[derive(Default)]
pub(crate) struct Laid {
    pub(crate) geo: Vec<GeoRoad>,
    pub(crate) sv: Vec<SvRoad>,
    pub(crate) attributes: BTreeMap<i64, RoadRecord>,
    pub(crate) fates: Vec<(u32, RoadFate)>,
    pub(crate) classes: BTreeMap<u8, ClassSums>,
    /// Next part number of each way, GEO and SV.
    parts: BTreeMap<i64, [u32; 2]>,
}

impl Laid {
    pub(crate) fn lay(
        &mut self,
        road: &Road,
        ordinal: u32,
        on: &Ground<'_>,
        levels: &Levels,
        lengths: &TrueLengths<'_>,
    ) {
        let &Ground { id, surface, owned } = on;
        let frame = levels.frame();
        let bounds = frame.tile_lattice_bounds(id);
        let simplified = corniche_roads::simplify(road, levels.simplify_tolerance_steps(id.z()));
        let mut fate = RoadFate::default();
        let sums = self.classes.entry(road.class.number()).or_default();
        sums.source_vertices += points_of_tile(&road.line, id, levels);
        sums.simplified_vertices += points_of_tile(&simplified, id, levels);
        let parts = self.parts.entry(road.way_id).or_default();
        let mut laid = 0;
        // There the line is the source line: nothing is simplified.
        let is_finest = id.z() == frame.max_level();
        let segments_um = if is_finest { lengths.segments_um(&simplified) } else { Vec::new() };
        for part in corniche_drape::clip_parts(&simplified, &bounds, owned) {
            let draped = corniche_drape::drape(&part.line, surface);
            if is_finest {
                let pieces: Vec<[u64; 2]> = pieces_um(&simplified, &part, &segments_um).collect();
                let void_um = gaps_um(&pieces, &draped.gaps);
                fate.void_um += void_um;
                fate.kept_um += pieces.iter().map(|[from, to]| to - from).sum::<u64>() - void_um;
            }
            for line in draped.lines {
                self.geo.push(GeoRoad {
                    way_id: road.way_id,
                    part: parts[0],
                    class: road.class,
                    line,
                });
                parts[0] += 1;
                laid += 1;
            }
        }
        let margin = levels.margin_steps(id.z());
        for part in corniche_drape::clip_closed(&simplified, &bounds.expanded(margin)) {
            for line in corniche_drape::extrude(&part, surface, margin) {
                self.sv.push(SvRoad {
                    way_id: road.way_id,
                    part: parts[1],
                    class: road.class,
                    line,
                });
                parts[1] += 1;
                laid += 1;
            }
        }
        if laid > 0 {
            self.attributes.entry(road.way_id).or_insert_with(|| RoadRecord {
                way_id: road.way_id,
                attributes: road.attributes.clone(),
            });
        }
        if fate != RoadFate::default() {
            self.fates.push((ordinal, fate));
        }
    }

    /// Puts roads into the order in which a payload has them.
    pub(crate) fn sort(&mut self) {
        self.geo.sort_by_key(|road| (road.class, road.way_id, road.part));
        self.sv.sort_by_key(|road| (road.class, road.way_id, road.part));
    }

    fn into_payload(mut self, id: TileId, terrain: Terrain) -> TilePayload {
        self.sort();
        TilePayload {
            id,
            terrain: Some(terrain),
            roads_geo: self.geo,
            roads_sv: self.sv,
            attributes: self.attributes.into_values().collect(),
        }
    }
}

/// How many of a line's points belong to a tile: each point belongs to one tile of a level.
fn points_of_tile(line: &corniche_geom::Polyline, id: TileId, levels: &Levels) -> u64 {
    let last = (1_i64 << id.z()) - 1;
    let own = [i64::from(id.x()), i64::from(id.y())];
    let outer = levels.frame().tile_lattice_bounds(TileId::ROOT);
    let is_own = |&&point: &&corniche_geom::LatticePoint| {
        // The root's own east and south border belong to its last tiles.
        let at = levels.frame().tile_column_row(id.z(), point);
        outer.contains(point) && at.map(|index| index.min(last)) == own
    };
    line.points().iter().filter(is_own).count() as u64
}

/// Adds vertices by class, and each section's stored bytes shared out by the classes' encoded lengths.
fn class_sums(
    mut classes: BTreeMap<u8, ClassSums>,
    payload: &TilePayload,
    encoded: &EncodedTile,
) -> BTreeMap<u8, ClassSums> {
    for road in &payload.roads_geo {
        classes.entry(road.class.number()).or_default().geo_vertices +=
            road.line.vertices.len() as u64;
    }
    for road in &payload.roads_sv {
        classes.entry(road.class.number()).or_default().sv_vertices +=
            road.line.points.len() as u64;
    }
    for class in FunctionalRoadClass::all() {
        let index = usize::from(class.number());
        let shares = [
            share(encoded.roads_geo.stored, &encoded.geo_class_bytes, index),
            share(encoded.roads_sv.stored, &encoded.sv_class_bytes, index),
        ];
        if shares != [0, 0] {
            let sums = classes.entry(class.number()).or_default();
            sums.geo_stored_bytes += shares[0];
            sums.sv_stored_bytes += shares[1];
        }
    }
    classes
}

/// The share of `total` that falls to `parts[index]`, so that all shares add up to `total` exactly.
pub(crate) fn share(total: u64, parts: &[u64; FunctionalRoadClass::COUNT], index: usize) -> u64 {
    let sum: u64 = parts.iter().sum();
    if sum == 0 {
        return 0;
    }
    let up_to = |end: usize| {
        (u128::from(total) * u128::from(parts[..end].iter().sum::<u64>()) / u128::from(sum)) as u64
    };
    up_to(index + 1) - up_to(index)
}

#[cfg(test)]
#[path = "tiles_tests.rs"]
mod tests;
