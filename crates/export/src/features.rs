//! The export of roads and of each layer of a package: pieces of tiles, sorted by object, become
//! features of a vector file.

use std::path::Path;

use corniche_geom::TileId;
use corniche_layers::OsmObject;
use corniche_store::SortRecord;
use corniche_tileset::FilePackage;
use corniche_work::{Observer, Stage};

use crate::{
    bounds::DegreeBounds,
    error::FeaturesError,
    places::{FeatureCoordinates, Places},
    read,
    sorted_pieces::{FileScratch, SortedPieces},
    vector::{
        FeatureField, FeatureRecord, Layer, ShapeKind, StyledClasses, VectorFile, VectorFormat,
    },
};

/// The objects of a layer that are exported, and the form of the file.
#[derive(Debug, Clone, PartialEq)]
pub struct FeatureRequest<C> {
    /// The format of the file.
    pub format: VectorFormat,
    /// The level whose objects are exported; `None` means the finest.
    pub level: Option<u8>,
    /// The classes that are exported: of roads, or the ids of a layer's classes, none for all of
    /// them.
    pub classes: Vec<C>,
    /// The rectangle to which objects are clipped.
    pub bounds: Option<DegreeBounds>,
    /// The coordinates of features. Areas have no heights.
    pub coordinates: FeatureCoordinates,
    /// Memory for sorting, in bytes.
    pub memory_bytes: u64,
}

/// The unit of road that becomes a feature.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RoadFeatures {
    /// One feature for each way.
    Ways,
    /// One feature for each piece of a tile.
    Pieces,
}

/// Checks, before anything is read, whether a package can provide lines with heights as requested.
///
/// # Errors
/// When the package has no such level, or the request cannot be met.
pub fn check_lines_request(
    package: &FilePackage,
    level: Option<u8>,
    (format, coordinates): (VectorFormat, FeatureCoordinates),
) -> Result<(), FeaturesError> {
    let classes: Vec<()> = Vec::new();
    let request =
        FeatureRequest { format, level, classes, bounds: None, coordinates, memory_bytes: 0 };
    FeatureSource::new(package, &request).map(drop)
}

/// The part of an export that is specific to a layer.
pub(crate) trait Features {
    /// A piece: what one tile has of an object. Pieces sort by object.
    type TilePiece: SortRecord;
    /// The layer's name, fields and metadata in the file.
    fn layer(&self, source: &FeatureSource<'_>) -> Layer;

    /// A whole sentence with the largest error of heights, once all features are written; `None`
    /// for a layer without heights.
    fn heights_told(&self, source: &FeatureSource<'_>) -> Option<String>;

    /// Returns the pieces of the requested objects in a tile.
    fn pieces(
        &mut self,
        source: &FeatureSource<'_>,
        tile: TileId,
    ) -> Result<Vec<Self::TilePiece>, FeaturesError>;

    /// The object of a piece.
    fn object(piece: &Self::TilePiece) -> OsmObject;

    /// Returns the features of an object, made from all its pieces.
    fn records(
        &mut self,
        source: &FeatureSource<'_>,
        pieces: &[Self::TilePiece],
    ) -> Result<Vec<FeatureRecord>, FeaturesError>;
}

/// The inputs of the features of a layer.
pub(crate) struct FeatureSource<'a> {
    pub(crate) package: &'a FilePackage,
    format: VectorFormat,
    coordinates: FeatureCoordinates,
    pub(crate) bounds: Option<&'a DegreeBounds>,
    memory_bytes: u64,
    /// The level whose objects are exported.
    pub(crate) level: u8,
    pub(crate) places: Places<'a>,
}

impl<'a> FeatureSource<'a> {
    /// Fails if the package or the format does not support the request.
    pub(crate) fn new<C>(
        package: &'a FilePackage,
        request: &'a FeatureRequest<C>,
    ) -> Result<Self, FeaturesError> {
        let &FeatureRequest { format, level, ref bounds, coordinates, memory_bytes, .. } = request;
        let level = read::level(package, level)?;
        if format == VectorFormat::GeoJson && coordinates == FeatureCoordinates::Package {
            return Err(FeaturesError::GeoJsonCrs);
        }
        let places = Places::new(package.manifest(), coordinates)?;
        let bounds = bounds.as_ref();
        Ok(Self { package, format, coordinates, bounds, memory_bytes, level, places })
    }

    /// Returns the description of the file's layer, with the metadata of the package. `what` says
    /// what the features are.
    pub(crate) fn layer(
        &self,
        (name, classes): (&str, StyledClasses),
        shapes: ShapeKind,
        fields: Vec<FeatureField>,
        what: &str,
    ) -> Layer {
        let Self { package, level, places, .. } = self;
        let manifest = package.manifest();
        let crs = match (self.format, self.coordinates) {
            // GeoJSON can name a CRS only by its code, and a compound CRS of two codes has none.
            (VectorFormat::GeoJson, FeatureCoordinates::Epsg(code)) => format!("EPSG:{code}"),
            _ => places.wkt.clone(),
        };
        let has_heights = shapes != ShapeKind::Polygons;
        let mut metadata = vec![
            ("GENERATOR", manifest.generator.clone()),
            ("PACKAGE", package.file_name().to_owned()),
            ("PACKAGE_SETTINGS_SHA256", manifest.settings_sha256.clone()),
            ("LEVEL", level.to_string()),
            ("FIELDS", meanings(&fields)),
        ];
        let mut description = format!("{what}.");
        if has_heights {
            let heights = &places.heights;
            description.extend([" Heights: ", heights.as_str(), "."]);
            metadata.push(("HEIGHTS", heights.clone()));
            metadata.push(("VERTICAL_DATUM_OF_PACKAGE", manifest.vertical.datum.clone()));
        }
        Layer {
            name: name.to_owned(),
            fields,
            shapes,
            crs,
            description,
            attribution: manifest.attribution.join("; "),
            metadata,
            classes,
        }
    }

    /// The spacing of the level's grid nodes, in words.
    pub(crate) fn cells(&self) -> String {
        let [east_m, north_m] = self.package.manifest().frame.level_cell(self.level).to_array();
        format!("cells of {east_m:.1} × {north_m:.1} m")
    }
}

/// Writes the features of a layer to a new file at `path`. While it writes, the same folder also
/// contains unnamed temporary files for sorting, and temporary files of GDAL. After an error the
/// file at `path` is incomplete.
pub(crate) fn write_features<F: Features>(
    features: &mut F,
    source: &FeatureSource<'_>,
    path: &Path,
    observer: &dyn Observer,
) -> Result<(), FeaturesError> {
    let scratch = FileScratch::create(corniche_store::folder_of(path))?;
    let tiles = read::tiles(source.package, source.level, source.bounds)?;
    let sorting = (&scratch, source.memory_bytes);
    let pieces =
        SortedPieces::read(&tiles, sorting, observer, |tile| features.pieces(source, tile))?;
    let mut file = VectorFile::create(path, source.format, features.layer(source))?;
    pieces.for_each(observer, F::object, |pieces| {
        for record in features.records(source, &pieces)? {
            file.push(record)?;
        }
        Ok::<(), FeaturesError>(())
    })?;
    if let Some(sentence) = features.heights_told(source) {
        file.tell_heights(sentence);
    }
    file.finish()?;
    observer.end(Stage::ExportFeatures);
    Ok(())
}

/// The meaning and the unit of each field, one line per field.
fn meanings(fields: &[FeatureField]) -> String {
    let line = |field: &FeatureField| match field.unit {
        "" => format!("{}: {}", field.name, field.meaning),
        unit => format!("{} ({unit}): {}", field.name, field.meaning),
    };
    fields.iter().map(line).collect::<Vec<_>>().join("\n")
}
