//! The areas of the extract, split again, against those of the package, tile by tile.

use corniche_areas::AreaTable;
use corniche_geom::TileId;
use corniche_store::Artifacts;
use corniche_tileset::{AreaRecord, FilePackage, Manifest, decode_areas};

use super::{
    checks::{CheckId, Findings},
    each_tile::{compare_in_order, each_tile},
    error::VerifyError,
};
use crate::{
    Observer,
    areas::{sections::TileAreas, totals::AreaTotals},
    settings_record,
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
pub(crate) fn compare(
    package: &FilePackage,
    store: &dyn Artifacts,
    threads: usize,
    findings: &mut Findings,
    observer: &dyn Observer,
) -> Result<(), VerifyError> {
    each_tile(
        package,
        threads,
        observer,
        |id| look_at(package, id, store),
        |_, found| findings.merge(found),
    )?;
    let found = AreaTotals::get(store)?.map(|totals| totals.counts());
    let recorded = package.manifest().areas.as_ref().map(|areas| areas.counts.clone());
    findings.look(CheckId::OsmAreaCounts, found == recorded, || {
        format!("{recorded:?} are recorded, {found:?} are in the extract")
    });
    Ok(())
}

fn look_at(
    package: &FilePackage,
    id: TileId,
    store: &dyn Artifacts,
) -> Result<Findings, VerifyError> {
    let mut findings = Findings::default();
    // Tiles that cannot be read are told elsewhere.
    let Some(payload) = package.tile(id).ok().flatten() else { return Ok(findings) };
    let frame = &package.manifest().frame;
    let Ok(recorded) = decode_areas(&payload, id, frame) else { return Ok(findings) };
    let expected = match TileAreas::get(store, id)? {
        Some(areas) => areas.into_section().decode(id, frame).unwrap_or_default(),
        None => Vec::new(),
    };
    compare_in_order(CheckId::OsmAreas, id, [&recorded, &expected], name, &mut findings);
    Ok(findings)
}

fn name(area: &AreaRecord) -> String {
    let rings = area.polygons.iter().flat_map(|part| &part.rings);
    let points: usize = rings.map(Vec::len).sum();
    format!("{} {} with {points} points", area.class, area.object)
}
