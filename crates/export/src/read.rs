//! Reads pieces of roads from tiles.

use std::collections::HashMap;

use corniche_drape::{DrapedLine, DrapedVertex};
use corniche_geom::{Bounds, GridFrame, TileId};
use corniche_roads::FunctionalRoadClass;
use corniche_tileset::{
    FilePackage, GeoRoad, Manifest, ReadError, Sections, SpanRun, TilePayload, pmtiles_order,
};
use corniche_tin::Surface;

use crate::{
    between_samples::TileCells,
    bounds::DegreeBounds,
    error::{SelectionError, TileError},
    piece::{PieceHeights, PieceKey, Vertex, WayPiece},
};

/// The payload sections from which pieces of roads are read.
pub(crate) fn road_sections() -> Sections {
    Sections::ROADS_GEO | Sections::ATTRIBUTES
}

/// The payload sections from which the ground of a tile is read, with the lines of its roads or its
/// relief if requested.
pub(crate) fn ground_sections(has_lines: bool, has_relief: bool) -> Sections {
    let lines = if has_lines { road_sections() } else { Sections::TERRAIN };
    let relief = if has_relief { Sections::RELIEF } else { Sections::TERRAIN };
    Sections::TERRAIN | lines | relief
}

/// Positions along each side of a tile that determine its extent: enough for tiles that the CRS
/// bends.
const SIDE: usize = 9;

/// Returns the requested level if the package has it; by default the finest.
pub(crate) fn level(package: &FilePackage, wanted: Option<u8>) -> Result<u8, SelectionError> {
    let finest = package.manifest().frame.max_level();
    let level = wanted.unwrap_or(finest);
    if level > finest {
        let package = package.path().to_path_buf();
        return Err(SelectionError::NoLevel { package, level, finest });
    }
    Ok(level)
}

/// Returns the tiles of a level that may contain roads inside the bounds, in the package's order.
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

/// Whether the bounds share a place with the part of a tile that can have data: a side of the tile
/// passes through the bounds, or the bounds are within the tile.
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
        place_deg(manifest, &tile, [across, along])
    });
    let around: Vec<[f64; 2]> = around.collect();
    around.windows(2).any(|ends| !bounds.inside(ends[0], ends[1]).is_empty())
        || manifest
            .coordinates
            .working_from_wgs84(bounds.middle())
            .is_some_and(|middle| tile.contains(middle))
}

/// Returns the part of a tile that can have data. The coordinate table extends little beyond the
/// data: a tile can be many times as wide as small data, and places far outside would be
/// transformed to anywhere.
pub(crate) fn data_part(manifest: &Manifest, id: TileId) -> Bounds {
    manifest.frame.tile_bounds(id).intersection(&manifest.data_bounds)
}

/// Longitudes and latitudes over the part of a tile that can have data.
pub(crate) fn places_deg(manifest: &Manifest, id: TileId) -> Vec<[f64; 2]> {
    let tile = data_part(manifest, id);
    let share = |k: usize| k as f64 / (SIDE - 1) as f64;
    let places = (0..SIDE * SIDE).map(|k| [share(k % SIDE), share(k / SIDE)]);
    places.map(|shares| place_deg(manifest, &tile, shares)).collect()
}

/// Returns the place at shares of a rectangle's sides, from the west and from the south.
fn place_deg(manifest: &Manifest, tile: &Bounds, [across, along]: [f64; 2]) -> [f64; 2] {
    let at = [tile.min_x + tile.width() * across, tile.min_y + tile.height() * along];
    manifest.coordinates.wgs84_from_working(at)
}

/// Returns the pieces of one tile that have a requested class; see [`pieces_of`].
pub(crate) fn pieces(
    package: &FilePackage,
    id: TileId,
    classes: &[FunctionalRoadClass],
    is_bounded: bool,
) -> Result<Vec<WayPiece>, TileError> {
    let payload = package.payload(id, road_sections())?;
    payload.map_or(Ok(Vec::new()), |payload| {
        pieces_of(&payload, package.manifest(), classes, is_bounded)
    })
}

/// Returns the [`pieces`] of roads of all classes.
pub(crate) fn all_pieces(package: &FilePackage, id: TileId) -> Result<Vec<WayPiece>, TileError> {
    let classes: Vec<FunctionalRoadClass> = FunctionalRoadClass::all().collect();
    pieces(package, id, &classes, false)
}

/// Returns the runs of roads on bridges and in tunnels of one tile by way; none if the package was
/// built without them.
pub(crate) fn span_runs(
    package: &FilePackage,
    id: TileId,
) -> Result<HashMap<i64, Vec<SpanRun>>, TileError> {
    let mut runs: HashMap<i64, Vec<SpanRun>> = HashMap::new();
    let manifest = package.manifest();
    if manifest.spans.is_some()
        && let Some(bytes) = package.tile(id)?
    {
        let all = manifest.decode_spans(&bytes, id).map_err(ReadError::from)?;
        for run in all.into_iter().filter(|run| run.owner.layer().is_none()) {
            runs.entry(run.way_id).or_default().push(run);
        }
    }
    Ok(runs)
}

/// Returns the [`pieces`] of a payload that was read with [`road_sections`]; with `is_bounded`,
/// including the package's bounds for the distance of the lines from the elevation data.
pub(crate) fn pieces_of(
    payload: &TilePayload,
    manifest: &Manifest,
    classes: &[FunctionalRoadClass],
    is_bounded: bool,
) -> Result<Vec<WayPiece>, TileError> {
    let Some(terrain) = &payload.terrain else { return Ok(Vec::new()) };
    let id = payload.id;
    let surface = manifest.surface(id, &terrain.tin);
    let mut cells = TileCells::from_level(manifest, id.z(), &surface, terrain.geometric_error_m)
        .filter(|_| is_bounded);
    let mut pieces = Vec::new();
    for road in payload.roads_geo.iter().filter(|road| classes.contains(&road.class)) {
        let way_id = road.way_id;
        let known = payload.attributes.binary_search_by_key(&way_id, |record| record.way_id);
        let known = known.map_err(|_| TileError::NoAttributes { tile: id, way_id })?;
        let failed = |source| TileError::Line { tile: id, source };
        let vertices = vertices(&road.line, &surface).map_err(failed)?;
        let tolerance_m = cells.as_mut().map(|cells| cells.bound_m(&vertices));
        pieces.push(WayPiece {
            key: PieceKey { way_id, tile: pmtiles_order(id), part: road.part, cut: 0 },
            class: road.class,
            attributes: payload.attributes[known].attributes.clone(),
            goes_on: goes_on(road, &manifest.frame, id),
            heights: PieceHeights { tolerance_m, ..PieceHeights::default() },
            vertices,
        });
    }
    Ok(pieces)
}

/// Returns the vertices of a line on the ground of a tile.
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

/// Whether the ends of a line are points on its tile's border. A line that ends where the ground
/// ends has no point on the border.
fn goes_on(road: &GeoRoad, frame: &GridFrame, id: TileId) -> [bool; 2] {
    let tile = frame.tile_lattice_bounds(id);
    let vertices = &road.line.vertices;
    [vertices.first(), vertices.last()].map(|vertex| match vertex {
        Some(DrapedVertex::Source { point, .. }) => tile.has_on_border(*point),
        _ => false,
    })
}
