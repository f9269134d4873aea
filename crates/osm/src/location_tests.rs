//! Positions are rounded to the resolution of the data, and positions off the Earth are marked.

use super::*;

#[test]
fn rounds_to_the_resolution_of_the_data_and_marks_what_is_not_on_earth() {
    assert_eq!(location_from_nano(9_500_000_049, -47_000_000_050), [95_000_000, -470_000_000]);
    assert_eq!(location_from_nano(9_500_000_050, -47_000_000_051), [95_000_001, -470_000_001]);
    assert_eq!(location_from_nano(180_000_000_000, -90_000_000_000), [1_800_000_000, -900_000_000]);
    assert_eq!(location_from_nano(180_000_000_001, 0), OUT_OF_RANGE);
    assert_eq!(location_from_nano(0, 90_000_000_001), OUT_OF_RANGE);
    assert_eq!(location_from_nano(i64::MIN, i64::MAX), OUT_OF_RANGE);
    assert_eq!(location_from_nano(214_748_364_700, 214_748_364_700), MISSING);
    assert_eq!(location_from_nano(214_748_364_700, 0), OUT_OF_RANGE);
    assert_eq!(degrees([95_000_001, -470_000_000]), Some([9.500_000_1, -47.0]));
    assert_eq!((degrees(MISSING), degrees(OUT_OF_RANGE)), (None, None));
}
