//! Lines with classes round-trip in their section, and damage is reported.

use proptest::prelude::*;

use super::*;
use crate::payload::builder::Section;

fn tile() -> TileId {
    TileId::new(1, 1, 0).unwrap()
}

fn boundary(way_id: i64, class: BoundaryClass, points: &[(i64, i64)]) -> LineRecord {
    let points = points.iter().map(|&(u, v)| LatticePoint::new(u, v)).collect();
    LineRecord { way_id, class, points }
}

#[test]
fn what_is_encoded_comes_back() {
    let boundaries = [
        boundary(-5, BoundaryClass::Admin2, &[(0, 0), (-64, 128), (1 << 40, 64)]),
        boundary(i64::MAX, BoundaryClass::Admin8, &[(64, 64), (0, 64)]),
        boundary(i64::MIN, BoundaryClass::Protected, &[(64, 64), (0, 64), (64, 64)]),
    ];
    let section = encode_boundaries(tile(), 64, &boundaries).unwrap().unwrap();
    assert_eq!(section.boundaries(tile()).unwrap(), boundaries);
    assert_eq!(encode_boundaries(tile(), 64, &[]).unwrap(), None);
}

#[test]
fn what_cannot_be_read_is_not_written() {
    let refused = |step, points: &[(i64, i64)]| {
        let boundary = boundary(1, BoundaryClass::Admin2, points);
        encode_boundaries(tile(), step, &[boundary]).unwrap_err().to_string()
    };
    assert!(refused(0, &[(0, 0), (1, 1)]).contains("a spacing of 0"));
    assert!(refused(1, &[(0, 0)]).contains("fewer than two"));
    assert!(refused(1, &[(0, 0), (0, 0)]).contains("two equal points"));
    assert!(refused(4, &[(0, 0), (4, 6)]).contains("not on the lattice"));
    assert!(refused(1, &[(0, 0), (i64::MAX, 0)]).contains("not on the lattice"));
}

proptest! {
    #[test]
    fn boundaries_come_back(
        step_bits in 0_u32..20,
        lines in prop::collection::vec((any::<i64>(), 0_u8..8, prop::collection::vec((-9000_i64..9000, -9000_i64..9000), 2..40)), 1..20),
    ) {
        let step = 1_i64 << step_bits;
        let boundaries: Vec<LineRecord> = lines
            .into_iter()
            .map(|(way_id, class, mut points)| {
                points.dedup();
                let class = BoundaryClass::from_number(class).unwrap();
                let points: Vec<_> = points.into_iter().map(|(u, v)| (u * step, v * step)).collect();
                boundary(way_id, class, &points)
            })
            .filter(|boundary| boundary.points.len() >= 2)
            .collect();
        if let Some(section) = encode_boundaries(tile(), step, &boundaries).unwrap() {
            prop_assert_eq!(section.boundaries(tile()).unwrap(), boundaries);
        }
    }

    /// Damage is reported; nothing panics, and everything that is read could have been written.
    #[test]
    fn damaged_bytes_are_refused_or_read(at in 0_usize..60, value in any::<u8>(), cut in 0_usize..60) {
        let boundaries = [
            boundary(7, BoundaryClass::Admin4, &[(0, 0), (-640, 128), (6400, 64), (64, 0)]),
            boundary(9, BoundaryClass::Admin6, &[(64, 64), (0, 64)]),
        ];
        let section = encode_boundaries(tile(), 64, &boundaries).unwrap().unwrap();
        let mut bytes = section.into_bytes();
        if let Some(byte) = bytes.get_mut(at) {
            *byte = value;
        }
        bytes.truncate(bytes.len().saturating_sub(cut / 10));
        if let Ok(read) = Section::of_boundaries(bytes).boundaries(tile()) {
            for boundary in read {
                prop_assert!(boundary.points.len() >= 2);
            }
        }
    }
}
