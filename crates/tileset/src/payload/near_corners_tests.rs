//! The lists of nodes near short gates are complete and sorted.

use super::*;

/// No node outside a list sees its gate under as large an angle as a node of the list, even beyond
/// the margin.
#[test]
fn lists_lack_no_better_node() {
    let lists = NearCorners::get();
    for rows in -LONGEST..=LONGEST {
        for columns in -LONGEST..=LONGEST {
            let nodes = lists.near([columns, rows]);
            assert_eq!(nodes.is_empty(), columns == 0 && rows == 0);
            let place = |node: &NearNode| {
                let from_corner = node.offset() + (MARGIN * STRIDE + MARGIN) as isize;
                let (row, column) = (from_corner / STRIDE as isize, from_corner % STRIDE as isize);
                [column as i32 - MARGIN as i32, row as i32 - MARGIN as i32]
            };
            let angle = |[column, row]: [i32; 2]| {
                let cross = f64::from(rows * column - columns * row);
                let dot = column * (column - columns) + row * (row - rows);
                (cross > 0.0).then(|| f64::from(dot) / cross)
            };
            let listed: Vec<[i32; 2]> = nodes.iter().map(place).collect();
            let cotangents: Vec<f64> =
                listed.iter().map(|&node| angle(node).expect("on the left")).collect();
            for (k, pair) in cotangents.windows(2).enumerate() {
                assert!(pair[0] <= pair[1] + 1e-12);
                let ties = (pair[0] - pair[1]).abs() < 1e-12;
                assert_eq!(nodes[k].ties_with_next(), ties);
                assert!(
                    !ties || [listed[k][1], listed[k][0]] < [listed[k + 1][1], listed[k + 1][0]]
                );
            }
            let Some(&last) = cotangents.last() else { continue };
            let far = 3 * MARGIN as i32;
            let all = (-far..=far).flat_map(|row| (-far..=far).map(move |column| [column, row]));
            let within = all.filter_map(angle).filter(|&cot| cot <= last + 1e-12).count();
            assert_eq!(within, listed.len(), "gate {columns}, {rows}");
        }
    }
}

/// Gates beyond the table have no list.
#[test]
fn long_gates_have_no_list() {
    assert!(NearCorners::get().near([LONGEST + 1, 0]).is_empty());
    assert!(NearCorners::get().near([3, -LONGEST - 1]).is_empty());
}
