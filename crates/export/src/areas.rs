//! The whole way of areas out of a package.

use std::path::Path;

use corniche_areas::{AreaClass, Polygon};
use corniche_geom::{LatticePoint, TileId, wgs84};
use corniche_store::{Groups, Sorter};
use corniche_tileset::{FilePackage, decode_areas, pmtiles_order};
use corniche_work::{Observer, Stage, workers::one_by_one};

use crate::{
    area_piece::AreaPiece,
    cut::polygons_of,
    error::ExportError,
    feature_request::{AreasRequest, Coordinates},
    places::Places,
    read,
    scratch::FileScratch,
    vector::{Field, FieldKind, Layer, Record, Shape, ShapeKind, Value, VectorFile, VectorFormat},
};

/// What was exported.
#[derive(Debug, Clone, PartialEq)]
pub struct AreasSummary {
    /// The level whose areas were taken.
    pub level: u8,
    /// Features written: objects of OSM.
    pub areas: u64,
    /// Polygons of all features.
    pub polygons: u64,
    /// Points of their rings.
    pub points: u64,
    /// True area on the ellipsoid, square metres.
    pub area_m2: f64,
    /// Areas whose parts in tiles could not be joined; each part is a polygon.
    pub unjoined: u64,
}

const FIELDS: &[Field] = &[
    Field {
        name: "object",
        kind: FieldKind::Text,
        unit: "",
        meaning: "`way` or `relation` of OpenStreetMap",
    },
    Field { name: "id", kind: FieldKind::Integer64, unit: "", meaning: "its id" },
    Field {
        name: "class",
        kind: FieldKind::Text,
        unit: "",
        meaning: "class of the area, such as `water`",
    },
    Field { name: "name", kind: FieldKind::Text, unit: "", meaning: "OSM's `name`; null without" },
    Field {
        name: "area_m2",
        kind: FieldKind::Real,
        unit: "m²",
        meaning: "true area on the ellipsoid of WGS84, of what the package has of it",
    },
    Field { name: "polygons", kind: FieldKind::Integer, unit: "", meaning: "number of polygons" },
    Field {
        name: "points",
        kind: FieldKind::Integer,
        unit: "",
        meaning: "points of all rings, the closing ones not counted",
    },
];

/// Writes the areas of a package to a new file at `path`: a feature for each object, joined again over borders of tiles. Beside
/// the file, in the same folder, are unnamed files for sorting. After an error the file at `path` is of no use.
///
/// # Errors
/// When the package has no areas or no such level, the request cannot be met, the package is damaged, or something cannot be
/// written.
pub fn export_areas(
    package: &FilePackage,
    request: &AreasRequest,
    path: &Path,
    observer: &dyn Observer,
) -> Result<AreasSummary, ExportError> {
    let manifest = package.manifest();
    if manifest.areas.is_none() {
        return Err(ExportError::NoAreas { package: package.path().to_path_buf() });
    }
    let level = read::level(package, request.level)?;
    if request.format == VectorFormat::GeoJson && request.coordinates == Coordinates::Package {
        return Err(ExportError::GeoJsonPlanCrs);
    }
    let places = Places::new(manifest, request.coordinates)?;
    let folder = corniche_store::folder_of(path);
    let sort = |source| ExportError::Sort { folder: folder.to_path_buf(), source };
    let scratch = FileScratch::create(folder).map_err(sort)?;
    let mut sorter = Sorter::new(&scratch, request.memory_bytes);
    let mut ids = package.tile_ids()?;
    ids.retain(|id| id.z() == level);
    let mut count = 0;
    one_by_one((observer, Stage::ExportTiles), &ids, |&id| {
        for piece in pieces(package, id, &request.classes)? {
            count += 1;
            sorter.push(piece).map_err(sort)?;
        }
        Ok::<(), ExportError>(())
    })?;
    let mut sorted = Groups::of(sorter.finish().map_err(sort)?);
    let mut file = VectorFile::create(path, request.format, layer(package, level, &places))?;
    let mut summary =
        AreasSummary { level, areas: 0, polygons: 0, points: 0, area_m2: 0.0, unjoined: 0 };
    let rounding_m = rounding_m(package, level);
    observer.begin(Stage::ExportFeatures, Some(count));
    while let Some(pieces) = sorted.next_by(|piece| piece.object).map_err(sort)? {
        observer.check()?;
        file.push(feature(&pieces, (&places, rounding_m), &mut summary)?)?;
        observer.advance(Stage::ExportFeatures, pieces.len() as u64);
    }
    file.finish()?;
    observer.end(Stage::ExportFeatures);
    Ok(summary)
}

/// The most by which corners of areas can be off on a level: the build has them on a lattice of 0.1 m on the finest level, of a quarter of a cell
/// above. Where tiles meet they are rounded twice, by half a step each time.
fn rounding_m(package: &FilePackage, level: u8) -> f64 {
    let frame = &package.manifest().frame;
    if level == frame.max_level() { 0.1 } else { frame.level_cell(level).shorter_m() / 4.0 }
}

/// What a tile has of areas of these classes.
fn pieces(
    package: &FilePackage,
    id: TileId,
    classes: &[AreaClass],
) -> Result<Vec<AreaPiece>, ExportError> {
    let Some(bytes) = package.tile(id)? else { return Ok(Vec::new()) };
    let areas = decode_areas(&bytes, id, &package.manifest().frame)
        .map_err(|source| ExportError::Areas { source: Box::new(source) })?;
    let wanted = areas.into_iter().filter(|area| classes.contains(&area.class));
    Ok(wanted
        .map(|area| AreaPiece {
            object: area.object,
            tile: pmtiles_order(id),
            class: area.class.number(),
            name: area.name,
            rings: area.polygons.into_iter().flat_map(|polygon| polygon.rings).collect(),
        })
        .collect())
}

fn feature(
    pieces: &[AreaPiece],
    (places, rounding_m): (&Places<'_>, f64),
    summary: &mut AreasSummary,
) -> Result<Record, ExportError> {
    let first = &pieces[0];
    let object = first.object;
    if pieces.iter().any(|piece| (piece.class, &piece.name) != (first.class, &first.name)) {
        return Err(ExportError::AreaDiffers { object });
    }
    let class = first.class().ok_or(ExportError::AreaDiffers { object })?;
    let (polygons, is_joined) = joined(pieces);
    let (mut shape, mut area_m2, mut points) = (Vec::new(), 0.0, 0);
    for polygon in &polygons {
        let mut rings = Vec::new();
        for ring in polygon.rings() {
            points += ring.points().len();
            area_m2 += area_of(ring.points(), places);
            rings.push(places.carry_ring(object, ring.points())?);
        }
        shape.extend(places.cut_polygon(object, rings, rounding_m)?);
    }
    summary.areas += 1;
    summary.polygons += polygons.len() as u64;
    summary.points += points as u64;
    summary.area_m2 += area_m2;
    summary.unjoined += u64::from(!is_joined);
    let (kind, id) = object.parts();
    let name = first.name.clone();
    let values = vec![
        Value::Text(kind.to_owned()),
        Value::Integer(id),
        Value::Text(class.name().to_owned()),
        if name.is_empty() { Value::Null } else { Value::Text(name) },
        Value::Real((area_m2 * 1e3).round() / 1e3),
        Value::Integer(polygons.len() as i64),
        Value::Integer(points as i64),
    ];
    Ok(Record { values, shape: Shape::Polygons(shape) })
}

/// The polygons of an object, joined over borders of tiles: there both tiles have the same segments, and what is there twice
/// cancels out. Where that is no outline any more (a damaged package), the parts as the tiles have them, and `false`.
fn joined(pieces: &[AreaPiece]) -> (Vec<Polygon>, bool) {
    let all: Vec<&[LatticePoint]> =
        pieces.iter().flat_map(|piece| piece.rings.iter().map(Vec::as_slice)).collect();
    if let Some(polygons) = polygons_of(&all) {
        return (polygons, true);
    }
    let parts = pieces.iter().filter_map(|piece| {
        let rings: Vec<&[LatticePoint]> = piece.rings.iter().map(Vec::as_slice).collect();
        polygons_of(&rings)
    });
    (parts.flatten().collect(), false)
}

/// True area inside a ring, square metres; negative for a clockwise one.
fn area_of(points: &[LatticePoint], places: &Places<'_>) -> f64 {
    let at = |point: &LatticePoint| places.wgs84([point.u as f64, point.v as f64]);
    wgs84::area_m2(&points.iter().map(at).collect::<Vec<_>>())
}

/// What the file says of itself.
fn layer(package: &FilePackage, level: u8, places: &Places<'_>) -> Layer {
    let manifest = package.manifest();
    let [east_m, north_m] = manifest.frame.level_cell(level).to_array();
    let name = package.file_name().to_owned();
    Layer {
        name: "areas",
        fields: FIELDS.to_vec(),
        shapes: ShapeKind::Polygons,
        crs: places.crs().to_owned(),
        description: format!(
            "Areas, as they are stored for cells of {east_m:.1} × {north_m:.1} m."
        ),
        attribution: manifest.attribution.join("; "),
        metadata: vec![
            ("GENERATOR", manifest.generator.clone()),
            ("PACKAGE", name),
            ("PACKAGE_SETTINGS_SHA256", manifest.settings_sha256.clone()),
            ("LEVEL", level.to_string()),
        ],
    }
}
