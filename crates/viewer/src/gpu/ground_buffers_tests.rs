use super::*;

#[test]
fn triangles_that_share_an_edge_have_it_once() {
    assert_eq!(edges(&[0, 1, 2, 2, 1, 3]), [[0, 1], [0, 2], [1, 2], [1, 3], [2, 3]]);
    assert!(edges(&[]).is_empty());
}
