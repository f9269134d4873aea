//! Which check detects the change of a field.

use std::path::Path;

use corniche_verify::{CheckId, Needs, VerifyError};

use super::parts::{Against, verify_against};

/// The expected result of `verify` for a package with one changed field.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum SeenBy {
    /// The check with this id fails.
    By(CheckId),
    /// The package cannot be written or opened: writers or readers reject the value.
    Refused,
    /// The error says that the files are not those from which the package was built.
    OtherInput(Against),
    /// No check can detect it, for this reason; docs/promises.md lists it.
    Unseen(&'static str),
}

use SeenBy::{By, OtherInput, Refused, Unseen};

/// A row of the table that the tests print.
pub(crate) fn row(name: &str, seen: SeenBy) -> String {
    let by = match seen {
        By(check) => format!("{} ({})", check.id(), check.needs().text()),
        Refused => "refused".to_owned(),
        OtherInput(Against::Dem) => "refused as other files (`--dem`)".to_owned(),
        OtherInput(_) => "refused as another file (`--osm`)".to_owned(),
        Unseen(reason) => format!("nothing: {reason}"),
    };
    format!("| {name} | {by} |")
}

/// Verifies the package at `path`; returns the result as an error if it is not the expected one.
pub(crate) fn check(path: &Path, seen: SeenBy) -> Result<(), String> {
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
            // The recorded options do not match these files.
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
