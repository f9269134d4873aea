//! Every node of the elevation files counts for one tile.

use super::*;

fn node(i: i64, j: i64) -> NodeIndex {
    NodeIndex { i, j }
}

fn count_at(counts: &[(TileId, u64)], x: u32, y: u32) -> u64 {
    counts.iter().find(|(id, _)| (id.x(), id.y()) == (x, y)).unwrap().1
}

#[test]
fn every_node_counts_for_one_tile() {
    let (south_west, north_east) = (node(-300, 100), node(700, 900));
    let frame = GridFrame::covering([0.0; 2], 10.0, south_west, north_east).unwrap();
    let data = DataTiles::between(&frame, south_west, north_east);
    let counts = nodes_by_tile(&frame, &data, &[[south_west, north_east]]);
    assert_eq!(counts.iter().map(|(_, nodes)| nodes).sum::<u64>(), 1001 * 801);
    let tiles = data.within(TileId::ROOT);
    assert_eq!(counts.iter().map(|&(id, _)| id).collect::<Vec<_>>(), tiles);
    // Counted node by node, by the rule that assigns nodes on a border to a tile.
    for (id, nodes) in &counts {
        let corner = frame.tile_corner(*id);
        let own = |i: i64, j: i64| {
            (0..TILE_CELLS).contains(&(i - corner.i)) && (0..TILE_CELLS).contains(&(corner.j - j))
        };
        let all = (-300..=700).flat_map(|i| (100..=900).map(move |j| (i, j)));
        assert_eq!(all.filter(|&(i, j)| own(i, j)).count() as u64, *nodes, "{id}");
    }
}

#[test]
fn tiles_between_files_have_no_node_and_those_of_two_files_no_more_than_all() {
    let (south_west, north_east) = (node(0, 0), node(256 * 4 - 1, 256 * 4));
    let frame = GridFrame::covering([0.0; 2], 10.0, south_west, north_east).unwrap();
    let data = DataTiles::between(&frame, south_west, north_east);
    // The north-western tile, twice, and a corner of the south-eastern one.
    let north_west = [node(0, 256 * 3 + 1), node(255, 256 * 4)];
    let south_east = [node(256 * 4 - 10, 1), node(256 * 4 - 1, 20)];
    let counts = nodes_by_tile(&frame, &data, &[north_west, north_west, south_east]);
    assert_eq!(count_at(&counts, 0, 0), 65_536);
    assert_eq!(count_at(&counts, 3, 3), 200);
    assert_eq!(counts.iter().filter(|(_, nodes)| *nodes > 0).count(), 2);
    // Outside the data there is nothing to count.
    let beside = [node(-5000, -5000), node(-4000, -4000)];
    assert!(nodes_by_tile(&frame, &data, &[beside]).iter().all(|(_, nodes)| *nodes == 0));
}
