//! Records are read as they were written, and truncated records are rejected.

use proptest::prelude::*;

use super::*;

/// A record is read as it was written, with nothing left over. Truncated anywhere, it is rejected.
#[track_caller]
fn check<T: SortRecord + std::fmt::Debug>(record: &T) {
    let mut bytes = Vec::new();
    record.encode(&mut bytes);
    let mut rest = bytes.as_slice();
    assert_eq!(
        T::decode(&mut rest).as_ref().map(|found| found.cmp(record)),
        Some(std::cmp::Ordering::Equal)
    );
    assert_eq!(rest, b"");
    for len in 0..bytes.len() {
        assert!(T::decode(&mut &bytes[..len]).is_none(), "{record:?} cut at {len}");
    }
}

proptest! {
    #[test]
    fn records_come_back(
        id: i64,
        order: u64,
        version: i32,
        bytes: Vec<u8>,
        location: [i32; 2],
        mark: bool,
    ) {
        let (file, age, facts) = (order as u32, version.unsigned_abs(), bytes.iter().rev().copied());
        let facts = facts.collect();
        let origin = Origin { age, order, version, file };
        check(&WayRecord { way_id: id, origin, bytes: bytes.into(), facts });
        check(&Mention::new(id, order >> 3, WayUse::Carrier, mark));
        check(&Located { node_id: id, order, location, layer: 2 });
        check(&Stop::new(order >> 2, [mark, !mark], location));
    }

    #[test]
    fn a_mark_does_not_change_the_number(
        number in 0..1_u64 << 61, mark: bool, other: bool,
        used in prop::sample::select(vec![WayUse::Road, WayUse::Carrier, WayUse::Length]),
    ) {
        let mention = Mention::new(5, number, used, mark);
        prop_assert_eq!((mention.number(), mention.way_use(), mention.is_repeat()), (number, used, mark));
        let stop = Stop::new(number, [mark, other], [0; 2]);
        prop_assert_eq!((stop.visit >> 2, stop.is_shared(), stop.is_met()), (number, mark, other));
    }
}
