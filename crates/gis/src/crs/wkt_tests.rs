//! WKT is split at the right commas.

use super::*;

#[test]
fn wkt_is_taken_apart_at_its_own_commas() {
    let wkt = r#"PROJCS["a, b",GEOGCS["x [y]",1,2],UNIT["m",1]]"#;
    assert_eq!(children(wkt), [r#"GEOGCS["x [y]",1,2]"#, r#"UNIT["m",1]"#]);
    assert_eq!((quoted(wkt), keyword(wkt)), (Some("a, b"), "PROJCS"));
    assert_eq!(child(wkt, &["UNIT"]).as_deref(), Some(r#"UNIT["m",1]"#));
    assert_eq!(child(wkt, &["AXIS"]), None);
}

#[test]
fn the_survey_foot_is_exact() {
    let unit = |digits: &str| length_unit_m(&format!(r#"X["a",LENGTHUNIT["foot",{digits}]]"#));
    assert_eq!(unit("0.304800609601219"), Some(1200.0 / 3937.0));
    assert_eq!(unit("0.3048"), Some(0.3048));
    assert_eq!(length_unit_m(r#"X["a"]"#), None);
}
