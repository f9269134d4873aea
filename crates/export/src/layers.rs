//! The export of a layer of a package, from tiles to file: its lines, areas or points.

use std::path::Path;

use corniche_areas::Polygon;
use corniche_geom::{StepBudget, TileId};
use corniche_layers::{LayerForm, LayerGeometry, OsmObject};
use corniche_tileset::{FilePackage, LayerObject, LayerShape, LayerSlot, ReadError, pmtiles_order};
use corniche_work::Observer;

use crate::{
    cut::{cut_line_at_bounds, polygons_of},
    cut_polygon::{Rings, cut_polygon_at_bounds, rings_of},
    error::{FeaturesError, SelectionError},
    features::{FeatureRequest, FeatureSource, Features, write_features},
    heights::height_bound,
    laid_lines::{LaidStretch, MOST_STEPS, TileGround},
    layer_fields::{LayerFields, LayerMeasures},
    layer_piece::{LayerPiece, check_same, lines_of, point_of},
    piece::Vertex,
    places::FeatureCoordinates,
    vector::{FeatureGeometry, FeatureRecord, Layer, ShapeKind, StyledClasses},
};

/// The figures of an export of a layer.
#[derive(Debug, Clone, PartialEq)]
pub struct LayerSummary {
    /// The level whose objects were exported.
    pub level: u8,
    /// Whether features are lines, areas or points.
    pub geometry: LayerGeometry,
    /// Features written: one for each OSM object.
    pub objects: u64,
    /// Lines, polygons or points of all features.
    pub parts: u64,
    /// Points of all parts; rings without their closing points.
    pub points: u64,
    /// True length of lines in plan, metres.
    pub length_m: f64,
    /// True area on the ellipsoid, square metres.
    pub area_m2: f64,
    /// Areas whose parts in different tiles could not be joined; each part is exported as a
    /// polygon.
    pub unjoined: u64,
    /// Lines and points without any ground below them; they are skipped.
    pub without_ground: u64,
    /// What the heights of lines and points refer to, in words; `None` for areas.
    pub heights: Option<String>,
}

/// Writes a layer of a package to a new file at `path`: one feature for each OSM object, joined
/// across tile borders. Lines and points are on the ground of the level. `languages` are the
/// languages of additional fields with names, such as `de`. Unnamed temporary files for sorting are
/// created in the same folder. After an error the file at `path` is incomplete.
///
/// # Errors
/// When the package has no such layer, class or level, the request cannot be met, the package is
/// corrupt, or something cannot be written.
pub fn export_layer(
    package: &FilePackage,
    (layer, languages): (&str, &[String]),
    request: &FeatureRequest<String>,
    path: &Path,
    observer: &dyn Observer,
) -> Result<LayerSummary, FeaturesError> {
    let (slot, record) = SelectionError::find_layer(package, layer)?;
    let table = &record.table;
    let classes = SelectionError::find_classes(table, &request.classes)?;
    let has_heights = table.geometry != LayerGeometry::Area;
    let mut request = request.clone();
    if !has_heights && request.coordinates == FeatureCoordinates::Wgs84 {
        request.coordinates = FeatureCoordinates::Wgs84WithPackageHeights;
    }
    let source = FeatureSource::new(package, &request)?;
    let summary = LayerSummary {
        level: source.level,
        geometry: table.geometry,
        objects: 0,
        parts: 0,
        points: 0,
        length_m: 0.0,
        area_m2: 0.0,
        unjoined: 0,
        without_ground: 0,
        heights: has_heights.then(|| source.places.heights.clone()),
    };
    let fields = LayerFields::new(table, languages);
    let mut objects = Objects { slot, table, classes, fields, summary };
    write_features(&mut objects, &source, path, observer)?;
    Ok(objects.summary)
}

/// The largest rounding error of area corners on a level, metres. The build rounds corners to a
/// lattice of 0.1 m on the finest level, and of a quarter of a cell on the levels above. Where
/// tiles meet, corners are rounded twice, by up to half a step each time.
fn rounding_m(source: &FeatureSource<'_>) -> f64 {
    let frame = &source.package.manifest().frame;
    let level = source.level;
    if level == frame.max_level() { 0.1 } else { frame.level_cell(level).shorter_m() / 4.0 }
}

/// An export of a layer in progress.
struct Objects<'a> {
    slot: LayerSlot,
    table: &'a LayerForm,
    /// Whether each class is exported.
    classes: Vec<bool>,
    fields: LayerFields,
    summary: LayerSummary,
}

impl Features for Objects<'_> {
    type TilePiece = LayerPiece;

    fn layer(&self, source: &FeatureSource<'_>) -> Layer {
        let (shapes, stored) = match self.table.geometry {
            LayerGeometry::Line => (ShapeKind::Lines, "laid on terrain with"),
            LayerGeometry::Area => (ShapeKind::Polygons, "as stored for"),
            LayerGeometry::Point => (ShapeKind::Points, "on terrain with"),
        };
        let id = self.table.id.as_str();
        let title = self.table.title.title(&["en"]).unwrap_or(id);
        let what = format!("{title}, {stored} {}", source.cells());
        let classes = StyledClasses::Layer(Box::new(self.table.clone()));
        source.layer((id, classes), shapes, self.fields.fields(), &what)
    }

    fn heights_told(&self, source: &FeatureSource<'_>) -> Option<String> {
        self.summary.heights.as_ref()?;
        height_bound(source.package.manifest(), source.level)
    }

    fn pieces(
        &mut self,
        FeatureSource { package, .. }: &FeatureSource<'_>,
        tile: TileId,
    ) -> Result<Vec<LayerPiece>, FeaturesError> {
        let manifest = package.manifest();
        let Some(bytes) = package.tile(tile)? else { return Ok(Vec::new()) };
        let mut objects =
            manifest.decode_layer(&bytes, tile, self.slot).map_err(ReadError::from)?;
        objects.retain(|of| self.classes.get(usize::from(of.class)) == Some(&true));
        let needs_ground = self.summary.heights.is_some() && !objects.is_empty();
        let ground = if needs_ground { TileGround::decode(manifest, tile, &bytes)? } else { None };
        let work = StepBudget::new(MOST_STEPS);
        let piece = |(part, of): (usize, LayerObject)| {
            let laid = ground.as_ref().map_or(Ok(Vec::new()), |ground| match &of.shape {
                LayerShape::Line(points) => ground.lay::<FeaturesError>(points, &work),
                LayerShape::Area(_) => Ok(Vec::new()),
                LayerShape::Point(point) => {
                    let segment = [*point; 2];
                    let at = |vertex| LaidStretch { segment, vertices: vec![vertex] };
                    Ok(ground.vertex(*point).map(at).into_iter().collect())
                }
            })?;
            Ok(LayerPiece { tile: pmtiles_order(tile), part, of, laid })
        };
        objects.into_iter().enumerate().map(piece).collect()
    }

    fn object(piece: &LayerPiece) -> OsmObject {
        piece.of.object
    }

    fn records(
        &mut self,
        source: &FeatureSource<'_>,
        pieces: &[LayerPiece],
    ) -> Result<Vec<FeatureRecord>, FeaturesError> {
        let of = check_same(pieces)?;
        let shape = match self.table.geometry {
            LayerGeometry::Line | LayerGeometry::Point => self.lines(source, pieces)?,
            LayerGeometry::Area => self.polygons(source, pieces)?,
        };
        let Some((shape, measures)) = shape else { return Ok(Vec::new()) };
        let summary = &mut self.summary;
        summary.objects += 1;
        summary.parts += measures.parts;
        summary.points += measures.points;
        summary.length_m += measures.length_m;
        summary.area_m2 += measures.area_m2;
        let class = &self.table.classes[usize::from(of.class)].id;
        let values = self.fields.values(of, class, measures);
        Ok(vec![FeatureRecord { values, shape }])
    }
}

/// The geometry of a feature with its measures; `None` outside the bounds, or without ground.
type MeasuredShape = Option<(FeatureGeometry, LayerMeasures)>;

impl Objects<'_> {
    /// Returns lines, or a point.
    fn lines(
        &mut self,
        FeatureSource { places, bounds, .. }: &FeatureSource<'_>,
        pieces: &[LayerPiece],
    ) -> Result<MeasuredShape, FeaturesError> {
        let object = pieces[0].of.object;
        let is_point = self.table.geometry == LayerGeometry::Point;
        let laid = if is_point { point_of(pieces) } else { lines_of(pieces) };
        self.summary.without_ground += u64::from(laid.is_empty());
        let wgs84 = |at| places.wgs84(at);
        let cut = |line: Vec<Vertex>| match bounds {
            None => vec![line],
            Some(bounds) if is_point => {
                let at = wgs84(line[0].at);
                bounds.inside(at, at).first().map(|_| line).into_iter().collect()
            }
            Some(bounds) => {
                let cut = cut_line_at_bounds(&line, bounds, &wgs84).into_iter();
                cut.map(|cut| cut.vertices).collect()
            }
        };
        let lines: Vec<Vec<Vertex>> = laid.into_iter().flat_map(cut).collect();
        let segments = lines.iter().flat_map(|line| line.array_windows());
        let measures = LayerMeasures {
            parts: lines.len() as u64,
            points: lines.iter().map(|line| line.len() as u64).sum(),
            length_m: segments.map(|[from, to]| places.distance_m(from.at, to.at)).sum(),
            area_m2: 0.0,
        };
        let mut carried = Vec::with_capacity(lines.len());
        for line in &lines {
            carried.extend(places.carry(object, line)?);
        }
        let shape = match carried.first().map(Vec::as_slice) {
            None => return Ok(None),
            Some(&[point]) if is_point => FeatureGeometry::Point(point),
            Some(_) => FeatureGeometry::Lines(carried),
        };
        Ok(Some((shape, measures)))
    }

    fn polygons(
        &mut self,
        source: &FeatureSource<'_>,
        pieces: &[LayerPiece],
    ) -> Result<MeasuredShape, FeaturesError> {
        let FeatureSource { places, bounds, .. } = source;
        let object = pieces[0].of.object;
        let (joined, is_joined) = joined(pieces);
        let mut polygons: Vec<Rings> = Vec::new();
        for polygon in &joined {
            match bounds {
                None => polygons.push(rings_of(polygon, places)),
                Some(bounds) => polygons.extend(
                    cut_polygon_at_bounds(polygon, bounds, places)
                        .ok_or(FeaturesError::BoundsAcross { object })?,
                ),
            }
        }
        if polygons.is_empty() {
            return Ok(None);
        }
        self.summary.unjoined += u64::from(!is_joined);
        let mut measures =
            LayerMeasures { parts: polygons.len() as u64, ..LayerMeasures::default() };
        let mut shape = Vec::new();
        for polygon in polygons {
            let mut rings = Vec::new();
            for ring in polygon {
                measures.points += ring.len() as u64;
                measures.area_m2 += places.manifest.coordinates.ring_area_m2(&ring);
                rings.push(places.carry_plan(object, ring)?);
            }
            shape.extend(places.cut_polygon(object, rings, rounding_m(source))?);
        }
        Ok(Some((FeatureGeometry::Polygons(shape), measures)))
    }
}

/// Joins the polygons of an object across tile borders. Both tiles of a border have the same
/// segments there, and a segment that occurs twice cancels out. Where the result is no valid
/// outline (in a corrupt package), returns the parts as the tiles have them, and `false`.
fn joined(pieces: &[LayerPiece]) -> (Vec<Polygon>, bool) {
    let all: Vec<_> = pieces.iter().flat_map(|piece| piece.of.shape.rings()).collect();
    if let Some(polygons) = polygons_of(&all) {
        return (polygons, true);
    }
    let own = |piece: &LayerPiece| polygons_of(&piece.of.shape.rings().collect::<Vec<_>>());
    let parts = pieces.iter().filter_map(own);
    (parts.flatten().collect(), false)
}
