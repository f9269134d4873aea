//! The index gives the same results as a map, in at most 32 bytes per artifact.

use std::collections::BTreeMap;

use proptest::prelude::*;

use super::*;

fn place(number: u64) -> ArtifactLocation {
    let part = if number.is_multiple_of(3) { PART_LIMIT - 1 } else { number as u32 };
    ArtifactLocation {
        part,
        offset: number * 977 % OFFSET_LIMIT,
        length: number as u32,
        crc: !number as u32,
    }
}

proptest! {
    /// The index gives the same results as a map, in whatever order keys are added.
    #[test]
    fn index_equals_a_map(keys in proptest::collection::vec((0_u8..3, 0_u64..2000), 0..3000)) {
        let (mut index, mut map) = (Index::default(), BTreeMap::new());
        for (number, (kind, item)) in keys.into_iter().enumerate() {
            let key = ArtifactKey { kind, item };
            let place = place(number as u64);
            let is_new = !map.contains_key(&key);
            map.entry(key).or_insert(place);
            prop_assert_eq!(index.insert(key, place), is_new);
        }
        prop_assert!(index.iter().eq(map.iter().map(|(key, place)| (*key, *place))));
        for kind in 0..4 {
            let items: Vec<u64> =
                map.keys().filter(|key| key.kind == kind).map(|key| key.item).collect();
            prop_assert_eq!(index.items(kind), items);
            for item in (0..2000).step_by(7) {
                let key = ArtifactKey { kind, item };
                prop_assert_eq!(index.get(key), map.get(&key).copied());
            }
        }
    }
}

/// The largest values that fit in an entry round-trip.
#[test]
fn keeps_the_largest_values() {
    let place = ArtifactLocation {
        part: PART_LIMIT - 1,
        offset: OFFSET_LIMIT - 1,
        length: u32::MAX,
        crc: u32::MAX,
    };
    let key = ArtifactKey { kind: u8::MAX, item: u64::MAX };
    let mut index = Index::default();
    assert!(index.insert(key, place));
    assert_eq!(index.get(key), Some(place));
}

/// An artifact takes at most 32 bytes, whether keys are added in order or not.
#[test]
fn takes_at_most_32_bytes_an_artifact() {
    for factor in [1, 7919] {
        let mut index = Index::default();
        let count = 100_003;
        for number in 0..count {
            let item = number * factor % count;
            assert!(index.insert(ArtifactKey { kind: 4, item }, place(number)));
        }
        let kind = &index.kinds[4];
        // A map entry takes its key and value, and nodes are two thirds full on average.
        let map_bytes = kind.recent.len() * (size_of::<IndexEntry>() + 8) * 3 / 2;
        let bytes = kind.sorted.capacity() * size_of::<IndexEntry>() + map_bytes;
        assert!(bytes <= 32 * count as usize, "{} bytes each", bytes / count as usize);
    }
}
