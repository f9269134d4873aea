//! At a fork off the ground, the straightest other bridge continues each bridge.

use corniche_geom::LatticePoint;

use super::{super::stretches::PlanStretch, DeckEnds};

fn deck(points: &[(i64, i64)]) -> PlanStretch {
    PlanStretch {
        points: points.iter().map(|&(u, v)| LatticePoint::new(u, v)).collect(),
        deck_m: Some(vec![9.0; points.len()]),
        goes_on: [false; 2],
    }
}

#[test]
fn the_straightest_goes_on() {
    let trunk = deck(&[(-100, 0), (0, 0)]);
    let straight = deck(&[(0, 0), (100, 5)]);
    let bent = deck(&[(60, 60), (0, 0)]);
    let ground = PlanStretch { deck_m: None, ..deck(&[(0, 0), (100, 0)]) };
    let ends = DeckEnds::from_stretches([&trunk, &straight, &bent, &ground].into_iter());
    let point = |u, v| Some(LatticePoint::new(u, v));
    assert_eq!(ends.beyond(&trunk, 1), point(100, 5));
    assert_eq!(ends.beyond(&straight, 0), point(-100, 0));
    assert_eq!(ends.beyond(&bent, 1), point(-100, 0));
    assert_eq!(ends.beyond(&trunk, 0), None, "nothing is there");
}

#[test]
fn nothing_goes_on_in_a_hairpin() {
    let there = deck(&[(0, 0), (100, 0)]);
    let back = deck(&[(0, 0), (100, 10)]);
    let ends = DeckEnds::from_stretches([&there, &back].into_iter());
    assert_eq!(ends.beyond(&there, 0), None);
}
