//! Lines over valleys, banks and bumps: which parts are slabs, and where they begin.

use corniche_geom::{LatticePoint, StepBudget};
use corniche_roads::{FunctionalRoadClass, RoadAttributes, Structure};
use corniche_tileset::{RunOwner, SpanHeight, SpanPoint, SpanRun};

use super::{PlanStretch, slab_thickness_m, stretches};
use crate::piece::{PieceHeights, PieceKey, Vertex, WayPiece};

/// Lattice steps per metre, and steps of heights per metre.
const METRE: i64 = 1000;
const QUANTUM_M: f64 = 0.25;

fn class() -> FunctionalRoadClass {
    FunctionalRoadClass::new(4).unwrap()
}

/// A vertex this many metres east; whole for points of the way.
fn vertex(east_m: f64, z_m: f64, is_source: bool) -> Vertex {
    Vertex { at: [east_m * METRE as f64, 0.0], z_m, is_source }
}

fn piece(vertices: Vec<Vertex>) -> WayPiece {
    WayPiece {
        key: PieceKey { way_id: 7, tile: 0, part: 0, cut: 0 },
        class: class(),
        attributes: RoadAttributes::default(),
        vertices,
        goes_on: [false, true],
        heights: PieceHeights {
            tolerance_m: Some(0.0),
            ground_m: None,
            on_deck: false,
            has_deck: false,
        },
    }
}

/// A point of a run this many metres east; `None` is on the ground.
fn at(east_m: i64, deck_m: Option<f64>) -> SpanPoint {
    let height = deck_m.map_or(SpanHeight::Ground { triangle: 0 }, |deck_m| {
        SpanHeight::Steps((deck_m / QUANTUM_M).round() as i64)
    });
    SpanPoint { at: LatticePoint::new(east_m * METRE, 0), height }
}

fn run(points: Vec<SpanPoint>) -> SpanRun {
    SpanRun { way_id: 7, owner: RunOwner::Road(class()), structure: Structure::Bridge, points }
}

fn divided(line: Vec<Vertex>, runs: &[SpanRun]) -> Vec<PlanStretch> {
    stretches(&piece(line), runs, QUANTUM_M, &StepBudget::unlimited()).unwrap()
}

/// The positions of the points of a stretch, metres east, and the heights of its deck.
fn told(stretch: &PlanStretch) -> (Vec<f64>, Option<Vec<f64>>) {
    let metres = stretch.points.iter().map(|point| point.u as f64 / METRE as f64);
    (metres.collect(), stretch.deck_m.clone())
}

#[test]
fn without_runs_a_line_is_as_it_was() {
    let line = vec![vertex(0.0, 9.0, false), vertex(5.0, 9.0, false), vertex(10.0, 9.0, true)];
    let found = divided(line, &[]);
    assert_eq!(found.len(), 1);
    assert_eq!(told(&found[0]), (vec![0.0, 10.0], None));
    assert_eq!(found[0].goes_on, [false, true]);
}

/// A ramp of 4 m over 40 m, then down the same way to a border that is 3 m above the ground. It is
/// a slab from 0.1 m on, and on the ground, too, until it is as high as a slab of class 4.
#[test]
fn a_ramp_is_draped_until_it_is_a_slab_high() {
    let line = vec![
        vertex(0.0, 100.0, true),
        vertex(15.0, 100.0, false),
        vertex(40.0, 100.0, true),
        vertex(50.0, 100.0, true),
    ];
    let found = divided(line, &[run(vec![at(0, None), at(40, Some(104.0)), at(50, Some(103.0))])]);
    assert_eq!(found.len(), 2);
    assert_eq!(told(&found[0]), (vec![1.0, 40.0, 50.0], Some(vec![100.1, 104.0, 103.0])));
    assert_eq!(told(&found[1]), (vec![0.0, 10.0], None));
    assert_eq!([found[0].goes_on, found[1].goes_on], [[false, true], [false, false]]);
}

/// A level deck over a valley whose ground bends between its points, with a bump in the middle that
/// comes within a slab of it: one slab, and the road beneath it on the bump.
#[test]
fn the_ground_between_points_of_a_run_counts() {
    let line = vec![
        vertex(0.0, 100.0, true),
        vertex(10.0, 98.0, false),
        vertex(20.0, 98.0, false),
        vertex(30.0, 99.5, false),
        vertex(40.0, 98.0, false),
        vertex(50.0, 100.0, true),
    ];
    let found = divided(line, &[run(vec![at(0, None), at(50, None)])]);
    let told: Vec<_> = found.iter().map(told).collect();
    assert_eq!(told.len(), 4, "{told:?}");
    assert_eq!(told[0], (vec![0.5, 49.5], Some(vec![100.0; 2])));
    assert_eq!(told[2], (vec![26.667, 33.333], None));
    assert_eq!([&told[1].0[..], &told[3].0], [[0.0, 5.0], [45.0, 50.0]]);
    assert_eq!(found[3].goes_on, [false, true]);
}

/// Tunnels, decks that are nowhere high, and runs that are on no line change nothing.
#[test]
fn other_runs_leave_the_road_on_the_ground() {
    let line = || vec![vertex(0.0, 100.0, true), vertex(50.0, 100.0, true)];
    let high = || vec![at(0, None), at(20, Some(110.0)), at(50, None)];
    let tunnel = SpanRun { structure: Structure::Tunnel, ..run(high()) };
    let low = run(vec![at(0, None), at(20, Some(100.75)), at(50, None)]);
    let mut beside = run(high());
    beside.points[1].at.v += 500;
    let back = run(vec![at(20, Some(110.0)), at(0, Some(110.0))]);
    let beyond = run(vec![at(20, Some(110.0)), at(80, Some(110.0))]);
    let found = divided(line(), &[tunnel, low, beside, back, beyond]);
    assert_eq!(found.len(), 1);
    assert_eq!(told(&found[0]), (vec![0.0, 50.0], None));
}

/// The same run twice is one slab.
#[test]
fn runs_over_each_other_are_taken_once() {
    let line = vec![vertex(0.0, 100.0, true), vertex(50.0, 100.0, true)];
    let one = run(vec![at(0, Some(110.0)), at(50, Some(110.0))]);
    let found = divided(line, &[one.clone(), one]);
    assert_eq!(found.len(), 1);
    assert_eq!(found[0].goes_on, [false, true]);
    assert_eq!(told(&found[0]), (vec![0.0, 50.0], Some(vec![110.0; 2])));
}

/// If two runs overlap in part, the road is on the ground where the second one's slab would be.
#[test]
fn no_road_is_lost_where_runs_overlap() {
    let line = vec![vertex(0.0, 100.0, true), vertex(90.0, 100.0, true)];
    let one = run(vec![at(0, Some(110.0)), at(50, Some(110.0))]);
    let other = run(vec![at(40, Some(110.0)), at(90, Some(110.0))]);
    let told: Vec<_> = divided(line, &[one, other]).iter().map(told).collect();
    assert_eq!(told, [(vec![0.0, 50.0], Some(vec![110.0; 2])), (vec![50.0, 90.0], None)]);
}

/// A line that crosses itself: the run is where the way continues in the same way as the run.
#[test]
fn a_loop_over_itself_is_followed() {
    let place = |u: f64, v: f64, z_m: f64| Vertex {
        at: [u, v].map(|metres| metres * METRE as f64),
        z_m,
        is_source: true,
    };
    let line = vec![
        place(0.0, 0.0, 100.0),
        place(20.0, 0.0, 100.0),
        place(40.0, 0.0, 100.0),
        place(20.0, 20.0, 100.0),
        place(20.0, 0.0, 100.0),
        place(20.0, -20.0, 100.0),
    ];
    let north = |v: i64| SpanPoint {
        at: LatticePoint::new(20 * METRE, v * METRE),
        height: SpanHeight::Steps(440),
    };
    let found = divided(line, &[run(vec![north(0), north(-20)])]);
    assert_eq!(found.len(), 2);
    assert_eq!(found[0].deck_m, Some(vec![110.0; 2]));
    assert_eq!(found[1].points.len(), 5);
}

/// A low bridge over a border is a slab in both tiles, because neither knows its height in the
/// other.
#[test]
fn low_decks_that_go_on_are_slabs() {
    let line = vec![vertex(0.0, 100.0, true), vertex(50.0, 100.0, true)];
    let found = divided(line, &[run(vec![at(0, None), at(50, Some(100.5))])]);
    assert_eq!(told(&found[0]), (vec![10.0, 50.0], Some(vec![100.1, 100.5])));
    assert_eq!(told(&found[1]), (vec![0.0, 50.0], None));
}

#[test]
fn many_runs_over_much_ground_are_refused() {
    let line = vec![vertex(0.0, 100.0, true), vertex(50.0, 100.0, true)];
    let one = run(vec![at(0, Some(110.0)), at(50, Some(110.0))]);
    assert!(stretches(&piece(line), &vec![one; 100], QUANTUM_M, &StepBudget::new(50)).is_err());
}

#[test]
fn less_important_roads_have_thinner_slabs() {
    let thickness = FunctionalRoadClass::all().map(slab_thickness_m);
    let expected = [1.5, 1.5, 1.5, 1.5, 1.0, 1.0, 1.0, 0.5, 0.5];
    assert!(thickness.eq(expected));
}
