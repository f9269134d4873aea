//! Varints, zigzag numbers and planes round-trip, and overlong ones are rejected.

use corniche_varints::{push_varint, to_zigzag, zigzag};
use proptest::prelude::*;

use super::*;

proptest! {
    #[test]
    fn varints_and_zigzag_come_back(values in prop::collection::vec(any::<i64>(), 0..40)) {
        let mut bytes = Vec::new();
        for &value in &values {
            push_varint(&mut bytes, to_zigzag(value));
        }
        let mut cursor = Cursor::new(&bytes);
        for value in values {
            prop_assert_eq!(zigzag(cursor.varint().unwrap()), value);
        }
        prop_assert!(cursor.finish().is_ok());
    }

    #[test]
    fn planes_come_back(values in prop::collection::vec(any::<u64>(), 0..40), shift in 0..64_u32) {
        let values: Vec<u64> = values.iter().map(|value| value >> shift).collect();
        let mut bytes = Vec::new();
        put_planes(&mut bytes, &values);
        let mut cursor = Cursor::new(&bytes);
        prop_assert_eq!(cursor.planes(values.len()).unwrap().iter().collect::<Vec<_>>(), values);
        prop_assert!(cursor.finish().is_ok());
    }
}

#[test]
fn overlong_and_cut_varints_are_refused() {
    assert!(Cursor::new(&[0xff; 10]).varint().is_err());
    assert!(Cursor::new(&[0x80, 0x80]).varint().is_err());
    assert_eq!(
        Cursor::new(&[0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 1]).varint(),
        Ok(u64::MAX)
    );
}
