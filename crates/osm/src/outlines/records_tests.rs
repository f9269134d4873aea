//! Records of areas are read as they were written.

use std::fmt::Debug;

use corniche_store::SortRecord;

use super::*;

fn comes_back<T: SortRecord + PartialEq + Debug>(record: &T) {
    let mut bytes = Vec::new();
    record.encode(&mut bytes);
    let mut rest = &*bytes;
    assert_eq!(T::decode(&mut rest).as_ref(), Some(record));
    assert!(rest.is_empty());
    for length in 0..bytes.len() {
        assert_eq!(T::decode(&mut &bytes[..length]), None, "{length} of {} bytes", bytes.len());
    }
}

fn member(way_id: i64) -> Member {
    Member { way_id, is_inner: way_id < 0 }
}

#[test]
fn records_come_back() {
    let classes = [(Some(7), false), (None, true)];
    let objects = [OsmObject::Way(-7), OsmObject::Relation(i64::MAX)];
    for (object, (class, is_coastline)) in objects.into_iter().zip(classes) {
        comes_back(&ObjectRecord {
            object,
            origin: Origin { age: 3, order: 1 << 40, version: -1, file: 2 },
            class,
            is_coastline,
            values: "Füssen".as_bytes().into(),
            unread: Box::new([0, 63]),
            ways: Box::new([1, -2, i64::MIN].map(member)),
            at: is_coastline.then_some([i32::MIN, 7]),
        });
    }
    comes_back(&MemberRecord { member: member(-5), object_number: 300 });
    let points = Box::new([[i32::MIN + 1, i32::MAX - 1], [0, 0], [1_800_000_000, -900_000_000]]);
    for line in [
        Err(AreaLoss::MissingWays),
        Err(AreaLoss::MissingNodes),
        Err(AreaLoss::OutOfRange),
        Ok(OutlinePoints(points)),
    ] {
        comes_back(&OutlineWayRecord { object_number: 9, member: member(10), line });
    }
}

#[test]
fn lines_with_unknown_places_say_so() {
    let [near, missing, far] = [[1, 2], location::MISSING, location::OUT_OF_RANGE];
    let line = OutlinePoints::from_locations;
    assert_eq!(line(&[near, missing, far]), Err(AreaLoss::MissingNodes));
    assert_eq!(line(&[near, far]), Err(AreaLoss::OutOfRange));
    assert_eq!(line(&[near, near]), Ok(OutlinePoints(Box::new([near, near]))));
}
