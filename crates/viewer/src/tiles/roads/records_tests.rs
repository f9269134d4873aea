//! Segments and volumes of roads, and pieces of decks, from a worker equal those that were sent.

use proptest::prelude::*;

use super::*;
use crate::tiles::{RoadList, RoadSegments, RoadVolumes};

fn described() -> impl Strategy<Value = RoadKind> {
    let class = (0..FunctionalRoadClass::COUNT as u8)
        .prop_map(|number| FunctionalRoadClass::new(number).expect("a class"));
    let own_width = prop_oneof![
        Just(OwnWidth::Unknown),
        (1..=u32::MAX).prop_map(|mm| OwnWidth::Millimetres(NonZeroU32::new(mm).expect("above 0"))),
        (1..=u8::MAX).prop_map(|lanes| OwnWidth::Lanes(NonZeroU8::new(lanes).expect("above 0"))),
    ];
    let look = prop::sample::select(RoadLook::ALL.to_vec());
    (class, own_width, look).prop_map(|(class, own_width, look)| RoadKind {
        class,
        own_width,
        look,
    })
}

fn pair() -> impl Strategy<Value = [f32; 2]> {
    [-1e6_f32..1e6, -1e6_f32..1e6]
}

prop_compose! {
    fn segment()(
        pairs in [pair(), pair(), pair(), pair(), pair(), pair(), pair(), pair(), pair(), pair()],
        part_m in prop_oneof![0.0_f32..1e6, Just(f32::INFINITY)],
        flags in any::<[bool; 7]>(),
        kind in described(),
    ) -> RoadSegment {
        let [start_in_tile, end_in_tile, shares, heights, slopes, rises, a, b, c, dash] = pairs;
        let [cap, other_cap, flat, other_flat, near, far, farthest] = flags;
        RoadSegment {
            start_in_tile, end_in_tile, shares,
            height_in_tile: heights[0],
            has_caps: [cap, other_cap],
            width_factor: heights[1],
            bed: Bed { slopes, rises, most_m: [a, b, c], leaves_tile: [near, far, farthest] },
            kind, part_m,
            dash: DashPlace(dash),
            flat_ends: [flat, other_flat],
        }
    }
}

prop_compose! {
    fn volume()(
        pairs in [pair(), pair(), pair(), pair(), pair(), pair()],
        part_m in 0.0_f32..1e6,
        flat_ends in any::<[bool; 2]>(),
        kind in described(),
    ) -> RoadVolume {
        let [start_in_tile, end_in_tile, height_range_in_tile, range_in_tile, pair, dash] = pairs;
        RoadVolume {
            start_in_tile, end_in_tile, height_range_in_tile,
            near: crate::tiles::NearHeights { range_in_tile, rise: pair[0] },
            width_factor: pair[1],
            kind, part_m,
            dash: DashPlace(dash),
            flat_ends,
        }
    }
}

prop_compose! {
    fn piece()(
        pairs in [pair(), pair(), pair(), pair(), pair(), pair(), pair()],
        [part_m, deck_m] in [0.0_f32..1e6, 0.0_f32..1e6],
        lands in any::<[bool; 2]>(),
        kind in described(),
    ) -> DeckPiece {
        let [[a, b], [c, d], [e, f], start, end, numbers, dash] = pairs;
        DeckPiece {
            start_in_tile: [a, b, c],
            end_in_tile: [d, e, f],
            mitres: [start, end],
            lands, deck_m,
            slab_m: numbers[0],
            width_factor: numbers[1],
            kind, part_m,
            dash: DashPlace(dash),
        }
    }
}

fn sent<T: Recorded>(list: &RoadList<T>) -> RoadList<T> {
    let config = bincode::config::legacy();
    let bytes = bincode::serde::encode_to_vec(list, config).expect("memory is sufficient");
    bincode::serde::decode_from_slice(&bytes, config).expect("the bytes are complete").0
}

proptest! {
    #[test]
    fn segments_come_as_they_were_sent(segments in prop::collection::vec(segment(), 0..20)) {
        let list: RoadSegments = RoadList::sorted(segments, Vec::new());
        prop_assert_eq!(sent(&list), list);
    }

    #[test]
    fn volumes_come_as_they_were_sent(volumes in prop::collection::vec(volume(), 0..20)) {
        let list: RoadVolumes = RoadList::sorted(volumes, Vec::new());
        prop_assert_eq!(sent(&list), list);
    }
}

proptest! {
    #[test]
    fn pieces_of_decks_come_as_they_were_sent(pieces in prop::collection::vec(piece(), 0..20)) {
        let list: RoadList<DeckPiece> = RoadList::sorted(pieces, Vec::new());
        prop_assert_eq!(sent(&list), list);
    }
}

#[test]
fn words_of_no_road_are_refused() {
    let words = [0_u32; 24];
    assert!(RoadSegment::of_words(words).is_some());
    // An invalid class, an invalid kind of width, a width of 0, an invalid look.
    for (at, word) in [(21, 9), (21, 3 << 8), (21, 1 << 8), (23, 8)] {
        let mut others = words;
        others[at] = word;
        assert!(RoadSegment::of_words(others).is_none(), "word {at} is {word}");
    }
}
