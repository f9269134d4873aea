//! The grid covers its extent with aligned tiles, and neighbours share their borders to the last
//! bit.

use super::*;
use proptest::prelude::*;

fn frame() -> GridFrame {
    let node = |i, j| NodeIndex { i, j };
    GridFrame::covering([0.5, 0.25], 1.0, node(563_999, 146_000), node(564_998, 146_999)).unwrap()
}

#[test]
fn covers_the_extent_with_aligned_tiles() {
    let frame = frame();
    assert_eq!(frame.root_corner().i % TILE_CELLS, 0);
    assert_eq!(frame.root_corner().j % TILE_CELLS, 0);
    let bounds = frame.tile_bounds(TileId::ROOT);
    assert!(bounds.min_x <= frame.x_m(563_999) && bounds.max_x >= frame.x_m(564_998));
    assert!(bounds.min_y <= frame.y_m(146_000) && bounds.max_y >= frame.y_m(146_999));
    assert_eq!(frame.max_level(), 3, "564 000 / 256 is no whole number, so five columns of tiles");
}

#[test]
fn an_extent_of_exactly_one_tile_is_one_tile() {
    let frame = GridFrame::covering(
        [0.0, 0.0],
        10.0,
        NodeIndex { i: 256, j: -512 },
        NodeIndex { i: 512, j: -256 },
    );
    let frame = frame.unwrap();
    assert_eq!((frame.max_level(), frame.root_corner()), (0, NodeIndex { i: 256, j: -256 }));
}

#[test]
fn lattice_step_is_at_most_a_millimetre_and_divides_the_cell() {
    for cell_m in [0.25, 1.0, 5.0, 30.0, 92.7, 5000.0] {
        let frame = GridFrame::new([0.0; 2], cell_m, NodeIndex { i: 0, j: 0 }, 2).unwrap();
        assert!(frame.lattice_step_m() <= 0.001 && frame.lattice_step_m() > 0.000_49);
    }
}

#[test]
fn a_cell_is_fitted_to_whole_steps_and_moves_by_less_than_a_millimetre() {
    for sides in [[20.0, 30.0], [63.123_456, 92.654_321], [0.7, 1.0], [1000.1, 0.3]] {
        let cell = Cell::from(sides).fitted();
        let frame = GridFrame::new([0.0; 2], cell, NodeIndex { i: 0, j: 0 }, 1).unwrap();
        assert!((cell.east_m - sides[0]).abs() <= 0.000_5 && cell.north_m == sides[1]);
        let [east, north] = frame.node_steps(1);
        let step_m = frame.lattice_step_m();
        assert_eq!(east as f64 * step_m, cell.east_m);
        assert_eq!(north as f64 * step_m, cell.north_m);
    }
    let off = GridFrame::new([0.0; 2], [20.000_1, 30.0], NodeIndex { i: 0, j: 0 }, 1);
    assert!(matches!(off, Err(GridFrameError::EastSide { .. })), "{off:?}");
}

#[test]
fn refuses_what_is_out_of_range() {
    let corner = NodeIndex { i: 0, j: 0 };
    assert!(GridFrame::new([0.0; 2], f64::NAN, corner, 2).is_err());
    assert!(GridFrame::new([f64::INFINITY, 0.0], 1.0, corner, 2).is_err());
    assert!(GridFrame::new([0.0; 2], 1.0, NodeIndex { i: 3, j: 0 }, 2).is_err());
    assert!(GridFrame::new([0.0; 2], 1.0, corner, 23).is_err());
    assert!(GridFrame::new([0.0; 2], 1.0, NodeIndex { i: i64::MIN, j: 0 }, 2).is_err());
}

#[test]
fn what_lies_beyond_the_lattice_has_no_place_on_it() {
    let origin = NodeIndex { i: 0, j: 0 };
    for (cell_m, max_level) in [(1e6, 22), (1e6, 13), (30_000.0, 22)] {
        let frame = GridFrame::new([0.0; 2], cell_m, origin, max_level);
        assert!(matches!(frame, Err(GridFrameError::Extent { .. })), "{cell_m} m, {max_level}");
    }
    let frame = GridFrame::new([0.0; 2], 1e6, origin, 8).unwrap();
    let farthest_m = (MAX_LATTICE_STEPS - 1) as f64 * frame.lattice_step_m();
    assert!(frame.snap([0.5 * farthest_m, 0.0]).is_some());
    assert_eq!(frame.snap([1.01 * farthest_m, 0.0]), None);
}

proptest! {
    /// A node has one position, however it is computed.
    #[test]
    fn node_and_lattice_positions_have_the_same_bits(
        i in -2_000_000_i64..2_000_000, j in -2_000_000_i64..2_000_000, east_m in 0.1..1000.0_f64,
        north_m in 0.1..1000.0_f64,
    ) {
        let cell = Cell { east_m, north_m }.fitted();
        let frame = GridFrame::new([0.07, 0.03], cell, NodeIndex { i: 0, j: 0 }, 4).unwrap();
        let at = frame.position_m(frame.lattice_of_node(NodeIndex { i, j }));
        prop_assert_eq!([at[0].to_bits(), at[1].to_bits()], [frame.x_m(i).to_bits(), frame.y_m(j).to_bits()]);
    }

    /// Snapping moves a point by at most half a step on each axis.
    #[test]
    fn snap_is_within_half_a_step(x in 560_000.0..570_000.0_f64, y in 140_000.0..150_000.0_f64) {
        let frame = frame();
        let at = frame.position_m(frame.snap([x, y]).unwrap());
        let half = frame.lattice_step_m() / 2.0 + 1e-9;
        prop_assert!((at[0] - x).abs() <= half && (at[1] - y).abs() <= half);
    }

    /// Children share their parent's corners and halve its side.
    #[test]
    fn neighbours_share_their_border(x in 0_u32..7, y in 0_u32..8) {
        let frame = frame();
        let id = TileId::new(3, x, y).unwrap();
        let (own, east) = (frame.tile_bounds(id), frame.tile_bounds(id.neighbour(1, 0).unwrap()));
        prop_assert_eq!(own.max_x.to_bits(), east.min_x.to_bits());
        prop_assert_eq!(frame.tile_corner(id.parent().unwrap()) == frame.tile_corner(id), x % 2 == 0 && y % 2 == 0);
        let inside = frame.tile_lattice_bounds(id).min;
        prop_assert_eq!(frame.tile_column_row(3, LatticePoint::new(inside.u, inside.v + 1)), [i64::from(x), i64::from(y)]);
    }
}
