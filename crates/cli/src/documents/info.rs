//! `corniche info --json`: the manifest, with objects instead of the file's pairs, and with the
//! zeros that the file omits.

use corniche_geom::{Bounds, Cell, CoordinateTable, GridFrame};
use corniche_tileset::{
    ClipRecord, DatumOperationRecord, Distribution, GrowthRow, InputRecord, LeftOutRecord,
    LevelRecord, Manifest, ManifestCounts, PhotoLevelRecord, RoadLoss, SampleCounts,
    SampleErrorRecord, ScaleRecord, SettingsRecord, SvTail, VerticalRecord,
};
use serde::{Serialize, Serializer};

use super::{layers::LayerDocument, spans::SpansDocument};

/// The contents of a package.
#[derive(Serialize)]
pub(crate) struct InfoDocument<'a> {
    #[serde(serialize_with = "ManifestDocument::serialize")]
    pub manifest: &'a Manifest,
    /// Ids of all tiles, "z/x/y".
    pub tiles: Vec<String>,
}

/// The manifest of a package. The schema, which is among the tests, documents its fields.
#[derive(Serialize)]
#[serde(remote = "Manifest")]
struct ManifestDocument {
    format_version: u32,
    generator: String,
    tiling: String,
    crs: String,
    crs_wkt: String,
    metres_per_unit: [f64; 2],
    point_scale: f64,
    scale: ScaleRecord,
    frame: GridFrame,
    data_bounds: Bounds,
    wgs84_bounds: Bounds,
    #[serde(skip_serializing_if = "Option::is_none")]
    clip: Option<ClipRecord>,
    #[serde(skip_serializing_if = "Option::is_none")]
    outline: Option<Vec<Vec<Vec<[i64; 2]>>>>,
    resampling: String,
    nodes_are_samples: bool,
    #[serde(with = "VerticalDocument")]
    vertical: VerticalRecord,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    datum_operations: Vec<DatumOperationRecord>,
    coordinates: CoordinateTable,
    #[serde(serialize_with = "levels")]
    levels: Vec<LevelRecord>,
    #[serde(serialize_with = "SettingsRecord::serialize_document")]
    settings: SettingsRecord,
    settings_sha256: String,
    inputs: Vec<InputRecord>,
    attribution: Vec<String>,
    #[serde(with = "CountsDocument")]
    counts: ManifestCounts,
    growth: Vec<GrowthRow>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    photos: Vec<PhotoLevelRecord>,
    #[serde(getter = "layers", skip_serializing_if = "Vec::is_empty")]
    layers: Vec<LayerDocument>,
    #[serde(getter = "spans", skip_serializing_if = "Option::is_none")]
    spans: Option<SpansDocument>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    sv_tails: Vec<SvTail>,
}

fn layers(manifest: &Manifest) -> Vec<LayerDocument> {
    manifest.layers.iter().map(Into::into).collect()
}

fn spans(manifest: &Manifest) -> Option<SpansDocument> {
    manifest.spans.clone().map(Into::into)
}

/// The heights, also with a step of 0.
#[derive(Serialize)]
#[serde(remote = "VerticalRecord")]
struct VerticalDocument {
    quantum_m: f64,
    unit: String,
    datum: String,
    treatment: String,
    height_step_m: f64,
    range_m: [f64; 2],
}

/// A level, also with 0 bytes of relief.
#[derive(Serialize)]
#[serde(remote = "LevelRecord")]
struct LevelDocument {
    level: u8,
    cell_m: Cell,
    max_error_m: f64,
    geometric_error_m: f64,
    errors_m: Option<Distribution>,
    sample_error: SampleErrorRecord,
    tightness: Option<Distribution>,
    least_class: Option<u8>,
    simplify_tolerance_m: f64,
    width_margin_m: f64,
    tiles: u64,
    triangles: u64,
    vertices: u64,
    terrain_bytes: u64,
    relief_bytes: u64,
    uncovered_nodes: u64,
}

fn levels<S: Serializer>(levels: &[LevelRecord], to: S) -> Result<S::Ok, S::Error> {
    #[derive(Serialize)]
    struct Level<'a>(#[serde(serialize_with = "LevelDocument::serialize")] &'a LevelRecord);
    to.collect_seq(levels.iter().map(Level))
}

/// Roads that were read, kept and lost, with the reasons.
#[derive(Serialize)]
#[serde(remote = "ManifestCounts")]
struct CountsDocument {
    samples: SampleCounts,
    roads_in: u64,
    roads_in_um: u64,
    roads_kept: u64,
    roads_kept_um: u64,
    roads_lost: Vec<RoadLoss>,
    #[serde(serialize_with = "named")]
    defects: Vec<(String, u64)>,
    #[serde(serialize_with = "named")]
    unknown_highways: Vec<(String, u64)>,
    #[serde(serialize_with = "named")]
    tags_taken_otherwise: Vec<(String, u64)>,
    blobs_passed_over: u64,
    highways_in: u64,
    #[serde(serialize_with = "named")]
    highways_left_out: Vec<(String, u64)>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    left_out: Vec<LeftOutRecord>,
    #[serde(serialize_with = "by_class")]
    classes: Vec<(u64, u64)>,
}

fn named<S: Serializer>(pairs: &[(String, u64)], to: S) -> Result<S::Ok, S::Error> {
    #[derive(Serialize)]
    struct NamedCount<'a> {
        name: &'a str,
        count: u64,
    }
    to.collect_seq(pairs.iter().map(|(name, count)| NamedCount { name, count: *count }))
}

fn by_class<S: Serializer>(pairs: &[(u64, u64)], to: S) -> Result<S::Ok, S::Error> {
    #[derive(Serialize)]
    struct ClassCount {
        class: usize,
        roads: u64,
        length_um: u64,
    }
    let classes = pairs.iter().enumerate();
    to.collect_seq(classes.map(|(class, &(roads, length_um))| ClassCount {
        class,
        roads,
        length_um,
    }))
}
