//! SV lines round-trip with the height ranges of their ground.

use std::sync::LazyLock;

use corniche_geom::NodeIndex;
use proptest::prelude::*;

use super::*;
use crate::payload::source_grid::SourceGrid;

const QUANTUM_M: f64 = 0.25;

/// A point: its position, the lowest ground of the segment to it, and the highest minus the lowest
/// ground, in height steps.
type Point = ([i64; 2], i32, u32);

/// A frame whose lattice has 2^14 steps per 10 m.
static FRAME: LazyLock<GridFrame> = LazyLock::new(|| {
    GridFrame::new([0.5, 0.25], 10.0, NodeIndex { i: -512, j: 1024 }, 2).expect("a frame")
});

/// A grid with steps of 1/256 m.
fn grid() -> SourceGrid<'static> {
    let steps = [1_f64 / 256.0; 2].map(f64::to_le_bytes).concat();
    SourceGrid::read(&mut Cursor::new(&steps), &FRAME).expect("a grid")
}

proptest! {
    /// Lines with ground of any heights, most of their points off the grid, round-trip as
    /// range-coded bits.
    #[test]
    fn coded_lines_come_back_with_their_ground(
        lines in prop::collection::btree_map(
            (0..9_u8, 0..1_i64 << 31, 0..3_u32),
            prop::collection::vec(([-1_i64 << 20..1 << 20, -1_i64 << 20..1 << 20], -1_000_000..1_000_000_i32, 0..60_000_u32), 2..9),
            1..8,
        ),
    ) {
        let road = |(&(class, way_id, part), line): (&(u8, i64, u32), &Vec<Point>)| {
            let mut points: Vec<LatticePoint> = line.iter().map(|(p, ..)| LatticePoint::new(p[0], p[1])).collect();
            points.dedup();
            let range_m = |&(_, low, span): &Point| {
                [f64::from(low) * QUANTUM_M, (f64::from(low) + f64::from(span)) * QUANTUM_M]
            };
            let ground_range_m = line.iter().skip(1).take(points.len() - 1).map(range_m).collect();
            let class = FunctionalRoadClass::new(class)?;
            (points.len() > 1).then_some(SvRoad { way_id, part, class, line: SvLine { points, ground_range_m } })
        };
        let roads: Vec<SvRoad> = lines.iter().filter_map(road).collect();
        prop_assert!(!roads.is_empty());
        let corner = LatticePoint::new(0, 0);
        let (bytes, _) = encode(&roads, Some(grid()), corner, QUANTUM_M).expect("all numbers have codes");
        prop_assert_eq!(decode(&bytes, Some(&FRAME), corner, QUANTUM_M), Ok(roads));
    }
}
