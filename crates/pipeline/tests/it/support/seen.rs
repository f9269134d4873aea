//! Which check finds that a field was changed.

use std::path::Path;

use corniche_verify::{CheckId, Needs, VerifyError};

use super::parts::{Against, verify_against};

/// What `verify` must say of a package with one field changed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Seen {
    /// The check with this id is broken.
    By(CheckId),
    /// The package cannot be written or opened: writers or readers refuse the value.
    Refused,
    /// The error says that these are not the files that the package was made from.
    OtherInput(Against),
    /// No check can see it, for this reason; so it stands in docs/promises.md.
    Unseen(&'static str),
}

use Seen::{By, OtherInput, Refused, Unseen};

/// A row of the table that the tests print.
pub(crate) fn row(name: &str, seen: Seen) -> String {
    let by = match seen {
        By(check) => format!("{} ({})", check.id(), check.needs().text()),
        Refused => "refused".to_owned(),
        OtherInput(Against::Dem) => "refused as other files (`--dem`)".to_owned(),
        OtherInput(_) => "refused as another file (`--osm`)".to_owned(),
        Unseen(reason) => format!("nothing: {reason}"),
    };
    format!("| {name} | {by} |")
}

/// Verifies the package at `path`; gives the answer as an error if it is not the expected one.
pub(crate) fn check(path: &Path, seen: Seen) -> Result<(), String> {
    let broken = |against| match verify_against(path, against) {
        Ok(report) => Ok(report
            .checks
            .iter()
            .filter(|check| !check.holds())
            .map(|check| check.id)
            .collect::<Vec<_>>()),
        Err(error) => Err(error),
    };
    let needed = |check: CheckId| match check.needs() {
        Needs::Package => Against::Itself,
        Needs::Dem => Against::Dem,
        Needs::Photo => unreachable!("packages of these tests have no photos"),
        Needs::Osm => Against::Osm,
    };
    let found = match seen {
        By(check) => match broken(needed(check)) {
            Ok(ids) if ids.contains(&check) => return Ok(()),
            found => format!("{found:?}"),
        },
        OtherInput(against) => match broken(against) {
            Err(
                VerifyError::OtherDem { .. }
                | VerifyError::OtherOsm { .. }
                | VerifyError::OtherTable { .. }
                | VerifyError::OtherTableOfThatName { .. },
            ) => return Ok(()),
            // The options that are recorded do not go with these files.
            Err(VerifyError::Dem(_)) if against == Against::Dem => return Ok(()),
            found => format!("{found:?}"),
        },
        Refused => match broken(Against::Itself) {
            Err(VerifyError::Open(_)) => return Ok(()),
            found => format!("{found:?}"),
        },
        Unseen(_) => {
            let all = [Against::Itself, Against::Dem, Against::Osm].map(broken);
            if all.iter().all(|found| matches!(found, Ok(ids) if ids.is_empty())) {
                return Ok(());
            }
            format!("{all:?}")
        }
    };
    Err(found)
}
