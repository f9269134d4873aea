use corniche_pipeline::{Check, CheckId};

use super::*;

#[test]
fn a_check_of_an_input_that_looked_at_nothing_is_not_made() {
    let check = |id, checked| Check { id, checked, broken: 0, examples: Vec::new() };
    let report = VerifyReport {
        tiles: 1,
        checks: vec![
            check(CheckId::Seams, 0),
            check(CheckId::DemPlan, 1),
            check(CheckId::Bound, 0),
        ],
        gaps: Vec::new(),
        borders: 0,
        errors: Vec::new(),
        samples: None,
    };
    let text = to_text(&report, Digits::Plain);
    let verdict = |id: &str| text.lines().find(|line| line.contains(id)).map(|line| &line[..8]);
    assert_eq!(verdict(" P3:"), Some("holds   "));
    assert_eq!(verdict(" dem.plan:"), Some("holds   "));
    assert_eq!(verdict(" P2.bound:"), Some("not made"));
    let document = serde_json::to_value(VerifyDocument::from(&report)).unwrap();
    let checks = document["checks"].clone();
    assert_eq!(checks[1]["holds"], true);
    assert!(checks[2]["holds"].is_null(), "{checks}");
}
