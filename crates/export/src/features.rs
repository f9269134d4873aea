//! The way of each layer out of a package: pieces of tiles, sorted by object, become features of a vector file.

use std::path::Path;

use corniche_areas::AreaObject;
use corniche_geom::TileId;
use corniche_store::SortRecord;
use corniche_tileset::FilePackage;
use corniche_work::{Observer, Stage};

use crate::{
    bounds::DegreeBounds,
    error::FeaturesError,
    places::{Coordinates, Places},
    read,
    sorted_pieces::{FileScratch, SortedPieces},
    vector::{Field, Layer, Record, ShapeKind, VectorFile, VectorFormat},
};

/// Which objects of a layer of a package are exported, and how.
#[derive(Debug, Clone, PartialEq)]
pub struct FeatureRequest<C> {
    /// The format of the file.
    pub format: VectorFormat,
    /// The level whose objects are taken; `None` is the finest.
    pub level: Option<u8>,
    /// The classes that are taken.
    pub classes: Vec<C>,
    /// Objects are cut here.
    pub bounds: Option<DegreeBounds>,
    /// The coordinates of features; only roads have heights.
    pub coordinates: Coordinates,
    /// Memory for sorting, bytes.
    pub memory_bytes: u64,
}

/// Which features roads become.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RoadFeatures {
    /// One for each way.
    Ways,
    /// One for each piece, as the tiles have them.
    Pieces,
}

/// Looks whether lines with heights can be had from a package as they are asked for, before anything is read.
///
/// # Errors
/// When the package has no such level, or the request cannot be met.
pub fn check_lines_request(
    package: &FilePackage,
    level: Option<u8>,
    (format, coordinates): (VectorFormat, Coordinates),
) -> Result<(), FeaturesError> {
    let classes: Vec<()> = Vec::new();
    let request =
        FeatureRequest { format, level, classes, bounds: None, coordinates, memory_bytes: 0 };
    FeatureSource::new(package, &request).map(drop)
}

/// A layer of a package on its way into a file: what is its own.
pub(crate) trait Features {
    /// The classes of its objects.
    type Class;
    /// What one tile holds of an object; pieces sort by objects.
    type Piece: SortRecord;
    /// Its geometries.
    const SHAPES: ShapeKind;

    /// The layer's name in the file.
    fn name(&self) -> &'static str;

    /// What the file says of the layer.
    fn about(&self, source: &FeatureSource<'_, Self::Class>) -> About;

    /// How far heights may be off, a whole sentence, once all features are written; `None` for a layer without heights.
    fn heights_told(&self, _source: &FeatureSource<'_, Self::Class>) -> Option<String> {
        None
    }

    /// What a tile holds of the objects that are wanted.
    fn pieces(
        &mut self,
        source: &FeatureSource<'_, Self::Class>,
        tile: TileId,
    ) -> Result<Vec<Self::Piece>, FeaturesError>;

    /// The object of a piece.
    fn object(piece: &Self::Piece) -> AreaObject;

    /// The features of an object, from all its pieces.
    fn records(
        &mut self,
        source: &FeatureSource<'_, Self::Class>,
        pieces: &[Self::Piece],
    ) -> Result<Vec<Record>, FeaturesError>;
}

/// What a file says of a layer, beside what it says of the package.
pub(crate) struct About {
    pub(crate) fields: Vec<Field>,
    pub(crate) description: String,
    pub(crate) metadata: Vec<(&'static str, String)>,
}

/// What features are made from.
pub(crate) struct FeatureSource<'a, C> {
    pub(crate) package: &'a FilePackage,
    pub(crate) request: &'a FeatureRequest<C>,
    /// The level whose objects are taken.
    pub(crate) level: u8,
    pub(crate) places: Places<'a>,
}

impl<'a, C> FeatureSource<'a, C> {
    /// Fails where the package or the format cannot have what is asked for.
    pub(crate) fn new(
        package: &'a FilePackage,
        request: &'a FeatureRequest<C>,
    ) -> Result<Self, FeaturesError> {
        let level = read::level(package, request.level)?;
        if request.format == VectorFormat::GeoJson && request.coordinates == Coordinates::Package {
            return Err(FeaturesError::GeoJsonCrs);
        }
        let places = Places::new(package.manifest(), request.coordinates)?;
        Ok(Self { package, request, level, places })
    }

    /// The layer of a file that is made from it.
    pub(crate) fn layer(&self, name: &'static str, shapes: ShapeKind, about: About) -> Layer {
        let Self { package, level, places, .. } = self;
        let manifest = package.manifest();
        let About { fields, description, metadata } = about;
        let crs = match (self.request.format, self.request.coordinates) {
            // GeoJSON names systems by their codes, or not at all: there is none for both parts of a compound one.
            (VectorFormat::GeoJson, Coordinates::Epsg(code)) => format!("EPSG:{code}"),
            _ => places.wkt.clone(),
        };
        let of_package = [
            ("GENERATOR", manifest.generator.clone()),
            ("PACKAGE", package.file_name().to_owned()),
            ("PACKAGE_SETTINGS_SHA256", manifest.settings_sha256.clone()),
            ("LEVEL", level.to_string()),
            ("FIELDS", meanings(&fields)),
        ];
        Layer {
            name,
            fields,
            shapes,
            crs,
            description,
            attribution: manifest.attribution.join("; "),
            metadata: of_package.into_iter().chain(metadata).collect(),
        }
    }

    /// The spacing of the level's nodes, in words.
    pub(crate) fn cells(&self) -> String {
        let [east_m, north_m] = self.package.manifest().frame.level_cell(self.level).to_array();
        format!("cells of {east_m:.1} × {north_m:.1} m")
    }
}

/// Writes the features of a layer to a new file at `path`. Beside it, in the same folder, are unnamed files for sorting, and what GDAL needs
/// while it writes. After an error the file at `path` is of no use.
pub(crate) fn write_features<F: Features>(
    features: &mut F,
    source: &FeatureSource<'_, F::Class>,
    path: &Path,
    observer: &dyn Observer,
) -> Result<(), FeaturesError> {
    let FeatureSource { package, request, level, .. } = source;
    let scratch = FileScratch::create(corniche_store::folder_of(path))?;
    let tiles = read::tiles(package, *level, request.bounds.as_ref())?;
    let sorting = (&scratch, request.memory_bytes);
    let pieces =
        SortedPieces::read(&tiles, sorting, observer, |tile| features.pieces(source, tile))?;
    let layer = source.layer(features.name(), F::SHAPES, features.about(source));
    let mut file = VectorFile::create(path, request.format, layer)?;
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

/// What fields say and in which unit, a line for each.
fn meanings(fields: &[Field]) -> String {
    let line = |field: &Field| match field.unit {
        "" => format!("{}: {}", field.name, field.meaning),
        unit => format!("{} ({unit}): {}", field.name, field.meaning),
    };
    fields.iter().map(line).collect::<Vec<_>>().join("\n")
}
