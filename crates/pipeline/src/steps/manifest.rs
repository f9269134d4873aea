//! Builds the manifest, the package's table of contents, from the context and the sums over all
//! tiles, which are folds of their records.

use std::collections::BTreeMap;

use corniche_geom::TileId;
use corniche_ground::heights::pyramid::HeightSums;
use corniche_layers::LayerTable;
use corniche_pieces::{
    layers::{
        extract_layers,
        tile_section::{LayerTotals, SectionSums},
    },
    roads::{
        lay::ClassSums,
        losses::{self, road_counts},
        totals::RoadTotals,
    },
    spans::totals::SpanTotals,
};
use corniche_spec::{
    artifacts::ArtifactError, extent::ExtentOutline, manifest_texts, settings_record,
};
use corniche_tileset::{
    Distribution, FORMAT_VERSION, GrowthRow, InputRecord, LayerRecord, LevelRecord, Manifest,
    ManifestCounts, PhotoLevelRecord, SampleSums, SectionLevelRecord, SpansRecord, SvTails,
    VerticalRecord,
};

use crate::{
    context::BuildContext,
    tile::record::{LevelShare, TileRecord},
};

/// The sources of the manifest.
pub(crate) struct ManifestSources<'a> {
    pub context: &'a BuildContext<'a>,
    pub inputs: Vec<InputRecord>,
    /// The outline of the elevation files, if they do not fill a rectangle.
    pub outline: Option<ExtentOutline>,
    pub heights: HeightSums,
    pub roads: Option<(&'a RoadTotals, &'a losses::Sums)>,
    pub layers: Vec<LayerTotals>,
    pub spans: Option<SpanTotals>,
    pub tiles: &'a ManifestSums,
}

/// Builds the manifest.
pub(crate) fn build_manifest(outcome: &ManifestSources<'_>) -> Manifest {
    let BuildContext { settings, grid: plan, levels, opened, .. } = *outcome.context;
    let frame = *levels.frame();
    let record =
        settings_record::record_settings(settings, opened.max_error_m, opened.photo.record());
    let mut attribution = settings.attribution.clone();
    for credit in opened.photo.files().into_iter().flat_map(|photo| &photo.credits) {
        if !attribution.contains(credit) {
            attribution.push(credit.clone());
        }
    }
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
        scale: plan.scale,
        frame,
        data_bounds: plan.data_bounds,
        wgs84_bounds: plan.wgs84_bounds,
        clip: plan.clip,
        outline: outcome.outline.as_ref().map(manifest_texts::outline),
        resampling: plan.resampling_text.clone(),
        nodes_are_samples: plan.nodes_are_samples(),
        vertical: VerticalRecord {
            quantum_m: levels.quantum_m(),
            unit: manifest_texts::HEIGHT_UNIT.to_owned(),
            datum: manifest_texts::datum(plan).to_owned(),
            treatment: plan.vertical.clone(),
            height_step_m: outcome.heights.step_m,
            range_m: outcome.heights.range_m.map(f64::from),
        },
        datum_operations: manifest_texts::datum_operations(&plan.datum_operations),
        coordinates: opened.coordinates.clone(),
        levels: level_records(outcome),
        settings_sha256: settings_record::sha256(&record),
        settings: record,
        inputs: outcome.inputs.clone(),
        attribution,
        counts: match outcome.roads {
            Some((totals, losses)) => road_counts(outcome.heights.samples, totals, losses),
            None => {
                ManifestCounts { samples: outcome.heights.samples, ..ManifestCounts::default() }
            }
        },
        growth: growth(outcome),
        photos: photos(outcome),
        layers: layers(outcome),
        spans: spans(outcome),
        sv_tails: outcome.tiles.sv_tails.list(),
    }
}

fn level_records(outcome: &ManifestSources<'_>) -> Vec<LevelRecord> {
    let levels = outcome.context.levels;
    let recorded = outcome.context.source.package();
    levels
        .numbers()
        .map(|level| {
            let sums = outcome.tiles.levels.get(&level).cloned().unwrap_or_default();
            let errors_m = Distribution::from_values(sums.geometric_errors_m);
            let record = LevelRecord {
                level,
                cell_m: levels.frame().level_cell(level),
                max_error_m: levels.max_error_m(level),
                geometric_error_m: errors_m.map_or(0.0, |errors_m| errors_m.max),
                errors_m,
                sample_error: outcome.tiles.samples[usize::from(level)].record(),
                tightness: Distribution::from_values(sums.tightness),
                least_class: levels
                    .least_class(level)
                    .map(corniche_roads::FunctionalRoadClass::number),
                simplify_tolerance_m: levels.simplify_tolerance_m(level),
                width_margin_m: levels.margin_m(level),
                tiles: sums.tiles,
                triangles: sums.triangles,
                vertices: sums.vertices,
                terrain_bytes: sums.terrain_bytes,
                relief_bytes: sums.relief_bytes,
                uncovered_nodes: sums.uncovered_nodes,
            };
            // A package records figures of each level that result from comparing its TINs with the
            // heights, but not the underlying values of each tile.
            let Some(terrain) = recorded else { return record };
            let &LevelRecord { sample_error, tightness, uncovered_nodes, .. } =
                &terrain.manifest().levels[usize::from(level)];
            LevelRecord { sample_error, tightness, uncovered_nodes, ..record }
        })
        .collect()
}

fn photos(outcome: &ManifestSources<'_>) -> Vec<PhotoLevelRecord> {
    let levels = outcome.tiles.levels.iter().filter(|(_, sums)| sums.photo_tiles > 0);
    levels
        .map(|(&level, sums)| PhotoLevelRecord {
            level,
            tiles: sums.photo_tiles,
            bytes: sums.photo_bytes,
        })
        .collect()
}

/// Reads the totals of all layers.
pub(crate) fn layer_totals(context: &BuildContext<'_>) -> Result<Vec<LayerTotals>, ArtifactError> {
    let layers = extract_layers(context.settings.layers.len());
    let totals = layers.map(|layer| LayerTotals::get(layer, context.store));
    totals.map(|totals| Ok(totals?.unwrap_or_default())).collect()
}

fn layers(outcome: &ManifestSources<'_>) -> Vec<LayerRecord> {
    let tables = outcome.context.settings.layers.iter().enumerate();
    let record = |((index, table), totals): ((usize, &LayerTable), &LayerTotals)| LayerRecord {
        table: table.form().clone(),
        counts: totals.counts(),
        levels: levels_of(outcome, |sums| sums.layers.get(index).copied().unwrap_or_default()),
    };
    tables.zip(&outcome.layers).map(record).collect()
}

fn spans(outcome: &ManifestSources<'_>) -> Option<SpansRecord> {
    let (_, kept) = outcome.roads?;
    let totals = outcome.spans.as_ref()?;
    Some(SpansRecord {
        counts: totals.counts(kept),
        levels: levels_of(outcome, |sums| sums.spans),
        outer_grounds: totals.outer.clone(),
    })
}

/// The sums of sections on the levels that have some.
fn levels_of(
    outcome: &ManifestSources<'_>,
    sums_of: impl Fn(&LevelSums) -> SectionSums,
) -> Vec<SectionLevelRecord> {
    let levels = outcome.tiles.levels.iter().map(|(&level, sums)| (level, sums_of(sums)));
    let levels = levels.filter(|(_, own)| own.tiles > 0);
    levels
        .map(|(level, SectionSums { tiles, parts, points, bytes })| SectionLevelRecord {
            level,
            tiles,
            parts,
            points,
            bytes,
        })
        .collect()
}

fn growth(outcome: &ManifestSources<'_>) -> Vec<GrowthRow> {
    outcome
        .tiles
        .classes
        .iter()
        .filter(|(_, sums)| sums.source_vertices > 0)
        .map(|(&(level, class), &sums)| GrowthRow {
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

/// Sums over all tiles.
///
/// They are whole numbers, maxima, and lists that are sorted before they are used, so the order of
/// the records does not matter.
pub(crate) struct ManifestSums {
    pub levels: BTreeMap<u8, LevelSums>,
    /// Sums by level and class.
    pub classes: BTreeMap<(u8, u8), ClassSums>,
    /// Per level, root first: distances to samples.
    pub samples: Vec<SampleSums>,
    pub sv_tails: SvTails,
    least_measured_m: f64,
}

/// Sums over the tiles of a level.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct LevelSums {
    pub tiles: u64,
    pub vertices: u64,
    pub triangles: u64,
    pub terrain_bytes: u64,
    pub relief_bytes: u64,
    /// Tiles with a photo.
    pub photo_tiles: u64,
    pub photo_bytes: u64,
    /// The sections of the layers, in their order.
    pub layers: Vec<SectionSums>,
    pub spans: SectionSums,
    /// Geometric errors of the level's tiles.
    pub geometric_errors_m: Vec<f64>,
    /// Ratios of the tiles' geometric errors to their deviations, if those can be measured.
    pub tightness: Vec<f64>,
    /// Nodes with data that the level's tiles do not cover, or that have no tile above them.
    pub uncovered_nodes: u64,
}

impl ManifestSums {
    /// Creates empty sums.
    pub(crate) fn new(context: &BuildContext<'_>) -> Self {
        let quantum_m = context.levels.quantum_m();
        Self {
            levels: BTreeMap::new(),
            classes: BTreeMap::new(),
            samples: vec![SampleSums::new(quantum_m); context.levels.numbers().count()],
            sv_tails: SvTails::new(),
            least_measured_m: VerticalRecord::least_measured_error_m(quantum_m),
        }
    }

    /// Adds a tile.
    pub(crate) fn add(&mut self, id: TileId, record: &TileRecord) {
        let level = id.z();
        for ((above, share), samples) in (0..).zip(&record.levels).zip(&mut self.samples) {
            let LevelShare { has_ground, seen, sums } = share;
            samples.merge(sums);
            if !has_ground {
                self.levels.entry(above).or_default().uncovered_nodes += seen.uncovered_nodes;
            }
        }
        let Some(ground) = &record.ground else { return };
        let sums = self.levels.entry(level).or_default();
        let deviation = ground.deviation;
        sums.tiles += 1;
        sums.vertices += ground.vertices;
        sums.triangles += ground.triangles;
        sums.terrain_bytes += ground.terrain_bytes;
        sums.relief_bytes += ground.relief_bytes;
        sums.photo_tiles += u64::from(ground.photo_bytes > 0);
        sums.photo_bytes += ground.photo_bytes;
        sums.layers.resize_with(ground.layers.len(), SectionSums::default);
        for (sums, &own) in sums.layers.iter_mut().zip(&ground.layers) {
            sums.add(own);
        }
        sums.geometric_errors_m.push(deviation.geometric_error_m);
        if deviation.deviation_m >= self.least_measured_m {
            sums.tightness.push(deviation.geometric_error_m / deviation.deviation_m);
        }
        sums.uncovered_nodes += deviation.uncovered_nodes;
        self.sv_tails.add(id, record.classes.values().map(|class| class.sv_stored_bytes).sum());
        for (&class, counted) in &record.classes {
            self.classes.entry((level, class)).or_default().merge(counted);
        }
    }
}
