//! The whole way of roads out of a package.

use std::path::Path;

use corniche_store::Sorter;
use corniche_tileset::{FilePackage, tile_of_order};
use corniche_work::{Observer, Stage};

use crate::{
    cut::cut_at_bounds,
    error::ExportError,
    feature::{Road, road_fields, road_values},
    feature_request::{Coordinates, RoadsRequest},
    join::{Line, lines},
    measures::Measures,
    piece::Piece,
    places::Places,
    read,
    scratch::FileScratch,
    vector::{Layer, Record, Shape, ShapeKind, VectorFile, VectorFormat},
    ways::Ways,
};

/// What was exported.
#[derive(Debug, Clone, PartialEq)]
pub struct ExportSummary {
    /// The level whose roads were taken.
    pub level: u8,
    /// Features written.
    pub features: u64,
    /// Ways of which there is something.
    pub ways: u64,
    /// True length in plan, metres.
    pub length_2d_m: f64,
    /// Vertices of all lines on the ground.
    pub vertices: u64,
    /// What the heights of the features are, in words.
    pub heights: String,
}

/// Writes the roads of a package to a new file at `path`. Beside it, in the same folder, are unnamed files for sorting, and
/// what GDAL needs while it writes. After an error the file at `path` is of no use.
///
/// # Errors
/// When the package has no roads or no such level, the request cannot be met, the package is damaged, or something cannot be
/// written.
pub fn export_roads(
    package: &FilePackage,
    request: &RoadsRequest,
    path: &Path,
    observer: &dyn Observer,
) -> Result<ExportSummary, ExportError> {
    let manifest = package.manifest();
    if manifest.inputs.iter().all(|input| input.kind != "osm") {
        return Err(ExportError::NoRoads { package: package.path().to_path_buf() });
    }
    let level = read::level(package, request.level)?;
    if request.format == VectorFormat::GeoJson && request.coordinates == Coordinates::Package {
        return Err(ExportError::GeoJsonCrs);
    }
    let places = Places::new(manifest, request.coordinates)?;
    let folder = corniche_store::folder_of(path);
    let sort = |source| ExportError::Sort { folder: folder.to_path_buf(), source };
    let scratch = FileScratch::create(folder).map_err(sort)?;
    let tiles = read::tiles(package, level, request.bounds.as_ref())?;
    let sorter = (Sorter::new(&scratch, request.memory_bytes), folder);
    let keep = |piece: Piece| match &request.bounds {
        Some(bounds) => cut_at_bounds(&piece, bounds, &|at| places.wgs84(at)),
        None => vec![piece],
    };
    let ways = Ways::read(package, &tiles, &request.classes, sorter, observer, keep)?;
    let layer = layer(package, level, request, &places);
    let mut writing = Writing {
        places: &places,
        by_piece: request.pieces,
        file: VectorFile::create(path, request.format, layer)?,
        summary: ExportSummary {
            level,
            features: 0,
            ways: 0,
            length_2d_m: 0.0,
            vertices: 0,
            heights: places.heights().to_owned(),
        },
    };
    ways.for_each(observer, |pieces| writing.way(&pieces))?;
    let Writing { file, summary, .. } = writing;
    file.finish()?;
    observer.end(Stage::ExportFeatures);
    Ok(summary)
}

/// What the file says of itself.
fn layer(package: &FilePackage, level: u8, request: &RoadsRequest, places: &Places<'_>) -> Layer {
    let manifest = package.manifest();
    let [east_m, north_m] = manifest.frame.level_cell(level).to_array();
    let name = package.file_name().to_owned();
    let what = if request.pieces { "Pieces of roads" } else { "Roads" };
    Layer {
        name: "roads",
        fields: road_fields(request.pieces),
        shapes: ShapeKind::Lines,
        crs: places.crs().to_owned(),
        description: format!(
            "{what} laid on terrain with cells of {east_m:.1} × {north_m:.1} m. Heights: {}.",
            places.heights()
        ),
        attribution: manifest.attribution.join("; "),
        metadata: vec![
            ("GENERATOR", manifest.generator.clone()),
            ("PACKAGE", name),
            ("PACKAGE_SETTINGS_SHA256", manifest.settings_sha256.clone()),
            ("LEVEL", level.to_string()),
            ("HEIGHTS", places.heights().to_owned()),
            ("VERTICAL_DATUM_OF_PACKAGE", manifest.vertical.datum.clone()),
        ],
    }
}

/// Makes features of pieces and writes them.
struct Writing<'a> {
    places: &'a Places<'a>,
    by_piece: bool,
    file: VectorFile,
    summary: ExportSummary,
}

impl Writing<'_> {
    /// Writes the features of a way.
    fn way(&mut self, pieces: &[Piece]) -> Result<(), ExportError> {
        let Some(first) = pieces.first() else { return Ok(()) };
        let is_same =
            |piece: &Piece| piece.class == first.class && piece.attributes == first.attributes;
        if !pieces.iter().all(is_same) {
            return Err(ExportError::Differs { way_id: first.key.way_id });
        }
        self.summary.ways += 1;
        if !self.by_piece {
            return self.feature(first, &lines(pieces), false);
        }
        for piece in pieces {
            let line = Line { vertices: piece.vertices.clone(), joins: Vec::new() };
            self.feature(piece, &[line], true)?;
        }
        Ok(())
    }

    fn feature(&mut self, of: &Piece, lines: &[Line], is_piece: bool) -> Result<(), ExportError> {
        let Piece { key, class, attributes, .. } = of;
        let measures = Measures::of(lines, &|from, to| self.places.distance_m(from, to));
        self.summary.features += 1;
        self.summary.length_2d_m += measures.length_2d_m;
        self.summary.vertices += measures.vertices_out;
        let piece = tile_of_order(key.tile).filter(|_| is_piece).map(|tile| (tile, key.part));
        let road = Road {
            way_id: key.way_id,
            class: *class,
            attributes,
            parts: lines.len(),
            measures,
            piece,
        };
        let mut carried = Vec::with_capacity(lines.len());
        for line in lines {
            carried.extend(self.places.carry(key.way_id, &line.vertices)?);
        }
        self.file.push(Record { values: road_values(&road), shape: Shape::Lines(carried) })
    }
}
