//! Varints and zigzag numbers round-trip, and truncated or too large ones are rejected.

use proptest::prelude::*;

use super::*;

proptest! {
    /// Numbers of all lengths round-trip; truncation only removes the last of them.
    #[test]
    fn numbers_come_back(values in prop::collection::vec((any::<i64>(), 0..64_u32), 1..40)) {
        let values: Vec<i64> = values.into_iter().map(|(value, shift)| value >> shift).collect();
        let mut bytes = Vec::new();
        for &value in &values {
            push_varint(&mut bytes, to_zigzag(value));
        }
        for (end, error) in [(bytes.len(), None), (bytes.len() - 1, Some(BadVarint::Cut))] {
            let mut rest = &bytes[..end];
            for (k, &value) in values.iter().enumerate() {
                let expected = error.filter(|_| k + 1 == values.len()).map_or(Ok(value), Err);
                prop_assert_eq!(varint(&mut rest).map(zigzag), expected);
            }
        }
    }
}

#[test]
fn signs_come_back_to_the_very_ends() {
    let found = [0, 1, 2, 3, u64::MAX - 1, u64::MAX].map(zigzag);
    assert_eq!(found, [0, -1, 1, -2, i64::MAX, i64::MIN]);
}

#[test]
fn what_does_not_fit_is_refused() {
    let read = |bytes: &[u8]| varint(&mut &*bytes);
    // The example in the documentation.
    assert_eq!(read(b"\x96\x01"), Ok(150));
    let nine = [0xff; 9];
    assert_eq!(read(&[&nine[..], &[1]].concat()), Ok(u64::MAX));
    for last in [2, 0x7f, 0x80, 0x81, 0xff] {
        assert_eq!(read(&[&nine[..], &[last]].concat()), Err(BadVarint::TooLarge), "{last}");
    }
    assert_eq!(read(&nine), Err(BadVarint::Cut));
    assert_eq!(read(b""), Err(BadVarint::Cut));
    // A number may have more bytes than it needs.
    assert_eq!(read(b"\x81\x80\x00"), Ok(1));
}
