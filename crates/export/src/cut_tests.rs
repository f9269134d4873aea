//! Pieces of roads keep their positions and heights where bounds cut them.

use corniche_roads::{FunctionalRoadClass, RoadAttributes};

use super::*;
use crate::piece::PieceKey;

/// A piece through longitudes at 0 north; its heights are its longitudes.
fn piece(longitudes: &[f64]) -> WayPiece {
    let vertices =
        longitudes.iter().map(|&lon| Vertex { at: [lon, 0.0], z_m: lon, is_source: true });
    WayPiece {
        key: PieceKey { way_id: 1, tile: 2, part: 3, cut: 0 },
        class: FunctionalRoadClass::new(0).unwrap(),
        attributes: RoadAttributes::default(),
        vertices: vertices.collect(),
        goes_on: [true, true],
        heights: crate::piece::PieceHeights {
            tolerance_m: Some(0.5),
            ground_m: None,
            on_deck: false,
            has_deck: false,
        },
    }
}

fn cut(piece: &WayPiece, west: f64, east: f64) -> Vec<WayPiece> {
    let bounds = DegreeBounds::new([west, -1.0, east, 1.0]).unwrap();
    cut_at_bounds(piece.clone(), Some(&bounds), &|at| at)
}

fn longitudes(piece: &WayPiece) -> Vec<f64> {
    piece.vertices.iter().map(|vertex| vertex.at[0]).collect()
}

/// A piece inside the bounds is unchanged, to the last bit; a piece outside disappears.
#[test]
fn what_is_inside_stays_as_it_is() {
    let inside = piece(&[1.0, 2.5, 4.0]);
    assert_eq!(cut(&inside, 0.0, 10.0), std::slice::from_ref(&inside));
    assert!(cut(&inside, 5.0, 10.0).is_empty());
    assert!(cut(&inside, 4.0, 10.0).is_empty(), "one point is not a line");
}

/// New ends are on the sides, with the line's height there, and do not continue.
#[test]
fn ends_lie_on_the_sides() {
    let [found] = &cut(&piece(&[1.0, 3.0, 5.0]), 2.0, 4.5)[..] else { panic!() };
    assert_eq!(longitudes(found), [2.0, 3.0, 4.5]);
    assert!(found.vertices.iter().all(|vertex| (vertex.z_m - vertex.at[0]).abs() < 1e-12));
    assert_eq!(
        found.vertices.iter().map(|vertex| vertex.is_source).collect::<Vec<_>>(),
        [false, true, false]
    );
    assert_eq!(found.goes_on, [false, false]);
    let [found] = &cut(&piece(&[1.0, 3.0, 5.0]), 0.0, 4.0)[..] else { panic!() };
    assert_eq!(found.goes_on, [true, false]);
    let [found] = &cut(&piece(&[1.0, 3.0, 5.0]), 2.0, 6.0)[..] else { panic!() };
    assert_eq!(found.goes_on, [false, true]);
}

/// A line that leaves and returns becomes two pieces with numbers of their own.
#[test]
fn a_line_that_comes_back_is_two_pieces() {
    let found = cut(&piece(&[1.0, 3.0, 6.0, 3.0]), 0.0, 4.0);
    assert_eq!(
        found.iter().map(longitudes).collect::<Vec<_>>(),
        [vec![1.0, 3.0, 4.0], vec![4.0, 3.0]]
    );
    assert_eq!(found.iter().map(|piece| piece.key.cut).collect::<Vec<_>>(), [0, 1]);
    assert_eq!(
        found.iter().map(|piece| piece.goes_on).collect::<Vec<_>>(),
        [[true, false], [false, true]]
    );
}

/// RFC 7946: a line over the antimeridian is cut there, at the height of the line.
#[test]
fn lines_are_cut_at_the_antimeridian() {
    let line = vec![[179.0, 10.0, 100.0], [-179.0, 12.0, 300.0], [-178.0, 12.0, 300.0]];
    let found = cut_at_antimeridian(line);
    let expected = vec![
        vec![[179.0, 10.0, 100.0], [180.0, 11.0, 200.0]],
        vec![[-180.0, 11.0, 200.0], [-179.0, 12.0, 300.0], [-178.0, 12.0, 300.0]],
    ];
    assert_eq!(found, expected);
    let back: Vec<_> =
        expected.iter().rev().map(|part| part.iter().rev().copied().collect::<Vec<_>>()).collect();
    let line = vec![[-178.0, 12.0, 300.0], [-179.0, 12.0, 300.0], [179.0, 10.0, 100.0]];
    assert_eq!(cut_at_antimeridian(line), back);
}

/// In a CRS in degrees, longitudes may exceed 180; they are normalised, and the line is cut in the
/// same way.
#[test]
fn longitudes_that_ran_on_come_back() {
    let line = vec![[179.0, 10.0, 100.0], [181.0, 12.0, 300.0], [182.0, 12.0, 300.0]];
    let expected = vec![
        vec![[179.0, 10.0, 100.0], [180.0, 11.0, 200.0]],
        vec![[-180.0, 11.0, 200.0], [-179.0, 12.0, 300.0], [-178.0, 12.0, 300.0]],
    ];
    assert_eq!(cut_at_antimeridian(line), expected);
    let line = vec![[-181.0, 1.0, 1.0], [-182.0, 2.0, 2.0]];
    assert_eq!(cut_at_antimeridian(line), [vec![[179.0, 1.0, 1.0], [178.0, 2.0, 2.0]]]);
}

/// Vertices exactly on the antimeridian are not duplicated, and do not make lines of one point.
#[test]
fn a_vertex_on_the_antimeridian_is_there_once() {
    let line = vec![[179.0, 0.0, 0.0], [180.0, 0.0, 0.0], [-179.0, 0.0, 0.0]];
    assert_eq!(
        cut_at_antimeridian(line),
        [vec![[179.0, 0.0, 0.0], [180.0, 0.0, 0.0]], vec![[-180.0, 0.0, 0.0], [-179.0, 0.0, 0.0]]]
    );
    let line = vec![[179.0, 0.0, 0.0], [-180.0, 0.0, 0.0]];
    assert_eq!(cut_at_antimeridian(line), [vec![[179.0, 0.0, 0.0], [180.0, 0.0, 0.0]]]);
    let line = vec![[9.0, 47.0, 1.0], [10.0, 47.0, 2.0]];
    assert_eq!(cut_at_antimeridian(line.clone()), [line]);
}

/// If the lattice moves a vertex beyond 180° by half a millimetre, no part is created there.
#[test]
fn no_part_is_as_short_as_a_step_of_the_lattice() {
    let line = vec![[179.9, -16.6, 1.0], [180.000_000_004, -16.6, 2.0]];
    assert_eq!(cut_at_antimeridian(line), [vec![[179.9, -16.6, 1.0], [180.0, -16.6, 2.0]]]);
    let line =
        vec![[-180.000_000_004, -16.6, 1.0], [-179.999_999_999, -16.6, 1.0], [-179.9, -16.6, 2.0]];
    assert_eq!(cut_at_antimeridian(line), [vec![[-180.0, -16.6, 1.0], [-179.9, -16.6, 2.0]]]);
    let along = vec![[179.9, 0.0, 1.0], [180.0, 0.0, 2.0], [180.000_000_004, 0.000_000_004, 2.0]];
    let [west] = &cut_at_antimeridian(along)[..] else { panic!("one part") };
    assert!(west.iter().all(|place| place[0] <= 180.0) && west.len() == 3);
}

/// A polygon over the antimeridian is cut there with its hole; others stay, to the last bit.
#[test]
fn polygons_are_cut_at_the_antimeridian() {
    let square = |west: f64, east: f64, half: f64| {
        vec![[west, -half], [east, -half], [east, half], [west, half]]
    };
    let whole = vec![square(9.1, 9.3, 0.1), square(9.15, 9.2, 0.01)];
    assert_eq!(cut_polygon_at_antimeridian(whole.clone(), 1e-6), Some(vec![whole]));
    for east in [181.0, -179.0] {
        let found = cut_polygon_at_antimeridian(
            vec![square(179.0, east, 1.0), square(179.5, 180.0, 0.5)],
            1e-6,
        );
        let found = found.unwrap();
        let ends: Vec<[f64; 2]> = found
            .iter()
            .map(|rings| {
                let x = || rings[0].iter().map(|place| place[0]);
                [x().fold(f64::INFINITY, f64::min), x().fold(f64::NEG_INFINITY, f64::max)]
            })
            .collect();
        assert_eq!(ends, [[179.0, 180.0], [-180.0, -179.0]], "{found:?}");
        // The hole ends at the antimeridian, so it is a notch of the western part.
        assert_eq!(found.iter().map(Vec::len).collect::<Vec<_>>(), [1, 1]);
        assert_eq!(found.iter().map(|rings| rings[0].len()).collect::<Vec<_>>(), [8, 4]);
    }
    let beyond = cut_polygon_at_antimeridian(vec![square(270.0, 271.0, 1.0)], 1e-6).unwrap();
    assert_eq!(beyond, [vec![square(-90.0, -89.0, 1.0)]]);
    // Beyond the antimeridian by rounding alone.
    let rounded = cut_polygon_at_antimeridian(vec![square(179.0, 180.000_000_5, 1.0)], 1e-6);
    assert_eq!(rounded, Some(vec![vec![square(179.0, 180.0, 1.0)]]));
    let sliver = cut_polygon_at_antimeridian(vec![square(180.0, 180.000_000_5, 1.0)], 1e-6);
    assert_eq!(sliver, Some(Vec::new()));
}

/// A line that runs on across 180° and goes around the earth stays whole in a rectangle all around
/// it.
#[test]
fn all_around_the_earth_nothing_is_cut() {
    for around in [
        vec![178.0, 179.5, -179.5, -178.0, -177.0],
        vec![178.0, 181.0, 300.0, 365.0],
        vec![0.0, 100.0, 200.0, 300.0, 400.0],
    ] {
        let line = piece(&around);
        assert_eq!(cut(&line, -180.0, 180.0), std::slice::from_ref(&line), "{around:?}");
    }
    // Almost: the part in the gap of two degrees is dropped.
    let found = cut(&piece(&[178.0, 182.0, 183.0]), -179.0, 179.0);
    let ends: Vec<_> = found.iter().map(longitudes).collect();
    assert_eq!(ends, [vec![178.0, 179.0], vec![181.0, 182.0, 183.0]]);
}

#[test]
fn a_line_no_longer_than_a_step_lies_on_one_end() {
    let line = vec![[179.999_999_999, 10.0, 1.0], [-179.999_999_999, 10.0, 2.0]];
    assert_eq!(cut_at_antimeridian(line), [[[180.0, 10.0, 1.0], [180.0, 10.0, 2.0]]]);
}
