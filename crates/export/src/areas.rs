//! The export of a package's areas, from tiles to file.

use std::path::Path;

use corniche_areas::{AreaClass, AreaObject, Polygon};
use corniche_geom::TileId;
use corniche_tileset::{FilePackage, decode_areas, pmtiles_order};
use corniche_work::Observer;

use crate::{
    cut::polygons_of,
    cut_polygon::{Rings, cut_polygon_at_bounds, rings_of},
    error::{FeaturesError, SelectionError},
    features::{FeatureRequest, FeatureSource, Features, write_features},
    plan_piece::{PlanPiece, class_of, lines_of},
    read,
    vector::{
        FeatureField, FeatureGeometry, FeatureRecord, FieldKind, FieldValue, Layer, ShapeKind,
        fields, fields_of, text,
    },
};

/// The figures of an export of areas.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct AreasSummary {
    /// The level whose areas were exported.
    pub level: u8,
    /// Features written: one for each OSM object.
    pub areas: u64,
    /// Polygons of all features.
    pub polygons: u64,
    /// Points of their rings.
    pub points: u64,
    /// True area on the ellipsoid, square metres.
    pub area_m2: f64,
    /// Areas whose parts in different tiles could not be joined; each part is exported as a
    /// polygon.
    pub unjoined: u64,
}

/// The attributes and the geometry of an area.
struct AreaFeature<'a> {
    object: AreaObject,
    class: AreaClass,
    name: &'a str,
    area_m2: f64,
    polygons: usize,
    points: usize,
}

fields! { FIELDS, area: &AreaFeature<'_>:
    "object", Text, "", "type of the OSM object: `way` or `relation`", area.object.parts().0;
    "id", Integer64, "", "id of the OSM object", area.object.parts().1;
    "class", Text, "", "class of the area, such as `water`", area.class.name();
    "name", Text, "", "OSM's `name`; null if not tagged", text(area.name);
    "area_m2", Real, "m²", "area of the part in the package, on the WGS84 ellipsoid",
        (area.area_m2 * 1e3).round() / 1e3;
    "polygons", Integer, "", "number of polygons", area.polygons as i64;
    "points", Integer, "", "number of points of all rings, without the closing points", area.points as i64;
}

/// Writes the areas of a package to a new file at `path`: one feature for each object, joined
/// across tile borders. Unnamed temporary files for sorting are created in the same folder. After
/// an error the file at `path` is incomplete.
///
/// # Errors
/// When the package has no areas or no such level, the request cannot be met, the package is
/// corrupt, or something cannot be written.
pub fn export_areas(
    package: &FilePackage,
    request: &FeatureRequest<AreaClass>,
    path: &Path,
    observer: &dyn Observer,
) -> Result<AreasSummary, FeaturesError> {
    SelectionError::check_layer(package, NAME, package.manifest().areas.as_ref())?;
    let source = FeatureSource::new(package, request)?;
    let level = source.level;
    let summary = AreasSummary { level, ..AreasSummary::default() };
    let mut areas = Areas { rounding_m: rounding_m(package, level), summary };
    write_features(&mut areas, &source, path, observer)?;
    Ok(areas.summary)
}

/// The largest rounding error of area corners on a level, metres. The build rounds corners to a
/// lattice of 0.1 m on the finest level, and of a quarter of a cell on the levels above. Where
/// tiles meet, corners are rounded twice, by up to half a step each time.
fn rounding_m(package: &FilePackage, level: u8) -> f64 {
    let frame = &package.manifest().frame;
    if level == frame.max_level() { 0.1 } else { frame.level_cell(level).shorter_m() / 4.0 }
}

/// The name of the layer.
const NAME: &str = "areas";

/// An export of areas in progress.
struct Areas {
    rounding_m: f64,
    summary: AreasSummary,
}

impl Features for Areas {
    type Class = AreaClass;
    type TilePiece = PlanPiece;

    fn layer(&self, source: &FeatureSource<'_, AreaClass>) -> Layer {
        let description = format!("Areas, as they are stored for {}.", source.cells());
        source.layer((NAME, ShapeKind::Polygons), fields_of(FIELDS), description, Vec::new())
    }

    fn pieces(
        &mut self,
        FeatureSource { package, request, .. }: &FeatureSource<'_, AreaClass>,
        tile: TileId,
    ) -> Result<Vec<PlanPiece>, FeaturesError> {
        let frame = &package.manifest().frame;
        let areas = read::layer(package, tile, NAME, |bytes| decode_areas(bytes, tile, frame))?;
        let wanted = areas.into_iter().filter(|area| request.classes.contains(&area.class));
        Ok(wanted
            .map(|area| PlanPiece {
                object: area.object,
                tile: pmtiles_order(tile),
                class: area.class.number(),
                name: area.name,
                lines: area.polygons.into_iter().flat_map(|polygon| polygon.rings).collect(),
            })
            .collect())
    }

    fn object(piece: &PlanPiece) -> AreaObject {
        piece.object
    }

    fn records(
        &mut self,
        FeatureSource { places, request, .. }: &FeatureSource<'_, AreaClass>,
        pieces: &[PlanPiece],
    ) -> Result<Vec<FeatureRecord>, FeaturesError> {
        let class = class_of(pieces, AreaClass::from_number)?;
        let object = pieces[0].object;
        let (joined, is_joined) = joined(pieces);
        let mut polygons: Vec<Rings> = Vec::new();
        for polygon in &joined {
            match &request.bounds {
                None => polygons.push(rings_of(polygon, places)),
                Some(bounds) => polygons.extend(
                    cut_polygon_at_bounds(polygon, bounds, places)
                        .ok_or(FeaturesError::BoundsAcross { object })?,
                ),
            }
        }
        if polygons.is_empty() {
            return Ok(Vec::new());
        }
        let count = polygons.len();
        let (mut shape, mut area_m2, mut points) = (Vec::new(), 0.0, 0);
        for polygon in polygons {
            let mut rings = Vec::new();
            for ring in polygon {
                points += ring.len();
                area_m2 += places.manifest.coordinates.ring_area_m2(&ring);
                rings.push(places.carry_plan(object, ring)?);
            }
            shape.extend(places.cut_polygon(object, rings, self.rounding_m)?);
        }
        self.summary.areas += 1;
        self.summary.polygons += count as u64;
        self.summary.points += points as u64;
        self.summary.area_m2 += area_m2;
        self.summary.unjoined += u64::from(!is_joined);
        let feature =
            AreaFeature { object, class, name: &pieces[0].name, area_m2, polygons: count, points };
        let values = FIELDS.iter().map(|(_, value)| value(&feature)).collect();
        Ok(vec![FeatureRecord { values, shape: FeatureGeometry::Polygons(shape) }])
    }
}

/// Joins the polygons of an object across tile borders. Both tiles of a border have the same
/// segments there, and a segment that occurs twice cancels out. Where the result is no valid
/// outline (in a corrupt package), returns the parts as the tiles have them, and `false`.
fn joined(pieces: &[PlanPiece]) -> (Vec<Polygon>, bool) {
    let all: Vec<_> = lines_of(pieces).collect();
    if let Some(polygons) = polygons_of(&all) {
        return (polygons, true);
    }
    let parts = pieces.iter().filter_map(|piece| polygons_of(&piece.lines));
    (parts.flatten().collect(), false)
}
