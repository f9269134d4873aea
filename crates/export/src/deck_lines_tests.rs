//! Decks over ground: their heights, where they meet the ground, and which vertices remain.

use super::*;
use crate::grades::Station;

fn vertex(east: f64, z_m: f64, is_source: bool) -> Vertex {
    Vertex { at: [1000.0 * east, 0.0], z_m, is_source }
}

fn distance_m(from: [f64; 2], to: [f64; 2]) -> f64 {
    (to[0] - from[0]).hypot(to[1] - from[1]) / 1000.0
}

/// A deck through places `(along, height)`; one metre of the lattice for each metre of the way.
fn deck(places: &[(f64, f64)]) -> SmoothLine {
    let station = |&(along_m, ground_m): &(f64, f64)| Station {
        at: [1000.0 * along_m, 0.0],
        along_m,
        height_m: 0.0,
        ground_m,
    };
    SmoothLine { stations: places.iter().map(station).collect() }
}

fn raised(structure: Structure, ground: &[Vertex], deck: SmoothLine) -> Vec<(f64, f64)> {
    let found = on_deck(structure, ground, (&[deck], 10.0), &distance_m).unwrap().vertices;
    found.iter().map(|vertex| (vertex.at[0] / 1000.0, vertex.z_m)).collect()
}

/// Over a gorge only the ends and the points of the way remain.
#[test]
fn a_bridge_leaves_the_ground_beneath_it() {
    let ground = [
        vertex(0.0, 100.0, true),
        vertex(10.0, 60.0, false),
        vertex(25.0, 40.0, true),
        vertex(30.0, 55.0, false),
        vertex(40.0, 108.0, true),
    ];
    let found = raised(Structure::Bridge, &ground, deck(&[(0.0, 100.0), (40.0, 108.0)]));
    assert_eq!(found, [(0.0, 100.0), (25.0, 105.0), (40.0, 108.0)]);
}

/// Where a hill obstructs the bridge, the bridge is on the hill; the tunnel beneath dips under a
/// valley. Both have a vertex where they meet the ground.
#[test]
fn bridges_are_never_below_the_ground_and_tunnels_never_above() {
    let ground = |sign: f64| {
        [
            (0.0, 0.0, true),
            (10.0, -10.0, false),
            (20.0, 10.0, false),
            (30.0, -10.0, false),
            (40.0, 0.0, true),
        ]
        .map(|(east, z_m, is_source)| vertex(east, sign * z_m, is_source))
    };
    let flat = || deck(&[(0.0, 0.0), (40.0, 0.0)]);
    let over = [(0.0, 0.0), (15.0, 0.0), (20.0, 10.0), (25.0, 0.0), (40.0, 0.0)];
    assert_eq!(raised(Structure::Bridge, &ground(1.0), flat()), over);
    let under = over.map(|(east, z_m)| (east, 0.0 - z_m));
    assert_eq!(raised(Structure::Tunnel, &ground(-1.0), flat()), under);
}

/// Bends between two vertices of the ground count on both sides of the point where the deck meets
/// it; they are on the ground where the ground is higher.
#[test]
fn bends_are_kept_where_the_ground_is_near() {
    let two = |from: (f64, f64), to: (f64, f64)| {
        [(0.0, 100.0, true), (from.0, from.1, false), (to.0, to.1, false), (80.0, 100.0, true)]
            .map(|(east, z_m, is_source)| vertex(east, z_m, is_source))
    };
    let close = |found: Vec<(f64, f64)>, expected: &[(f64, f64)]| {
        let is_near = |(one, other): (&(f64, f64), &(f64, f64))| {
            (one.0 - other.0).abs() < 0.05 && (one.1 - other.1).abs() < 0.01
        };
        assert!(
            found.len() == expected.len() && found.iter().zip(expected).all(is_near),
            "{found:?}"
        );
    };
    // A valley of the deck that the ground fills.
    let valley = deck(&[(0.0, 100.0), (20.0, 101.0), (40.0, 100.0), (60.0, 100.9), (80.0, 100.0)]);
    let found = raised(Structure::Bridge, &two((22.0, 100.6), (58.0, 100.6)), valley);
    let expected =
        [(0.0, 100.0), (20.0, 101.0), (28.0, 100.6), (53.33, 100.6), (60.0, 100.9), (80.0, 100.0)];
    close(found, &expected);
    // A lift between two places under the ground.
    let tent = || deck(&[(0.0, 100.0), (40.0, 101.0), (80.0, 100.0)]);
    let found = raised(Structure::Bridge, &two((20.0, 100.7), (60.0, 100.7)), tent());
    let expected = [
        (0.0, 100.0),
        (20.0, 100.7),
        (28.0, 100.7),
        (40.0, 101.0),
        (52.0, 100.7),
        (60.0, 100.7),
        (80.0, 100.0),
    ];
    close(found, &expected);
    // A bend and a meeting in one segment.
    let steep = deck(&[(0.0, 100.0), (30.0, 101.0), (80.0, 100.0)]);
    let found = raised(Structure::Bridge, &two((5.0, 100.3), (45.0, 99.0)), steep);
    let expected = [(0.0, 100.0), (5.0, 100.3), (6.99, 100.23), (30.0, 101.0), (80.0, 100.0)];
    close(found, &expected);
}

/// The bends of a raised deck are vertices, also on a part of the way.
#[test]
fn a_deck_has_vertices_where_it_bends() {
    let tent = || deck(&[(0.0, 50.0), (10.0, 50.0), (20.0, 51.0), (30.0, 50.0), (40.0, 50.0)]);
    let ground = [vertex(5.0, 0.0, true), vertex(14.0, 0.0, false), vertex(40.0, 50.0, true)];
    let found = raised(Structure::Bridge, &ground, tent());
    assert_eq!(found, [(5.0, 50.0), (10.0, 50.0), (20.0, 51.0), (30.0, 50.0), (40.0, 50.0)]);
}

#[test]
fn what_lies_elsewhere_or_on_the_ground_is_no_deck() {
    let ground = [vertex(0.0, 0.0, true), vertex(40.0, 0.0, true)];
    let way = [deck(&[(0.0, 5.0), (40.0, 5.0)])];
    assert_eq!(on_deck(Structure::Ground, &ground, (&way, 10.0), &distance_m), None);
    let beside = [Vertex { at: [0.0, 5000.0], ..ground[0] }, ground[1]];
    assert_eq!(on_deck(Structure::Bridge, &beside, (&way, 10.0), &distance_m), None);
}

/// On level ground an obstructing ridge begins at a vertex: the line meets the ground there twice,
/// and the foot of the ridge remains.
#[test]
fn a_ridge_in_the_way_keeps_its_foot_and_its_top() {
    let along = [
        (0.0, 100.0),
        (10.0, 100.0),
        (20.0, 110.0),
        (30.0, 120.0),
        (40.0, 110.0),
        (50.0, 100.0),
        (60.0, 100.0),
    ];
    let last = along.len() - 1;
    let ground: Vec<Vertex> = along
        .iter()
        .enumerate()
        .map(|(index, &(east, z_m))| vertex(east, z_m, index == 0 || index == last))
        .collect();
    let found = raised(Structure::Bridge, &ground, deck(&[(0.0, 100.0), (60.0, 100.0)]));
    assert_eq!(found, [(0.0, 100.0), (10.0, 100.0), (30.0, 120.0), (50.0, 100.0), (60.0, 100.0)]);
}
