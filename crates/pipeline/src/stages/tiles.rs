//! Makes each tile's payload from its mesh, its deviation and its roads, and the sums over all tiles.

use std::collections::BTreeMap;

use corniche_drape::{Neighbours, OwnedBorders};
use corniche_geom::TileId;
use corniche_roads::FunctionalRoadClass;
use corniche_store::Artifacts;
use corniche_tileset::{
    EncodedTile, PayloadContext, Terrain, TilePayload, VerticalRecord, pmtiles_order,
};
use corniche_tin::{Placement, Surface};

use super::{
    deviations::TileDeviations,
    mesh::{self, Meshes},
};
use crate::{
    BuildError, Observer, Stage, Storage,
    heights::pyramid::Pyramid,
    levels::Levels,
    roads::{
        lay::{ClassSums, Laid, RoadFate, TileToLayOn, lost_pieces},
        losses::LossFold,
        pieces::TilePieces,
        shares::share,
    },
    storage::Kind,
    storage::Span,
    workers,
};

/// All tiles of a run, and their sums.
pub(crate) struct Tiles {
    /// Payloads in package order.
    pub(crate) payloads: Vec<(TileId, Span)>,
    pub(crate) levels: BTreeMap<u8, LevelSums>,
    /// Sums of roads by level and class.
    pub(crate) classes: BTreeMap<(u8, u8), ClassSums>,
}

/// Sums over the tiles of a level.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct LevelSums {
    pub(crate) tiles: u64,
    pub(crate) vertices: u64,
    pub(crate) triangles: u64,
    pub(crate) terrain_bytes: u64,
    /// Geometric errors of its tiles.
    pub(crate) geometric_errors_m: Vec<f64>,
    /// Geometric errors of its tiles over their deviations, where those can be measured.
    pub(crate) tightness: Vec<f64>,
    pub(crate) uncovered_nodes: u64,
}

/// What every tile needs.
pub(crate) struct TileInput<'a> {
    pub(crate) levels: &'a Levels,
    pub(crate) meshes: &'a Meshes,
    pub(crate) deviations: &'a TileDeviations,
    pub(crate) pyramid: &'a Pyramid<'a>,
    /// The finest tiles on which the data's rectangle lies.
    pub(crate) data_tiles: &'a [TileId],
    /// Holds the pieces of roads.
    pub(crate) pieces: &'a dyn Artifacts,
    pub(crate) storage: &'a dyn Storage,
    pub(crate) threads: usize,
}

/// A tile as a worker made it.
struct Made {
    /// `None` where there is no ground, and so no payload.
    kept: Option<Kept>,
    fates: Vec<(u32, RoadFate)>,
}

/// A payload in storage, and its counts.
struct Kept {
    span: Span,
    vertices: u64,
    triangles: u64,
    terrain_bytes: u64,
    classes: BTreeMap<u8, ClassSums>,
}

/// Makes and keeps all payloads. What becomes of roads goes to `fates`; without it there are no roads.
pub(crate) fn make(
    input: &TileInput<'_>,
    mut fates: Option<&mut LossFold<'_>>,
    observer: &dyn Observer,
) -> Result<Tiles, BuildError> {
    let mut ids: Vec<TileId> = input.meshes.keys().copied().collect();
    if fates.is_some() {
        // Roads on tiles of the data without any ground are lost there, and counted there.
        ids.extend(input.data_tiles.iter().filter(|id| !input.meshes.contains_key(id)));
    }
    ids.sort_unstable_by_key(|&id| pmtiles_order(id));
    observer.begin(Stage::Tiles, Some(ids.len() as u64));
    let mut tiles =
        Tiles { payloads: Vec::new(), levels: BTreeMap::new(), classes: BTreeMap::new() };
    workers::in_order_unless_cancelled(
        observer,
        input.threads,
        ids.len(),
        || Ok(()),
        |(), index| make_tile(input, ids[index]),
        |index, made| {
            tiles.add(ids[index], &made, input);
            if let Some(fates) = &mut fates {
                fates.add(&made.fates)?;
            }
            observer.advance(Stage::Tiles, 1);
            Ok(())
        },
    )?;
    observer.end(Stage::Tiles);
    Ok(tiles)
}

impl Tiles {
    fn add(&mut self, id: TileId, made: &Made, input: &TileInput<'_>) {
        if let Some(kept) = &made.kept {
            self.payloads.push((id, kept.span));
            let deviation = input.deviations.of(id);
            let level = self.levels.entry(id.z()).or_default();
            level.tiles += 1;
            level.vertices += kept.vertices;
            level.triangles += kept.triangles;
            level.terrain_bytes += kept.terrain_bytes;
            level.geometric_errors_m.push(deviation.geometric_error_m);
            let least_m = VerticalRecord::least_measured_error_m(input.levels.quantum_m());
            if deviation.deviation_m >= least_m {
                level.tightness.push(deviation.geometric_error_m / deviation.deviation_m);
            }
            level.uncovered_nodes += deviation.uncovered_nodes;
            for (&class, counted) in &kept.classes {
                self.classes.entry((id.z(), class)).or_default().merge(counted);
            }
        }
    }
}

fn make_tile(input: &TileInput<'_>, id: TileId) -> Result<Made, BuildError> {
    let levels = input.levels;
    let frame = levels.frame();
    let pieces = TilePieces::load(input.pieces, id)?;
    let owned = owned_borders(input, id, &pieces)?;
    let Some(span) = input.meshes.get(&id) else {
        let bounds = frame.tile_lattice_bounds(id);
        return Ok(Made { kept: None, fates: lost_pieces(&pieces, &bounds, owned) });
    };
    let meshed = mesh::load(input.storage, id, *span)?;
    let surface = Surface::new(&meshed.tin, Placement::of_tile(frame, id, levels.quantum_m()));
    let on = TileToLayOn { id, surface: &surface, owned };
    let mut laid = Laid::of_tile(&pieces, &on, levels);
    let fates = std::mem::take(&mut laid.fates);
    let laid_classes = std::mem::take(&mut laid.classes);
    let deviation = input.deviations.of(id);
    let counts = (meshed.tin.vertices().len() as u64, meshed.tin.triangles().len() as u64);
    let terrain = Terrain {
        tin: meshed.tin,
        normals: meshed.normals,
        geometric_error_m: deviation.geometric_error_m,
        height_range_m: deviation.height_range_m,
        uncovered_nodes: deviation.uncovered_nodes,
    };
    let payload = laid.into_payload(id, terrain);
    let context = PayloadContext { frame: *frame, quantum_m: levels.quantum_m() };
    let encoded = corniche_tileset::encode(&payload, &context)?;
    let classes = class_sums(laid_classes, &payload, &encoded);
    let span = input.storage.append(Kind::Payloads, &encoded.bytes).map_err(BuildError::Storage)?;
    let (vertices, triangles) = counts;
    let kept =
        Kept { span, vertices, triangles, terrain_bytes: encoded.sizes.terrain.stored, classes };
    Ok(Made { kept: Some(kept), fates })
}

/// What the tile owns of its borders, by the ground on both sides of them.
///
/// A neighbour for which no roads are laid (beside the data, or without ground above the finest level) owns nothing.
fn owned_borders(
    input: &TileInput<'_>,
    id: TileId,
    pieces: &TilePieces,
) -> Result<OwnedBorders, BuildError> {
    if pieces.roads.is_empty() {
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

/// Whether a tile is one of the data's tiles. These are a rectangle, listed row by row, so the first and the last are its
/// corners.
fn is_among(data_tiles: &[TileId], id: TileId) -> bool {
    let (Some(first), Some(last)) = (data_tiles.first(), data_tiles.last()) else { return false };
    id.z() == first.z()
        && (first.x()..=last.x()).contains(&id.x())
        && (first.y()..=last.y()).contains(&id.y())
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
            share(encoded.sizes.roads_geo.stored, &encoded.sizes.geo_class_bytes, index),
            share(encoded.sizes.roads_sv.stored, &encoded.sizes.sv_class_bytes, index),
        ];
        if shares != [0, 0] {
            let sums = classes.entry(class.number()).or_default();
            sums.geo_stored_bytes += shares[0];
            sums.sv_stored_bytes += shares[1];
        }
    }
    classes
}
