//! Layers share groups if all their classes fit, and no two classes share a place.

use std::collections::BTreeSet;

use super::*;
use crate::layers::tests::class;

fn places(counts: &[usize]) -> Vec<Vec<Option<(LineLayer, u8)>>> {
    let places = LinePlaces::new(counts.iter().copied());
    let layers = counts.iter().zip(0..);
    layers
        .map(|(count, layer)| {
            (0..*count).map(|number| places.place(class(layer, number as u8))).collect()
        })
        .collect()
}

#[test]
fn every_class_has_a_place_of_its_own_above_those_below_it() {
    for counts in [&[2, 0, 4, 8][..], &[8, 8], &[9, 9, 1], &[256, 1, 256], &[3; 64], &[]] {
        let all = places(counts);
        let of_layers = all.iter().flat_map(|layer| layer.iter().rev());
        let order: Vec<(LineLayer, u8)> = of_layers
            .map(|place| {
                let (group, style) = place.expect("a place for each class");
                assert!(usize::from(style) < LineStyle::MOST);
                (group, LineStyle::MOST as u8 - style)
            })
            .collect();
        assert!(order.is_sorted_by(|below, above| below < above), "{counts:?}: {order:?}");
    }
}

#[test]
fn a_layer_that_fits_into_one_group_is_in_one() {
    for counts in [&[2, 4, 8][..], &[8, 8, 8], &[5; 10], &[1, 9, 1]] {
        for layer in places(counts) {
            let groups: BTreeSet<LineLayer> =
                layer.iter().flatten().map(|(group, _)| *group).collect();
            assert_eq!(groups.len(), 1, "{counts:?}");
        }
    }
    assert_eq!(LinePlaces::new([2, 4, 8].into_iter()).groups(), 2);
    assert_eq!(LinePlaces::new([19].into_iter()).groups(), 3);
}

#[test]
fn other_classes_have_no_place() {
    let places = LinePlaces::new([2, 0].into_iter());
    for of in [class(0, 2), class(1, 0), class(2, 0), class(0, 255)] {
        assert_eq!(places.place(of), None);
    }
}
