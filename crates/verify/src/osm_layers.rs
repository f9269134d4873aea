//! Splits the layers of the extract that have sections again, and compares them with those of the
//! package, tile by tile.

use corniche_areas::AreaTable;
use corniche_geom::TileId;
use corniche_pieces::ExtractError;
use corniche_pieces::{
    layers::{
        SectionLayer,
        tile_section::TileSection,
        tile_section::{AreaTotals, LineTotals},
    },
    roads::losses,
    spans::{solving::SpanSolving, span_network::SpanInputs},
};
use corniche_spec::settings_record;
use corniche_store::Artifacts;
use corniche_tileset::{
    AreaRecord, LineRecord, Manifest, Section, SpanRun, decode_areas, decode_boundaries,
};
use corniche_work::Stage;
use serde::Serialize;

use super::{
    checks::{CheckId, Findings, as_json},
    each_tile::{VerifyRun, compare_in_order},
    error::VerifyError,
};

/// The table of areas with which the package was built, taken from the given one; `None` if the
/// package has no areas.
///
/// Fails if the given table is another one.
pub(crate) fn table<'a>(
    given: Option<&'a AreaTable>,
    manifest: &Manifest,
) -> Result<Option<&'a AreaTable>, VerifyError> {
    let Some(expected) = &manifest.settings.areas else { return Ok(None) };
    let is_it = |table: &&AreaTable| settings_record::area_table_record(table) == *expected;
    match given.filter(is_it) {
        Some(table) => Ok(Some(table)),
        None => Err(VerifyError::OtherAreaTable {
            given: given.map(|table| table.name().to_owned()),
            expected: expected.table.clone(),
        }),
    }
}

/// Compares the areas of each tile, and their counts, with those in the store.
pub(crate) fn compare_areas(
    run: &VerifyRun<'_>,
    store: &dyn Artifacts,
    findings: &mut Findings,
) -> Result<(), VerifyError> {
    let manifest = run.package.manifest();
    let frame = &manifest.frame;
    let how = HowCompared {
        stage: Stage::CompareAreas,
        layer: SectionLayer::Areas,
        check: CheckId::OsmAreas,
        recorded: |payload: &[u8], id| decode_areas(payload, id, frame).ok(),
        expected: |section: Section, id| section.areas(id, frame).ok(),
        name: |area: &AreaRecord| {
            let points: usize = area.rings().map(Vec::len).sum();
            format!("{} {} with {points} points", area.class, area.object)
        },
    };
    compare(run, store, &how, findings)?;
    let found = AreaTotals::get(how.layer, store)?.map(|totals| totals.counts());
    let recorded = manifest.areas.as_ref().map(|areas| &areas.counts);
    look_at_counts(CheckId::OsmAreaCounts, recorded, found.as_ref(), findings);
    Ok(())
}

/// Compares the boundaries of each tile, and their counts, with those in the store.
pub(crate) fn compare_boundaries(
    run: &VerifyRun<'_>,
    store: &dyn Artifacts,
    findings: &mut Findings,
) -> Result<(), VerifyError> {
    let how = HowCompared {
        stage: Stage::CompareBoundaries,
        layer: SectionLayer::Boundaries,
        check: CheckId::OsmBoundaries,
        recorded: |payload: &[u8], id| decode_boundaries(payload, id).ok(),
        expected: |section: Section, id| section.boundaries(id).ok(),
        name: |of: &LineRecord| {
            format!("{} way {} with {} points", of.class, of.way_id, of.points.len())
        },
    };
    compare(run, store, &how, findings)?;
    let found = LineTotals::get(how.layer, store)?.map(|totals| totals.counts());
    let recorded = run.package.manifest().boundaries.as_ref().map(|of| &of.counts);
    look_at_counts(CheckId::OsmBoundaryCounts, recorded, found.as_ref(), findings);
    Ok(())
}

/// Computes bridges and tunnels again on the ground of the package, and compares them with those of
/// each tile.
pub(crate) fn compare_spans(
    run: &VerifyRun<'_>,
    (of, kept): (SpanInputs<'_>, &losses::Sums),
    findings: &mut Findings,
) -> Result<(), VerifyError> {
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
) -> Result<(), VerifyError> {
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
