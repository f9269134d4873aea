//! What several checks do alike: look at all tiles side by side, take what is found in their order, and add up what they have of a layer.

use std::{collections::BTreeMap, fmt::Display};

use corniche_geom::TileId;
use corniche_pieces::layers::tile_section::{SectionOfTile, SectionSums};
use corniche_spec::Observer;
use corniche_tileset::{FilePackage, LineLevelRecord};
use corniche_work::{Stage, workers};

use super::{
    checks::{CheckId, Findings},
    error::VerifyError,
};

/// Fails if some bytes of a package could not be read. That says nothing about the package; but checks take a tile that cannot be read for
/// one that is not there, or is damaged.
pub(crate) fn check_readable(package: &FilePackage) -> Result<(), VerifyError> {
    package.failed_read().map_or(Ok(()), |error| Err(VerifyError::Read(error.clone())))
}

/// Looks at each tile of a package, on so many threads, and takes what is found in the order of tiles.
pub(crate) fn each_tile<T: Send>(
    package: &FilePackage,
    threads: usize,
    observer: &dyn Observer,
    look: impl Fn(TileId) -> Result<T, VerifyError> + Sync,
    mut take: impl FnMut(TileId, T),
) -> Result<(), VerifyError> {
    workers::side_by_side(
        (observer, Stage::Verify),
        threads,
        &package.tile_ids()?,
        || Ok(()),
        |(), &id| {
            let found = look(id)?;
            check_readable(package)?;
            Ok(found)
        },
        |&id, found| {
            take(id, found);
            Ok(())
        },
    )
}

/// Compares what a tile has with what the extract gives, one by one. `name` says what something is.
pub(crate) fn compare_in_order<T: PartialEq, N: Display>(
    check: CheckId,
    id: TileId,
    [recorded, expected]: [&[T]; 2],
    name: impl Fn(&T) -> N,
    findings: &mut Findings,
) {
    let name =
        |one: Option<&T>| one.map_or_else(|| "nothing".to_owned(), |one| name(one).to_string());
    for index in 0..recorded.len().max(expected.len()) {
        let (recorded, expected) = (recorded.get(index), expected.get(index));
        findings.look(check, recorded == expected, || {
            format!("tile {id} has {}, the extract gives {}", name(recorded), name(expected))
        });
    }
}

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
