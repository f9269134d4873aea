//! `corniche info --json`: the manifest, with objects where the file has pairs.

mod counts;
mod frame;
mod levels;

use corniche_areas::ClassedLayer;
use corniche_geom::CoordinateTable;
use corniche_tileset::{
    DatumOperationRecord, InputRecord, Manifest, PhotoLevelRecord, ScaleRecord, SettingsRecord,
    VerticalRecord,
};
use serde::Serialize;

use self::{
    counts::CountsDocument,
    frame::{BoundsDocument, ClipDocument, FrameDocument},
    levels::LevelDocument,
};
use super::{
    areas::AreasDocument, growth::RowDocument, lines::LinesDocument, spans::SpansDocument,
};

/// What a package holds.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct InfoDocument {
    /// Its table of contents.
    pub(crate) manifest: ManifestDocument,
    /// Its tiles, "z/x/y".
    pub(crate) tiles: Vec<String>,
}

/// The table of contents of a package.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct ManifestDocument {
    /// Version of the encodings.
    format_version: u32,
    /// Program and version that wrote the package, with its GDAL and PROJ.
    generator: String,
    /// Says that z/x/y is a local quadtree in the working CRS.
    tiling: String,
    /// CRS: "EPSG:…" where it has a code, else its name. Its coordinates times `metres_per_unit` are working metres.
    crs: String,
    /// CRS as WKT2.
    crs_wkt: String,
    /// Working metres to a unit of the CRS's coordinates, east and north.
    metres_per_unit: [f64; 2],
    /// Working metres to a true metre, at the centre.
    point_scale: f64,
    /// The same along each axis, at the centre and over the data's rim.
    scale: ScaleDocument,
    /// The grid.
    frame: FrameDocument,
    /// Rectangle of the DEM's nodes, working metres.
    data_bounds: BoundsDocument,
    /// The same in WGS84 degrees.
    wgs84_bounds: BoundsDocument,
    /// The part of the elevation files that the package is of (`--bounds`, `--polygon`); left out where it is of all.
    #[serde(skip_serializing_if = "Option::is_none")]
    clip: Option<ClipDocument>,
    /// The outline of the elevation files, where they fill no rectangle, on the lattice: polygons of rings of [u, v].
    #[serde(skip_serializing_if = "Option::is_none")]
    outline: Option<Vec<Vec<Vec<[i64; 2]>>>>,
    /// How nodes relate to the DEM's samples, in words.
    resampling: String,
    /// Whether nodes and the DEM's samples are the same points.
    nodes_are_samples: bool,
    /// Heights.
    vertical: VerticalDocument,
    /// How positions come from one datum to another; left out where all datums are that of WGS84, and in packages of before.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    datum_operations: Vec<DatumOperationDocument>,
    /// WGS84 ⇄ working CRS without PROJ.
    #[cfg_attr(test, schemars(with = "frame::CoordinatesSchema"))]
    coordinates: CoordinateTable,
    /// One for each level, root first.
    levels: Vec<LevelDocument>,
    /// Settings that determine the bytes.
    #[serde(serialize_with = "SettingsRecord::serialize_document")]
    #[cfg_attr(test, schemars(with = "super::settings_schema_tests::SettingsDocument"))]
    settings: SettingsRecord,
    /// SHA-256 of the settings.
    settings_sha256: String,
    /// What was read.
    inputs: Vec<InputDocument>,
    /// Credits to show wherever the package is shown.
    attribution: Vec<String>,
    /// What came in, what was kept, what was lost and why.
    counts: CountsDocument,
    /// What clipping costs, per level and class.
    growth: Vec<RowDocument>,
    /// The photos of each level that has some, root first; left out without any.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    photos: Vec<PhotoLevelDocument>,
    /// The areas; left out in packages made without.
    #[serde(skip_serializing_if = "Option::is_none")]
    areas: Option<AreasDocument>,
    /// The boundaries, in the classes "admin-2" to "admin-8" and "protected"; left out in packages made without.
    #[serde(skip_serializing_if = "Option::is_none")]
    boundaries: Option<LinesDocument>,
    /// Bridges and tunnels off the ground, whose heights are estimates; left out in packages made without.
    #[serde(skip_serializing_if = "Option::is_none")]
    spans: Option<SpansDocument>,
    /// The tiles that end with most SV roads, each as level, column, row and how many bytes these are; left out where none has many.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    sv_tails: Vec<[u32; 4]>,
}

/// Working metres to a true metre, along x and along y.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct ScaleDocument {
    /// In the middle of the data.
    center: [f64; 2],
    /// The smallest over corners, middles of sides and centre of every file.
    least: [f64; 2],
    /// The largest.
    largest: [f64; 2],
}

/// Heights: step, unit, datum.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct VerticalDocument {
    /// One step of heights, metres.
    quantum_m: f64,
    /// Always "metre".
    unit: String,
    /// Vertical datum as far as the inputs name one, else "unknown".
    datum: String,
    /// What was done to the inputs' heights, in words.
    treatment: String,
    /// The step between heights that the DEM can tell apart, metres; 0 where they have fractions.
    height_step_m: f64,
    /// Lowest and highest node, metres.
    range_m: [f64; 2],
}

/// How positions come from one datum to another.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct DatumOperationDocument {
    /// The system that positions are in.
    from: String,
    /// The system that they come to. The operation is also used the other way around.
    to: String,
    /// PROJ's name for the operation.
    operation: String,
    /// How accurate it is, metres; left out where PROJ does not know it.
    #[serde(skip_serializing_if = "Option::is_none")]
    accuracy_m: Option<f64>,
    /// Whether one datum was taken for another, as PROJ knows nothing between them; left out where not.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    ballpark: bool,
}

/// The photos of a level.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct PhotoLevelDocument {
    /// Level, 0 = root.
    level: u8,
    /// Tiles with a photo.
    tiles: u64,
    /// Stored bytes of their photos.
    bytes: u64,
}

/// An input file.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct InputDocument {
    /// "dem"; "dem-part", a file that the one before it refers to or that belongs to it; "photo"; "photo-part", likewise; "polygon"; or "osm".
    kind: String,
    /// File name without folders.
    name: String,
    /// Its size.
    bytes: u64,
    /// SHA-256 of its bytes.
    sha256: String,
}

impl From<&Manifest> for ManifestDocument {
    fn from(manifest: &Manifest) -> Self {
        let lines = |layer| manifest.lines(layer).cloned().map(|of| LinesDocument::of(layer, of));
        let boundaries = lines(ClassedLayer::Boundaries);
        let manifest = manifest.clone();
        let ScaleRecord { center, least, largest } = manifest.scale;
        let VerticalRecord { quantum_m, unit, datum, treatment, height_step_m, range_m } =
            manifest.vertical;
        let input =
            |InputRecord { kind, name, bytes, sha256 }| InputDocument { kind, name, bytes, sha256 };
        Self {
            format_version: manifest.format_version,
            generator: manifest.generator,
            tiling: manifest.tiling,
            crs: manifest.crs,
            crs_wkt: manifest.crs_wkt,
            metres_per_unit: manifest.metres_per_unit,
            point_scale: manifest.point_scale,
            scale: ScaleDocument { center, least, largest },
            frame: FrameDocument::from(&manifest.frame),
            data_bounds: manifest.data_bounds.into(),
            wgs84_bounds: manifest.wgs84_bounds.into(),
            clip: manifest.clip.map(Into::into),
            outline: manifest.outline,
            resampling: manifest.resampling,
            nodes_are_samples: manifest.nodes_are_samples,
            vertical: VerticalDocument {
                quantum_m,
                unit,
                datum,
                treatment,
                height_step_m,
                range_m,
            },
            datum_operations: manifest.datum_operations.into_iter().map(Into::into).collect(),
            coordinates: manifest.coordinates,
            levels: manifest.levels.iter().map(Into::into).collect(),
            settings: manifest.settings,
            settings_sha256: manifest.settings_sha256,
            inputs: manifest.inputs.into_iter().map(input).collect(),
            attribution: manifest.attribution,
            counts: manifest.counts.into(),
            growth: manifest.growth.iter().map(Into::into).collect(),
            photos: manifest.photos.into_iter().map(Into::into).collect(),
            areas: manifest.areas.map(Into::into),
            boundaries,
            spans: manifest.spans.map(Into::into),
            sv_tails: manifest.sv_tails.into_iter().map(Into::into).collect(),
        }
    }
}

impl From<PhotoLevelRecord> for PhotoLevelDocument {
    fn from(PhotoLevelRecord { level, tiles, bytes }: PhotoLevelRecord) -> Self {
        Self { level, tiles, bytes }
    }
}

impl From<DatumOperationRecord> for DatumOperationDocument {
    fn from(record: DatumOperationRecord) -> Self {
        let DatumOperationRecord { from, to, operation, accuracy_m, ballpark } = record;
        Self { from, to, operation, accuracy_m, ballpark }
    }
}
