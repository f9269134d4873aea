//! Numbers and texts round-trip, and truncated bytes result in `None`.

use proptest::prelude::*;

use super::*;

proptest! {
    /// Numbers and texts round-trip, and truncation turns the last of them into `None`.
    #[test]
    fn numbers_and_texts_come_back(unsigned in any::<u64>(), signed in any::<i64>(), text in ".{0,20}") {
        let mut bytes = Vec::new();
        push_varint(&mut bytes, unsigned);
        push_signed(&mut bytes, signed);
        push_bytes(&mut bytes, text.as_bytes());
        let mut rest = bytes.as_slice();
        prop_assert_eq!(take_number(&mut rest), Some(unsigned));
        prop_assert_eq!(take_signed(&mut rest), Some(signed));
        prop_assert_eq!(take_text(&mut rest), Some(&*text));
        prop_assert!(rest.is_empty());
        let mut cut = &bytes[..bytes.len() - 1];
        prop_assert!(take_number::<u64>(&mut cut).is_some() && take_signed(&mut cut).is_some());
        prop_assert_eq!(take_text(&mut cut), None);
    }
}
