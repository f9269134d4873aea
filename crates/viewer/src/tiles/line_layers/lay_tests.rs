//! Lines from files are on the ground, and dashes are as long on slopes as on level ground.

use corniche_geom::NodeIndex;
use corniche_tileset::{LayerSlot, RunOwner, SpanHeight, SpanPoint};
use corniche_tin::{Placement, Tin, TinVertex};

use super::*;
use crate::tiles::RoadSegment;

const CELL_M: f64 = 10.0;
/// The number of steps for some hundred diagonals, so that the test is quick.
const FEW_STEPS: u64 = 1 << 22;
/// Rise of the ground in metres per metre to the east.
const RISE: f64 = 0.75;

fn frame() -> GridFrame {
    GridFrame::new([0.25, 0.75], CELL_M, NodeIndex { i: 51_200, j: 512_000 }, 1).unwrap()
}

/// A plane in two triangles.
fn surface(frame: &GridFrame) -> Surface {
    let rise_q = (256.0 * 2.0 * CELL_M * RISE) as i32;
    let node =
        |row, column| TinVertex { row, column, height_q: if column > 0 { rise_q } else { 0 } };
    let nodes = vec![node(0, 0), node(0, 256), node(256, 0), node(256, 256)];
    let tin = Tin::new(nodes, &[[0, 2, 3], [0, 3, 1]]).unwrap();
    Surface::new(&tin, Placement::of_tile(frame, TileId::ROOT, 1.0))
}

fn laid(points_m: &[[f64; 2]]) -> TileLayer {
    laid_on(&surface(&frame()), &[points_m]).unwrap()
}

/// The lattice point this far east and south of the tile's corner.
fn place(&[east, south]: &[f64; 2]) -> LatticePoint {
    let tile = frame().tile_bounds(TileId::ROOT);
    frame().snap([tile.min_x + east, tile.max_y - south]).unwrap()
}

fn laid_on(surface: &Surface, lines_m: &[&[[f64; 2]]]) -> Result<TileLayer, TooMuchWork> {
    laid_with(surface, lines_m, &[])
}

fn laid_with(
    surface: &Surface,
    lines_m: &[&[[f64; 2]]],
    spans: &[SpanRun],
) -> Result<TileLayer, TooMuchWork> {
    let frame = frame();
    let tile = frame.tile_bounds(TileId::ROOT);
    let on = TileSurface {
        id: TileId::ROOT,
        surface: surface.clone(),
        frame,
        quantum_m: 0.125,
        reference_m: [tile.min_x, tile.max_y, 0.0],
        width_margin_m: 40.0,
        scale: PlanScale::uniform([1.0; 2]),
        vertical_scale: 1.0,
        most_steps: FEW_STEPS,
    };
    let line = |points_m: &&[[f64; 2]]| StyledLine {
        id: 7,
        style: 2,
        points: points_m.iter().map(place).collect(),
    };
    let lines: Vec<StyledLine> = lines_m.iter().map(line).collect();
    let spans: Vec<&SpanRun> = spans.iter().collect();
    on.lay_within((&lines, &spans), LineMethods::Both, &StepBudget::new(FEW_STEPS))
}

fn starts_and_rates(layer: &TileLayer) -> Vec<([f32; 2], [f32; 2])> {
    layer.segments.all().iter().map(|of| (of.start_in_tile, of.dash.0)).collect()
}

/// On a slope of 3 : 4, 150 m east are 187.5 m of ground; north along the slope a metre is a metre.
#[test]
fn dashes_are_as_long_on_a_slope_as_on_level_ground() {
    let layer = laid(&[[100.0, 900.0], [250.0, 900.0], [250.0, 800.0]]);
    let mut found = starts_and_rates(&layer);
    found.dedup();
    let expected = [([100.0, -900.0], [0.0, 1.25]), ([250.0, -900.0], [187.5, 1.0])];
    assert_eq!(found.len(), 2, "{found:?}");
    for ((start, dash), (expected_start, expected_dash)) in found.iter().zip(expected) {
        for (a, b) in [(start, expected_start), (dash, expected_dash)] {
            assert!(a.iter().zip(b).all(|(a, b)| (a - b).abs() < 0.02), "{found:?}");
        }
    }
}

#[test]
fn both_methods_have_dashes_at_the_same_places() {
    let layer = laid(&[[-500.0, 900.0], [700.0, 3000.0], [4000.0, 2500.0], [6000.0, 5000.0]]);
    let geo = starts_and_rates(&layer);
    let sv: Vec<_> = layer.volumes.all().iter().map(|of| (of.start_in_tile, of.dash.0)).collect();
    let mut compared = 0;
    for (start, dash) in &geo {
        let same =
            |(at, _): &&([f32; 2], [f32; 2])| (at[0] - start[0]).hypot(at[1] - start[1]) < 0.02;
        // If the border cuts a segment, only the line on the ground is cut.
        let Some((_, other)) = sv.iter().find(same) else { continue };
        assert!((dash[1] - other[1]).abs() < 1e-4 && (dash[0] - other[0]).abs() < 0.05);
        compared += 1;
    }
    assert!(compared > 20, "{compared} of {}", geo.len());
}

#[test]
fn every_vertex_lies_on_the_ground() {
    let layer = laid(&[[20.0, 900.0], [700.0, 3000.0], [4000.0, 2500.0]]);
    for of in layer.segments.all() {
        let share = of.shares[0];
        let east = of.start_in_tile[0] + share * (of.end_in_tile[0] - of.start_in_tile[0]);
        let ground_m = f64::from(east) * RISE;
        assert!((f64::from(of.height_in_tile) - ground_m).abs() < 0.01, "{of:?}");
    }
}

#[test]
fn lines_beyond_the_ground_give_nothing() {
    assert!(laid(&[[-9000.0, 100.0], [-8000.0, 100.0]]).is_empty());
    assert!(laid(&[[100.0, 100.0]]).is_empty());
}

#[test]
fn long_segments_are_divided_and_stay_straight() {
    let layer = laid(&[[100.0, 900.0], [2000.0, 900.0]]);
    let longest_m = LONGEST_CELLS * 2.0 * CELL_M;
    let starts: std::collections::BTreeSet<u32> =
        layer.volumes.all().iter().map(|of| of.start_in_tile[0].to_bits()).collect();
    assert_eq!(starts.len(), (1900.0 / longest_m).ceil() as usize);
    assert!(layer.volumes.all().iter().all(|of| (of.start_in_tile[1] + 900.0).abs() < 0.02));
}

/// A segment that crosses the tile, and begins and ends far away, is divided only near the tile.
#[test]
fn a_segment_all_around_the_earth_is_divided_near_the_tile_alone() {
    let far_m = 2e7;
    let layer = laid(&[[-far_m, 900.0], [far_m, 900.0]]);
    let [side_m, _] = [256.0 * 2.0 * CELL_M; 2];
    let parts = layer.volumes.all().len() as f64;
    let most = (side_m + 2.0 * 40.0) / (LONGEST_CELLS * 2.0 * CELL_M) + 6.0;
    assert!(parts > 20.0 && parts <= most, "{parts} parts");
    assert!(layer.volumes.all().iter().all(|of| (of.start_in_tile[1] + 900.0).abs() < 0.02));
}

/// Twenty thousand lines of two points that cross five hundred triangles each: a small file with
/// ten million vertices.
#[test]
fn lines_that_cross_too_many_triangles_are_refused() {
    let tin = corniche_testing::package::full_tin();
    let surface = Surface::new(&tin, Placement::of_tile(&frame(), TileId::ROOT, 1.0));
    let side_m = 256.0 * 2.0 * CELL_M;
    let diagonal: &[[f64; 2]] = &[[10.0, side_m - 20.0], [side_m - 30.0, 10.0]];
    assert!(laid_on(&surface, &[diagonal; 4]).is_ok());
    let error = laid_on(&surface, &vec![diagonal; 20_000]).unwrap_err();
    assert_eq!(error, TooMuchWork { limit: FEW_STEPS });
    // One line of many long segments is the same case.
    let back: Vec<[f64; 2]> = (0..20_000).map(|k| diagonal[k % 2]).collect();
    assert!(laid_on(&surface, &[&back]).is_err());
}

/// A bridge of a line is a deck in its style, and the line is on the ground on both sides of it.
#[test]
fn a_line_leaves_the_ground_where_it_has_a_bridge() {
    let surface = surface(&frame());
    let ground = |at: [f64; 2]| {
        let at = place(&at);
        SpanPoint { at, height: SpanHeight::Ground { triangle: surface.locate(at).unwrap() } }
    };
    let high = SpanPoint { at: place(&[450.0, 900.0]), height: SpanHeight::Steps(4000) };
    let run = SpanRun {
        way_id: 7,
        owner: RunOwner::Layer(LayerSlot::new(0).unwrap()),
        structure: Structure::Bridge,
        points: vec![ground([300.0, 900.0]), high, ground([600.0, 900.0])],
    };
    let line = [[100.0, 900.0], [1000.0, 900.0]];
    let of_other = SpanRun { way_id: 8, ..run.clone() };
    let layer = laid_with(&surface, &[&line], &[run.clone(), of_other]).unwrap();
    let east = |at: [f32; 3]| f64::from(at[0]);
    let decks = layer.decks.all();
    let class = FunctionalRoadClass::new(2).unwrap();
    assert!(decks.iter().all(|deck| deck.kind == RoadKind::plain(class) && deck.slab_m > 0.0));
    let highest_m = decks.iter().map(|deck| deck.end_in_tile[2]).fold(0.0, f32::max);
    assert!((highest_m - 500.0).abs() < 0.01, "{highest_m}");
    assert_eq!((decks.len(), layer.volumes.all().is_empty()), (2, false));
    assert!((east(decks[0].start_in_tile) - 300.0).abs() < 0.01);
    let is_covered = |at_m: f64| {
        let is_in = |of: &RoadSegment| {
            let [from, to] = [of.start_in_tile[0], of.end_in_tile[0]];
            let [first, last] = of.shares.map(|share| f64::from(from + share * (to - from)));
            first <= at_m && at_m <= last
        };
        layer.segments.all().iter().any(is_in)
    };
    assert!([150.0, 290.0, 610.0, 900.0].into_iter().all(is_covered));
    assert!(![310.0, 450.0, 590.0].into_iter().any(is_covered));
    // In a tunnel the line stays on the ground, with another look.
    let tunnel = SpanRun { structure: Structure::Tunnel, ..run };
    let layer = laid_with(&surface, &[&line], &[tunnel]).unwrap();
    assert!(layer.decks.all().is_empty());
    assert!(layer.segments.all().iter().all(|of| of.kind.look == RoadLook::Bore));
}
