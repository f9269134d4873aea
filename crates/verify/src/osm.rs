//! Reads the extract again, clips its roads, drapes them on the package's own ground, and compares
//! the result with the package, tile by tile. Other checks verify that roads lie on the ground,
//! without the extract and with other geometry code.

use std::{collections::BTreeMap, path::PathBuf};

use corniche_geom::TileId;
use corniche_gis::RegionPolygons;
use corniche_pieces::{
    extract::{
        partition::{ExtractInput, partition},
        reading_pool,
    },
    roads::{
        ground_lines,
        lay::ClassSums,
        losses::{LossFold, Sums, road_counts},
        pieces::TilePieces,
        totals::RoadTotals,
    },
    spans::{outer_ground::whole_rectangle, span_network::SpanInputs},
};
use corniche_roads::FrcTable;
use corniche_spec::{
    BuildObserver,
    data_tiles::DataTiles,
    inputs::InputFiles,
    levels::{Levels, most_scale},
    settings_record,
    true_lengths::TrueLengths,
};
use corniche_store::Artifacts;
use corniche_tileset::{InputKind, InputRecord, Manifest, pmtiles_order};
use corniche_work::{Silent, Stage, workers};

use super::{
    checks::{Check, CheckId, Findings, as_json},
    dem_inputs::{are_recorded, have_same_hashes},
    derived_records,
    each_tile::VerifyRun,
    error::{Result, VerifyError},
    georeference, osm_layers,
    osm_tile::{Laying, OsmTileFindings, look_at},
    polygon_cut,
    temporary_store::TemporaryStore,
    verify_settings::VerifyOsm,
};

pub(crate) fn verify(
    run: &VerifyRun<'_>,
    osm: &VerifyOsm,
    paths: &[PathBuf],
    polygon: Option<&RegionPolygons>,
    findings: &mut Findings,
) -> Result<()> {
    let manifest = run.package.manifest();
    let tables = osm_layers::tables(manifest);
    // If one of them is missing, the check `levels.derived` or `manifest.crs` is broken, and roads
    // cannot be draped.
    let (Some(settings), Some([first, last])) = (
        settings_record::roads(&manifest.settings, chosen(&osm.table, manifest)),
        derived_records::data_tiles(manifest),
    ) else {
        return Ok(());
    };
    let Ok(crs) = georeference::recorded(manifest) else { return Ok(()) };
    let projection = crs.projection(manifest.area_deg())?;
    let frame = manifest.frame;
    let polygon = polygon
        .map(|polygon| crs.working().polygon_on_lattice(polygon, manifest.area_deg(), &frame))
        .transpose()?;
    let widest = most_scale(manifest.scale.largest);
    let levels = Levels::new(frame, manifest.settings.max_error_m, &settings, widest);
    let lengths = TrueLengths::new(frame, &manifest.coordinates, &projection);
    let work = TemporaryStore::new(run.observer)?;
    let (store, scratch) = (&work.store, work.scratch()?);
    let pool = reading_pool(run.threads)?;
    let outline = manifest.data_outline();
    let input = ExtractInput {
        osm: paths,
        settings: &settings,
        layers: &tables,
        data: DataTiles::spanning(first, last),
        projection: &projection,
        levels: &levels,
        lengths: &lengths,
        node_bounds: frame.lattice_bounds(manifest.data_nodes()),
        clip: derived_records::clip_of(manifest),
        bounds_deg: manifest.settings.bounds_deg,
        outline: outline.as_ref(),
        area_deg: manifest.area_deg(),
        polygon: polygon.as_ref(),
        pool: &pool,
        memory_bytes: osm.memory_bytes,
    };
    let roads = partition(&input, store, &scratch, run.observer)?;
    let mut fates = LossFold::new(&scratch, osm.memory_bytes);
    let spans = settings.spans;
    let (data, tiles) = ([first, last], &run.tiles);
    let laying = Laying { tiles, levels: &levels, data, spans, lengths: &lengths };
    let classes = lay(&laying, store, &mut fates, run, findings)?;
    let losses = fates.finish(&roads, store, &Silent)?;
    check_counts(manifest, &roads, &losses, findings);
    osm_layers::compare_layers(run, store, findings)?;
    if settings.spans {
        let whole = whole_rectangle(&frame, &manifest.whole_data_bounds());
        let inputs = SpanInputs { store, frame: &frame, projection: &projection, whole };
        osm_layers::compare_spans(run, (inputs, &losses), findings)?;
    }
    if let Some(region) = &polygon {
        polygon_cut::verify(run, region, findings)?;
    }
    check_growth(manifest, &classes, findings);
    Ok(())
}

/// The FRC table with the classes that the package chose.
pub(crate) fn chosen(table: &FrcTable, manifest: &Manifest) -> FrcTable {
    let classes = manifest.settings.classes.as_deref();
    // An invalid choice of classes does not match the hash of the table either.
    let chosen = classes.and_then(|classes| table.clone().with_classes(classes).ok());
    chosen.unwrap_or_else(|| table.clone())
}

/// Checks that the extracts and the FRC table are those of the build. Returns the extracts in the
/// order of the build: of equal versions of an object the first one counts, and files may have
/// other names now.
pub(crate) fn check_inputs(
    manifest: &Manifest,
    osm: &VerifyOsm,
    inputs: &InputFiles,
    findings: &mut Findings,
    observer: &dyn BuildObserver,
) -> Result<Vec<PathBuf>> {
    if !manifest.has_extract() {
        return Err(VerifyError::NoExtract);
    }
    let given = inputs.hash(observer)?;
    let extracts = || manifest.inputs_of(InputKind::Osm);
    let mut sizes = Check::new(CheckId::OsmInputs);
    let kinds = &[InputKind::Osm];
    if !are_recorded(kinds, &manifest.inputs, &given, have_same_hashes, &mut sizes) {
        let expected = extracts().map(|input| input.name.clone()).collect();
        return Err(VerifyError::OtherOsm { paths: osm.paths.clone(), expected });
    }
    findings.merge([sizes]);
    let settings = &manifest.settings;
    if settings_record::table_sha256(&chosen(&osm.table, manifest)) != settings.frc_table_sha256 {
        let (given, expected) = (osm.table.name().to_owned(), settings.frc_table.clone());
        return Err(if given == expected {
            VerifyError::OtherTableOfThatName { name: expected }
        } else {
            VerifyError::OtherTable { given, expected }
        });
    }
    // Older packages did not record the names of classes.
    let names_of_classes = settings.class_labels.as_ref();
    let is_so_called = names_of_classes.is_none_or(|labels| osm.table.class_labels() == **labels);
    look!(
        findings,
        OsmInputs,
        is_so_called,
        "the class names of FRC table {:?} differ from the recorded ones",
        settings.frc_table
    );
    look!(
        findings,
        OsmInputs,
        osm.table.name() == settings.frc_table,
        "the FRC table is {:?}, {:?} is recorded",
        osm.table.name(),
        settings.frc_table
    );
    let mut hashed: Vec<(&InputRecord, &PathBuf)> = given.iter().zip(&osm.paths).collect();
    let in_order = extracts().filter_map(|said| {
        let at = hashed.iter().position(|(found, _)| found.sha256 == said.sha256)?;
        Some(hashed.remove(at).1.clone())
    });
    Ok(in_order.collect())
}

/// Drapes all roads again and compares each tile with the package. The fate of each road goes to
/// `fates`; the sums by level and class are those of the draped roads.
fn lay(
    laying: &Laying<'_>,
    store: &dyn Artifacts,
    fates: &mut LossFold<'_>,
    run: &VerifyRun<'_>,
    findings: &mut Findings,
) -> Result<BTreeMap<(u8, u8), ClassSums>> {
    let layers = run.package.manifest().layers.len();
    let [first, last] = laying.data;
    let mut ids = run.package.tile_ids()?;
    for y in first.y()..=last.y() {
        for x in first.x()..=last.x() {
            ids.extend(TileId::new(first.z(), x, y).ok());
        }
    }
    ids.sort_unstable_by_key(|&id| pmtiles_order(id));
    ids.dedup();
    let mut classes: BTreeMap<(u8, u8), ClassSums> = BTreeMap::new();
    workers::side_by_side(
        (run.observer, Stage::CompareRoads),
        run.threads,
        &ids,
        || Ok::<_, VerifyError>(()),
        |(), &id| Ok(look_at(laying, id, &TilePieces::load(store, id, layers)?)),
        |id, found: OsmTileFindings| {
            findings.merge(found.findings);
            fates.add(&found.fates)?;
            ground_lines::put(&found.ground_lines, store, *id)?;
            for (class, found) in found.classes {
                classes.entry((id.z(), class)).or_default().merge(&found);
            }
            Ok(())
        },
    )?;
    Ok(classes)
}

/// Compares the counts and lengths of roads.
fn check_counts(manifest: &Manifest, roads: &RoadTotals, losses: &Sums, findings: &mut Findings) {
    let said = &manifest.counts;
    let mut wanted = road_counts(said.samples, roads, losses);
    // Older packages count losses in the padding of tiles differently.
    if said.roads_lost == losses.lost_by_tiles {
        wanted.roads_lost.clone_from(&losses.lost_by_tiles);
    }
    macro_rules! same {
        ($($what:ident)*) => {$(
            let [recorded, found] = [&said.$what, &wanted.$what].map(as_json);
            let what = stringify!($what);
            look!(
                findings,
                OsmCounts,
                recorded == found,
                "{what}: recorded {recorded}, in the extract {found}"
            );
        )*};
    }
    same! {
        roads_in roads_kept defects unknown_highways blobs_passed_over tags_taken_otherwise
        highways_in highways_left_out left_out roads_in_um roads_kept_um roads_lost classes
    }
}

/// Compares the numbers of source points and simplified points of each level and class.
fn check_growth(
    manifest: &Manifest,
    classes: &BTreeMap<(u8, u8), ClassSums>,
    findings: &mut Findings,
) {
    let wanted: BTreeMap<(u8, u8), [u64; 2]> = classes
        .iter()
        .filter(|(_, sums)| sums.source_vertices > 0)
        .map(|(&key, sums)| (key, [sums.source_vertices, sums.simplified_vertices]))
        .collect();
    let said: BTreeMap<(u8, u8), [u64; 2]> = manifest
        .growth
        .iter()
        .map(|row| ((row.level, row.class), [row.source_vertices, row.simplified_vertices]))
        .collect();
    let keys: std::collections::BTreeSet<_> = wanted.keys().chain(said.keys()).collect();
    for key in keys {
        let (said, wanted) = (said.get(key), wanted.get(key));
        look!(
            findings,
            OsmGrowth,
            said == wanted,
            "level {} class {}: {said:?} source and simplified points are recorded, {wanted:?} were found",
            key.0,
            key.1
        );
    }
}
