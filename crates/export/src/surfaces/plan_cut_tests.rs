//! Both tiles at a border cut a segment at the same points.

use corniche_geom::{LatticeBounds, LatticePoint};
use proptest::prelude::*;

use super::within;

const WEST: LatticeBounds =
    LatticeBounds { min: LatticePoint::new(0, 0), max: LatticePoint::new(1000, 1000) };
const EAST: LatticeBounds =
    LatticeBounds { min: LatticePoint::new(1000, 0), max: LatticePoint::new(2000, 1000) };

fn point() -> impl Strategy<Value = LatticePoint> {
    (-500..2500_i64, -500..1500_i64).prop_map(|(u, v)| LatticePoint::new(u, v))
}

#[test]
fn a_segment_is_cut_at_borders() {
    let segment = [LatticePoint::new(-100, 100), LatticePoint::new(1100, 700)];
    let expected = [LatticePoint::new(0, 150), LatticePoint::new(1000, 650)];
    assert_eq!(within(segment, &WEST), expected);
    assert_eq!(within([segment[1], segment[0]], &WEST), expected);
    let outside = [LatticePoint::new(-100, 100), LatticePoint::new(-1, 900)];
    assert_eq!(within(outside, &WEST), []);
    let touching = [LatticePoint::new(1000, 300), LatticePoint::new(1200, 400)];
    assert_eq!(within(touching, &WEST), [LatticePoint::new(1000, 300)]);
}

proptest! {
    /// Both tiles of a border have the same points on it.
    #[test]
    fn borders_agree(from in point(), to in point()) {
        let on_border = |tile: &LatticeBounds| -> Vec<LatticePoint> {
            let mut found = within([from, to], tile);
            found.retain(|p| p.u == 1000);
            found.sort_unstable();
            found
        };
        prop_assert_eq!(on_border(&WEST), on_border(&EAST));
    }

    /// The remaining part is in the tile and within half a step of the segment.
    #[test]
    fn parts_lie_on_the_segment(from in point(), to in point()) {
        for at in within([from, to], &WEST) {
            prop_assert!((0..=1000).contains(&at.u) && (0..=1000).contains(&at.v));
            let (du, dv) = ((to.u - from.u) as f64, (to.v - from.v) as f64);
            let off = (at.u - from.u) as f64 * dv - (at.v - from.v) as f64 * du;
            prop_assert!(off.abs() <= 0.51 * du.abs().max(dv.abs()).max(1.0));
        }
    }
}
