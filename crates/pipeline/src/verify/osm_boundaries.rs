//! The boundaries of the extract, split again, against those of the package, tile by tile.

use corniche_geom::TileId;
use corniche_store::Artifacts;
use corniche_tileset::{BoundaryRecord, FilePackage, decode_boundaries};

use super::{
    checks::{CheckId, Findings},
    error::VerifyError,
};
use crate::{
    Observer,
    boundaries::{sections::TileBoundaries, totals::BoundaryTotals},
    workers,
};

/// Compares the boundaries of each tile, and their counts, with those that the store has now.
pub(crate) fn compare(
    package: &FilePackage,
    store: &dyn Artifacts,
    threads: usize,
    findings: &mut Findings,
    observer: &dyn Observer,
) -> Result<(), VerifyError> {
    let ids = package.tile_ids()?;
    workers::in_order_unless_cancelled(
        observer,
        threads,
        ids.len(),
        || Ok::<_, VerifyError>(()),
        |(), index| look_at(package, ids[index], store),
        |_, found| {
            findings.merge(found);
            Ok(())
        },
    )?;
    let found = BoundaryTotals::get(store)?.map(|totals| totals.counts());
    let recorded = package.manifest().boundaries.as_ref().map(|of| of.counts.clone());
    findings.look(CheckId::OsmBoundaryCounts, found == recorded, || {
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
    let Ok(recorded) = decode_boundaries(&payload, id) else { return Ok(findings) };
    let expected = match TileBoundaries::get(store, id)? {
        Some(boundaries) => boundaries.into_section().decode(id).unwrap_or_default(),
        None => Vec::new(),
    };
    let count = recorded.len().max(expected.len());
    let (mut recorded, mut expected) = (recorded.iter(), expected.iter());
    for _ in 0..count {
        let (recorded, expected) = (recorded.next(), expected.next());
        findings.look(CheckId::OsmBoundaries, recorded == expected, || {
            format!("tile {id} has {}, the extract gives {}", name(recorded), name(expected))
        });
    }
    Ok(findings)
}

fn name(boundary: Option<&BoundaryRecord>) -> String {
    boundary.map_or_else(
        || "nothing".to_owned(),
        |of| format!("{} way {} with {} points", of.class, of.way_id, of.points.len()),
    )
}
