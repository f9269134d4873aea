//! The export of a package's boundaries, from tiles to file.

use std::path::Path;

use corniche_areas::{AreaObject, BoundaryClass, BoundaryNames};
use corniche_geom::{LatticePoint, TileId};
use corniche_tileset::{FilePackage, decode_boundaries, pmtiles_order};
use corniche_work::Observer;

use crate::{
    cut::cut_line_at_bounds,
    error::{FeaturesError, SelectionError},
    features::{FeatureRequest, FeatureSource, Features, write_features},
    piece::Vertex,
    plan_piece::{PlanPiece, class_of, lines_of},
    read,
    vector::{
        FeatureField, FeatureGeometry, FeatureRecord, FieldKind, FieldValue, Layer, ShapeKind,
        fields, fields_of, real,
    },
    whole_lines::whole_lines,
};

/// The figures of an export of boundaries.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct LinesSummary {
    /// The level whose lines were exported.
    pub level: u8,
    /// Features written: one for each OSM way.
    pub ways: u64,
    /// Lines of all features.
    pub lines: u64,
    /// Points of all lines.
    pub points: u64,
    /// True length in plan, metres.
    pub length_m: f64,
}

/// A way with its measures, the input of a feature.
struct LineFeature<'a> {
    way_id: i64,
    class: BoundaryClass,
    /// The names of the areas that ways bound.
    names: Option<&'a BoundaryNames>,
    length_m: f64,
    parts: usize,
    points: u64,
}

/// A field of lines with the function that returns its value.
type LineField = (FeatureField, fn(&LineFeature<'_>) -> FieldValue);

fields! { WAY_FIELDS, line: &LineFeature<'_>:
    "way_id", Integer64, "", "id of the way in OpenStreetMap", line.way_id;
}

fields! { BOUNDARY_FIELDS, line: &LineFeature<'_>:
    "class", Text, "", "class of the most important area that the way bounds: `admin-2` to `admin-8` or `protected`", line.class.name();
    "admin_level", Integer, "", "OSM's `admin_level` of that area; null for protected areas",
        line.class.admin_level().map(i64::from);
}

fields! { NAME_FIELDS, line: &LineFeature<'_>:
    "names", Text, "", "names of all areas that the way bounds, by class, as JSON: `{\"admin-2\":[\"A\",\"B\"],\"protected\":[\"C\"]}`; null if none is known",
        names(line).as_deref();
}

fields! { MEASURES, line: &LineFeature<'_>:
    "length_m", Real, "m", "2D length (in plan) of the part in the package, on the WGS84 ellipsoid",
        real(line.length_m);
    "parts", Integer, "", "number of lines of the feature; gaps separate them", line.parts as i64;
    "points", Integer64, "", "number of points of these lines", line.points as i64;
}

/// Returns the names of the areas that a way bounds, by class, as JSON.
fn names(line: &LineFeature<'_>) -> Option<String> {
    let by_class: serde_json::Map<String, serde_json::Value> = line
        .names?
        .get(&line.way_id)?
        .iter()
        .map(|(class, names)| (class.name().to_owned(), names.iter().cloned().collect()))
        .collect();
    Some(serde_json::Value::from(by_class).to_string())
}

/// Writes the boundaries of a package to a new file at `path`: one feature for each way, joined
/// across tile borders, each segment once. Unnamed temporary files for sorting are created in the
/// same folder. After an error the file at `path` is incomplete. With `names`, each way has the
/// names of the areas that it bounds.
///
/// # Errors
/// When the package has no boundaries or no such level, the request cannot be met, the package is
/// corrupt, or something cannot be written.
pub fn export_boundaries(
    package: &FilePackage,
    names: Option<&BoundaryNames>,
    request: &FeatureRequest<BoundaryClass>,
    path: &Path,
    observer: &dyn Observer,
) -> Result<LinesSummary, FeaturesError> {
    SelectionError::check_layer(package, NAME, package.manifest().boundaries.as_ref())?;
    let source = FeatureSource::new(package, request)?;
    let summary = LinesSummary { level: source.level, ..LinesSummary::default() };
    let mut lines = Lines { names, summary };
    write_features(&mut lines, &source, path, observer)?;
    Ok(lines.summary)
}

/// The layer's name in files.
const NAME: &str = "boundaries";

/// An export of boundaries in progress.
struct Lines<'a> {
    names: Option<&'a BoundaryNames>,
    summary: LinesSummary,
}

impl Lines<'_> {
    fn fields(&self) -> Vec<LineField> {
        let names = if self.names.is_some() { NAME_FIELDS } else { &[] };
        [WAY_FIELDS, BOUNDARY_FIELDS, names, MEASURES].concat()
    }
}

impl Features for Lines<'_> {
    type Class = BoundaryClass;
    type TilePiece = PlanPiece;
    fn layer(&self, source: &FeatureSource<'_, BoundaryClass>) -> Layer {
        let description = format!("Boundaries, as they are stored for {}.", source.cells());
        source.layer(
            (NAME, ShapeKind::PlanLines),
            fields_of(&self.fields()),
            description,
            Vec::new(),
        )
    }

    fn pieces(
        &mut self,
        FeatureSource { package, request, .. }: &FeatureSource<'_, BoundaryClass>,
        tile: TileId,
    ) -> Result<Vec<PlanPiece>, FeaturesError> {
        let lines = read::layer(package, tile, NAME, |bytes| decode_boundaries(bytes, tile))?;
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
        FeatureSource { places, request, .. }: &FeatureSource<'_, BoundaryClass>,
        pieces: &[PlanPiece],
    ) -> Result<Vec<FeatureRecord>, FeaturesError> {
        let class = class_of(pieces, BoundaryClass::from_number)?;
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
        Ok(vec![FeatureRecord { values, shape: FeatureGeometry::Lines(carried) }])
    }
}
