//! Tiles that the data only touch at a border are not counted.

use super::*;

fn node(i: i64, j: i64) -> NodeIndex {
    NodeIndex { i, j }
}

/// The number of tiles on each level, root first.
fn counts(finest: &CoveredTiles) -> Vec<u64> {
    let mut levels = vec![finest.clone()];
    while let Some(parents) = levels.last().and_then(CoveredTiles::parents) {
        levels.push(parents);
    }
    levels.iter().rev().map(CoveredTiles::count).collect()
}

#[test]
fn a_border_alone_makes_no_tile() {
    let (south_west, north_east) = (node(256, 256), node(768, 1024));
    let frame = GridFrame::covering([0.0; 2], 10.0, south_west, north_east).unwrap();
    let covered = CoveredTiles::finest(&frame, &[[south_west, north_east]]);
    assert_eq!(counts(&covered), [1, 2, 6]);
    let wider = [[south_west, node(769, 1024)]];
    assert_eq!(CoveredTiles::finest(&frame, &wider).count(), 9);
}

#[test]
fn what_lies_between_files_is_not_counted_and_what_they_share_once() {
    let (south_west, north_east) = (node(0, 0), node(256 * 64, 256 * 64));
    let frame = GridFrame::covering([0.0; 2], 10.0, south_west, north_east).unwrap();
    let corner = [south_west, node(256, 256)];
    let far = [node(256 * 63, 256 * 63), north_east];
    let covered = CoveredTiles::finest(&frame, &[corner, far, corner]);
    assert_eq!(counts(&covered), [1, 2, 2, 2, 2, 2, 2]);
    assert_eq!(covered.spread(10).len(), 2);
    let whole = CoveredTiles::finest(&frame, &[[south_west, north_east], corner]);
    assert_eq!(whole.count(), 64 * 64);
    // The picked tiles are spread over all rows, each once.
    let picked = whole.spread(8);
    assert_eq!(picked.len(), 8);
    assert!(picked.windows(2).all(|two| two[0].y() < two[1].y()), "{picked:?}");
}
