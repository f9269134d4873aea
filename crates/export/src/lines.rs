//! The whole way of a layer of lines, such as boundaries, out of a package.

use std::path::Path;

use corniche_areas::{AreaObject, BoundaryClass, ClassedLayer, LineClass, LineNames};
use corniche_geom::{LatticePoint, TileId};
use corniche_tileset::{FilePackage, decode_lines, pmtiles_order};
use corniche_work::Observer;

use crate::{
    cut::cut_line_at_bounds,
    error::{FeaturesError, SelectionError},
    features::{About, FeatureRequest, FeatureSource, Features, write_features},
    piece::Vertex,
    plan_piece::{PlanPiece, class_of, lines_of},
    read,
    vector::{Field, FieldKind, Record, Shape, ShapeKind, Value, fields, fields_of, real},
    whole_lines::whole_lines,
};

/// What was exported.
#[derive(Debug, Clone, PartialEq)]
pub struct LinesSummary {
    /// The level whose lines were taken.
    pub level: u8,
    /// Features written: ways of OSM.
    pub ways: u64,
    /// Lines of all features.
    pub lines: u64,
    /// Points of all lines.
    pub points: u64,
    /// True length in plan, metres.
    pub length_m: f64,
}

/// A way on its way into a file.
struct LineFeature<'a> {
    way_id: i64,
    class: LineClass,
    /// The names of what ways bound.
    names: Option<&'a LineNames>,
    length_m: f64,
    parts: usize,
    points: u64,
}

/// A field of lines with what is in it.
type LineField = (Field, fn(&LineFeature<'_>) -> Value);

fields! { WAY_FIELDS, line: &LineFeature<'_>:
    "way_id", Integer64, "", "id of the way in OpenStreetMap", line.way_id;
}

fields! { BOUNDARY_FIELDS, line: &LineFeature<'_>:
    "class", Text, "", "the most important of what it bounds: `admin-2` to `admin-8` or `protected`", line.class.name();
    "admin_level", Integer, "", "OSM's `admin_level` of that; null for protected areas",
        BoundaryClass::from_number(line.class.number()).and_then(BoundaryClass::admin_level).map(i64::from);
}

fields! { NAME_FIELDS, line: &LineFeature<'_>:
    "names", Text, "", "names of all that it bounds, by class, as JSON: `{\"admin-2\":[\"A\",\"B\"],\"protected\":[\"C\"]}`; null without",
        names(line).as_deref();
}

fields! { MEASURES, line: &LineFeature<'_>:
    "length_m", Real, "m", "true length in plan, on the ellipsoid of WGS84, of what the package has of it",
        real(line.length_m);
    "parts", Integer, "", "lines without a gap between them", line.parts as i64;
    "points", Integer64, "", "points of these lines", line.points as i64;
}

/// The names of what a way bounds, by class, as JSON.
fn names(line: &LineFeature<'_>) -> Option<String> {
    let by_class: serde_json::Map<String, serde_json::Value> = line
        .names?
        .get(&line.way_id)?
        .iter()
        .map(|(class, names)| (class.name().to_owned(), names.iter().cloned().collect()))
        .collect();
    Some(serde_json::Value::from(by_class).to_string())
}

/// Writes a layer of lines of a package to a new file at `path`: a feature for each way, joined again over borders of tiles, each segment once.
/// Beside the file, in the same folder, are unnamed files for sorting. After an error the file at `path` is of no use. With `names` each way has
/// those of what it bounds.
///
/// # Errors
/// When the package has no such layer or level, the request cannot be met, the package is damaged, or something cannot be
/// written.
pub fn export_lines(
    package: &FilePackage,
    (layer, names): (ClassedLayer, Option<&LineNames>),
    request: &FeatureRequest<LineClass>,
    path: &Path,
    observer: &dyn Observer,
) -> Result<LinesSummary, FeaturesError> {
    SelectionError::check_layer(package, layer.name(), package.manifest().lines(layer))?;
    let source = FeatureSource::new(package, request)?;
    let level = source.level;
    let summary = LinesSummary { level, ways: 0, lines: 0, points: 0, length_m: 0.0 };
    let mut lines = Lines { layer, names, summary };
    write_features(&mut lines, &source, path, observer)?;
    Ok(lines.summary)
}

/// Lines of a layer on their way into a file.
struct Lines<'a> {
    layer: ClassedLayer,
    names: Option<&'a LineNames>,
    summary: LinesSummary,
}

impl Lines<'_> {
    fn fields(&self) -> Vec<LineField> {
        let of_class = match self.layer {
            ClassedLayer::Boundaries => BOUNDARY_FIELDS,
        };
        let names = if self.names.is_some() { NAME_FIELDS } else { &[] };
        [WAY_FIELDS, of_class, names, MEASURES].concat()
    }
}

impl Features for Lines<'_> {
    type Class = LineClass;
    type Piece = PlanPiece;
    const SHAPES: ShapeKind = ShapeKind::PlanLines;

    fn name(&self) -> &'static str {
        self.layer.name()
    }

    fn about(&self, source: &FeatureSource<'_, LineClass>) -> About {
        About {
            fields: fields_of(&self.fields()),
            description: format!(
                "{}, as they are stored for {}.",
                self.layer.table().title,
                source.cells()
            ),
            metadata: Vec::new(),
        }
    }

    fn pieces(
        &mut self,
        FeatureSource { package, request, .. }: &FeatureSource<'_, LineClass>,
        tile: TileId,
    ) -> Result<Vec<PlanPiece>, FeaturesError> {
        let lines =
            read::layer(package, tile, self.name(), |bytes| decode_lines(bytes, tile, self.layer))?;
        let wanted = lines.into_iter().filter(|one| request.classes.contains(&one.class));
        Ok(wanted
            .map(|line| PlanPiece {
                object: AreaObject::Way(line.way_id),
                tile: pmtiles_order(tile),
                class: line.class.number(),
                name: String::new(),
                lines: vec![line.points],
            })
            .collect())
    }

    fn object(piece: &PlanPiece) -> AreaObject {
        piece.object
    }

    fn records(
        &mut self,
        FeatureSource { places, request, .. }: &FeatureSource<'_, LineClass>,
        pieces: &[PlanPiece],
    ) -> Result<Vec<Record>, FeaturesError> {
        let class = class_of(pieces, |number| self.layer.class(number))?;
        let object = pieces[0].object;
        let vertex =
            |point: &LatticePoint| Vertex { at: point.in_steps(), z_m: 0.0, is_source: true };
        let whole = whole_lines(&lines_of(pieces)).into_iter();
        let whole = whole.map(|line| line.iter().map(vertex).collect::<Vec<Vertex>>());
        let lines: Vec<Vec<Vertex>> = match &request.bounds {
            None => whole.collect(),
            Some(bounds) => whole
                .flat_map(|line| cut_line_at_bounds(&line, bounds, &|at| places.wgs84(at)))
                .map(|cut| cut.vertices)
                .collect(),
        };
        if lines.is_empty() {
            return Ok(Vec::new());
        }
        let segments = || lines.iter().flat_map(|line| line.array_windows());
        let length_m = segments().map(|[from, to]| places.distance_m(from.at, to.at)).sum::<f64>();
        let points = lines.iter().map(|line| line.len() as u64).sum::<u64>();
        self.summary.ways += 1;
        self.summary.lines += lines.len() as u64;
        self.summary.points += points;
        self.summary.length_m += length_m;
        let mut carried = Vec::with_capacity(lines.len());
        for line in &lines {
            carried.extend(places.carry(object, line)?);
        }
        let line = LineFeature {
            way_id: object.parts().1,
            class,
            names: self.names,
            length_m,
            parts: lines.len(),
            points,
        };
        let values = self.fields().into_iter().map(|(_, value)| value(&line)).collect();
        Ok(vec![Record { values, shape: Shape::Lines(carried) }])
    }
}
