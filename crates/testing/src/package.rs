//! A small package of four tiles with all sections, its components, and a manifest for packages of
//! other frames.

use std::io::Cursor;

use corniche_drape::{SvLine, drape};
use corniche_geom::{
    Bounds, Cell, CoordinateTable, GridFrame, LatticePoint, NodeIndex, Polyline, TileId,
};
use corniche_roads::{FunctionalRoadClass, RoadAttributes, Structure};
use corniche_tileset::{
    FORMAT_VERSION, GeoRoad, GrowthRow, LevelRecord, Manifest, ManifestCounts, PackageWriter,
    PayloadBuilder, PayloadContext, RoadRecord, RunOwner, SampleErrorRecord, ScaleRecord, Section,
    SettingsRecord, SpanHeight, SpanPoint, SpanRun, SvRoad, TilePayload, TileTerrain,
    VerticalRecord, encode, encode_spans, pmtiles_order,
};
use corniche_tin::{Placement, Surface, Tin, TinVertex};

use crate::FlatProjection;

/// The height quantum of the small package.
pub const QUANTUM_M: f64 = 0.25;
/// The finest level of the small package.
pub const MAX_LEVEL: u8 = 2;

/// The grid of the small package.
#[must_use]
pub fn frame() -> GridFrame {
    GridFrame::new([0.5, 0.25], 10.0, NodeIndex { i: -512, j: 1024 }, MAX_LEVEL).unwrap()
}

/// The context in which the tiles of the small package are encoded.
#[must_use]
pub fn context() -> PayloadContext {
    PayloadContext { frame: frame(), quantum_m: QUANTUM_M, metres_per_unit: [1.0; 2] }
}

/// The tiles of the small package, in their order in the package.
#[must_use]
pub fn ids() -> Vec<TileId> {
    let mut ids: Vec<TileId> =
        ["0/0/0", "1/1/0", "2/3/1", "2/2/1"].map(|text| text.parse().unwrap()).to_vec();
    ids.sort_by_key(|&id| pmtiles_order(id));
    ids
}

/// The small package's manifest.
#[must_use]
pub fn manifest() -> Manifest {
    manifest_of(frame())
}

/// The manifest of the small package for another grid; its world is flat, with 100 km per degree.
/// Tests set the fields that they need.
#[must_use]
pub fn manifest_of(frame: GridFrame) -> Manifest {
    let projection = FlatProjection::new([1e5; 2]);
    let data_bounds = frame.tile_bounds(TileId::ROOT);
    Manifest {
        format_version: FORMAT_VERSION,
        generator: "corniche test".to_owned(),
        tiling: "local quadtree".to_owned(),
        crs: "EPSG:32632".to_owned(),
        crs_wkt: "PROJCRS[…]".to_owned(),
        metres_per_unit: [1.0; 2],
        point_scale: 0.9996,
        scale: ScaleRecord { center: [1.0; 2], least: [1.0; 2], largest: [1.0; 2] },
        frame,
        data_bounds,
        wgs84_bounds: Bounds { min_x: 9.4, min_y: 47.0, max_x: 9.7, max_y: 47.3 },
        resampling: "nodes are the DEM's samples".to_owned(),
        nodes_are_samples: true,
        clip: None,
        outline: None,
        vertical: VerticalRecord {
            quantum_m: QUANTUM_M,
            unit: "metre".to_owned(),
            datum: "unknown".to_owned(),
            treatment: "as in the files".to_owned(),
            height_step_m: 0.0,
            range_m: [0.0, 400.0],
        },
        coordinates: CoordinateTable::sample(&projection, data_bounds, 1.0).unwrap(),
        levels: (0..=frame.max_level()).map(|z| level(&frame, z)).collect(),
        datum_operations: Vec::new(),
        settings: SettingsRecord {
            max_error_m: 8.0,
            fill_voids: 32,
            cell_m: Some(Cell::from(10.0)),
            frc_table: "default".to_owned(),
            class_max_cell_m: vec![None; 9],
            simplify_cells: 0.5,
            ..SettingsRecord::default()
        },
        settings_sha256: String::new(),
        inputs: vec![],
        attribution: vec!["© OpenStreetMap contributors".to_owned()],
        counts: ManifestCounts { roads_in: 2, roads_kept: 2, ..ManifestCounts::default() },
        growth: vec![GrowthRow::default()],
        photos: Vec::new(),
        layers: Vec::new(),
        spans: None,
        sv_tails: Vec::new(),
    }
}

/// The record of a level of `frame`, with a root tile of the small package.
#[must_use]
pub fn level(frame: &GridFrame, level: u8) -> LevelRecord {
    LevelRecord {
        level,
        cell_m: frame.level_cell(level),
        max_error_m: 8.0,
        geometric_error_m: 2.0,
        errors_m: None,
        sample_error: SampleErrorRecord::default(),
        tightness: None,
        least_class: Some(7),
        simplify_tolerance_m: 0.0,
        width_margin_m: 40.0,
        tiles: 1,
        triangles: 24,
        vertices: 25,
        terrain_bytes: 300,
        relief_bytes: 0,
        uncovered_nodes: 0,
    }
}

/// Returns a package's JSON metadata, with the manifest under its own key.
#[must_use]
pub fn metadata(manifest: &Manifest) -> serde_json::Value {
    let manifest = serde_json::to_value(manifest).unwrap();
    serde_json::json!({ "name": "test", "corniche": manifest })
}

/// Returns a tile of the small package, with all sections except the relief, which would be most of
/// its bytes.
#[must_use]
pub fn payload(id: TileId) -> TilePayload {
    let mut vertices = Vec::new();
    for (row, column) in (0..5_u16).flat_map(|row| (0..5_u16).map(move |column| (row, column))) {
        let height_q = i32::from(column * column * 10 + row * 30);
        vertices.push(TinVertex { row: 64 * row, column: 64 * column, height_q });
    }
    let cells = (0..4_u32).flat_map(|row| (0..4_u32).map(move |column| (row, column)));
    let triangles: Vec<[u32; 3]> = cells
        .filter(|&cell| cell != (2, 2))
        .flat_map(|(row, column)| {
            let nw = 5 * row + column;
            [[nw, nw + 5, nw + 6], [nw, nw + 6, nw + 1]]
        })
        .collect();
    let tin = Tin::new(vertices, &triangles).unwrap();
    let surface = Surface::new(&tin, Placement::of_tile(&frame(), id, QUANTUM_M));
    let bounds = frame().tile_lattice_bounds(id);
    let side = bounds.max.u - bounds.min.u;
    let point = |x: i64, y: i64| {
        LatticePoint::new(bounds.min.u + side * x / 1024, bounds.max.v - side * y / 1024)
    };
    let class = FunctionalRoadClass::new(3).unwrap();
    let points = vec![point(30, 400), point(700, 450), point(900, 640), point(256, 512)];
    let lines = drape(&Polyline::new(points.clone()).unwrap(), &surface).lines;
    let roads_geo = (0..).zip(lines).map(|(part, line)| GeoRoad { way_id: 7, part, class, line });
    let line = SvLine { ground_range_m: vec![[0.25, 90.0]; points.len() - 1], points };
    let attributes = RoadAttributes { name: "Corniche".to_owned(), ..RoadAttributes::default() };
    TilePayload {
        id,
        relief: None,
        roads_geo: roads_geo.collect(),
        roads_sv: vec![SvRoad { way_id: 7, part: 0, class, line }],
        attributes: vec![RoadRecord { way_id: 7, attributes }],
        terrain: Some(TileTerrain {
            normals: vec![[3, -4]; tin.vertices().len()],
            tin,
            geometric_error_m: 1.75,
            height_range_m: [-3.5, 812.25],
            uncovered_nodes: 7,
        }),
    }
}

/// Returns the same tile as bytes.
#[must_use]
pub fn encoded(id: TileId) -> Vec<u8> {
    encode(&payload(id), &context()).unwrap().bytes
}

/// Returns spans of a tile of the small package: a bridge from a vertex of the ground to a point in
/// the air, and a tunnel below the ground.
#[must_use]
pub fn spans(id: TileId) -> Vec<SpanRun> {
    let placement = Placement::of_tile(&frame(), id, QUANTUM_M);
    let surface = Surface::new(&payload(id).terrain.unwrap().tin, placement);
    let [east, north] = placement.node_steps;
    let at = |column: i64, row: i64| {
        LatticePoint::new(placement.corner.u + column * east, placement.corner.v - row * north)
    };
    let low =
        |at| SpanPoint { at, height: SpanHeight::Ground { triangle: surface.locate(at).unwrap() } };
    let high = |at, steps| SpanPoint { at, height: SpanHeight::Steps(steps) };
    let owner = RunOwner::Road(FunctionalRoadClass::new(3).unwrap());
    let run = |way_id, structure, points| SpanRun { way_id, owner, structure, points };
    vec![
        run(
            7,
            Structure::Bridge,
            vec![low(at(64, 64)), high(at(70, 65), 401), high(at(80, 65), 399)],
        ),
        run(9, Structure::Tunnel, vec![high(at(10, 200), -7), low(at(20, 201))]),
    ]
}

/// Returns a tile of the small package with these spans, as bytes.
#[must_use]
pub fn encoded_with_spans(id: TileId) -> Vec<u8> {
    let section = encode_spans(id, &frame(), &spans(id)).unwrap().unwrap();
    with_section(&encoded(id), id, section)
}

/// Adds a section to the payload of a tile.
#[must_use]
pub fn with_section(payload: &[u8], id: TileId, section: Section) -> Vec<u8> {
    let mut builder = PayloadBuilder::with_all_of(payload, id).unwrap();
    builder.add(section).unwrap();
    builder.seal().unwrap().bytes
}

/// Returns the small package as the writer writes it.
#[must_use]
pub fn written() -> Vec<u8> {
    written_with(&manifest(), ids().into_iter().map(|id| (id, encoded(id))))
}

/// Returns a package of encoded tiles as the writer writes it; tiles must be in the order of
/// packages.
#[must_use]
pub fn written_with(
    manifest: &Manifest,
    tiles: impl IntoIterator<Item = (TileId, Vec<u8>)>,
) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    let mut writer = PackageWriter::new(&mut bytes, manifest, usize::MAX).unwrap();
    for (id, tile) in tiles {
        writer.add(id, &tile).unwrap();
    }
    writer.finish().unwrap();
    bytes.into_inner()
}

/// Returns a TIN with a vertex at each node, like rough ground that cannot be simplified.
#[must_use]
pub fn full_tin() -> Tin {
    let node = |row, column| TinVertex { row, column, height_q: i32::from(row % 7 * (column % 5)) };
    let nodes = (0..257_u16).flat_map(|row| (0..257_u16).map(move |column| node(row, column)));
    let cells = (0..256_u32).flat_map(|row| (0..256_u32).map(move |column| 257 * row + column));
    let triangles: Vec<[u32; 3]> =
        cells.flat_map(|nw| [[nw, nw + 257, nw + 258], [nw, nw + 258, nw + 1]]).collect();
    Tin::new(nodes.collect(), &triangles).unwrap()
}
