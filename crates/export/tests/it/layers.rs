//! Layers of a package are exported on its ground, with attributes, in every format.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::{
    collections::BTreeMap,
    fs,
    path::{Path, PathBuf},
};

use corniche_export::{
    DegreeBounds, ErrorKind, FeatureCoordinates, FeatureRequest, FeaturesError, LayerSummary,
    VectorFormat, export_layer,
};
use corniche_geom::{LatticeBounds, LatticePoint, TileId};
use corniche_layers::{AttributeValue, LayerForm, LayerGeometry, OsmObject};
use corniche_testing::package;
use corniche_tileset::{
    AreaPolygon, FilePackage, LayerCoding, LayerCounts, LayerObject, LayerRecord, LayerShape,
    LayerSlot, Manifest, TilePayload, TileTerrain, encode, encode_layer,
};
use corniche_tin::{Tin, TinVertex};
use corniche_work::Silent;
use gdal::{
    Dataset,
    vector::{Geometry, LayerAccess as _},
};

/// Two finest tiles side by side.
const TILES: [&str; 2] = ["2/2/1", "2/3/1"];
/// Between vertices of the ground: nodes, and metres.
const NODES: i64 = 64;
const CELL_M: f64 = 640.0;

/// The height of the ground at a vertex: columns count from the west of the first tile.
fn height_q(column: i64, row: i64) -> i64 {
    column * column * 10 + row * 30
}

/// Returns the height of the ground, by the triangles' planes, at a place in metres; both tiles
/// have a hole in row 2 and their column 2.
fn height_m(x: f64, y: f64) -> f64 {
    let frame = package::frame();
    let corner = frame.tile_bounds(TILES[0].parse().unwrap());
    let [across, down] = [(x - corner.min_x) / CELL_M, (corner.max_y - y) / CELL_M];
    let [column, row] = [across, down].map(|number| number.floor().clamp(0.0, 7.0));
    let [right, below] = [across - column, down - row];
    let at = |east: i64, south: i64| {
        package::QUANTUM_M * height_q(column as i64 + east, row as i64 + south) as f64
    };
    // The diagonal goes from the north-west to the south-east.
    if below >= right {
        at(0, 0) + (at(0, 1) - at(0, 0)) * below + (at(1, 1) - at(0, 1)) * right
    } else {
        at(0, 0) + (at(1, 0) - at(0, 0)) * right + (at(1, 1) - at(1, 0)) * below
    }
}

fn terrain(id: TileId) -> TileTerrain {
    let nodes = (0..5).flat_map(|row| (0..5).map(move |column| (row, column)));
    let east = 4 * (i64::from(id.x()) - 2);
    let vertex = |(row, column): (i64, i64)| TinVertex {
        row: (NODES * row) as u16,
        column: (NODES * column) as u16,
        height_q: height_q(east + column, row) as i32,
    };
    let vertices: Vec<TinVertex> = nodes.map(vertex).collect();
    let like = package::payload(id).terrain.unwrap();
    let tin = Tin::new(vertices, like.tin.triangles()).unwrap();
    TileTerrain { tin, ..like }
}

/// The point at shares of a cell from the north-western corner of the first tile.
fn at(column: f64, row: f64) -> LatticePoint {
    let frame = package::frame();
    let corner = frame.tile_lattice_bounds(TILES[0].parse().unwrap());
    let side = (corner.max.u - corner.min.u) as f64 / 4.0;
    let steps = |share: f64| (share * side).round() as i64;
    LatticePoint::new(corner.min.u + steps(column), corner.max.v - steps(row))
}

fn table(id: &str, geometry: &str) -> LayerForm {
    let table = serde_json::json!({
        "id": id, "title": "Some things", "geometry": geometry,
        "attributes": {
            "height": { "number": "m" }, "name": "names", "class": "text", "dry": "yes-no",
        },
        "class": [
            { "id": "old", "tags": { "age": "old" } },
            { "id": "new", "tags": { "age": "new" } },
        ],
    });
    serde_json::from_value(table).unwrap()
}

fn values(name: &str) -> Vec<Option<AttributeValue>> {
    let names = vec![(String::new(), name.to_owned()), ("de".to_owned(), format!("{name} (de)"))];
    vec![
        Some(AttributeValue::Text("=1".to_owned())),
        Some(AttributeValue::YesNo(true)),
        None,
        Some(AttributeValue::Names(names)),
    ]
}

/// A wall that crosses both tiles and a hole of each, one along their border, and a short one.
fn walls() -> [(i64, u8, Vec<LatticePoint>); 3] {
    [
        (1, 0, vec![at(0.3, 0.4), at(1.5, 1.25), at(3.7, 2.8), at(6.5, 2.5), at(7.5, 0.5)]),
        (2, 1, vec![at(3.5, 3.5), at(4.0, 3.25), at(4.0, 0.75), at(4.5, 0.5)]),
        (3, 1, vec![at(5.1, 3.9), at(5.2, 3.8)]),
    ]
}

/// Trees, of which the last is in a hole.
fn trees() -> [(i64, LatticePoint); 3] {
    [(11, at(1.25, 0.75)), (12, at(5.5, 3.125)), (13, at(6.5, 2.5))]
}

/// The part of each object in a tile.
fn objects(layer: LayerGeometry, tile: LatticeBounds) -> Vec<LayerObject> {
    let object =
        |class, object, shape| LayerObject { class, object, values: values("Name"), shape };
    match layer {
        LayerGeometry::Line => {
            let mut found = Vec::new();
            for (id, class, points) in walls() {
                let is_near =
                    |ends: &[LatticePoint]| LatticeBounds::around(ends).unwrap().intersects(&tile);
                let near: Vec<[LatticePoint; 2]> =
                    points.array_windows::<2>().filter(|ends| is_near(*ends)).copied().collect();
                for part in near.chunk_by(|one, next| one[1] == next[0]) {
                    let points = [part[0][0]].into_iter().chain(part.iter().map(|ends| ends[1]));
                    let shape = LayerShape::Line(points.collect());
                    found.push(object(class, OsmObject::Way(id), shape));
                }
            }
            found
        }
        LayerGeometry::Point => trees()
            .into_iter()
            .filter(|&(_, point)| tile.contains(point))
            .map(|(id, point)| object(0, OsmObject::Node(id), LayerShape::Point(point)))
            .collect(),
        LayerGeometry::Area => {
            // From column 3.5 to 4.5, cut by the border at 4.
            let [west, east] = if tile.contains(at(3.5, 1.0)) { [3.5, 4.0] } else { [4.0, 4.5] };
            let ring = vec![at(west, 2.0), at(east, 2.0), at(east, 1.0), at(west, 1.0)];
            let shape = LayerShape::Area(vec![AreaPolygon { rings: vec![ring] }]);
            vec![object(1, OsmObject::Relation(21), shape)]
        }
    }
}

fn written(folder: &Path) -> PathBuf {
    let layers = [("ponds", "area"), ("walls", "line"), ("trees", "point")];
    let layers = layers.map(|(id, geometry)| LayerRecord {
        table: table(id, geometry),
        counts: LayerCounts { objects: 0, kept: vec![], lost: vec![], unread_values: vec![] },
        levels: Vec::new(),
    });
    let crs_wkt = "EPSG:32632".to_owned();
    let manifest = Manifest { crs_wkt, layers: layers.to_vec(), ..package::manifest() };
    let tile = |id: TileId| {
        let terrain = Some(terrain(id));
        let (roads_geo, roads_sv, attributes) = (Vec::new(), Vec::new(), Vec::new());
        let payload = TilePayload { id, relief: None, terrain, roads_geo, roads_sv, attributes };
        let mut bytes = encode(&payload, &package::context()).unwrap().bytes;
        let frame = package::frame();
        for (index, layer) in layers.iter().enumerate() {
            let objects = objects(layer.table.geometry, frame.tile_lattice_bounds(id));
            let coding = LayerCoding::from_table(&layer.table);
            let slot = LayerSlot::new(index).unwrap();
            if let Some(section) = encode_layer(id, &frame, slot, &coding, 1, &objects).unwrap() {
                bytes = package::with_section(&bytes, id, section);
            }
        }
        (id, bytes)
    };
    let is_there = |id: &TileId| TILES.contains(&id.to_string().as_str());
    let tiles = package::ids().into_iter().filter(is_there).map(tile);
    let path = folder.join("layers.pmtiles");
    fs::write(&path, package::written_with(&manifest, tiles)).unwrap();
    path
}

fn request(format: VectorFormat, classes: &[&str]) -> FeatureRequest<String> {
    FeatureRequest {
        format,
        level: None,
        classes: classes.iter().map(|&class| class.to_owned()).collect(),
        bounds: None,
        coordinates: match format {
            VectorFormat::GeoJson => FeatureCoordinates::Epsg(32632),
            _ => FeatureCoordinates::Package,
        },
        memory_bytes: 500,
    }
}

/// The geometry of a feature and its fields as text.
type Exported = (Geometry, BTreeMap<String, Option<String>>);

/// Exports a layer, and reads its features with OGR, by id.
fn exported(
    package: &FilePackage,
    layer: &str,
    request: &FeatureRequest<String>,
) -> Result<(LayerSummary, BTreeMap<i64, Exported>), FeaturesError> {
    let folder = tempfile::tempdir().unwrap();
    let ending = match request.format {
        VectorFormat::GeoPackage => "gpkg",
        VectorFormat::FlatGeobuf => "fgb",
        VectorFormat::GeoJson => "geojson",
        VectorFormat::Csv => "csv",
    };
    let path = folder.path().join(format!("{layer}.{ending}"));
    let languages = ["de".to_owned()];
    let summary = export_layer(package, (layer, &languages), request, &path, &Silent)?;
    let dataset = Dataset::open(&path).unwrap();
    let mut layer = dataset.layer(0).unwrap();
    let features = layer.features().map(|feature| {
        let fields = feature.fields().map(|(name, _)| name).collect::<Vec<_>>();
        let text = |name: String| {
            let index = feature.field_index(&name).unwrap();
            let text = feature.field_as_string(index).unwrap().filter(|text| !text.is_empty());
            (name, text)
        };
        let fields: BTreeMap<_, _> = fields.into_iter().map(text).collect();
        let id = fields["id"].as_ref().unwrap().parse().unwrap();
        (id, (feature.geometry().unwrap().clone(), fields))
    });
    let features = features.collect();
    Ok((summary, features))
}

fn field<'a>((_, fields): &'a Exported, name: &str) -> Option<&'a str> {
    fields[name].as_deref()
}

/// The lines of a feature: x, y and height.
fn lines((geometry, _): &Exported) -> Vec<Vec<[f64; 3]>> {
    (0..geometry.geometry_count())
        .map(|part| {
            let part = geometry.get_geometry(part);
            let point = |index| part.get_point(index as i32);
            (0..part.point_count()).map(point).map(|(x, y, z)| [x, y, z]).collect()
        })
        .collect()
}

const FORMATS: [VectorFormat; 4] =
    [VectorFormat::GeoPackage, VectorFormat::FlatGeobuf, VectorFormat::GeoJson, VectorFormat::Csv];

/// Whether a place is in a hole of the ground, by more than rounding.
fn is_in_hole(x: f64, y: f64) -> bool {
    let corner = package::frame().tile_bounds(TILES[0].parse().unwrap());
    let [across, down] = [(x - corner.min_x) / CELL_M, (corner.max_y - y) / CELL_M];
    let inside = |share: f64, cell: f64| share > cell + 1e-6 && share < cell + 1.0 - 1e-6;
    inside(down, 2.0) && (inside(across, 2.0) || inside(across, 6.0))
}

/// Lines are on the planes of triangles everywhere, also between vertices, have gaps in holes and
/// nowhere else, and are as long as the walls, each stretch once.
#[test]
fn lines_are_on_the_ground_in_every_format() {
    let folder = tempfile::tempdir().unwrap();
    let package = FilePackage::open(&written(folder.path())).unwrap();
    for format in FORMATS {
        let (summary, found) = exported(&package, "walls", &request(format, &[])).unwrap();
        assert_eq!((summary.objects, summary.level, summary.without_ground), (3, 2, 0));
        assert_eq!(summary.geometry, LayerGeometry::Line);
        assert!(summary.heights.is_some(), "{summary:?}");
        assert_eq!(found.keys().copied().collect::<Vec<_>>(), [1, 2, 3], "{format:?}");
        for (id, class, points) in walls() {
            let feature = &found[&id];
            let lines = lines(feature);
            // The first wall crosses two holes.
            assert_eq!(lines.len(), if id == 1 { 3 } else { 1 }, "{format:?}, {id}: {lines:?}");
            let frame = package::frame();
            let whole_m: Vec<[f64; 2]> =
                points.iter().map(|&point| frame.position_m(point)).collect();
            let mut expected_m = 0.0;
            for [from, to] in whole_m.array_windows() {
                let parts = 4096;
                let place = |part: usize| {
                    let share = (part as f64 + 0.5) / parts as f64;
                    [0, 1].map(|axis| from[axis] + share * (to[axis] - from[axis]))
                };
                let is_ground = |&part: &usize| !is_in_hole(place(part)[0], place(part)[1]);
                let share = (0..parts).filter(is_ground).count() as f64 / parts as f64;
                expected_m += share * (to[0] - from[0]).hypot(to[1] - from[1]);
            }
            let mut length_m = 0.0;
            for [from, to] in lines.iter().flat_map(|line| line.array_windows()) {
                length_m += (to[0] - from[0]).hypot(to[1] - from[1]);
                for share in [0.0, 0.5, 1.0] {
                    let [x, y, z] =
                        [0, 1, 2].map(|axis| from[axis] + share * (to[axis] - from[axis]));
                    assert!((z - height_m(x, y)).abs() < 1e-5, "{format:?}, {id}: {x} {y} {z}");
                    assert!(!is_in_hole(x, y), "{format:?}, {id}: {x} {y}");
                }
            }
            assert!(
                (length_m - expected_m).abs() < 2.0,
                "{format:?}, {id}: {length_m} {expected_m}"
            );
            assert_eq!(field(feature, "object"), Some("way"));
            assert_eq!(field(feature, "class"), Some(["old", "new"][usize::from(class)]));
            let escaped = if format == VectorFormat::Csv { "'=1" } else { "=1" };
            assert_eq!(field(feature, "class_"), Some(escaped), "{format:?}");
            assert_eq!(field(feature, "dry"), Some("1"));
            assert_eq!(field(feature, "height"), None);
            assert_eq!(field(feature, "name"), Some("Name"));
            assert_eq!(field(feature, "name:de"), Some("Name (de)"));
            let vertices: usize = lines.iter().map(Vec::len).sum();
            assert_eq!(field(feature, "points"), Some(vertices.to_string().as_str()));
        }
    }
}

#[test]
fn points_are_on_the_ground_in_every_format() {
    let folder = tempfile::tempdir().unwrap();
    let package = FilePackage::open(&written(folder.path())).unwrap();
    for format in FORMATS {
        let (summary, found) = exported(&package, "trees", &request(format, &[])).unwrap();
        assert_eq!((summary.objects, summary.points, summary.without_ground), (2, 2, 1));
        assert_eq!(found.keys().copied().collect::<Vec<_>>(), [11, 12], "{format:?}");
        for (id, point) in &trees()[..2] {
            let (x, y, z) = found[id].0.get_point(0);
            let [expected_x, expected_y] = package::frame().position_m(*point);
            assert!((x - expected_x).abs() < 1e-6 && (y - expected_y).abs() < 1e-6);
            assert!((z - height_m(x, y)).abs() < 1e-6, "{format:?}: {x} {y} {z}");
            assert_eq!(field(&found[id], "object"), Some("node"));
        }
    }
}

/// An area on both sides of a border is one polygon of four corners and two points on the border.
#[test]
fn areas_are_joined_and_flat_in_every_format() {
    let folder = tempfile::tempdir().unwrap();
    let package = FilePackage::open(&written(folder.path())).unwrap();
    for format in FORMATS {
        let mut request = request(format, &["new"]);
        let (summary, found) = exported(&package, "ponds", &request).unwrap();
        assert_eq!((summary.objects, summary.parts, summary.points), (1, 1, 6), "{format:?}");
        assert_eq!((summary.unjoined, summary.heights), (0, None));
        let (geometry, _) = &found[&21];
        assert!((geometry.area() - CELL_M * CELL_M).abs() < 1e-3, "{format:?}");
        assert!(geometry.wkt().unwrap().starts_with("MULTIPOLYGON (("), "{format:?}");
        assert_eq!(field(&found[&21], "object"), Some("relation"));
        request.classes = vec!["old".to_owned()];
        assert_eq!(exported(&package, "ponds", &request).unwrap().0.objects, 0);
        // Areas have no heights, so an unknown vertical datum does not matter.
        request.coordinates = FeatureCoordinates::Wgs84;
        assert!(exported(&package, "ponds", &request).is_ok());
        assert!(exported(&package, "walls", &request).is_err());
    }
}

/// The western tile has one tree with ground, one of the walls whole, and parts of another.
#[test]
fn bounds_cut_lines_and_select_points() {
    let folder = tempfile::tempdir().unwrap();
    let package = FilePackage::open(&written(folder.path())).unwrap();
    // The world of the package has 100 km per degree.
    let tile = package::frame().tile_bounds(TILES[0].parse().unwrap());
    let sides = [tile.min_x, tile.min_y, tile.max_x, tile.max_y].map(|metres| metres / 1e5);
    let bounds = DegreeBounds::new(sides);
    let request = FeatureRequest { bounds, ..request(VectorFormat::FlatGeobuf, &[]) };
    let (summary, found) = exported(&package, "trees", &request).unwrap();
    assert_eq!((summary.objects, found.keys().copied().collect::<Vec<_>>()), (1, vec![11]));
    let (_, found) = exported(&package, "walls", &request).unwrap();
    assert_eq!(found.keys().copied().collect::<Vec<_>>(), [1, 2]);
    let points = found.values().flat_map(lines).flatten();
    let east = points.map(|[x, ..]| x).fold(f64::NEG_INFINITY, f64::max);
    assert!((east - tile.max_x).abs() < 0.02, "{east}");
}

#[test]
fn layers_and_classes_that_are_not_there_are_refused_with_those_that_are() {
    let folder = tempfile::tempdir().unwrap();
    let package = FilePackage::open(&written(folder.path())).unwrap();
    let all = request(VectorFormat::Csv, &[]);
    let refused = |package: &FilePackage, layer: &str, request: &FeatureRequest<String>| {
        let error = exported(package, layer, request).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::Unusable);
        error.to_string()
    };
    let error = refused(&package, "hedges", &all);
    assert!(error.contains("\"hedges\"; its layers are ponds, walls, trees"), "{error}");
    let error = refused(&package, "walls", &request(VectorFormat::Csv, &["old", "odd"]));
    assert!(error.contains("has no class \"odd\"; its classes are old, new"), "{error}");
    let path = folder.path().join("plain.pmtiles");
    fs::write(&path, package::written()).unwrap();
    let error = refused(&FilePackage::open(&path).unwrap(), "walls", &all);
    assert!(error.contains("has no layers"), "{error}");
}
