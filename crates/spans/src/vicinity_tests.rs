//! Segments near a bridge are in its vicinity, and others are not.

use corniche_geom::LatticePoint;

use super::Vicinity;

#[test]
fn what_crosses_or_comes_near_a_node_is_near() {
    let point = LatticePoint::new;
    let bridge = [point(0, 0), point(1000, 1000)];
    let near = Vicinity::new([bridge].into_iter(), [bridge[1]].into_iter(), 50.0);
    assert!(near.may_meet([point(0, 1000), point(1000, 0)]), "it crosses");
    assert!(near.may_meet([point(1040, 900), point(1040, 1200)]), "it comes near a node");
    assert!(!near.may_meet([point(1060, 900), point(1060, 1200)]), "it passes by");
    assert!(!near.may_meet([point(-20, 0), point(-10, 500)]), "the other end is no node");
}
