//! Cells between the samples of files that lie side by side, apart, or around a hole.

use super::*;

/// Twice the area of the cells, and the number of polygons that they form.
fn found(rects: &[[[i64; 2]; 2]]) -> (i128, usize) {
    let cells = cells(rects).unwrap();
    (cells.iter().map(Polygon::doubled_area).sum::<i128>(), cells.len())
}

/// The same result, computed cell by cell.
fn counted(rects: &[[[i64; 2]; 2]]) -> i128 {
    let is_sample = |column: i64, row: i64| {
        let within = |[min, max]: &[[i64; 2]; 2]| {
            (min[0]..=max[0]).contains(&column) && (min[1]..=max[1]).contains(&row)
        };
        rects.iter().any(within)
    };
    let has_corners = |column: i64, row: i64| {
        [[0, 0], [1, 0], [0, 1], [1, 1]].iter().all(|by| is_sample(column + by[0], row + by[1]))
    };
    let all = (-5..40).flat_map(|column| (-5..40).map(move |row| (column, row)));
    2 * all.filter(|&(column, row)| has_corners(column, row)).count() as i128
}

#[test]
fn cells_have_all_of_their_corners() {
    let single = [[[3, 4], [9, 12]]];
    assert_eq!(found(&single), (2 * 6 * 8, 1));
    // Three of four files next to each other, once with a common row and column of samples.
    let beside = [[[0, 0], [9, 9]], [[10, 0], [19, 9]], [[0, 10], [9, 19]]];
    assert_eq!(found(&beside), (counted(&beside), 1));
    let common = [[[0, 0], [10, 10]], [[10, 0], [20, 10]], [[0, 10], [10, 20]]];
    assert_eq!(found(&common), (counted(&common), 1));
    // Four files; the cell in the middle has one corner in each of them.
    let four = [[[0, 0], [9, 9]], [[10, 0], [19, 9]], [[0, 10], [9, 19]], [[10, 10], [19, 19]]];
    assert_eq!(found(&four), (2 * 19 * 19, 1));
    // Two files that are separated by one column without samples.
    let apart = [[[0, 0], [9, 9]], [[11, 0], [19, 9]]];
    assert_eq!(found(&apart), (counted(&apart), 2));
    // Files around a hole.
    let around: Vec<[[i64; 2]; 2]> = (0..9)
        .filter(|k| *k != 4)
        .map(|k| [[10 * (k % 3), 10 * (k / 3)], [10 * (k % 3) + 9, 10 * (k / 3) + 9]])
        .collect();
    assert_eq!(found(&around), (counted(&around), 1));
    // A common corner is a sample but not a cell.
    let corner = [[[0, 0], [9, 9]], [[9, 9], [20, 20]]];
    assert_eq!(found(&corner), (counted(&corner), 2));
}
