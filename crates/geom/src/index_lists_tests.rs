//! The list of each place contains the items that name it, in ascending order.

use super::*;

#[test]
fn each_place_lists_the_items_that_name_it_in_ascending_order() {
    let places_of = [vec![2, 0], vec![], vec![2], vec![0, 2]];
    let lists = IndexLists::new(4, places_of.len(), |item| places_of[item].iter().copied());
    assert_eq!(lists.list(0), [0, 3]);
    assert!(lists.list(1).is_empty());
    assert_eq!(lists.list(2), [0, 2, 3]);
    assert!(lists.list(3).is_empty());
    assert!(!lists.is_empty());
}

#[test]
fn without_items_every_list_is_empty() {
    let lists = IndexLists::new(2, 0, |_| std::iter::empty());
    assert!(lists.is_empty() && lists.list(0).is_empty() && lists.list(1).is_empty());
    assert_eq!(IndexLists::new(0, 0, |_| std::iter::empty()), IndexLists::default());
}

#[test]
fn lists_are_made_of_their_parts_and_of_nothing_else() {
    let lists = IndexLists::new(3, 4, |item| std::iter::once(item % 3));
    let [starts, indices] = lists.parts().map(<[u32]>::to_vec);
    assert_eq!(IndexLists::of_parts(starts.clone(), indices.clone()), Some(lists));
    assert_eq!(IndexLists::of_parts(vec![0], Vec::new()), Some(IndexLists::default()));
    for (wrong, of) in [
        (Vec::new(), indices.clone()),
        (vec![1, 2, 3, 4], indices.clone()),
        (vec![0, 3, 2, 4], indices.clone()),
        (starts.clone(), Vec::new()),
    ] {
        assert_eq!(IndexLists::of_parts(wrong.clone(), of), None, "{wrong:?}");
    }
}
