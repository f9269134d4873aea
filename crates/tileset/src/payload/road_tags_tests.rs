//! The road tags section has the bytes of the specification.

use super::*;

fn ways() -> Vec<RoadRecord> {
    let record = |way_id| RoadRecord { way_id, attributes: RoadAttributes::default() };
    [3, 7, 9].map(record).to_vec()
}

/// Bytes assembled by hand according to FORMAT.md, not by the writer: a track, a path, and a way
/// without further tags.
#[rustfmt::skip]
const BY_HAND: &[u8] = &[
    // Texts, sorted.
    6,
    6, b'3', b'0', b' ', b'm', b'p', b'h',
    6, b'g', b'r', b'a', b'd', b'e', b'2',
    6, b'h', b'i', b'k', b'i', b'n', b'g',
    4, b'n', b'o', b'n', b'e',
    4, b'p', b'a', b't', b'h',
    5, b't', b'r', b'a', b'c', b'k',
    // highway, maxspeed, sac_scale, tracktype: one plane each.
    1, 6, 5, 0,
    1, 1, 4, 0,
    1, 0, 3, 0,
    1, 2, 0, 0,
    // lanes: one plane; width: 3500 = 0x0dac, 70 000 = 0x011170, three planes.
    1, 2, 0, 0,
    3, 0xac, 0x70, 0, 0x0d, 0x11, 0, 0x00, 0x01, 0,
];

#[test]
fn the_bytes_are_those_of_the_specification() {
    let mut roads = ways();
    decode(BY_HAND, &mut roads).unwrap();
    let attributes: Vec<RoadAttributes> =
        roads.iter().map(|road| road.attributes.clone()).collect();
    let [track, path, unknown] = <[RoadAttributes; 3]>::try_from(attributes).unwrap();
    assert_eq!(
        track,
        RoadAttributes {
            highway: "track".to_owned(),
            max_speed: "30 mph".to_owned(),
            tracktype: "grade2".to_owned(),
            lanes: NonZeroU8::new(2),
            width_mm: NonZeroU32::new(3500),
            ..RoadAttributes::default()
        }
    );
    assert_eq!(
        path,
        RoadAttributes {
            highway: "path".to_owned(),
            max_speed: "none".to_owned(),
            sac_scale: "hiking".to_owned(),
            width_mm: NonZeroU32::new(70_000),
            ..RoadAttributes::default()
        }
    );
    assert_eq!(unknown, RoadAttributes::default());
    assert_eq!(encode(&roads).unwrap(), BY_HAND);
}

/// A tag that no way has takes one byte; without any tags there is no section.
#[test]
fn absent_tags_take_a_byte_or_none() {
    let mut roads = ways();
    assert_eq!(encode(&roads), None);
    roads[1].attributes.lanes = NonZeroU8::new(1);
    assert_eq!(encode(&roads).unwrap(), [0, 0, 0, 0, 0, 1, 0, 1, 0, 0]);
}

#[test]
fn cut_or_longer_bytes_are_refused() {
    for length in 0..BY_HAND.len() {
        assert!(decode(&BY_HAND[..length], &mut ways()).is_err(), "{length} bytes");
    }
    assert!(decode(&[BY_HAND, &[0]].concat(), &mut ways()).is_err());
}
