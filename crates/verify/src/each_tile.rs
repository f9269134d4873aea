//! Helpers that several checks share: visiting all tiles in parallel with results in order, and
//! summing up a layer.

use std::{collections::BTreeMap, fmt::Display};

use corniche_geom::TileId;
use corniche_pieces::layers::tile_section::{SectionOfTile, SectionSums};
use corniche_spec::BuildObserver;
use corniche_tileset::{FilePackage, LineLevelRecord};
use corniche_work::{Stage, workers};

use super::{
    checks::{CheckId, Findings},
    decoded_tiles::DecodedTiles,
    error::VerifyError,
};

/// A running verification.
pub(crate) struct VerifyRun<'a> {
    pub(crate) package: &'a FilePackage,
    pub(crate) tiles: DecodedTiles<'a>,
    pub(crate) threads: usize,
    pub(crate) observer: &'a dyn BuildObserver,
}

/// Fails if some bytes of a package could not be read. An unreadable file says nothing about the
/// package; but checks treat a tile that cannot be read as missing or damaged.
pub(crate) fn check_readable(package: &FilePackage) -> Result<(), VerifyError> {
    package.failed_read().map_or(Ok(()), |error| Err(VerifyError::Read(error.clone())))
}

impl VerifyRun<'_> {
    /// Visits each tile as a step of `stage`, and takes the results in the order of tiles.
    pub(crate) fn each_tile<T: Send>(
        &self,
        stage: Stage,
        look: impl Fn(TileId) -> Result<T, VerifyError> + Sync,
        mut take: impl FnMut(TileId, T),
    ) -> Result<(), VerifyError> {
        workers::side_by_side(
            (self.observer, stage),
            self.threads,
            &self.package.tile_ids()?,
            || Ok(()),
            |(), &id| {
                let found = look(id)?;
                check_readable(self.package)?;
                Ok(found)
            },
            |&id, found| {
                take(id, found);
                Ok(())
            },
        )
    }
}

/// Compares the items of a tile with those of the extract, one by one. `name` describes an item.
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

/// The findings and the sums of a layer in one tile.
#[derive(Default)]
pub(crate) struct OfTile {
    pub(crate) findings: Findings,
    pub counts: SectionOfTile,
}

/// The recorded sums of a layer of lines, or of spans, on a level.
pub(crate) fn recorded(of: &LineLevelRecord) -> (u8, SectionSums) {
    let &LineLevelRecord { level, tiles, parts, points, bytes } = of;
    (level, SectionSums { tiles, parts, points, bytes })
}

/// Visits the layer in each tile, and compares the sums with the recorded ones of each level.
pub(crate) fn look_at_layer(
    run: &VerifyRun<'_>,
    stage: Stage,
    look_at: impl Fn(TileId) -> OfTile + Sync,
    (check, recorded): (CheckId, Vec<(u8, SectionSums)>),
    findings: &mut Findings,
) -> Result<(), VerifyError> {
    let mut levels: BTreeMap<u8, SectionSums> = BTreeMap::new();
    run.each_tile(
        stage,
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

/// Checks that each object counts once, as kept or as lost.
pub(crate) fn check_totals(
    check: CheckId,
    what: &str,
    all: u64,
    kept: impl Iterator<Item = u64>,
    lost: &[(String, u64)],
    findings: &mut Findings,
) {
    let (kept, lost): (u64, u64) = (kept.sum(), lost.iter().map(|(_, lost)| lost).sum());
    findings
        .look(check, all == kept + lost, || format!("{all} {what}, {kept} kept and {lost} lost"));
}
