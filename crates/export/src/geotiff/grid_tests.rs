//! Blocks cover a raster of any size exactly once.

use super::*;

/// Blocks cover a raster of any size exactly once, and end where it ends.
#[test]
fn blocks_cover_a_raster() {
    for (columns, rows) in [(1, 1), (256, 257), (1000, 300)] {
        let grid =
            RasterGrid { corner: NodeIndex { i: -7, j: 1000 }, size: RasterSize { columns, rows } };
        let [across, down] = grid.size.blocks();
        let windows: Vec<NodeWindow> =
            (0..across * down).map(|k| grid.window(grid.size.place(k))).collect();
        let nodes: usize = windows.iter().map(|window| window.columns * window.rows).sum();
        assert_eq!(nodes, columns * rows);
        let last = windows.last().unwrap();
        let end = last.node(last.columns - 1, last.rows - 1);
        assert_eq!(end, NodeIndex { i: -7 + columns as i64 - 1, j: 1000 - rows as i64 + 1 });
    }
}
