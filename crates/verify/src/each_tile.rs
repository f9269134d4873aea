//! What several checks do alike: look at all tiles side by side, and take what is found in their order.

use std::fmt::Display;

use corniche_geom::TileId;
use corniche_spec::Observer;
use corniche_tileset::FilePackage;
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
