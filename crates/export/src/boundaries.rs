//! The whole way of boundaries out of a package.

use std::path::Path;

use corniche_areas::{AreaObject, BoundaryClass};
use corniche_geom::{LatticePoint, TileId};
use corniche_tileset::{FilePackage, decode_boundaries, pmtiles_order};
use corniche_work::Observer;

use crate::{
    cut::cut_line_at_bounds,
    error::ExportError,
    feature_request::FeatureRequest,
    features::{About, FeatureSource, Features, write_features},
    piece::Vertex,
    plan_piece::{PlanPiece, class_of, lines_of},
    vector::{Field, FieldKind, Record, Shape, ShapeKind, Value},
    whole_lines::whole_lines,
};

/// What was exported.
#[derive(Debug, Clone, PartialEq)]
pub struct BoundariesSummary {
    /// The level whose boundaries were taken.
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

const FIELDS: &[Field] = &[
    Field {
        name: "way_id",
        kind: FieldKind::Integer64,
        unit: "",
        meaning: "id of the way in OpenStreetMap",
    },
    Field {
        name: "class",
        kind: FieldKind::Text,
        unit: "",
        meaning: "the most important of what it bounds: `admin-2` to `admin-8` or `protected`",
    },
    Field {
        name: "admin_level",
        kind: FieldKind::Integer,
        unit: "",
        meaning: "OSM's `admin_level` of that; null for protected areas",
    },
    Field {
        name: "length_m",
        kind: FieldKind::Real,
        unit: "m",
        meaning: "true length in plan, on the ellipsoid of WGS84, of what the package has of it",
    },
    Field {
        name: "parts",
        kind: FieldKind::Integer,
        unit: "",
        meaning: "lines without a gap between them",
    },
    Field {
        name: "points",
        kind: FieldKind::Integer64,
        unit: "",
        meaning: "points of these lines",
    },
];

/// Writes the boundaries of a package to a new file at `path`: a feature for each way, joined again over borders of tiles, each segment once.
/// Beside the file, in the same folder, are unnamed files for sorting. After an error the file at `path` is of no use.
///
/// # Errors
/// When the package has no boundaries or no such level, the request cannot be met, the package is damaged, or something cannot be
/// written.
pub fn export_boundaries(
    package: &FilePackage,
    request: &FeatureRequest<BoundaryClass>,
    path: &Path,
    observer: &dyn Observer,
) -> Result<BoundariesSummary, ExportError> {
    if package.manifest().boundaries.is_none() {
        let package = package.path().to_path_buf();
        return Err(ExportError::NoLayer { package, layer: Boundaries::NAME });
    }
    let source = FeatureSource::new(package, request, Boundaries::SHAPES)?;
    let level = source.level;
    let mut boundaries =
        Boundaries(BoundariesSummary { level, ways: 0, lines: 0, points: 0, length_m: 0.0 });
    write_features(&mut boundaries, &source, path, observer)?;
    Ok(boundaries.0)
}

/// Boundaries on their way into a file.
struct Boundaries(BoundariesSummary);

impl Features for Boundaries {
    type Class = BoundaryClass;
    type Piece = PlanPiece;
    const NAME: &'static str = "boundaries";
    const SHAPES: ShapeKind = ShapeKind::PlanLines;

    fn about(&self, source: &FeatureSource<'_, BoundaryClass>) -> About {
        About {
            fields: FIELDS.to_vec(),
            description: format!("Boundaries, as they are stored for {}.", source.cells()),
            metadata: Vec::new(),
        }
    }

    fn pieces(
        &mut self,
        FeatureSource { package, request, .. }: &FeatureSource<'_, BoundaryClass>,
        tile: TileId,
    ) -> Result<Vec<PlanPiece>, ExportError> {
        let Some(bytes) = package.tile(tile)? else { return Ok(Vec::new()) };
        let boundaries = decode_boundaries(&bytes, tile).map_err(|source| {
            ExportError::Damaged { layer: Self::NAME, source: Box::new(source) }
        })?;
        let wanted = boundaries.into_iter().filter(|one| request.classes.contains(&one.class));
        Ok(wanted
            .map(|boundary| PlanPiece {
                object: AreaObject::Way(boundary.way_id),
                tile: pmtiles_order(tile),
                class: boundary.class.number(),
                name: String::new(),
                lines: vec![boundary.points],
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
    ) -> Result<Vec<Record>, ExportError> {
        let class = class_of(pieces, BoundaryClass::from_number)?;
        let object = pieces[0].object;
        let vertex = |point: &LatticePoint| Vertex {
            at: [point.u as f64, point.v as f64],
            z_m: 0.0,
            is_source: true,
        };
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
        self.0.ways += 1;
        self.0.lines += lines.len() as u64;
        self.0.points += points;
        self.0.length_m += length_m;
        let mut carried = Vec::with_capacity(lines.len());
        for line in &lines {
            carried.extend(places.carry(object, line)?);
        }
        let values = vec![
            Value::Integer(object.parts().1),
            Value::Text(class.name().to_owned()),
            class.admin_level().map_or(Value::Null, |level| Value::Integer(level.into())),
            Value::Real((length_m * 1e6).round() / 1e6),
            Value::Integer(lines.len() as i64),
            Value::Integer(points as i64),
        ];
        Ok(vec![Record { values, shape: Shape::Lines(carried) }])
    }
}
