//! The last line of `verify` is the verdict, checks without objects do not count, and words are
//! explained.

use corniche_verify::{Check, CheckId};

use super::*;

fn check(id: CheckId, checked: u64, broken: u64) -> Check {
    Check { id, checked, broken, examples: Vec::new() }
}

fn report(checks: Vec<Check>) -> VerifyReport {
    VerifyReport {
        tiles: 1,
        checks,
        gaps: Vec::new(),
        borders: 0,
        errors: Vec::new(),
        samples: None,
    }
}

#[test]
fn a_check_that_looked_at_nothing_does_not_apply_or_was_not_made() {
    // A broken check may be the reason why another one was not run; a valid package has no objects
    // of that kind. In the document, a check of the package alone always has a result.
    for (broken, expected) in [(0, ["holds   ", "n/a     "]), (1, ["BROKEN  ", "not run "])] {
        let report = report(vec![
            check(CheckId::Seams, 0, 0),
            check(CheckId::DemPlan, 1, broken),
            check(CheckId::Bound, 0, 0),
        ]);
        let text = to_text(&report, &Missing::default(), Digits::Plain);
        let verdict = |id: &str| text.lines().find(|line| line.contains(id)).map(|line| &line[..8]);
        assert_eq!([verdict(" dem.plan:"), verdict(" P2.bound:")], expected.map(Some));
        assert_eq!(verdict(" P3:"), Some("n/a     "));
        let document = serde_json::to_value(VerifyDocument::from(&report)).unwrap();
        let checks = document["checks"].clone();
        assert_eq!(checks[0]["holds"], true);
        assert_eq!(checks[1]["holds"], broken == 0);
        assert!(checks[2]["holds"].is_null(), "{checks}");
    }
}

#[test]
fn the_last_line_is_the_verdict() {
    let number = |needs| CheckId::ALL.iter().filter(|id| id.needs() == needs).count();
    let (of_dem, of_osm) = (number(Needs::Dem), number(Needs::Osm));
    let both = of_dem + of_osm;
    let all_three = both + number(Needs::Photo);
    let [none, roads, photos] = [[false; 2], [false, true], [true; 2]];
    let [seams, order] = [CheckId::Seams, CheckId::Order];
    let (plan, bound) = (CheckId::DemPlan, CheckId::Bound);
    let package = vec![check(seams, 1, 0), check(order, 1, 0)];
    let dem = vec![check(seams, 1, 1), check(plan, 1, 0), check(bound, 0, 0)];
    let without_case = |number| vec![check(bound, 0, 0); number];
    let whole =
        |number| [vec![check(seams, 1, 0), check(plan, 1, 0)], without_case(number)].concat();
    let all = vec![check(seams, 1, 1), check(plan, 1, 1), check(CheckId::OsmGeo, 1, 0)];
    for (checks, holds, expected) in [
        (
            package.clone(),
            photos,
            format!("all 2 checks hold; {all_three} more need --dem, --photo and --osm"),
        ),
        (package.clone(), roads, format!("all 2 checks hold; {both} more need --dem and --osm")),
        (package, none, format!("all 2 checks hold; {of_dem} more need --dem")),
        (
            dem.clone(),
            roads,
            format!("1 of 2 checks is broken; 1 not run; {of_osm} more need --osm"),
        ),
        (dem, none, "1 of 2 checks is broken; 1 not run".to_owned()),
        (whole(1), none, "all 2 checks hold; 1 does not apply".to_owned()),
        (whole(4), none, "all 2 checks hold; 4 do not apply".to_owned()),
        (all, roads, "2 of 3 checks are broken".to_owned()),
    ] {
        let report = report(checks);
        let missing = Missing::from_report(&report, holds);
        let text = to_text(&report, &missing, Digits::Plain);
        assert_eq!(text.lines().last(), Some(&*expected), "{text}");
        let short = to_short_text(&report, &missing, Digits::Plain);
        let broken = report.checks.iter().filter(|check| !check.holds()).count();
        assert_eq!(short.lines().count(), broken + 1, "{short}");
        assert!(short.lines().take(broken).all(|line| line.starts_with("BROKEN ")), "{short}");
        assert_eq!(short.lines().last(), Some(&*expected), "{short}");
    }
}

#[test]
fn the_output_explains_the_words_of_checks() {
    let report = report(vec![check(CheckId::OnTin, 1, 0), check(CheckId::Methods, 1, 0)]);
    assert!(to_text(&report, &Missing::default(), Digits::Plain).contains(WORDS));
    let words =
        ["P1", "P2", "P3", "P6", "GEO", "SV", "TIN", "node", "sample", "uncovered", "manifest"];
    for word in words {
        assert_eq!(WORDS.matches(&format!("{word}: ")).count(), 1, "{word}");
        let is_used = |id: &CheckId| id.id().contains(word) || id.promise().contains(word);
        assert!(CheckId::ALL.iter().any(is_used), "{word}");
    }
    let promises = CheckId::ALL.iter().filter_map(|id| id.id().split('.').next());
    for promise in promises.filter(|name| name.starts_with('P')) {
        assert!(words.contains(&promise), "{promise} is not explained");
    }
    let short = to_short_text(&report, &Missing::default(), Digits::Plain);
    assert_eq!(short, "all 2 checks hold\n");
}
