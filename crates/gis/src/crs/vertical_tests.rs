//! The unit of heights is that of their own axis.

use super::*;

fn unit_m(text: &str) -> Option<f64> {
    match VerticalCrs::of_wkt(text) {
        Ok(found) => found.map(|vertical| vertical.unit_m),
        Err(error) => {
            assert!(error.to_string().contains("no unit of length"), "{error}");
            None
        }
    }
}

/// PROJ writes the unit of each axis; WKT written by hand may have one unit for all axes, or none.
#[test]
fn the_unit_of_heights_is_the_axis_own_and_never_the_ellipsoids() {
    let geographic = |unit: &str, last: &str| {
        format!(
            r#"GEOGCRS["x",DATUM["D",ELLIPSOID["e",6378137,298.25,LENGTHUNIT["metre",1]]],CS[ellipsoidal,3],
                AXIS["latitude",north],AXIS["longitude",east],AXIS["h",up{unit}]{last}]"#
        )
    };
    let foot = r#",LENGTHUNIT["foot",0.3048]"#;
    assert_eq!(unit_m(&geographic(foot, "")), Some(0.3048));
    assert_eq!(unit_m(&geographic("", foot)), Some(0.3048));
    assert_eq!(unit_m(&geographic("", "")), None);
    let vertical = |unit: &str, last: &str| {
        format!(r#"VERTCRS["v",VDATUM["D"],CS[vertical,1],AXIS["H",up{unit}]{last}]"#)
    };
    assert_eq!(unit_m(&vertical(foot, "")), Some(0.3048));
    assert_eq!(unit_m(&vertical("", foot)), Some(0.3048));
    assert_eq!(unit_m(&vertical("", "")), None);
}

#[test]
fn unknown_is_no_name_of_a_datum() {
    for text in ["", " ", "unknown", "Unknown based on WGS 84 ellipsoid", "D_Unknown", "unnamed"] {
        assert!(!is_named(text), "{text}");
    }
    for text in ["North American Vertical Datum 1988", "D_WGS_1984", "Known Point"] {
        assert!(is_named(text), "{text}");
    }
}
