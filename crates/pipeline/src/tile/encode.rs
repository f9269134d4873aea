//! Encodes a tile's ground and roads as its payload.

use std::collections::BTreeMap;

use corniche_drape::{Neighbours, OwnedBorders};
use corniche_geom::{HeightGrid, TILE_NODES, TileId};
use corniche_ground::{heights::rasters, photos::textures};
use corniche_pieces::{
    layers::{
        extract_layers,
        tile_section::{SectionOfTile, TileSection},
    },
    roads::{
        ground_lines,
        lay::{ClassSums, DrapedRoads, TileToLayOn, lost_pieces},
        pieces::TilePieces,
        proportions::share,
    },
};
use corniche_roads::FunctionalRoadClass;
use corniche_spec::artifacts::ArtifactKind;
use corniche_tileset::{
    EncodedTile, PayloadContext, PayloadSizes, Relief, TilePayload, TileTerrain,
};
use corniche_tin::Surface;

use super::{
    mesh::Meshed,
    record::{GroundRecord, TileDeviation, TileRecord},
};
use crate::{BuildError, context::BuildContext};

/// Drapes a tile's roads on its ground, encodes both and stores the payload. The record lacks only
/// the values about levels, which come from finest tiles.
///
/// `earlier` is a payload with this ground, if there is one. `owned` returns the borders that the
/// tile owns; it is called only if there are roads.
pub(crate) fn with_ground(
    context: &BuildContext<'_>,
    id: TileId,
    (meshed, relief): (Meshed, Option<Relief>),
    deviation: TileDeviation,
    earlier: Option<&[u8]>,
    owned: impl FnOnce() -> Result<OwnedBorders, BuildError>,
) -> Result<TileRecord, BuildError> {
    let levels = context.levels;
    let frame = context.frame();
    let pieces = TilePieces::load(context.store, id, context.settings.layers.len())?;
    let mut laid = if pieces.is_empty() {
        DrapedRoads::default()
    } else {
        let surface = Surface::of_tile(&meshed.tin, frame, id, levels.quantum_m());
        let clip = context.clip();
        let spans = context.settings.roads.spans;
        let lengths = &context.lengths();
        let on = TileToLayOn { id, surface: &surface, owned: owned()?, clip, spans, lengths };
        DrapedRoads::of_tile(&pieces, &on, levels)
    };
    let fates = std::mem::take(&mut laid.fates);
    ground_lines::put(&laid.ground_lines, context.store, id)?;
    let laid_classes = std::mem::take(&mut laid.classes);
    let (vertices, triangles) =
        (meshed.tin.vertices().len() as u64, meshed.tin.triangles().len() as u64);
    let terrain = TileTerrain {
        tin: meshed.tin,
        normals: meshed.normals,
        geometric_error_m: deviation.geometric_error_m,
        height_range_m: deviation.height_range_m,
        uncovered_nodes: deviation.uncovered_nodes,
    };
    let payload = TilePayload { relief, ..laid.into_payload(id, terrain) };
    let encoding = PayloadContext {
        frame: *frame,
        quantum_m: levels.quantum_m(),
        metres_per_unit: context.grid.metres_per_unit,
    };
    let mut builder = corniche_tileset::encode_sections(&payload, &encoding, earlier)?;
    if let Some(photo) = textures::of_tile(context.textures(), id, earlier)? {
        builder.add(photo)?;
    }
    let mut layers = vec![SectionOfTile::default(); context.settings.layers.len()];
    for (layer, own) in extract_layers(layers.len()).zip(&mut layers) {
        if let Some(TileSection { section, parts, points }) =
            TileSection::get(layer, context.store, id)?
        {
            builder.add(layer.section_of(section))?;
            *own = SectionOfTile { parts, points, bytes: 0 };
        }
    }
    let EncodedTile { bytes, sizes } = builder.seal()?;
    for (own, size) in layers.iter_mut().zip(&sizes.layers) {
        own.bytes = size.stored;
    }
    context.store.put(ArtifactKind::Payload.of_tile(id), &bytes)?;
    Ok(TileRecord {
        ground: Some(GroundRecord {
            vertices,
            triangles,
            terrain_bytes: sizes.terrain.stored,
            relief_bytes: sizes.relief.stored,
            photo_bytes: sizes.photo.stored,
            layers,
            deviation,
        }),
        classes: class_sums(laid_classes, &payload, &sizes),
        fates,
        levels: Vec::new(),
    })
}

/// Returns the record of a finest tile without ground: its roads are lost there. `owned` returns
/// the borders that the tile owns; it is called only if there are roads.
pub(crate) fn without_ground(
    context: &BuildContext<'_>,
    id: TileId,
    owned: impl FnOnce() -> Result<OwnedBorders, BuildError>,
) -> Result<TileRecord, BuildError> {
    // Lines of layers need ground.
    let pieces = TilePieces::load(context.store, id, 0)?;
    let mut record = TileRecord::default();
    if pieces.roads.is_empty() {
        return Ok(record);
    }
    let bounds = context.frame().tile_lattice_bounds(id);
    record.fates = lost_pieces(&pieces, &bounds, owned()?, context.clip(), &context.lengths());
    Ok(record)
}

/// The borders that the tile owns, derived from the heights on both sides. `with_halo` has one node
/// of halo on every side, and is `None` if no node has a height.
pub(crate) fn owned_by_heights(
    context: &BuildContext<'_>,
    id: TileId,
    with_halo: Option<&HeightGrid>,
) -> Result<OwnedBorders, BuildError> {
    let neighbours = neighbours(context, id, |other| has_ground(context, other))?;
    Ok(OwnedBorders::among(neighbours).where_ground(|column, row| {
        with_halo.is_some_and(|heights| {
            heights.cell_has_ground((column + 1) as usize, (row + 1) as usize)
        })
    }))
}

/// The neighbours that have roads, so that they may own a border: on the finest level those on the
/// data, on other levels those with ground.
pub(crate) fn neighbours(
    context: &BuildContext<'_>,
    id: TileId,
    has_ground: impl Fn(TileId) -> Result<bool, BuildError>,
) -> Result<Neighbours, BuildError> {
    let is_asked = |east, south| match id.neighbour(east, south) {
        Some(other) if id.z() == context.frame().max_level() => Ok(context.data().contains(other)),
        Some(other) => has_ground(other),
        None => Ok(false),
    };
    Ok(Neighbours { east: is_asked(1, 0)?, south: is_asked(0, 1)? })
}

/// Whether a coarse tile has ground: a cell with a height at each corner. The raster is used, in
/// case the TIN is created in another part.
fn has_ground(context: &BuildContext<'_>, id: TileId) -> Result<bool, BuildError> {
    let Some(raster) = rasters::get(context.store, &context.data(), id)? else { return Ok(false) };
    Ok((0..TILE_NODES - 1)
        .any(|row| (0..TILE_NODES - 1).any(|column| raster.cell_has_ground(column, row))))
}

/// Adds vertices by class, and distributes each section's stored bytes in proportion to the
/// classes' encoded lengths.
fn class_sums(
    mut classes: BTreeMap<u8, ClassSums>,
    payload: &TilePayload,
    sizes: &PayloadSizes,
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
            share(sizes.roads_geo.stored, &sizes.geo_class_bytes, index),
            share(sizes.roads_sv.stored, &sizes.sv_class_bytes, index),
        ];
        if shares != [0, 0] {
            let sums = classes.entry(class.number()).or_default();
            sums.geo_stored_bytes += shares[0];
            sums.sv_stored_bytes += shares[1];
        }
    }
    classes
}
