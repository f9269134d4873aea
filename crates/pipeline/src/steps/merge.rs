//! Step *merge*: the heights of bridges and tunnels with their runs by tile, the coarse tiles above
//! all subtrees, the sums over all records, the manifest, and the package.

use std::path::Path;

use corniche_geom::{LatticePoint, TileId};
use corniche_ground::{
    heights::pyramid::{HeightSums, all_there},
    terrain::{ground::GroundSource, recorded::RecordedTerrain},
};
use corniche_pieces::{
    ExtractError,
    layers::{
        SectionLayer,
        tile_section::{SectionOfTile, TileSection},
    },
    roads::losses::LossFold,
    spans::{
        outer_ground::{OuterGrounds, WholeDem, whole_rectangle},
        solving::SpanSolving,
        span_network::SpanInputs,
        totals::SpanTotals,
    },
};
use corniche_spec::{
    Defect,
    artifacts::{self, ArtifactError, ArtifactKind},
};
use corniche_store::{OpenMode, ScratchSpace, open_own};
use corniche_tileset::{
    LevelRecord, Manifest, PackageWriter, PayloadBuilder, ReliefLevels, Sections, WriteError,
    decode,
};
use corniche_tin::Tin;
use corniche_work::Stage;

use super::{
    hashes,
    manifest::{self, ManifestSources, ManifestSums},
    roads, top,
};
use crate::{BuildError, context::BuildContext, tile::record::TileRecord};

/// The target of the package.
pub(crate) struct MergeTarget<'a> {
    /// The file to write.
    pub finished: &'a Path,
    /// Its final path, for messages.
    pub named: &'a Path,
}

/// Fails if one of the steps is not complete for all tiles.
pub(crate) fn check_complete(context: &BuildContext<'_>) -> Result<(), BuildError> {
    hashes::records(context)?;
    roads::check_done(context)?;
    if let Some(pyramid) = context.pyramid() {
        pyramid.all_patches()?;
    }
    top::check_done(context)?;
    let is_missing = |id| !context.store.has(ArtifactKind::Record.of_tile(id));
    Ok(all_there("the tiles", &context.data().missing(is_missing), "tiles")?)
}

/// Sums up all records and writes the package.
pub(crate) fn make(
    context: &BuildContext<'_>,
    scratch: &dyn ScratchSpace,
    target: &MergeTarget<'_>,
) -> Result<Manifest, BuildError> {
    make_spans(context)?;
    let heights = match context.source {
        GroundSource::Dem(dem) => {
            let pyramid = context.pyramid_of(dem);
            pyramid.sums(&pyramid.all_patches()?)
        }
        GroundSource::Package(terrain) => HeightSums::recorded(terrain.manifest()),
    };
    let roads = roads::totals(context)?;
    let mut tiles = ManifestSums::new(context);
    let mut fold = LossFold::new(scratch, context.memory().sorting);
    for item in context.store.items(ArtifactKind::Record as u8) {
        let id = artifacts::tile_of(ArtifactKind::Record.item(item))?;
        if let Some(record) = TileRecord::get(context.store, id)? {
            if record.ground.is_some() && !context.store.has(ArtifactKind::Payload.item(item)) {
                return Err(ArtifactError::Missing {
                    what: format!("the tile {id}"),
                    step: "tiles",
                }
                .into());
            }
            tiles.add(id, &record);
            if let Some(TileSection { section, parts, points }) =
                TileSection::get(SectionLayer::Spans, context.store, id)?
            {
                let bytes = SectionLayer::Spans.section_of(section).size(id)?.stored;
                let sums = tiles.levels.entry(id.z()).or_default();
                sums.spans.add(SectionOfTile { parts, points, bytes });
            }
            fold.add(&record.fates)?;
        }
        context.observer.check()?;
    }
    if tiles.levels.values().all(|level| level.tiles == 0) {
        let dem = context.settings.terrain_files();
        return Err(BuildError::NoCell { dem, nodes: heights.samples.with_data });
    }
    let losses = match &roads {
        Some(totals) => Some(fold.finish(totals, context.store, context.observer)?),
        None => None,
    };
    let manifest = manifest::build_manifest(&ManifestSources {
        context,
        inputs: hashes::records(context)?,
        outline: context.data_outline()?,
        heights,
        roads: roads.as_ref().zip(losses.as_ref()),
        layers: manifest::layer_totals(context)?,
        spans: artifacts::get(context.store, ArtifactKind::SpanTotals.item(0))?,
        tiles: &tiles,
    });
    if let Some(terrain) = context.source.package() {
        check_levels(context, terrain, &manifest.levels)?;
    }
    let osm = &context.settings.osm;
    if let Some(what) = all_beside_ground(&manifest).filter(|_| !osm.is_empty()) {
        return Err(BuildError::NoGround { osm: osm.clone(), what });
    }
    // All inputs have been read. If none has changed, the recorded hashes are those of the bytes
    // that were used.
    context.opened.inputs.check_unchanged()?;
    write(context, target, &manifest)?;
    Ok(manifest)
}

/// Returns the kind of objects in the extract, if none of them is on ground.
fn all_beside_ground(manifest: &Manifest) -> Option<&'static str> {
    // An extract without roads is used for its other layers.
    if manifest.counts.roads_in > 0 {
        return (manifest.counts.roads_kept == 0).then_some("road");
    }
    manifest.layers.iter().all(|layer| layer.levels.is_empty()).then_some("object of a layer")
}

/// Fails if the levels of a package whose terrain is reused differ from those found in its tiles.
fn check_levels(
    context: &BuildContext<'_>,
    terrain: &RecordedTerrain,
    found: &[LevelRecord],
) -> Result<(), BuildError> {
    let drops_relief = context.settings.terrain.relief == ReliefLevels::Off;
    for (said, found) in terrain.manifest().levels.iter().zip(found) {
        // Values that depend on the settings for roads may differ.
        let wanted = LevelRecord {
            least_class: found.least_class,
            simplify_tolerance_m: found.simplify_tolerance_m,
            relief_bytes: if drops_relief { 0 } else { said.relief_bytes },
            ..said.clone()
        };
        if wanted != *found {
            let what = format!("the tiles of level {} do not match its manifest", said.level);
            return Err(terrain.damaged(&what).into());
        }
    }
    Ok(())
}

/// Writes the package.
fn write(
    context: &BuildContext<'_>,
    target: &MergeTarget<'_>,
    manifest: &Manifest,
) -> Result<(), BuildError> {
    let failed = |source| BuildError::Write { path: target.named.to_path_buf(), source };
    let payloads = context.store.items(ArtifactKind::Payload as u8);
    context.observer.begin(Stage::Package, Some(payloads.len() as u64));
    let file = open_own(target.finished, OpenMode::Change);
    let mut writer = file
        .map_err(WriteError::Io)
        .and_then(|file| PackageWriter::of_file(file, manifest, payloads.len()))
        .map_err(failed)?;
    for item in payloads {
        context.observer.check()?;
        let key = ArtifactKind::Payload.item(item);
        let id = artifacts::tile_of(key)?;
        let mut payload =
            context.store.get(key)?.ok_or_else(|| artifacts::damaged(key, &"it is missing"))?;
        if let Some(spans) = TileSection::get(SectionLayer::Spans, context.store, id)? {
            let mut builder = PayloadBuilder::with_all_of(&payload, id)?;
            builder.add(SectionLayer::Spans.section_of(spans.section))?;
            payload = builder.seal()?.bytes;
        }
        writer.add(id, &payload).map_err(failed)?;
        context.observer.advance(Stage::Package, 1);
    }
    writer.finish().map_err(failed)?;
    context.observer.end(Stage::Package);
    Ok(())
}

/// Solves bridges and tunnels, and stores the sections of all tiles, if they are requested and
/// missing. All tiles must be complete. Reports the notes about bridges and tunnels.
pub(crate) fn make_spans(context: &BuildContext<'_>) -> Result<(), BuildError> {
    if !context.settings.roads.spans || context.settings.osm.is_empty() {
        return Ok(());
    }
    let key = ArtifactKind::SpanTotals.item(0);
    let kept: Option<SpanTotals> = artifacts::get(context.store, key)?;
    let is_kept = kept.is_some();
    let totals = kept.map_or_else(|| solve(context), Ok)?;
    if let Some(terrain) = context.source.package().filter(|_| totals.without_ground > 0) {
        context.observer.warning(&totals.told_without_ground(terrain.path()));
    }
    if !is_kept {
        artifacts::put(context.store, key, &totals)?;
    }
    for (reason, way_id, node_id) in totals.problems {
        context.observer.defect(&Defect::Span { way_id, node_id, reason });
    }
    Ok(())
}

fn solve(context: &BuildContext<'_>) -> Result<SpanTotals, BuildError> {
    let grid = context.grid;
    let data = grid.clip.map_or(grid.data_bounds, |clip| clip.whole_data_bounds);
    let whole = whole_rectangle(context.frame(), &data);
    let projection = context.source.projection(grid)?;
    let inputs =
        SpanInputs { store: context.store, frame: context.frame(), projection: &projection, whole };
    let (threads, observer) = (context.threads(), context.observer);
    let quantum_m = context.levels.quantum_m();
    let tin = |id| tin_of(context, id);
    let solve = |outer: &dyn OuterGrounds| {
        SpanSolving { of: inputs, quantum_m, tin: &tin, outer, threads, observer }.solve()
    };
    match context.source {
        GroundSource::Package(terrain) => {
            let recorded = terrain.manifest().spans.as_ref();
            Ok(solve(&recorded.map_or(&[][..], |spans| &spans.outer_grounds))?)
        }
        GroundSource::Dem(dem) => {
            let levels = context.levels;
            let dem = WholeDem { dem, plan: grid, levels, whole, threads, observer };
            let mut totals = solve(&dem)?;
            let places: Vec<LatticePoint> = totals.outer.iter().map(|own| own.at).collect();
            totals.inputs =
                context.opened.inputs.hash_unused(&dem.needed_files(&places)?, observer)?;
            Ok(totals)
        }
    }
}

/// The TIN of a tile, decoded from its payload; `None` if it has no ground. Separate TINs are only
/// in the parts that created them.
fn tin_of(context: &BuildContext<'_>, id: TileId) -> Result<Option<Tin>, ExtractError> {
    let key = ArtifactKind::Payload.of_tile(id);
    let Some(bytes) = context.store.get(key)? else { return Ok(None) };
    let quantum_m = context.levels.quantum_m();
    let payload = decode(&bytes, id, context.frame(), quantum_m, Sections::TERRAIN)
        .map_err(|error| artifacts::damaged(key, &error))?;
    Ok(payload.terrain.map(|terrain| terrain.tin).filter(|tin| !tin.is_empty()))
}
