//! The manifest and the package file.

use std::path::Path;

use corniche_dem::{Dem, GridPlan};
use corniche_geom::{Bounds, CoordinateTable, CoordinateTableError};
use corniche_tileset::{
    Counts, Distribution, FORMAT_VERSION, GrowthRow, InputRecord, LevelRecord, Manifest,
    SampleCounts, ScaleRecord, VerticalRecord, Writer,
};

use super::{deviations::TileDeviations, tiles::Tiles};
use crate::{
    BuildError, BuildSettings, Observer, Stage, Storage,
    levels::Levels,
    manifest_texts,
    roads::{counts::road_counts, losses::Sums, totals::RoadTotals},
    sample_deviation::SampleSums,
    settings_record,
    storage::Kind,
};

/// How far positions that are interpolated from the manifest may be off.
const COORDINATE_TOLERANCE_M: f64 = 0.01;

/// Everything that goes into the manifest.
pub(crate) struct Outcome<'a> {
    pub(crate) settings: &'a BuildSettings,
    pub(crate) max_error_m: f64,
    pub(crate) plan: &'a GridPlan,
    pub(crate) levels: &'a Levels,
    pub(crate) coordinates: &'a CoordinateTable,
    pub(crate) inputs: Vec<InputRecord>,
    pub(crate) samples: SampleCounts,
    /// Heights of the lowest and the highest node.
    pub(crate) range_m: [f32; 2],
    pub(crate) roads: Option<&'a (RoadTotals, Sums)>,
    pub(crate) tiles: &'a Tiles,
    pub(crate) deviations: &'a TileDeviations,
    /// Per level, root first.
    pub(crate) sample_sums: &'a [SampleSums],
}

/// Longitudes and latitudes over the data's rectangle, for readers without PROJ.
///
/// The table has a margin around the rectangle, but does not reach to the root's far corners, which can be very far away.
/// The margin ends at the poles; if a projection ends within the margin, there is no margin.
pub(crate) fn coordinates(dem: &Dem, plan: &GridPlan) -> Result<CoordinateTable, BuildError> {
    let projection = dem.projection(plan)?;
    let data = plan.data_bounds;
    let room_m = 0.1 * data.width().max(data.height()).max(plan.frame.cell().shorter_m());
    let pole_m = plan.poles_y_m().unwrap_or(f64::INFINITY);
    let around = Bounds {
        min_x: data.min_x - room_m,
        min_y: (data.min_y - room_m).max(-pole_m).min(data.min_y),
        max_x: data.max_x + room_m,
        max_y: (data.max_y + room_m).min(pole_m).max(data.max_y),
    };
    let sample = |bounds| CoordinateTable::sample(&projection, bounds, COORDINATE_TOLERANCE_M);
    match sample(around) {
        Err(CoordinateTableError::TooCurved { .. }) => Ok(sample(data)?),
        found => Ok(found?),
    }
}

/// Puts the manifest together.
pub(crate) fn manifest(outcome: &Outcome<'_>) -> Manifest {
    let Outcome { settings, plan, levels, .. } = outcome;
    let frame = *levels.frame();
    let record = settings_record::of(&settings.terrain, &settings.roads, outcome.max_error_m);
    let mut attribution = settings.attribution.clone();
    if outcome.roads.is_some() {
        attribution.push(corniche_osm::ATTRIBUTION.to_owned());
    }
    Manifest {
        format_version: FORMAT_VERSION,
        generator: format!("{}, {}", settings.generator, plan.libraries),
        tiling: manifest_texts::TILING.to_owned(),
        crs: plan.crs.clone(),
        crs_wkt: plan.crs_wkt.clone(),
        metres_per_unit: plan.metres_per_unit,
        point_scale: plan.point_scale,
        scale: ScaleRecord {
            center: plan.scale.center,
            least: plan.scale.least,
            largest: plan.scale.largest,
        },
        frame,
        data_bounds: plan.data_bounds,
        wgs84_bounds: plan.wgs84_bounds,
        resampling: plan.resampling_text.clone(),
        nodes_are_samples: plan.nodes_are_samples(),
        vertical: VerticalRecord {
            quantum_m: levels.quantum_m(),
            unit: manifest_texts::HEIGHT_UNIT.to_owned(),
            datum: manifest_texts::datum(plan).to_owned(),
            treatment: plan.vertical.clone(),
            range_m: outcome.range_m.map(f64::from),
        },
        coordinates: outcome.coordinates.clone(),
        levels: level_records(outcome),
        settings_sha256: settings_record::sha256(&record),
        settings: record,
        inputs: outcome.inputs.clone(),
        attribution,
        counts: counts(outcome),
        growth: growth(outcome),
    }
}

fn level_records(outcome: &Outcome<'_>) -> Vec<LevelRecord> {
    let levels = outcome.levels;
    levels
        .numbers()
        .map(|level| {
            let sums = outcome.tiles.levels.get(&level).cloned().unwrap_or_default();
            let errors_m = Distribution::of(sums.geometric_errors_m);
            LevelRecord {
                level,
                cell_m: levels.frame().level_cell(level),
                max_error_m: levels.max_error_m(level),
                geometric_error_m: errors_m.map_or(0.0, |errors_m| errors_m.max),
                errors_m,
                sample_error: outcome.sample_sums[usize::from(level)].record(),
                tightness: Distribution::of(sums.tightness),
                least_class: levels
                    .least_class(level)
                    .map(corniche_roads::FunctionalRoadClass::number),
                simplify_tolerance_m: levels.simplify_tolerance_m(level),
                width_margin_m: levels.margin_m(level),
                tiles: sums.tiles,
                triangles: sums.triangles,
                vertices: sums.vertices,
                terrain_bytes: sums.terrain_bytes,
                uncovered_nodes: sums.uncovered_nodes + outcome.deviations.under_absent(level),
            }
        })
        .collect()
}

/// Counts of roads: read, kept, and lost by reason.
fn counts(outcome: &Outcome<'_>) -> Counts {
    let samples = outcome.samples;
    match outcome.roads {
        Some((totals, losses)) => road_counts(samples, totals, losses),
        None => Counts { samples, ..Counts::default() },
    }
}

fn growth(outcome: &Outcome<'_>) -> Vec<GrowthRow> {
    outcome
        .tiles
        .classes
        .iter()
        .filter(|(_, sums)| sums.source_vertices > 0)
        .map(|(&(level, class), sums)| GrowthRow {
            level,
            class,
            source_vertices: sums.source_vertices,
            simplified_vertices: sums.simplified_vertices,
            geo_vertices: sums.geo_vertices,
            sv_vertices: sums.sv_vertices,
            source_bytes: sums.source_vertices * 16,
            simplified_bytes: sums.simplified_vertices * 16,
            geo_raw_bytes: sums.geo_vertices * 24,
            geo_stored_bytes: sums.geo_stored_bytes,
            sv_stored_bytes: sums.sv_stored_bytes,
        })
        .collect()
}

/// Writes the package to `path`.
pub(crate) fn write(
    path: &Path,
    target: &Path,
    manifest: &Manifest,
    tiles: &Tiles,
    storage: &dyn Storage,
    observer: &dyn Observer,
) -> Result<(), BuildError> {
    let failed = |source| BuildError::Write { path: target.to_path_buf(), source };
    observer.begin(Stage::Package, Some(tiles.payloads.len() as u64));
    let mut writer = Writer::create(path, manifest).map_err(failed)?;
    for &(id, span) in &tiles.payloads {
        if observer.is_cancelled() {
            return Err(BuildError::Interrupted);
        }
        let bytes = storage.read(Kind::Payloads, span).map_err(BuildError::Storage)?;
        writer.add(id, &bytes).map_err(failed)?;
        observer.advance(Stage::Package, 1);
    }
    writer.finish().map_err(failed)?;
    observer.end(Stage::Package);
    Ok(())
}
