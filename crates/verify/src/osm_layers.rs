//! Splits the layers of the extract that have sections again, and compares them with those of the
//! package, tile by tile.

use corniche_geom::TileId;
use corniche_layers::{LayerGeometry, LayerTable};
use corniche_pieces::{
    ExtractError,
    layers::{
        SectionLayer,
        tile_section::{LayerTotals, TileSection},
    },
    roads::losses,
    spans::{solving::SpanSolving, span_network::SpanInputs},
};
use corniche_store::Artifacts;
use corniche_tileset::{LayerCoding, LayerObject, LayerRecord, Manifest, Section, SpanRun};
use corniche_work::Stage;
use serde::Serialize;

use super::{
    checks::{CheckId, Findings, as_json},
    each_tile::{VerifyRun, compare_in_order},
    error::Result,
};

/// The tables of the package's layers.
pub(crate) fn tables(manifest: &Manifest) -> Vec<LayerTable> {
    // The tables were checked when the package was opened.
    manifest.layers.iter().filter_map(|of| LayerTable::new(of.table.clone()).ok()).collect()
}

/// Compares the objects of each layer in each tile, and their counts, with those in the store.
pub(crate) fn compare_layers(
    run: &VerifyRun<'_>,
    store: &dyn Artifacts,
    findings: &mut Findings,
) -> Result<()> {
    let manifest = run.package.manifest();
    let frame = &manifest.frame;
    for (slot, LayerRecord { table, counts, .. }) in manifest.layers() {
        let check = match table.geometry {
            LayerGeometry::Line => CheckId::OsmLines,
            LayerGeometry::Area => CheckId::OsmAreas,
            LayerGeometry::Point => CheckId::OsmPoints,
        };
        let coding = LayerCoding::from_table(table);
        let how = HowCompared {
            stage: Stage::CompareLayers,
            layer: SectionLayer::Extract(slot),
            check,
            recorded: |payload: &[u8], id| manifest.decode_layer(payload, id, slot).ok(),
            expected: |section: Section, id| section.objects(id, frame, &coding).ok(),
            name: |of: &LayerObject| {
                let (object, points) = (of.object, of.shape.points().count());
                format!(
                    "{object} of layer {:?}, class {}, with {points} points",
                    table.id, of.class
                )
            },
        };
        compare(run, store, &how, findings)?;
        let found = LayerTotals::get(how.layer, store)?.map(|totals| totals.counts());
        look_at_counts(CheckId::OsmLayerCounts, Some(counts), found.as_ref(), findings);
    }
    Ok(())
}

/// Computes bridges and tunnels again on the ground of the package, and compares them with those of
/// each tile.
pub(crate) fn compare_spans(
    run: &VerifyRun<'_>,
    (of, kept): (SpanInputs<'_>, &losses::Sums),
    findings: &mut Findings,
) -> Result<()> {
    let &VerifyRun { package, ref tiles, threads, observer } = run;
    let manifest = package.manifest();
    let (frame, quantum_m) = (&manifest.frame, manifest.vertical.quantum_m);
    let tin = |id| Ok(tiles.tile_at(id).terrain().map(|terrain| terrain.tin.clone()));
    let outer = manifest.spans.as_ref().map_or(&[][..], |spans| &spans.outer_grounds);
    let outer = &outer;
    let solving = SpanSolving { of, quantum_m, tin: &tin, outer, threads, observer };
    let counts = match solving.solve() {
        Ok(totals) => totals.counts(kept),
        Err(ExtractError::Encode(error)) => {
            findings.look(CheckId::OsmSpans, false, || error.to_string());
            return Ok(());
        }
        Err(error) => return Err(error.into()),
    };
    let how = HowCompared {
        stage: Stage::CompareSpans,
        layer: SectionLayer::Spans,
        check: CheckId::OsmSpans,
        recorded: |payload: &[u8], id| manifest.decode_spans(payload, id).ok(),
        expected: |section: Section, id| section.spans(id, frame).ok(),
        name: |run: &SpanRun| {
            format!("a run of way {} with {} points", run.way_id, run.points.len())
        },
    };
    compare(run, of.store, &how, findings)?;
    let recorded = manifest.spans.as_ref().map(|spans| &spans.counts);
    look_at_counts(CheckId::OsmSpanCounts, recorded, Some(&counts), findings);
    Ok(())
}

/// Checks that the counts of a layer are those of the extract.
fn look_at_counts<T: PartialEq + Serialize>(
    check: CheckId,
    recorded: Option<&T>,
    found: Option<&T>,
    findings: &mut Findings,
) {
    findings.look(check, found == recorded, || {
        format!("recorded {}, in the extract {}", as_json(&recorded), as_json(&found))
    });
}

/// How the objects of a layer are compared: the stage, the items of a payload, the items of a newly
/// encoded section, and a text for an object.
struct HowCompared<R, E, N> {
    stage: Stage,
    layer: SectionLayer,
    check: CheckId,
    recorded: R,
    expected: E,
    name: N,
}

fn compare<T: PartialEq>(
    run: &VerifyRun<'_>,
    store: &dyn Artifacts,
    how: &HowCompared<
        impl Fn(&[u8], TileId) -> Option<Vec<T>> + Sync,
        impl Fn(Section, TileId) -> Option<Vec<T>> + Sync,
        impl Fn(&T) -> String + Sync,
    >,
    findings: &mut Findings,
) -> Result<()> {
    let look_at = |id: TileId| {
        let mut findings = Findings::default();
        // Unreadable tiles are reported by the check of tiles.
        let payload = run.package.tile(id).ok().flatten();
        let Some(recorded) = payload.and_then(|payload| (how.recorded)(&payload, id)) else {
            return Ok(findings);
        };
        let made = TileSection::get(how.layer, store, id)?;
        let made = made.map(|made| how.layer.section_of(made.section));
        let expected = made.and_then(|made| (how.expected)(made, id)).unwrap_or_default();
        compare_in_order(how.check, id, [&recorded, &expected], &how.name, &mut findings);
        Ok(findings)
    };
    run.each_tile(how.stage, look_at, |_, found| findings.merge(found))
}
