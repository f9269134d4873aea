//! What tiles have of a layer, counted level by level.

use std::collections::BTreeMap;

use corniche_geom::TileId;
use corniche_pieces::layers::tile_section::{SectionOfTile, SectionSums};
use corniche_spec::Observer;
use corniche_tileset::{FilePackage, LineLevelRecord};

use super::{
    checks::{CheckId, Findings},
    each_tile::each_tile,
    error::VerifyError,
};

/// What is found of a layer in one tile.
#[derive(Default)]
pub(crate) struct OfTile {
    pub(crate) findings: Findings,
    pub counts: SectionOfTile,
}

/// What is recorded of a layer of lines, or of spans, on a level.
pub(crate) fn recorded(of: &LineLevelRecord) -> (u8, SectionSums) {
    let &LineLevelRecord { level, tiles, parts, points, bytes } = of;
    (level, SectionSums { tiles, parts, points, bytes })
}

/// Looks at the layer in each tile, and compares what all have with what is recorded by level.
pub(crate) fn look_at_layer(
    (package, threads): (&FilePackage, usize),
    look_at: impl Fn(TileId) -> OfTile + Sync,
    (check, recorded): (CheckId, Vec<(u8, SectionSums)>),
    findings: &mut Findings,
    observer: &dyn Observer,
) -> Result<(), VerifyError> {
    let mut levels: BTreeMap<u8, SectionSums> = BTreeMap::new();
    each_tile(
        package,
        threads,
        observer,
        |id| Ok(look_at(id)),
        |id, found| {
            findings.merge(found.findings);
            if found.counts.parts > 0 {
                levels.entry(id.z()).or_default().add(found.counts);
            }
        },
    )?;
    let found: Vec<(u8, SectionSums)> = levels.into_iter().collect();
    findings.look(check, found == recorded, || {
        format!("{found:?} in the tiles, {recorded:?} are recorded")
    });
    Ok(())
}

/// Looks whether each object counts once.
pub(crate) fn check_totals(
    check: CheckId,
    what: &str,
    (all, kept, lost): (u64, impl Iterator<Item = u64>, &[(String, u64)]),
    findings: &mut Findings,
) {
    let (kept, lost): (u64, u64) = (kept.sum(), lost.iter().map(|(_, lost)| lost).sum());
    findings
        .look(check, all == kept + lost, || format!("{all} {what}, {kept} kept and {lost} lost"));
}
