//! A cause has one form in the error of a build, whichever step reports it.

use corniche_dem::DemError;

use corniche_work::Interrupted;

use super::*;

/// The same cause, reported by heights, inputs, the plan and the extract.
fn through_all<C>(cause: impl Fn() -> C, is_it: impl Fn(&BuildError) -> bool)
where
    GroundError: From<C>,
    PlanError: From<C>,
    ExtractError: From<C>,
{
    let all: [BuildError; 4] = [
        GroundError::from(cause()).into(),
        PlanError::from(cause()).into(),
        PlanError::Ground(GroundError::from(cause())).into(),
        ExtractError::from(cause()).into(),
    ];
    for error in all {
        assert!(is_it(&error), "{error:?}");
    }
}

#[test]
fn interruptions_and_elevation_errors_have_one_shape() {
    through_all(|| Interrupted, |error| matches!(error, BuildError::Interrupted));
    let grid = || DemError::from(corniche_dem::GridError::CellTwice);
    through_all(grid, |error| matches!(error, BuildError::Dem(DemError::Grid(_))));
    let stopped = BuildError::from(PlanError::from(InputError::Interrupted));
    assert!(matches!(stopped, BuildError::Interrupted), "{stopped:?}");
}

#[test]
fn what_the_store_lacks_has_one_shape() {
    let missing = || ArtifactError::Missing { what: "a tile".to_owned(), step: "tiles" };
    for error in [
        BuildError::from(GroundError::from(missing())),
        BuildError::from(ExtractError::from(missing())),
        BuildError::from(missing()),
    ] {
        let is_it = matches!(&error, BuildError::Artifact(ArtifactError::Missing { .. }));
        assert!(is_it && !error.is_unusable_input(), "{error:?}");
    }
}
