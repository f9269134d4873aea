//! The results of shares are read as they were written, and other bytes are rejected.

use proptest::prelude::*;

use super::*;
use crate::location::{MISSING, OUT_OF_RANGE};

fn place() -> impl Strategy<Value = PlaceRecord> {
    let location = prop_oneof![
        8 => (-1_800_000_000_i32..=1_800_000_000, -900_000_000_i32..=900_000_000)
            .prop_map(|(lon, lat)| [lon, lat]),
        1 => Just(MISSING),
        1 => Just(OUT_OF_RANGE),
    ];
    (any::<i64>(), location, any::<bool>(), any::<i32>()).prop_map(
        |(node_id, location, is_conflicting, version)| PlaceRecord {
            node_id,
            location,
            is_conflicting,
            version,
        },
    )
}

proptest! {
    /// Records are read as they were written, whatever came before them, and no more bytes are read
    /// than were written.
    #[test]
    fn places_come_back(places in prop::collection::vec(place(), 0..50)) {
        let (mut bytes, mut before) = (Vec::new(), Default::default());
        for place in &places {
            place.write(&mut before, &mut bytes);
        }
        let (mut rest, mut before) = (bytes.as_slice(), Default::default());
        for place in &places {
            prop_assert_eq!(PlaceRecord::take(&mut before, &mut rest), Some(*place));
        }
        prop_assert!(rest.is_empty());
    }

    /// Other bytes are rejected or read, and never more bytes than there are.
    #[test]
    fn any_bytes_are_read_or_refused(bytes: Vec<u8>) {
        let (mut rest, mut before) = (bytes.as_slice(), Default::default());
        while !rest.is_empty() && PlaceRecord::take(&mut before, &mut rest).is_some() {}
        let mut rest = bytes.as_slice();
        while !rest.is_empty() && ExtractDefect::take(&mut (), &mut rest).is_some() {}
    }
}

/// A length that exceeds any memory is rejected before memory is allocated.
#[test]
fn a_defect_that_claims_an_endless_text_is_refused() {
    let value = "moat".to_owned();
    let mut bytes = Vec::new();
    ExtractDefect::UnknownHighway { way_id: 1, value }.write(&mut (), &mut bytes);
    assert!(ExtractDefect::take(&mut (), &mut bytes.as_slice()).is_some());
    // The length precedes the text: bincode's mark of 64 bits, and a number.
    let at = bytes.windows(4).position(|four| four == b"moat").unwrap() - 1;
    bytes.splice(at..=at, [[253].as_slice(), &(1_u64 << 61).to_le_bytes()].concat());
    assert_eq!(ExtractDefect::take(&mut (), &mut bytes.as_slice()), None);
}
