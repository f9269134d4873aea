//! `corniche tile`: one decoded tile, for other tools to check packages with.

use corniche_areas::ClassedLayer;
use corniche_geom::{Bounds, LatticePoint, NodeIndex, TileId};
use corniche_tileset::{
    AreaRecord, FilePackage, GeoRoad, LineRecord, Manifest, Sections, SpanPoint, SpanRun, SvRoad,
    Terrain, TilePayload, decode_areas, decode_lines,
};
use corniche_tin::Surface;

use crate::{
    args::{Coordinates, TileArgs},
    documents::{
        areas::TileAreaDocument,
        lines::TileBoundaryDocument,
        spans::TileSpanDocument,
        tile::{
            GeoRoadDocument, SvRoadDocument, TileDocument, TinDocument, WayDocument, Written,
            normal,
        },
    },
    exit::ExitCode,
    failure::Failure,
    messages, packages,
    table::{Digits, Table},
};

pub(crate) fn run(args: &TileArgs) -> Result<ExitCode, Failure> {
    let package = packages::open(&args.from.package)?;
    let payload = match (args.id, args.at) {
        (Some(id), _) => package.payload(id, Sections::ALL)?.ok_or_else(|| no_tile(args, id))?,
        (None, Some(at)) => payload_at(args, &package, at)?,
        // The command line has one of them.
        (None, None) => return Err(Failure::unusable("name a tile: Z/X/Y, or --at LON,LAT")),
    };
    let layers = TileLayers::read(&package, payload.id)?;
    if args.json {
        let document = document(package.manifest(), &payload, layers, args.coordinates)?;
        messages::answer_document(&document)?;
    } else {
        messages::answer(&to_text(&payload, &layers, Digits::of_answers()))?;
    }
    Ok(ExitCode::Done)
}

/// What a tile has of the layers that are read by themselves.
struct TileLayers {
    areas: Vec<AreaRecord>,
    boundaries: Vec<LineRecord>,
    spans: Vec<SpanRun>,
}

impl TileLayers {
    fn read(package: &FilePackage, id: TileId) -> Result<Self, Failure> {
        let bytes = package.tile(id).map_err(Failure::unusable)?.unwrap_or_default();
        let manifest = package.manifest();
        let boundaries = decode_lines(&bytes, id, ClassedLayer::Boundaries);
        let spans = manifest.decode_spans(&bytes, id);
        Ok(Self {
            areas: decode_areas(&bytes, id, &manifest.frame).map_err(Failure::unusable)?,
            boundaries: boundaries.map_err(Failure::unusable)?,
            spans: spans.map_err(Failure::unusable)?,
        })
    }
}

fn no_tile(args: &TileArgs, id: TileId) -> Failure {
    let package = &args.from.package;
    Failure::unusable(format!("{package} has no tile {id}; corniche info --json lists its tiles"))
}

/// The tile of the level asked for that holds a place, else the finest one there.
fn payload_at(
    args: &TileArgs,
    package: &FilePackage,
    [lon_deg, lat_deg]: [f64; 2],
) -> Result<TilePayload, Failure> {
    let manifest = package.manifest();
    let finest = manifest.frame.max_level();
    if let Some(level) = args.level.filter(|&level| level > finest) {
        return Err(Failure::unusable(format!("--level {level}: the finest level is {finest}")));
    }
    let levels = args.level.map_or(0..=finest, |level| level..=level);
    for level in levels.rev() {
        let Some((id, point)) = tile_at(manifest, level, [lon_deg, lat_deg]) else { continue };
        // A tile at the edge reaches beyond the data.
        if !lies_in_data(manifest, point) {
            break;
        }
        let Some(payload) = package.payload(id, Sections::ALL)? else { continue };
        if args.level.is_none() && level < finest {
            messages::note(&format!(
                "there is no tile of level {finest} at this place; tile {id} is the finest one"
            ));
        }
        if !has_ground(manifest, &payload, point) {
            messages::note(&format!(
                "tile {id} has no ground at this place: it is in a void or beyond the edge of the data"
            ));
        }
        return Ok(payload);
    }
    Err(Failure::unusable(no_tile_at(args, manifest, [lon_deg, lat_deg])))
}

/// Why there is no tile at a place, and what to do.
fn no_tile_at(args: &TileArgs, manifest: &Manifest, [lon_deg, lat_deg]: [f64; 2]) -> String {
    let package = &args.from.package;
    let on = args.level.map_or_else(String::new, |level| format!(" on level {level}"));
    let place = format!("longitude {lon_deg}, latitude {lat_deg}");
    if manifest.covers_deg([lon_deg, lat_deg]) {
        let coarser = if args.level.is_some() { "leave --level out, or " } else { "" };
        return format!(
            "{package} has no tile{on} at {place}: the data have a void there; {coarser}choose another place \
             (corniche info --json lists the tiles)"
        );
    }
    let covered = manifest.covered_text([lon_deg, lat_deg]);
    format!("{package} has no ground{on} at {place}; it covers {covered}; choose a place there")
}

/// Whether a place lies in the rectangle of the data, or at its edge, to a cell.
fn lies_in_data(manifest: &Manifest, point: LatticePoint) -> bool {
    let [low, high] = manifest.data_nodes();
    let around =
        [NodeIndex { i: low.i - 1, j: low.j - 1 }, NodeIndex { i: high.i + 1, j: high.j + 1 }];
    manifest.frame.lattice_bounds(around).contains(point)
}

/// Whether a tile's triangles cover a place.
fn has_ground(manifest: &Manifest, payload: &TilePayload, point: LatticePoint) -> bool {
    payload
        .terrain
        .as_ref()
        .is_some_and(|terrain| manifest.surface(payload.id, &terrain.tin).locate(point).is_some())
}

/// The tile of a level that holds a place, and where that is; `None` outside the root tile.
fn tile_at(
    manifest: &Manifest,
    level: u8,
    [lon_deg, lat_deg]: [f64; 2],
) -> Option<(TileId, LatticePoint)> {
    // Longitudes of a package may run on past 180.
    [0.0, 360.0, -360.0].into_iter().find_map(|turn| {
        let position = manifest.coordinates.working_from_wgs84([lon_deg + turn, lat_deg])?;
        let point = manifest.frame.snap(position)?;
        let [column, row] = manifest.frame.tile_column_row(level, point);
        let id = TileId::new(level, u32::try_from(column).ok()?, u32::try_from(row).ok()?).ok()?;
        Some((id, point))
    })
}

fn to_text(payload: &TilePayload, layers: &TileLayers, digits: Digits) -> String {
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
    table.row(["ways".into(), count(payload.attributes.len())]);
    let layers = [
        ("areas", layers.areas.len()),
        ("boundaries", layers.boundaries.len()),
        ("spans", layers.spans.len()),
    ];
    for (name, number) in layers.into_iter().filter(|(_, number)| *number > 0) {
        table.row([name.into(), count(number)]);
    }
    table.to_text()
}

/// Makes coordinates of one kind from working metres and from points of the lattice.
#[derive(Clone, Copy)]
struct Places<'a> {
    manifest: &'a Manifest,
    /// What working metres are divided by.
    unit: [f64; 2],
}

impl Places<'_> {
    fn of(self, [x, y]: [f64; 2]) -> [f64; 2] {
        [x / self.unit[0], y / self.unit[1]]
    }

    fn of_point(self, point: LatticePoint) -> [f64; 2] {
        self.of(self.manifest.frame.position_m(point))
    }

    fn with_height(self, position: [f64; 2], height_m: f64) -> [f64; 3] {
        let [x, y] = self.of(position);
        [x, y, height_m]
    }
}

fn document<'a>(
    manifest: &'a Manifest,
    payload: &'a TilePayload,
    layers: TileLayers,
    coordinates: Coordinates,
) -> Result<TileDocument<'a>, Failure> {
    let frame = &manifest.frame;
    let id = payload.id;
    let (word, unit) = match coordinates {
        Coordinates::Working => ("working", [1.0; 2]),
        Coordinates::Crs => ("crs", manifest.metres_per_unit),
    };
    let places = Places { manifest, unit };
    let at = |point| places.of_point(point);
    let Bounds { min_x, min_y, max_x, max_y } = frame.tile_bounds(id);
    // Where an axis counts back, its smallest coordinate is that of the other end.
    let mut bounds = Bounds::EMPTY;
    bounds.include(places.of([min_x, min_y]));
    bounds.include(places.of([max_x, max_y]));
    let terrain = payload.terrain.as_ref();
    let surface = terrain.map(|terrain| manifest.surface(id, &terrain.tin));
    let (mut roads_geo, mut spans) = (Vec::new(), Vec::new());
    // Without ground a tile has neither.
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
        roads_sv: Written::of(&payload.roads_sv, move |road| sv_road(road, places)),
        attributes: Written::of(&payload.attributes, WayDocument::from),
        areas: layers.areas.into_iter().map(|area| TileAreaDocument::of(area, &at)).collect(),
        boundaries: layers
            .boundaries
            .into_iter()
            .map(|line| TileBoundaryDocument::of(line, at))
            .collect(),
        spans,
    })
}

fn tin(id: TileId, terrain: &Terrain, places: Places<'_>) -> TinDocument {
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

fn geo_road(
    road: &GeoRoad,
    surface: &Surface,
    places: Places<'_>,
) -> Result<GeoRoadDocument, Failure> {
    let positions = corniche_drape::positions(&road.line, surface)
        .map_err(|error| Failure::new(ExitCode::Unusable, error))?;
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
) -> Result<TileSpanDocument, Failure> {
    let Manifest { frame, vertical, .. } = places.manifest;
    let place = |point: &SpanPoint| {
        let height_m = point.height_m(surface, vertical.quantum_m)?;
        Some(places.with_height(frame.position_m(point.at), height_m))
    };
    let line: Option<Vec<[f64; 3]>> = run.points.iter().map(place).collect();
    let line = line.ok_or_else(|| {
        let way = run.way_id;
        Failure::unusable(format!("tile {id}: a span of way {way} ends beside the ground"))
    })?;
    Ok(TileSpanDocument::of(run, line))
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
