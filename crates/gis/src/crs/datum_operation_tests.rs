//! The chosen operation of PROJ is the one that GDAL uses, and a better one is reported only if
//! just its grids are missing.

use super::*;

fn known(name: &str, accuracy_m: Option<f64>, area_deg: [f64; 4]) -> ProjOperation {
    ProjOperation {
        name: name.to_owned(),
        accuracy_m,
        is_ballpark: false,
        area_deg: Some(area_deg),
        missing_grids: Vec::new(),
        has_grids: false,
    }
}

const WEST: [f64; 4] = [0.0, 40.0, 10.0, 50.0];
const WORLD: [f64; 4] = [-180.0, -90.0, 180.0, 90.0];

#[test]
fn the_most_accurate_operation_whose_area_holds_the_place_is_taken() {
    let all = [
        known("rough", Some(20.0), WORLD),
        known("unknown", None, WEST),
        known("fine", Some(1.0), WEST),
        known("as fine", Some(1.0), WEST),
    ];
    let name = |place: [f64; 2], all: &[ProjOperation]| {
        let all: Vec<&ProjOperation> = all.iter().collect();
        taken_at(place, &all).map(|found| found.name.clone())
    };
    assert_eq!(name([5.0, 45.0], &all).as_deref(), Some("fine"));
    assert_eq!(name([365.0, 45.0], &all).as_deref(), Some("fine"));
    assert_eq!(name([20.0, 45.0], &all).as_deref(), Some("rough"));
    // Like in GDAL, the first is kept if its accuracy is unknown.
    assert_eq!(name([5.0, 45.0], &all[1..]).as_deref(), Some("unknown"));
    // Outside all areas: the first without grids.
    let with_grid = ProjOperation { has_grids: true, ..known("grid", Some(0.1), WEST) };
    let outside = [with_grid.clone(), all[2].clone()];
    assert_eq!(name([20.0, 45.0], &outside).as_deref(), Some("fine"));
    assert_eq!(name([20.0, 45.0], &[with_grid]), None);
}

#[test]
fn areas_across_the_antimeridian_hold_both_sides() {
    let aleutians = Some([172.0, 51.0, -164.0, 54.0]);
    for lon in [172.0, 180.0, -180.0, 185.0, -170.0] {
        assert!(holds(aleutians, [lon, 52.0]), "{lon}");
    }
    for lon in [171.0, 0.0, -163.0] {
        assert!(!holds(aleutians, [lon, 52.0]), "{lon}");
    }
    assert!(holds(None, [0.0, 0.0]));
}

#[test]
fn only_a_more_accurate_operation_that_lacks_a_grid_is_better() {
    let lacks = |operation: ProjOperation| ProjOperation {
        missing_grids: vec!["conus.tif".to_owned()],
        has_grids: true,
        ..operation
    };
    let place = [5.0, 45.0];
    let used = known("used", Some(7.0), WORLD);
    let better = |used: &ProjOperation, all: &[ProjOperation]| {
        better_than(used, place, all).map(|found| (found.name, found.accuracy_m))
    };
    let all = [
        lacks(known("worse", Some(8.0), WEST)),
        lacks(known("elsewhere", Some(0.1), [20.0, 40.0, 30.0, 50.0])),
        lacks(known("unknown", None, WEST)),
        known("there", Some(1.0), WEST),
        lacks(known("good", Some(5.0), WEST)),
        lacks(known("best", Some(1.5), WEST)),
    ];
    assert_eq!(better(&used, &all), Some(("best".to_owned(), 1.5)));
    assert_eq!(better(&used, &all[..4]), None);
    // The smaller area is the one of the local operation.
    let small = lacks(known("near", Some(6.0), [4.0, 44.0, 6.0, 46.0]));
    let with_small = [&all[..], &[small]].concat();
    assert_eq!(better(&used, &with_small), Some(("near".to_owned(), 6.0)));
    let unknown = known("used", None, WORLD);
    assert_eq!(better(&unknown, &all[..1]), Some(("worse".to_owned(), 8.0)));
}

#[test]
fn a_warning_names_the_grid_or_says_that_nothing_is_known() {
    let plain = DatumOperation {
        record: DatumOperationRecord {
            from: "EPSG:4267".to_owned(),
            to: "EPSG:4326".to_owned(),
            operation: "NAD27 to WGS 84 (6)".to_owned(),
            accuracy_m: Some(7.0),
            ballpark: false,
        },
        must_be_allowed: false,
        better: None,
    };
    assert_eq!(plain.warning(), None);
    let better = BetterOperation {
        name: "NAD27 to WGS 84 (79)".to_owned(),
        accuracy_m: 5.0,
        grids: vec!["us_noaa_conus.tif".to_owned()],
    };
    let told = DatumOperation { better: Some(better), ..plain.clone() }.warning().unwrap();
    for word in ["EPSG:4267", "accurate to 7 m", "accurate to 5 m", "us_noaa_conus.tif", "projsync"]
    {
        assert!(told.contains(word), "{told}");
    }
    let record = DatumOperationRecord { accuracy_m: None, ..plain.record.clone() };
    let told = DatumOperation { record, ..plain }.warning().unwrap();
    assert!(told.contains("unknown accuracy") && told.contains("-a_srs"), "{told}");
}
