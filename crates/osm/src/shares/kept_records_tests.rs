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
    (any::<i64>(), location, any::<bool>()).prop_map(|(node_id, location, is_conflicting)| {
        PlaceRecord { node_id, location, is_conflicting }
    })
}

proptest! {
    /// What is written is read, whatever came before it, and no more bytes than were written.
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

    /// Other bytes are refused or read, never more.
    #[test]
    fn any_bytes_are_read_or_refused(bytes: Vec<u8>) {
        let (mut rest, mut before) = (bytes.as_slice(), Default::default());
        while !rest.is_empty() && PlaceRecord::take(&mut before, &mut rest).is_some() {}
        let mut rest = bytes.as_slice();
        while !rest.is_empty() && Defect::take(&mut (), &mut rest).is_some() {}
    }
}
