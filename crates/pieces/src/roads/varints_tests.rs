//! Numbers and texts come back, and cut bytes give nothing.

use proptest::prelude::*;

use super::*;

proptest! {
    /// Numbers and texts come back, and a cut makes the last of them nothing.
    #[test]
    fn numbers_and_texts_come_back(unsigned in any::<u64>(), signed in any::<i64>(), text in ".{0,20}") {
        let mut bytes = Vec::new();
        push_varint(&mut bytes, unsigned);
        put_signed(&mut bytes, signed);
        put_text(&mut bytes, &text);
        let mut rest = Take::new(&bytes);
        prop_assert_eq!(rest.unsigned(), Some(unsigned));
        prop_assert_eq!(rest.signed(), Some(signed));
        prop_assert_eq!(rest.text(), Some(text));
        prop_assert!(rest.is_empty());
        let mut cut = Take::new(&bytes[..bytes.len() - 1]);
        prop_assert!(cut.unsigned().is_some() && cut.signed().is_some());
        prop_assert_eq!(cut.text(), None);
    }
}
