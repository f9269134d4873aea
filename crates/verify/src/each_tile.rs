//! Helpers that several checks share: visiting all tiles in parallel with results in order, and
//! summing up a layer.

use std::{collections::BTreeMap, fmt::Display};

use corniche_geom::TileId;
use corniche_pieces::layers::tile_section::{SectionOfTile, SectionSums};
use corniche_spec::BuildObserver;
use corniche_tileset::{FilePackage, SectionLevelRecord};
use corniche_work::{Stage, workers};

use super::{
    checks::{CheckId, Findings},
    decoded_tiles::DecodedTiles,
    error::{Result, VerifyError},
};

/// A running verification.
pub(crate) struct VerifyRun<'a> {
    pub package: &'a FilePackage,
    pub tiles: DecodedTiles<'a>,
    pub threads: usize,
    pub observer: &'a dyn BuildObserver,
}

/// Fails if some bytes of a package could not be read. An unreadable file says nothing about the
/// package; but checks treat a tile that cannot be read as missing or damaged.
pub(crate) fn check_readable(package: &FilePackage) -> Result<()> {
    package.failed_read().map_or(Ok(()), |error| Err(VerifyError::Read(error.clone())))
}

impl VerifyRun<'_> {
    /// Visits each tile as a step of `stage`, and takes the results in the order of tiles.
    pub(crate) fn each_tile<T: Send>(
        &self,
        stage: Stage,
        look: impl Fn(TileId) -> Result<T> + Sync,
        mut take: impl FnMut(TileId, T),
    ) -> Result<()> {
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

/// The findings and the counts of the sections of a tile.
#[derive(Default)]
pub(crate) struct OfTile {
    pub findings: Findings,
    /// One for each kind of section that is looked at; none if the tile cannot be read.
    pub counts: Vec<SectionOfTile>,
}

/// The sums that a manifest records of a kind of section.
pub(crate) struct RecordedSums<'a> {
    name: &'a str,
    levels: BTreeMap<u8, SectionSums>,
}

impl<'a> RecordedSums<'a> {
    /// Gathers the sums; `name` is that of the layer.
    pub(crate) fn new(name: &'a str, levels: &[SectionLevelRecord]) -> Self {
        let sums = |of: &SectionLevelRecord| {
            let &SectionLevelRecord { level, tiles, parts, points, bytes } = of;
            (level, SectionSums { tiles, parts, points, bytes })
        };
        Self { name, levels: levels.iter().map(sums).collect() }
    }
}

/// Visits sections in each tile, and compares the sums with the recorded ones of each level.
pub(crate) fn look_at_sections(
    run: &VerifyRun<'_>,
    (stage, check): (Stage, CheckId),
    look_at: impl Fn(TileId) -> OfTile + Sync,
    recorded: &[RecordedSums<'_>],
    findings: &mut Findings,
) -> Result<()> {
    let mut sums: Vec<BTreeMap<u8, SectionSums>> = vec![BTreeMap::new(); recorded.len()];
    run.each_tile(
        stage,
        |id| Ok(look_at(id)),
        |id, found| {
            findings.merge(found.findings);
            for (levels, counts) in sums.iter_mut().zip(found.counts) {
                if counts.parts > 0 {
                    levels.entry(id.z()).or_default().add(counts);
                }
            }
        },
    )?;
    for (found, RecordedSums { name, levels }) in sums.iter().zip(recorded) {
        findings.look(check, found == levels, || {
            format!("{name}: {found:?} in the tiles, {levels:?} are recorded")
        });
    }
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
