//! Missing tiles are named by the largest subtrees that are missing as a whole.

use super::*;

fn data(level: u8, columns: [u32; 2], rows: [u32; 2]) -> DataTiles {
    DataTiles { level, columns, rows }
}

fn tile(text: &str) -> TileId {
    text.parse().unwrap()
}

/// Missing tiles are named by the largest subtrees that are missing as a whole, whatever is outside
/// the data.
#[test]
fn missing_tiles_are_named_by_the_largest_subtrees() {
    let data = data(3, [1, 5], [0, 4]);
    assert_eq!(data.missing(|_| false), []);
    assert_eq!(data.missing(|_| true), [TileId::ROOT]);
    // Of 1/1/0 only the tiles with columns 4 and 5 have data, so they stand for all of it.
    let east = data.missing(|id| id.x() >= 4);
    assert_eq!(east, [tile("1/1/0"), tile("1/1/1")]);
    let some = data.missing(|id| id.y() == 0 && id.x() >= 3);
    assert_eq!(some, ["3/3/0", "3/4/0", "3/5/0"].map(tile));
    // One quarter, and one tile elsewhere.
    let mixed = data.missing(|id| id.ancestor(2) == tile("2/0/0") || id == tile("3/3/3"));
    assert_eq!(mixed, [tile("2/0/0"), tile("3/3/3")]);
}

/// The subtrees that are named contain exactly the tiles that are missing.
#[test]
fn missing_subtrees_hold_what_is_missing() {
    let data = data(4, [2, 12], [3, 14]);
    let mut random = corniche_testing::Random::new(11);
    for _ in 0..50 {
        let every = random.below(6) + 1;
        let gone: BTreeSet<TileId> =
            data.within(TileId::ROOT).into_iter().filter(|_| random.below(every) == 0).collect();
        let named = data.missing(|id| gone.contains(&id));
        let held: Vec<TileId> = named.iter().flat_map(|&id| data.within(id)).collect();
        assert_eq!(held.len(), gone.len(), "none is named twice");
        assert_eq!(held.into_iter().collect::<BTreeSet<_>>(), gone);
    }
}
