//! A tile gets all overlay segments near it.

use corniche_geom::NodeIndex;
use proptest::prelude::*;

use super::*;

fn frame() -> GridFrame {
    GridFrame::new([0.0, 0.0], 10.0, NodeIndex { i: 0, j: 0 }, 2).unwrap()
}

fn line(points: Vec<LatticePoint>) -> StyledLine {
    StyledLine { id: 1, style: 0, points }
}

/// Converts shares of the root tile's sides to points on the lattice.
fn points(shares: &[(f64, f64)]) -> Vec<LatticePoint> {
    let bounds = frame().tile_lattice_bounds(TileId::ROOT);
    let at = |low: i64, high: i64, share: f64| low + ((high - low) as f64 * share) as i64;
    shares
        .iter()
        .map(|&(x, y)| {
            LatticePoint::new(at(bounds.min.u, bounds.max.u, x), at(bounds.min.v, bounds.max.v, y))
        })
        .collect()
}

proptest! {
    /// On the finest level nothing is simplified: the tile gets every segment whose bounding box
    /// touches it, and nothing else.
    #[test]
    fn a_tile_gets_all_segments_near_it(shares in prop::collection::vec((-0.5..1.5_f64, -0.5..1.5_f64), 2..300), x in 0_u32..4, y in 0_u32..4) {
        let frame = frame();
        let mut points = points(&shares);
        points.dedup();
        prop_assume!(points.len() >= 2);
        let overlays = Overlays::new(&[line(points.clone())], &frame);
        let id = TileId::new(2, x, y).unwrap();
        let found: Vec<[LatticePoint; 2]> = overlays
            .near(id, &frame, 3)
            .iter()
            .flat_map(|line| line.points.array_windows().copied().collect::<Vec<_>>())
            .collect();
        let around = frame.tile_lattice_bounds(id).expanded(4);
        let expected: Vec<[LatticePoint; 2]> = points
            .array_windows()
            .filter(|pair: &&[_; 2]| LatticeBounds::around(&pair[..]).unwrap().intersects(&around))
            .copied()
            .collect();
        prop_assert_eq!(found, expected);
    }
}

#[test]
fn coarse_levels_have_fewer_points() {
    let wave = (0..400).map(|k| {
        let share = f64::from(k) / 400.0;
        (share, 0.5 + 0.001 * (f64::from(k) * 0.7).sin())
    });
    let overlays = Overlays::new(&[line(points(&wave.collect::<Vec<_>>()))], &frame());
    let counts: Vec<usize> =
        overlays.levels.iter().map(|level| overlays.of_level(level)[0].line.points.len()).collect();
    assert!(counts[0] <= counts[1] && counts[1] < counts[2], "{counts:?}");
    assert_eq!(counts[2], 400);
}

#[test]
fn what_is_no_line_is_left_out() {
    let one = points(&[(0.5, 0.5)]);
    let twice = points(&[(0.5, 0.5), (0.5, 0.5)]);
    assert!(Overlays::new(&[line(one), line(twice)], &frame()).is_empty());
    assert!(Overlays::default().is_empty());
}
