//! Every kind of defect is one line of six fields in the list of defects.

use super::*;

#[test]
fn every_kind_of_defect_is_one_line_of_six_fields() {
    let unknown =
        corniche_osm::ExtractDefect::UnknownHighway { way_id: -7, value: "a,\"b\"\nc".to_owned() };
    assert_eq!(line(&unknown.into()), "unknown highway value,way,-7,,,\"a,\"\"b\"\"\\u000ac\"\n");
    let missing = corniche_osm::ExtractDefect::MissingNodes { way_id: 5, points: 3 };
    assert_eq!(line(&missing.into()), "missing nodes,way,5,3,,\n");
    let lost = Defect::LostRoad {
        way_id: 9,
        loss: corniche_spec::Loss::NoGround,
        length_m: 12.5,
        is_whole: false,
    };
    assert_eq!(
        line(&lost),
        "where the data have no ground (void or edge),way,9,,12.500,a part of it\n"
    );
    assert_eq!(HEADER.trim_end().split(',').count(), 6);
}
