//! The whole way of roads out of a package.

use std::path::Path;

use corniche_areas::AreaObject;
use corniche_geom::TileId;
use corniche_roads::FunctionalRoadClass;
use corniche_tileset::{FilePackage, tile_of_order};
use corniche_work::Observer;

use crate::{
    cut::cut_at_bounds,
    error::ExportError,
    feature::{Road, road_fields, road_values},
    feature_request::{FeatureRequest, RoadFeatures},
    features::{About, FeatureSource, Features, write_features},
    join::{Line, lines},
    measures::Measures,
    piece::Piece,
    places::Places,
    read,
    vector::{Record, Shape, ShapeKind},
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
    request: &FeatureRequest<FunctionalRoadClass>,
    features: RoadFeatures,
    path: &Path,
    observer: &dyn Observer,
) -> Result<ExportSummary, ExportError> {
    if package.manifest().inputs.iter().all(|input| input.kind != "osm") {
        return Err(ExportError::NoRoads { package: package.path().to_path_buf() });
    }
    let source = FeatureSource::new(package, request, Roads::SHAPES)?;
    let mut roads = Roads {
        by_piece: features == RoadFeatures::Pieces,
        summary: ExportSummary {
            level: source.level,
            features: 0,
            ways: 0,
            length_2d_m: 0.0,
            vertices: 0,
            heights: source.places.heights().to_owned(),
        },
    };
    write_features(&mut roads, &source, path, observer)?;
    Ok(roads.summary)
}

/// Roads on their way into a file.
struct Roads {
    by_piece: bool,
    summary: ExportSummary,
}

impl Features for Roads {
    type Class = FunctionalRoadClass;
    type Piece = Piece;
    const NAME: &'static str = "roads";
    const SHAPES: ShapeKind = ShapeKind::Lines;

    fn about(&self, source: &FeatureSource<'_, FunctionalRoadClass>) -> About {
        let what = if self.by_piece { "Pieces of roads" } else { "Roads" };
        let (cells, heights) = (source.cells(), source.places.heights());
        About {
            fields: road_fields(self.by_piece),
            description: format!("{what} laid on terrain with {cells}. Heights: {heights}."),
            metadata: vec![
                ("HEIGHTS", heights.to_owned()),
                ("VERTICAL_DATUM_OF_PACKAGE", source.package.manifest().vertical.datum.clone()),
            ],
        }
    }

    fn pieces(
        &self,
        FeatureSource { package, request, places, .. }: &FeatureSource<'_, FunctionalRoadClass>,
        tile: TileId,
    ) -> Result<Vec<Piece>, ExportError> {
        let pieces = read::pieces(package, tile, &request.classes)?;
        let Some(bounds) = &request.bounds else { return Ok(pieces) };
        let cut = |piece| cut_at_bounds(piece, bounds, &|at| places.wgs84(at));
        Ok(pieces.iter().flat_map(cut).collect())
    }

    fn object(piece: &Piece) -> AreaObject {
        AreaObject::Way(piece.key.way_id)
    }

    fn records(
        &mut self,
        source: &FeatureSource<'_, FunctionalRoadClass>,
        pieces: &[Piece],
    ) -> Result<Vec<Record>, ExportError> {
        let Some(first) = pieces.first() else { return Ok(Vec::new()) };
        let is_same =
            |piece: &Piece| piece.class == first.class && piece.attributes == first.attributes;
        if !pieces.iter().all(is_same) {
            return Err(ExportError::Differs { object: Self::object(first) });
        }
        self.summary.ways += 1;
        if !self.by_piece {
            return Ok(vec![self.record(&source.places, first, &lines(pieces))?]);
        }
        let of_piece = |piece: &Piece| {
            let line = Line { vertices: piece.vertices.clone(), joins: Vec::new() };
            self.record(&source.places, piece, &[line])
        };
        pieces.iter().map(of_piece).collect()
    }
}

impl Roads {
    fn record(
        &mut self,
        places: &Places<'_>,
        of: &Piece,
        lines: &[Line],
    ) -> Result<Record, ExportError> {
        let Piece { key, class, attributes, .. } = of;
        let measures = Measures::of(lines, &|from, to| places.distance_m(from, to));
        self.summary.features += 1;
        self.summary.length_2d_m += measures.length_2d_m;
        self.summary.vertices += measures.vertices_out;
        let piece = tile_of_order(key.tile).filter(|_| self.by_piece).map(|tile| (tile, key.part));
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
            carried.extend(places.carry(Self::object(of), &line.vertices)?);
        }
        Ok(Record { values: road_values(&road), shape: Shape::Lines(carried) })
    }
}
