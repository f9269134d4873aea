//! `corniche tile`: prints one decoded tile, for other tools that check packages.

use corniche_geom::{Bounds, LatticePoint, NodeIndex, TileId};
use corniche_tileset::{
    FilePackage, GeoRoad, LayerObject, Manifest, Sections, SpanPoint, SpanRun, SvRoad, TilePayload,
    TileTerrain,
};
use corniche_tin::Surface;

use crate::{
    args::{DumpCoordinates, TileArgs},
    documents::{
        layers::tile_layers,
        spans::TileSpanDocument,
        tile::{
            GeoRoadDocument, StreamedList, SvRoadDocument, TileDocument, TinDocument, WayDocument,
            normal,
        },
    },
    failure::{CommandFailure, Result},
    messages, packages,
    table::{Digits, Table},
};

pub(crate) fn run(args: &TileArgs) -> Result<()> {
    let package = packages::open(&args.from.package)?;
    let payload = match (args.id, args.at) {
        (Some(id), _) => package.payload(id, Sections::ALL)?.ok_or_else(|| no_tile(args, id))?,
        (None, Some(at)) => payload_at(args, &package, at)?,
        // The parser requires one of them.
        (None, None) => refuse!("name a tile: Z/X/Y, or --at LON,LAT"),
    };
    let layers = TileLayers::read(&package, payload.id)?;
    if args.json {
        let document = document(package.manifest(), &payload, layers, args.coordinates)?;
        messages::answer_document(&document)?;
    } else {
        let digits = Digits::of_answers();
        messages::answer(&to_text(package.manifest(), &payload, &layers, digits))?;
    }
    Ok(())
}

/// The layers of a tile that are read separately.
struct TileLayers {
    /// The objects of each layer of the package.
    layers: Vec<Vec<LayerObject>>,
    spans: Vec<SpanRun>,
}

impl TileLayers {
    fn read(package: &FilePackage, id: TileId) -> Result<Self> {
        let bytes = package.tile(id).map_err(CommandFailure::unusable)?.unwrap_or_default();
        let manifest = package.manifest();
        let layers = manifest.layers().map(|(slot, _)| manifest.decode_layer(&bytes, id, slot));
        let layers = layers.collect::<Result<_, _>>().map_err(CommandFailure::unusable)?;
        let spans = manifest.decode_spans(&bytes, id).map_err(CommandFailure::unusable)?;
        Ok(Self { layers, spans })
    }
}

fn no_tile(args: &TileArgs, id: TileId) -> CommandFailure {
    let package = args.from.package.name();
    unusable!("{package:?} has no tile {id}; list its tiles with corniche info --json")
}

/// The tile at a position, of the requested level or of the finest one that has a tile there.
fn payload_at(
    args: &TileArgs,
    package: &FilePackage,
    [lon_deg, lat_deg]: [f64; 2],
) -> Result<TilePayload> {
    let manifest = package.manifest();
    let finest = manifest.frame.max_level();
    if let Some(level) = args.level.filter(|&level| level > finest) {
        refuse!("--level {level} does not exist: the finest level is {finest}");
    }
    let levels = args.level.map_or(0..=finest, |level| level..=level);
    for level in levels.rev() {
        let Some((id, point)) = tile_at(manifest, level, [lon_deg, lat_deg]) else { continue };
        // A tile at the edge extends beyond the data.
        if !lies_in_data(manifest, point) {
            break;
        }
        let Some(payload) = package.payload(id, Sections::ALL)? else { continue };
        if args.level.is_none() && level < finest {
            note!(
                "there is no tile of level {finest} at this position; tile {id} is the finest one"
            );
        }
        if !has_ground(manifest, &payload, point) {
            note!(
                "tile {id} has no ground at this position, which is in a void or beyond the edge of the data"
            );
        }
        return Ok(payload);
    }
    Err(CommandFailure::unusable(no_tile_at(args, manifest, [lon_deg, lat_deg])))
}

/// The error for a position without a tile: the reason, and what to do.
fn no_tile_at(args: &TileArgs, manifest: &Manifest, [lon_deg, lat_deg]: [f64; 2]) -> String {
    let package = args.from.package.name();
    let on = args.level.map_or_else(String::new, |level| format!(" on level {level}"));
    let place = format!("longitude {lon_deg}, latitude {lat_deg}");
    if manifest.covers_deg([lon_deg, lat_deg]) {
        let coarser = if args.level.is_some() { "omit --level, or " } else { "" };
        return format!(
            "{package:?} has no tile{on} at {place}: the data has a void there; {coarser}choose another position \
             (corniche info --json lists the tiles)"
        );
    }
    let covered = manifest.covered_text([lon_deg, lat_deg]);
    format!("{package:?} has no ground{on} at {place}; {covered}")
}

/// Whether a point is in the rectangle of the data, with a tolerance of one cell.
fn lies_in_data(manifest: &Manifest, point: LatticePoint) -> bool {
    let [low, high] = manifest.data_nodes();
    let around =
        [NodeIndex { i: low.i - 1, j: low.j - 1 }, NodeIndex { i: high.i + 1, j: high.j + 1 }];
    manifest.frame.lattice_bounds(around).contains(point)
}

/// Whether a tile's triangles cover a point.
fn has_ground(manifest: &Manifest, payload: &TilePayload, point: LatticePoint) -> bool {
    payload
        .terrain
        .as_ref()
        .is_some_and(|terrain| manifest.surface(payload.id, &terrain.tin).locate(point).is_some())
}

/// The tile of a level that contains a position, and the position on the lattice; `None` outside
/// the root tile.
fn tile_at(
    manifest: &Manifest,
    level: u8,
    [lon_deg, lat_deg]: [f64; 2],
) -> Option<(TileId, LatticePoint)> {
    // Longitudes of a package may continue past 180.
    [0.0, 360.0, -360.0].into_iter().find_map(|turn| {
        let position = manifest.coordinates.working_from_wgs84([lon_deg + turn, lat_deg])?;
        let point = manifest.frame.snap(position)?;
        let [column, row] = manifest.frame.tile_column_row(level, point);
        let id = TileId::new(level, u32::try_from(column).ok()?, u32::try_from(row).ok()?).ok()?;
        Some((id, point))
    })
}

fn to_text(
    manifest: &Manifest,
    payload: &TilePayload,
    layers: &TileLayers,
    digits: Digits,
) -> String {
    let mut table = Table::new(["tile", &payload.id.to_string()]);
    let count = |number: usize| digits.count(number as u64);
    if let Some(terrain) = &payload.terrain {
        table.row(["vertices".into(), count(terrain.tin.vertices().len())]);
        table.row(["triangles".into(), count(terrain.tin.triangles().len())]);
        table.row(["geometric error".into(), format!("{:.3} m", terrain.geometric_error_m)]);
        let [low, high] = terrain.height_range_m;
        table.row(["heights".into(), format!("{low:.1} to {high:.1} m")]);
    }
    table.row(["GEO lines".into(), count(payload.roads_geo.len())]);
    let vertices = payload.roads_geo.iter().map(|road| road.line.vertices.len()).sum();
    table.row(["GEO vertices".into(), count(vertices)]);
    table.row(["SV lines".into(), count(payload.roads_sv.len())]);
    table.row(["OSM ways".into(), count(payload.attributes.len())]);
    let ids = manifest.layers.iter().map(|layer| layer.table.id.as_str());
    let named = ids.zip(layers.layers.iter().map(Vec::len)).chain([("spans", layers.spans.len())]);
    for (name, number) in named.filter(|(_, number)| *number > 0) {
        table.row([name.into(), count(number)]);
    }
    table.to_text()
}

/// Converts working metres and lattice points to coordinates of one kind.
#[derive(Clone, Copy)]
struct Places<'a> {
    manifest: &'a Manifest,
    /// The divisor of working metres.
    unit: [f64; 2],
}

impl Places<'_> {
    fn coordinates_at(self, [x, y]: [f64; 2]) -> [f64; 2] {
        [x / self.unit[0], y / self.unit[1]]
    }

    fn of_point(self, point: LatticePoint) -> [f64; 2] {
        self.coordinates_at(self.manifest.frame.position_m(point))
    }

    fn with_height(self, position: [f64; 2], height_m: f64) -> [f64; 3] {
        let [x, y] = self.coordinates_at(position);
        [x, y, height_m]
    }
}

fn document<'a>(
    manifest: &'a Manifest,
    payload: &'a TilePayload,
    layers: TileLayers,
    coordinates: DumpCoordinates,
) -> Result<TileDocument<'a>> {
    let frame = &manifest.frame;
    let id = payload.id;
    let (word, unit) = match coordinates {
        DumpCoordinates::Working => ("working", [1.0; 2]),
        DumpCoordinates::Crs => ("crs", manifest.metres_per_unit),
    };
    let places = Places { manifest, unit };
    let Bounds { min_x, min_y, max_x, max_y } = frame.tile_bounds(id);
    // If an axis is reversed, the smallest coordinate is that of the other end.
    let mut bounds = Bounds::EMPTY;
    bounds.include(places.coordinates_at([min_x, min_y]));
    bounds.include(places.coordinates_at([max_x, max_y]));
    let terrain = payload.terrain.as_ref();
    let surface = terrain.map(|terrain| manifest.surface(id, &terrain.tin));
    let (mut roads_geo, mut spans) = (Vec::new(), Vec::new());
    // A tile without ground has neither.
    if let Some(surface) = &surface {
        for road in &payload.roads_geo {
            roads_geo.push(geo_road(road, surface, places)?);
        }
        for run in &layers.spans {
            spans.push(span(id, run, surface, places)?);
        }
    }
    Ok(TileDocument {
        id: id.to_string(),
        crs: manifest.crs.clone(),
        coordinates: word,
        metres_per_unit: manifest.metres_per_unit,
        bounds: bounds.to_array(),
        cell_m: frame.level_cell(id.z()).to_array(),
        max_error_m: manifest.levels.get(usize::from(id.z())).map(|level| level.max_error_m),
        geometric_error_m: terrain.map(|terrain| terrain.geometric_error_m),
        height_range_m: terrain.map(|terrain| terrain.height_range_m),
        uncovered_nodes: terrain.map(|terrain| terrain.uncovered_nodes),
        tin: terrain.map(|terrain| tin(id, terrain, places)).unwrap_or_default(),
        roads_geo,
        roads_sv: StreamedList::from_slice(&payload.roads_sv, move |road| sv_road(road, places)),
        attributes: StreamedList::from_slice(&payload.attributes, WayDocument::from),
        layers: tile_layers(manifest, layers.layers, |point| places.of_point(point)),
        spans,
    })
}

fn tin(id: TileId, terrain: &TileTerrain, places: Places<'_>) -> TinDocument {
    let Manifest { frame, vertical, .. } = places.manifest;
    let corner = frame.tile_corner(id);
    let stride = frame.stride(id.z());
    let vertices = terrain.tin.vertices().iter().map(|vertex| {
        let x = frame.x_m(corner.i + i64::from(vertex.column) * stride);
        let y = frame.y_m(corner.j - i64::from(vertex.row) * stride);
        places.with_height([x, y], f64::from(vertex.height_q) * vertical.quantum_m)
    });
    TinDocument {
        vertices: vertices.collect(),
        normals: terrain.normals.iter().map(|&code| normal(code)).collect(),
        triangles: terrain.tin.triangles().to_vec(),
    }
}

fn geo_road(road: &GeoRoad, surface: &Surface, places: Places<'_>) -> Result<GeoRoadDocument> {
    let positions = corniche_drape::positions(&road.line, surface)?;
    let place = |[u, v, height_m]: [f64; 3]| {
        places.with_height(places.manifest.frame.position_of_fraction_m([u, v]), height_m)
    };
    Ok(GeoRoadDocument {
        way_id: road.way_id,
        part: road.part,
        frc: road.class.number(),
        line: positions.into_iter().map(place).collect(),
    })
}

fn span(
    id: TileId,
    run: &SpanRun,
    surface: &Surface,
    places: Places<'_>,
) -> Result<TileSpanDocument> {
    let Manifest { frame, vertical, .. } = places.manifest;
    let place = |point: &SpanPoint| {
        let height_m = point.height_m(surface, vertical.quantum_m)?;
        Some(places.with_height(frame.position_m(point.at), height_m))
    };
    let line: Option<Vec<[f64; 3]>> = run.points.iter().map(place).collect();
    let line = line.ok_or_else(|| {
        let way = run.way_id;
        unusable!("tile {id}: a span of OSM way {way} does not end on the ground")
    })?;
    Ok(TileSpanDocument::from_run(run, line, places.manifest))
}

fn sv_road(road: &SvRoad, places: Places<'_>) -> SvRoadDocument {
    SvRoadDocument {
        way_id: road.way_id,
        part: road.part,
        frc: road.class.number(),
        line: road.line.points.iter().map(|&point| places.of_point(point)).collect(),
        ground_range_m: road.line.ground_range_m.clone(),
    }
}
