//! Range-coded lines round-trip, and lines without a code are rejected.

use std::sync::LazyLock;

use corniche_geom::{GridFrame, NodeIndex};
use proptest::prelude::*;

use super::*;
use crate::payload::number_codes::Cursor;
use crate::payload::range_coder::BitWriter;

/// Cells of 3" at 47° north, whose sides are not a whole number of OSM's steps.
static FRAME: LazyLock<GridFrame> = LazyLock::new(|| {
    GridFrame::new([0.25, -0.5], 92.650_490_646_542_96, NodeIndex { i: 0, j: 256 }, 0)
        .expect("a frame")
});

fn grid() -> SourceGrid<'static> {
    let steps = [0.007_534_327, 0.011_118_058].map(f64::to_le_bytes).concat();
    SourceGrid::read(&mut Cursor::new(&steps), &FRAME).expect("a grid")
}

proptest! {
    /// Lines on the grid, off it, and through points of other lines round-trip.
    #[test]
    fn lines_come_back(
        lines in prop::collection::vec(
            (any::<u32>(), 0..4_u8, prop::collection::vec(([0..30_i64, 0..30_i64], prop::bool::weighted(0.1)), 1..9)), 1..9,
        ),
        spread in prop::sample::select(vec![1_i64, 7, 1000, 90_000]),
    ) {
        let mut written = Vec::new();
        let mut bits = BitWriter::new(Vec::new());
        let mut coder = LineCoder::new(grid(), LatticePoint::new(0, 0));
        for (way_id, flags, at) in &lines {
            let points = at.iter().map(|&([east, north], is_off)| {
                let on_grid = grid().lattice_point([east * spread, north * spread]).unwrap();
                LatticePoint::new(on_grid.u + i64::from(is_off), on_grid.v)
            });
            let mut points: Vec<LatticePoint> = points.collect();
            points.dedup();
            let head = LineHead { way_id: i64::from(*way_id), part: u32::from(*flags), points: points.len(), flags: *flags };
            coder.write_line(&mut bits, head, &points, |_, _, _| ()).unwrap();
            written.push((head, points));
        }
        let bytes = bits.finish();
        let mut bits = BitReader::new(&bytes);
        let mut coder = LineCoder::new(grid(), LatticePoint::new(0, 0));
        let mut room = MAX_POINTS;
        for (head, points) in &written {
            let mut read = Vec::new();
            let found = coder.read_line(&mut bits, &mut room, &mut read, |_, _, _| Ok(()));
            prop_assert_eq!(found, Ok(*head));
            prop_assert_eq!(&read, points);
        }
        prop_assert!(bits.is_exact());
    }

    /// Points that OSM can have are on the grid; other points, or points on a lattice as wide as
    /// the grid, are not.
    #[test]
    fn the_grid_of_osm_is_recognised(at in prop::collection::vec([0..2_000_000_i64, 0..2_000_000_i64], 8..40)) {
        let metres_per_unit = [75_343.27, 111_180.58];
        let on_grid: Vec<LatticePoint> = at.iter().map(|&at| grid().lattice_point(at).unwrap()).collect();
        prop_assert!(SourceGrid::of_osm(&FRAME, metres_per_unit, on_grid.iter().copied()).is_some());
        let beside = on_grid.iter().map(|point| LatticePoint::new(point.u + 5, point.v - 4));
        prop_assert!(SourceGrid::of_osm(&FRAME, metres_per_unit, beside).is_none());
        prop_assert!(SourceGrid::of_osm(&FRAME, [1.0, 1.0], on_grid.iter().copied()).is_none());
    }
}

/// Lines without a code cause an error, and are not written wrongly.
#[test]
fn steps_that_are_too_long_are_refused() {
    let mut bits = BitWriter::new(Vec::new());
    let mut coder = LineCoder::new(grid(), LatticePoint::new(0, 0));
    let points = [LatticePoint::new(0, 0)];
    let head = LineHead { way_id: 1 << 40, part: 0, points: 1, flags: 0 };
    assert!(coder.write_line(&mut bits, head, &points, |_, _, _| ()).is_err());
    let far = [LatticePoint::new(0, 0), LatticePoint::new(1 << 49, 0)];
    let mut coder = LineCoder::new(grid(), LatticePoint::new(0, 0));
    let head = LineHead { way_id: 1, part: 0, points: 2, flags: 0 };
    assert!(coder.write_line(&mut bits, head, &far, |_, _, _| ()).is_err());
}

/// The zeros beyond the end of the bits do not become millions of points.
#[test]
fn a_line_that_goes_on_beyond_its_bits_is_refused() {
    let mut bits = BitWriter::new(Vec::new());
    let mut coder = LineCoder::new(grid(), LatticePoint::new(0, 0));
    let head = LineHead { way_id: 1, part: 0, points: MAX_POINTS, flags: 0 };
    let points = (0..20).map(|k| grid().lattice_point([1000 * k, -900 * k]));
    let points: Vec<LatticePoint> = points.collect::<Option<_>>().expect("points of the grid");
    coder.write_line(&mut bits, head, &points, |_, _, _| ()).expect("short steps");
    let bytes = bits.finish();
    let mut bits = BitReader::new(&bytes);
    let mut coder = LineCoder::new(grid(), LatticePoint::new(0, 0));
    let (mut room, mut read) = (MAX_POINTS, Vec::new());
    let found = coder.read_line(&mut bits, &mut room, &mut read, |_, _, _| Ok(()));
    assert!(found.is_err());
    assert!(read.len() >= 20 && read.len() < 1000, "{} points", read.len());
    // A section has no more points than the limit, whatever its lines say.
    assert_eq!(room, 0);
    let lines =
        (0..1000).map(|_| coder.read_line(&mut bits, &mut room, &mut read, |_, _, _| Ok(())));
    assert!(lines.take(3).all(|line| line.is_err()));
}
