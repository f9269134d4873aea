//! Pieces of roads out of tiles.

use std::collections::HashMap;

use corniche_drape::{DrapedLine, DrapedVertex};
use corniche_geom::{Bounds, GridFrame, TileId};
use corniche_roads::FunctionalRoadClass;
use corniche_tileset::{
    DecodeError, FilePackage, GeoRoad, Manifest, Sections, SpanRun, TilePayload, pmtiles_order,
};
use corniche_tin::Surface;

use crate::{
    between_samples::SampleCells,
    bounds::DegreeBounds,
    error::{SelectionError, TileError},
    piece::{Piece, PieceHeights, PieceKey, Vertex},
};

/// What pieces of roads are read from.
pub(crate) fn road_sections() -> Sections {
    Sections::ROADS_GEO | Sections::ATTRIBUTES
}

/// Positions along each side of a tile that tell where it is: enough for tiles that the CRS bends.
const SIDE: usize = 9;

/// The level that is asked for, if the package has it; else the finest.
pub(crate) fn level(package: &FilePackage, wanted: Option<u8>) -> Result<u8, SelectionError> {
    let finest = package.manifest().frame.max_level();
    let level = wanted.unwrap_or(finest);
    if level > finest {
        let package = package.path().to_path_buf();
        return Err(SelectionError::NoLevel { package, level, finest });
    }
    Ok(level)
}

/// The tiles of a level that may hold roads of the bounds, in the package's order.
pub(crate) fn tiles(
    package: &FilePackage,
    level: u8,
    bounds: Option<&DegreeBounds>,
) -> Result<Vec<TileId>, TileError> {
    let manifest = package.manifest();
    let mut ids = package.tile_ids()?;
    ids.retain(|&id| {
        id.z() == level && bounds.is_none_or(|bounds| bounds.may_meet(&places_deg(manifest, id)))
    });
    Ok(ids)
}

/// Whether the part of a tile on which data can lie and the bounds have a place in common: a side of the tile goes through the bounds, or they lie within the tile.
pub(crate) fn meets(manifest: &Manifest, id: TileId, bounds: &DegreeBounds) -> bool {
    let tile = data_part(manifest, id);
    let last = SIDE - 1;
    let around = (0..=4 * last).map(|k| {
        let share = (k % last) as f64 / last as f64;
        let [across, along] = match k / last % 4 {
            0 => [share, 0.0],
            1 => [1.0, share],
            2 => [1.0 - share, 1.0],
            _ => [0.0, 1.0 - share],
        };
        let at = [tile.min_x + tile.width() * across, tile.min_y + tile.height() * along];
        manifest.coordinates.wgs84_from_working(at)
    });
    let around: Vec<[f64; 2]> = around.collect();
    around.windows(2).any(|ends| !bounds.inside(ends[0], ends[1]).is_empty())
        || manifest
            .coordinates
            .working_from_wgs84(bounds.middle())
            .is_some_and(|middle| tile.contains(middle))
}

/// The part of a tile on which data can lie. The table of coordinates reaches little beyond the data: of small ones a tile is many times as wide, and
/// places far outside would come out anywhere.
pub(crate) fn data_part(manifest: &Manifest, id: TileId) -> Bounds {
    manifest.frame.tile_bounds(id).intersection(&manifest.data_bounds)
}

/// Longitudes and latitudes over the part of a tile on which data can lie.
pub(crate) fn places_deg(manifest: &Manifest, id: TileId) -> Vec<[f64; 2]> {
    let tile = data_part(manifest, id);
    let share = |k: usize| k as f64 / (SIDE - 1) as f64;
    (0..SIDE * SIDE)
        .map(|k| {
            [
                tile.min_x + tile.width() * share(k % SIDE),
                tile.min_y + tile.height() * share(k / SIDE),
            ]
        })
        .map(|position| manifest.coordinates.wgs84_from_working(position))
        .collect()
}

/// The pieces of one tile whose class is wanted.
pub(crate) fn pieces(
    package: &FilePackage,
    id: TileId,
    classes: &[FunctionalRoadClass],
) -> Result<Vec<Piece>, TileError> {
    let payload = package.payload(id, road_sections())?;
    payload.map_or(Ok(Vec::new()), |payload| pieces_of(&payload, package.manifest(), classes))
}

/// The same, with what the package knows of the distance of their lines from the elevation data.
pub(crate) fn bounded_pieces(
    package: &FilePackage,
    id: TileId,
    classes: &[FunctionalRoadClass],
) -> Result<Vec<Piece>, TileError> {
    let Some(payload) = package.payload(id, road_sections())? else { return Ok(Vec::new()) };
    let (manifest, Some(terrain)) = (package.manifest(), &payload.terrain) else {
        return Ok(Vec::new());
    };
    let surface = manifest.surface(id, &terrain.tin);
    let mut pieces = pieces_on(&surface, &payload, manifest, classes)?;
    let cells = SampleCells::of(manifest, id.z());
    let mut cells = cells.as_ref().map(|cells| cells.on_tile(&surface, terrain.geometric_error_m));
    for piece in &mut pieces {
        piece.heights.tolerance_m = cells.as_mut().map(|cells| cells.bound_m(&piece.vertices));
    }
    Ok(pieces)
}

/// What one tile holds of a layer, which `decode` finds in its bytes.
pub(crate) fn layer<T>(
    package: &FilePackage,
    id: TileId,
    layer: &'static str,
    decode: impl FnOnce(&[u8]) -> Result<Vec<T>, DecodeError>,
) -> Result<Vec<T>, TileError> {
    let Some(bytes) = package.tile(id)? else { return Ok(Vec::new()) };
    decode(&bytes).map_err(|source| TileError::Damaged { layer, source: Box::new(source) })
}

/// The runs of bridges and tunnels of one tile by their ways; none in a package that was built without.
pub(crate) fn span_runs(
    package: &FilePackage,
    id: TileId,
) -> Result<HashMap<i64, Vec<SpanRun>>, TileError> {
    let mut runs: HashMap<i64, Vec<SpanRun>> = HashMap::new();
    let manifest = package.manifest();
    if manifest.spans.is_none() {
        return Ok(runs);
    }
    let runs_of = |bytes: &[u8]| manifest.decode_spans(bytes, id);
    for run in layer(package, id, "bridges and tunnels", runs_of)? {
        runs.entry(run.way_id).or_default().push(run);
    }
    Ok(runs)
}

/// The same pieces of a payload that was read with [`road_sections`].
pub(crate) fn pieces_of(
    payload: &TilePayload,
    manifest: &Manifest,
    classes: &[FunctionalRoadClass],
) -> Result<Vec<Piece>, TileError> {
    let Some(terrain) = &payload.terrain else { return Ok(Vec::new()) };
    pieces_on(&manifest.surface(payload.id, &terrain.tin), payload, manifest, classes)
}

fn pieces_on(
    surface: &Surface,
    payload: &TilePayload,
    Manifest { frame, .. }: &Manifest,
    classes: &[FunctionalRoadClass],
) -> Result<Vec<Piece>, TileError> {
    let id = payload.id;
    let mut pieces = Vec::new();
    for road in payload.roads_geo.iter().filter(|road| classes.contains(&road.class)) {
        let known = payload.attributes.binary_search_by_key(&road.way_id, |record| record.way_id);
        let attributes = known
            .ok()
            .and_then(|at| payload.attributes.get(at))
            .ok_or(TileError::NoAttributes { tile: id, way_id: road.way_id })?;
        let vertices =
            vertices(&road.line, surface).map_err(|source| TileError::Line { tile: id, source })?;
        pieces.push(Piece {
            key: PieceKey { way_id: road.way_id, tile: pmtiles_order(id), part: road.part, cut: 0 },
            class: road.class,
            attributes: attributes.attributes.clone(),
            goes_on: goes_on(road, frame, id),
            heights: PieceHeights {
                tolerance_m: None,
                ground_m: None,
                on_deck: false,
                has_deck: false,
            },
            vertices,
        });
    }
    Ok(pieces)
}

/// The vertices of a line on the ground of a tile.
pub(crate) fn vertices(
    line: &DrapedLine,
    surface: &Surface,
) -> Result<Vec<Vertex>, corniche_drape::BadLine> {
    let positions = corniche_drape::positions(line, surface)?;
    let vertices = positions.into_iter().zip(&line.vertices);
    Ok(vertices
        .map(|([u, v, z_m], vertex)| Vertex {
            at: [u, v],
            z_m,
            is_source: matches!(vertex, DrapedVertex::Source { .. }),
        })
        .collect())
}

/// Whether the ends of a line are points on its tile's border. A line that ends where the ground ends has no such point.
fn goes_on(road: &GeoRoad, frame: &GridFrame, id: TileId) -> [bool; 2] {
    let tile = frame.tile_lattice_bounds(id);
    let vertices = &road.line.vertices;
    [vertices.first(), vertices.last()].map(|vertex| match vertex {
        Some(DrapedVertex::Source { point, .. }) => tile.has_on_border(*point),
        _ => false,
    })
}
