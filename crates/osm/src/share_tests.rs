//! Shares cover an extract in order and without gaps.

use proptest::prelude::*;

use super::*;

#[test]
fn a_share_is_read_as_it_is_printed() {
    for text in ["1/1", "2/8", "256/256"] {
        assert_eq!(text.parse::<Share>().unwrap().to_string(), text);
    }
    for text in ["", "1", "0/4", "5/4", "1/257", "1/0", "-1/4", "1/4/4", "a/b", "1/65537"] {
        assert!(text.parse::<Share>().is_err(), "{text}");
    }
}

#[test]
fn what_has_no_size_at_the_end_belongs_to_the_last_share() {
    for (sizes, of, last) in
        [(&[5, 0][..], 1, 0..2), (&[5, 0], 3, 1..2), (&[0], 2, 1..1), (&[3, 3, 0, 0], 2, 1..4)]
    {
        let own = Share::new(of, of).unwrap().part_of(sizes.iter().copied());
        assert_eq!(own, last, "{sizes:?} in {of}");
    }
}

proptest! {
    /// The shares follow each other without a gap, and none is larger than its part by more than
    /// one item.
    #[test]
    fn shares_cover_everything_in_order(
        sizes in prop::collection::vec(0_u64..1000, 0..60), of in 1_u16..40
    ) {
        let mut next = 0;
        let total: u64 = sizes.iter().sum();
        let largest = sizes.iter().copied().max().unwrap_or(0);
        for share in Share::all(of) {
            let own = share.part_of(sizes.iter().copied());
            prop_assert_eq!(own.start, next);
            next = own.end;
            let bytes: u64 = sizes[own].iter().sum();
            prop_assert!(bytes <= total / u64::from(of) + largest + 1);
        }
        prop_assert_eq!(next, sizes.len());
        prop_assert_eq!(Share::WHOLE.part_of(sizes.iter().copied()), 0..sizes.len());
    }
}
