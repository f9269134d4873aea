//! Writes a vector file through GDAL, layer and features, and reads it back at the end.

use std::path::{Path, PathBuf};

use gdal::{
    Dataset, Driver, DriverManager, Metadata as _,
    errors::GdalError,
    vector::{
        Defn, Feature, FieldDefn, Geometry, Layer as GdalLayer, LayerOptions, OGRFieldType,
        OGRwkbGeometryType,
    },
};

use crate::{
    error::GdalFileError,
    gdal_writing::{self, GdalSettings, plain_text},
    vector::{
        cell::cell_text,
        field::{FeatureField, FeatureGeometry, FeatureRecord, FieldKind, FieldValue, ShapeKind},
        format::VectorFormat,
        geopackage,
        map_style::StyledClasses,
        whole::{self, FeatureFileContents},
    },
};

/// Features are passed to GDAL in batches of this many vertices. Each batch is one transaction.
const VERTICES_AT_ONCE: usize = 1 << 16;
/// GDAL's settings for this thread while a file is written. An incomplete file is useless, so the
/// database need not tolerate a loss of power. The same roads give the same bytes on any date.
const SETTINGS: [(&str, &str); 2] =
    [("OGR_SQLITE_SYNCHRONOUS", "OFF"), ("OGR_CURRENT_DATE", geopackage::NO_TIME)];

/// The name, fields and metadata of a layer.
pub(crate) struct Layer {
    pub(crate) name: String,
    pub(crate) fields: Vec<FeatureField>,
    pub(crate) shapes: ShapeKind,
    /// WKT2, or a code such as "EPSG:4979".
    pub(crate) crs: String,
    /// The human-readable description.
    pub(crate) description: String,
    /// The attribution that must be displayed with the features.
    pub(crate) attribution: String,
    /// Keys and values of metadata, for formats that support them.
    pub(crate) metadata: Vec<(&'static str, String)>,
    /// The classes of its features, for the style in which QGIS draws them.
    pub(crate) classes: StyledClasses,
}

/// A file of features while it is written.
pub(crate) struct VectorFile {
    path: PathBuf,
    format: VectorFormat,
    dataset: Dataset,
    layer: Layer,
    waiting: Vec<FeatureRecord>,
    waiting_vertices: usize,
    heights: Option<String>,
    written: FeatureFileContents,
    _settings: GdalSettings,
}

impl VectorFile {
    /// Creates a file with one layer. Nothing may exist at `path`.
    pub(crate) fn create(
        path: &Path,
        format: VectorFormat,
        layer: Layer,
    ) -> Result<Self, GdalFileError> {
        let settings = GdalSettings::set(&SETTINGS);
        let layer = layer.plain();
        let no_driver = |_| GdalFileError::NoDriver { driver: format.driver() };
        let driver = DriverManager::get_driver_by_name(format.driver()).map_err(no_driver)?;
        let dataset = create(path, format, &layer, &driver)
            .map_err(|error| GdalFileError::write(path, error))?;
        Ok(Self {
            path: path.to_path_buf(),
            format,
            dataset,
            layer,
            waiting: Vec::new(),
            waiting_vertices: 0,
            heights: None,
            written: FeatureFileContents::default(),
            _settings: settings,
        })
    }

    /// Adds a feature.
    pub(crate) fn push(&mut self, mut record: FeatureRecord) -> Result<(), GdalFileError> {
        if self.format == VectorFormat::Csv {
            for value in &mut record.values {
                if let FieldValue::Text(text) = value {
                    *text = cell_text(text).into_owned();
                }
            }
        }
        self.waiting_vertices += record.shape.vertices();
        self.waiting.push(record);
        if self.waiting_vertices >= VERTICES_AT_ONCE { self.write() } else { Ok(()) }
    }

    /// Adds the largest error of heights to the description of the layer in a GeoPackage: a whole
    /// sentence. It may be known only when all features are written; the last call counts.
    pub(crate) fn tell_heights(&mut self, sentence: String) {
        self.heights = Some(sentence);
    }

    fn write(&mut self) -> Result<(), GdalFileError> {
        let records = std::mem::take(&mut self.waiting);
        self.written.features += records.len() as u64;
        self.written.vertices += std::mem::take(&mut self.waiting_vertices) as u64;
        let of = &self.layer;
        let written = match self.format {
            // Without a transaction, each feature would be one.
            VectorFormat::GeoPackage => self.dataset.start_transaction().and_then(|transaction| {
                write_all(&transaction.layer(0)?, of, &records)?;
                transaction.commit()
            }),
            _ => self.dataset.layer(0).and_then(|layer| write_all(&layer, of, &records)),
        };
        written.map_err(|error| GdalFileError::write(&self.path, error))
    }

    /// Closes the file and reads it back, because GDAL does not report every error of closing.
    pub(crate) fn finish(mut self) -> Result<(), GdalFileError> {
        self.write()?;
        let Self { path, format, dataset, layer, heights, written, .. } = self;
        if format == VectorFormat::GeoPackage {
            let told = heights.map_or(Ok(()), |heights| {
                geopackage::describe(&dataset, &layer.name, &layer.about(&heights))
            });
            let styled =
                told.and_then(|()| geopackage::add_style(&dataset, &layer.name, &layer.classes));
            styled.map_err(|error| GdalFileError::write(&path, error))?;
        }
        gdal_writing::close(dataset, &path)?;
        whole::check(&path, format, written)
    }
}

impl Layer {
    /// Returns the same with texts that all formats support.
    fn plain(mut self) -> Self {
        let facts = self.metadata.iter_mut().map(|(_, text)| text);
        for text in facts.chain([&mut self.description, &mut self.attribution]) {
            *text = plain_text(text).into_owned();
        }
        self
    }

    /// Returns the description with the error of heights, and the attribution.
    fn about(&self, heights: &str) -> String {
        let parts = [self.description.as_str(), heights, &self.attribution];
        parts.into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join(" ")
    }
}

fn create(
    path: &Path,
    format: VectorFormat,
    layer: &Layer,
    driver: &Driver,
) -> Result<Dataset, GdalError> {
    let mut dataset = driver.create_vector_only(path)?;
    if format == VectorFormat::GeoPackage {
        dataset.set_metadata_item("ATTRIBUTION", &layer.attribution, "")?;
        for (key, value) in &layer.metadata {
            dataset.set_metadata_item(key, value, "")?;
        }
    }
    let crs = gdal_writing::east_north(&layer.crs)?;
    let options = options(format, layer, driver);
    let options: Vec<&str> = options.iter().map(String::as_str).collect();
    let created = dataset.create_layer(LayerOptions {
        name: &layer.name,
        // RFC 7946 has one CRS and no member for it. For others, GDAL writes the member `crs` of
        // the older GeoJSON specification.
        srs: (format != VectorFormat::GeoJson || crs.is_projected()).then_some(&crs),
        ty: layer.shapes.types()[0],
        options: Some(&options),
    })?;
    for field in &layer.fields {
        let kind = match field.kind {
            FieldKind::Integer => OGRFieldType::OFTInteger,
            FieldKind::Integer64 => OGRFieldType::OFTInteger64,
            FieldKind::Real => OGRFieldType::OFTReal,
            FieldKind::Text => OGRFieldType::OFTString,
        };
        FieldDefn::new(&field.name, kind)?.add_to_layer(&created)?;
    }
    Ok(dataset)
}

/// Returns the driver's options in addition to the layer's name, type and CRS.
fn options(format: VectorFormat, layer: &Layer, driver: &Driver) -> Vec<String> {
    let description = format!("{} {}", layer.description, layer.attribution);
    match format {
        VectorFormat::GeoPackage => vec![format!("DESCRIPTION={description}")],
        VectorFormat::FlatGeobuf => {
            // GDAL supports it since 3.9.
            let known = driver.metadata_item("DS_LAYER_CREATIONOPTIONLIST", "");
            let has_description = known.is_some_and(|known| known.contains("'DESCRIPTION'"));
            has_description.then(|| format!("DESCRIPTION={description}")).into_iter().collect()
        }
        VectorFormat::GeoJson => {
            let members = serde_json::json!({ "attribution": layer.attribution });
            vec![
                "COORDINATE_PRECISION=9".to_owned(),
                format!("DESCRIPTION={description}"),
                format!("NATIVE_DATA={members}"),
                "NATIVE_MEDIA_TYPE=application/vnd.geo+json".to_owned(),
            ]
        }
        VectorFormat::Csv => vec!["GEOMETRY=AS_WKT".to_owned()],
    }
}

fn write_all(
    layer: &GdalLayer<'_>,
    of: &Layer,
    records: &[FeatureRecord],
) -> Result<(), GdalError> {
    let defn = Defn::from_layer(layer);
    for record in records {
        let mut feature = Feature::new(&defn)?;
        for (index, (value, field)) in record.values.iter().zip(&of.fields).enumerate() {
            match value {
                FieldValue::Null => feature.set_field_null(index)?,
                FieldValue::Integer(number) if field.kind == FieldKind::Integer => {
                    feature.set_field_integer(index, i32::try_from(*number)?)?;
                }
                FieldValue::Integer(number) => feature.set_field_integer64(index, *number)?,
                FieldValue::Real(number) => feature.set_field_double(index, *number)?,
                FieldValue::Text(text) => feature.set_field_string(index, text)?,
            }
        }
        feature.set_geometry(geometry(&record.shape, of.shapes)?)?;
        feature.create(layer)?;
    }
    Ok(())
}

fn geometry(shape: &FeatureGeometry, kind: ShapeKind) -> Result<Geometry, GdalError> {
    let mut all = Geometry::empty(kind.types()[0])?;
    match shape {
        FeatureGeometry::Lines(lines) => {
            for line in lines {
                let mut part = Geometry::empty(kind.types()[1])?;
                // From the end, so that GDAL allocates memory for all vertices at once.
                for (index, &[x, y, z]) in line.iter().enumerate().rev() {
                    part.set_point(index, (x, y, written_height(z)));
                }
                all.add_geometry(part)?;
            }
        }
        FeatureGeometry::Polygons(polygons) => {
            for rings in polygons {
                let mut polygon = Geometry::empty(kind.types()[1])?;
                for ring in rings {
                    let mut closed = Geometry::empty(OGRwkbGeometryType::wkbLinearRing)?;
                    // From the end, so that GDAL allocates memory for all vertices at once.
                    let first = ring.first().map(|first| (ring.len(), first));
                    for (index, &[x, y]) in first.into_iter().chain(ring.iter().enumerate().rev()) {
                        closed.set_point_2d(index, (x, y));
                    }
                    polygon.add_geometry(closed)?;
                }
                all.add_geometry(polygon)?;
            }
        }
        FeatureGeometry::Point([x, y, z]) => all.set_point(0, (*x, *y, written_height(*z))),
    }
    Ok(all)
}

impl ShapeKind {
    /// Returns the types of a feature's geometry and of its parts.
    fn types(self) -> [OGRwkbGeometryType::Type; 2] {
        match self {
            Self::Lines => {
                [OGRwkbGeometryType::wkbMultiLineString25D, OGRwkbGeometryType::wkbLineString25D]
            }
            Self::Polygons => [OGRwkbGeometryType::wkbMultiPolygon, OGRwkbGeometryType::wkbPolygon],
            Self::Points => [OGRwkbGeometryType::wkbPoint25D; 2],
        }
    }
}

/// Returns a height that can be written. GDAL 3.6 removes trailing zeros from exponents: 4.5e-10
/// becomes 4.5E-1 in text.
fn written_height(height: f64) -> f64 {
    if height.abs() < 1e-9 { 0.0 } else { height }
}

#[cfg(test)]
#[path = "file_tests.rs"]
mod tests;
