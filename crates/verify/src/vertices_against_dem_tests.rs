//! Gradients next to gaps are one-sided, and only rejected samples are findings.

use corniche_dem::AuditError;
use corniche_pieces::ExtractError;
use corniche_spec::artifacts::ArtifactError;

use crate::VerifyError;

use super::*;

#[test]
fn a_gradient_beside_a_gap_is_taken_from_one_side_and_between_gaps_is_none() {
    // Rises 3 m a cell to the east and 1 m a cell to the south.
    let heights = HeightGrid::from_fn(5, 5, |c, r| {
        if (c == 3 && r == 2) || (c == 2 && r != 2) { f32::NAN } else { 3.0 * c as f32 + r as f32 }
    });
    assert_eq!(gradient(&heights, [1, 1], [10.0, 20.0]), [0.3, -0.05]);
    assert_eq!(gradient(&heights, [2, 2], [10.0, 20.0]), [0.3, 0.0]);
}

#[test]
fn only_what_the_audit_refuses_is_a_finding() {
    assert!(matches!(refusal(Ok(())), Ok(None)));
    let no_height = AuditError::OutOfRange {
        path: "a.tif".into(),
        count: 1,
        samples: 9,
        height_m: 70_000.0,
        stored: "70000".to_owned(),
        low_m: -500.0,
        high_m: 9000.0,
    };
    assert!(refusal(Err(GroundError::Dem(no_height.into()))).unwrap().unwrap().contains("70000"));
    let interrupted = refusal(Err(GroundError::Interrupted));
    assert!(matches!(interrupted, Err(VerifyError::Interrupted)));
    let damaged = ArtifactError::Damaged { what: "heights".to_owned() };
    let failed = refusal(Err(damaged.into()));
    assert!(matches!(failed, Err(VerifyError::Kept(_))));
    let full = ExtractError::Storage(std::io::ErrorKind::StorageFull.into());
    assert!(matches!(full.into(), VerifyError::Work(_)));
}
