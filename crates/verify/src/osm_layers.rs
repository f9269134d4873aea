//! Layers of the extract that have sections, split again, against those of the package, tile by tile.

use corniche_areas::{AreaTable, ClassedLayer};
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
use corniche_spec::{Observer, settings_record};
use corniche_store::Artifacts;
use corniche_tileset::{
    AreaRecord, FilePackage, LineRecord, Manifest, Section, SpanRun, decode_areas, decode_lines,
};
use serde::Serialize;

use super::{
    checks::{CheckId, Findings, as_json},
    decoded_tiles::DecodedTiles,
    each_tile::{compare_in_order, each_tile},
    error::VerifyError,
    lines::LineChecks,
};

/// The table that the package's areas were made with, out of the one that is given; `None` if the package has no areas.
///
/// Fails if it is another table.
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

/// Compares the areas of each tile, and their counts, with those that the store has now.
pub(crate) fn compare_areas(
    package: &FilePackage,
    store: &dyn Artifacts,
    threads: usize,
    findings: &mut Findings,
    observer: &dyn Observer,
) -> Result<(), VerifyError> {
    let frame = &package.manifest().frame;
    let how = HowCompared {
        layer: SectionLayer::Areas,
        check: CheckId::OsmAreas,
        recorded: |payload: &[u8], id| decode_areas(payload, id, frame).ok(),
        expected: |section: Section, id| section.areas(id, frame).ok(),
        name: |area: &AreaRecord| {
            let points: usize = area.rings().map(Vec::len).sum();
            format!("{} {} with {points} points", area.class, area.object)
        },
    };
    compare(package, store, threads, &how, findings, observer)?;
    let found = AreaTotals::get(how.layer, store)?.map(|totals| totals.counts());
    let recorded = package.manifest().areas.as_ref().map(|areas| &areas.counts);
    look_at_counts(CheckId::OsmAreaCounts, recorded, found.as_ref(), findings);
    Ok(())
}

/// Compares the lines of a layer of each tile, and their counts, with those that the store has now.
pub(crate) fn compare_lines(
    package: &FilePackage,
    layer: ClassedLayer,
    store: &dyn Artifacts,
    threads: usize,
    findings: &mut Findings,
    observer: &dyn Observer,
) -> Result<(), VerifyError> {
    let checks = LineChecks::of(layer);
    let how = HowCompared {
        layer: SectionLayer::Lines(layer),
        check: checks.osm,
        recorded: |payload: &[u8], id| decode_lines(payload, id, layer).ok(),
        expected: |section: Section, id| section.lines(layer, id).ok(),
        name: |of: &LineRecord| {
            format!("{} way {} with {} points", of.class, of.way_id, of.points.len())
        },
    };
    compare(package, store, threads, &how, findings, observer)?;
    let found = LineTotals::get(how.layer, store)?.map(|totals| totals.counts());
    let recorded = package.manifest().lines(layer).map(|of| &of.counts);
    look_at_counts(checks.osm_counts, recorded, found.as_ref(), findings);
    Ok(())
}

/// Solves bridges and tunnels again on the ground of the package, and compares them with those of each tile.
pub(crate) fn compare_spans(
    tiles: &DecodedTiles<'_>,
    (of, kept): (SpanInputs<'_>, &losses::Sums),
    threads: usize,
    findings: &mut Findings,
    observer: &dyn Observer,
) -> Result<(), VerifyError> {
    let package = tiles.package;
    let manifest = package.manifest();
    let (frame, quantum_m) = (&manifest.frame, manifest.vertical.quantum_m);
    let tin = |id| Ok(tiles.of(id).terrain().map(|terrain| terrain.tin.clone()));
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
        layer: SectionLayer::Spans,
        check: CheckId::OsmSpans,
        recorded: |payload: &[u8], id| manifest.decode_spans(payload, id).ok(),
        expected: |section: Section, id| section.spans(id, frame).ok(),
        name: |run: &SpanRun| {
            format!("a run of way {} with {} points", run.way_id, run.points.len())
        },
    };
    compare(package, of.store, threads, &how, findings, observer)?;
    let recorded = manifest.spans.as_ref().map(|spans| &spans.counts);
    look_at_counts(CheckId::OsmSpanCounts, recorded, Some(&counts), findings);
    Ok(())
}

/// Looks whether the counts of a layer are those of the extract.
fn look_at_counts<T: PartialEq + Serialize>(
    check: CheckId,
    recorded: Option<&T>,
    found: Option<&T>,
    findings: &mut Findings,
) {
    findings.look(check, found == recorded, || {
        format!("{} are recorded, {} are in the extract", as_json(&recorded), as_json(&found))
    });
}

/// How the objects of a layer are compared: what a payload has of it, what a section has that was made anew, and what an object is called.
struct HowCompared<R, E, N> {
    layer: SectionLayer,
    check: CheckId,
    recorded: R,
    expected: E,
    name: N,
}

fn compare<T: PartialEq>(
    package: &FilePackage,
    store: &dyn Artifacts,
    threads: usize,
    how: &HowCompared<
        impl Fn(&[u8], TileId) -> Option<Vec<T>> + Sync,
        impl Fn(Section, TileId) -> Option<Vec<T>> + Sync,
        impl Fn(&T) -> String + Sync,
    >,
    findings: &mut Findings,
    observer: &dyn Observer,
) -> Result<(), VerifyError> {
    let look_at = |id: TileId| {
        let mut findings = Findings::default();
        // Tiles that cannot be read are told elsewhere.
        let payload = package.tile(id).ok().flatten();
        let Some(recorded) = payload.and_then(|payload| (how.recorded)(&payload, id)) else {
            return Ok(findings);
        };
        let made = TileSection::get(how.layer, store, id)?;
        let made = made.map(|made| how.layer.section_of(made.section));
        let expected = made.and_then(|made| (how.expected)(made, id)).unwrap_or_default();
        compare_in_order(how.check, id, [&recorded, &expected], &how.name, &mut findings);
        Ok(findings)
    };
    each_tile(package, threads, observer, look_at, |_, found| findings.merge(found))
}
