//! Real and hard tiles stay far below the limits of work. Prints figures; run with `--nocapture`.
#![allow(clippy::print_stdout, reason = "these tests print figures")]

use corniche_drape::{DrapedVertex, drape};
use corniche_geom::{GridFrame, HeightGrid, LatticePoint, NodeIndex, Polyline, TileId};
use corniche_testing::srtm_heights;
use corniche_tin::{Placement, Surface, Tin, TinSpec, TinVertex, height_quantum_m, triangulate};

use super::*;
use crate::limits::{MAX_ROUTE_STEPS, max_walk_steps};
use crate::payload::connectivity::walk;
use crate::payload::corner_guess::GridVertices;
use crate::payload::range_coder::BitWriter;
use crate::payload::route_guess::RouteGuess;
use crate::payload::terrain::encode::TerrainRecorder;

const SRTM: &str = "liechtenstein/N47E009.hgt";

/// The steps of the writer's walk, which examines at least as much as a reader's, and the number of
/// allowed steps.
fn walk_steps(tin: &Tin) -> [u64; 2] {
    let (vertices, triangles) = (tin.vertices(), tin.triangles());
    let work = StepBudget::new(u64::MAX);
    let nodes = GridVertices::new(vertices.iter().map(|v| [v.column, v.row]), &work);
    let mut bits = BitWriter::new(Vec::new());
    let mut recorder = TerrainRecorder::new(vertices.len(), triangles, &mut bits);
    let (found, _) = walk(&nodes, triangles.len(), &mut recorder).expect("a TIN");
    assert_eq!(found.len(), triangles.len());
    [work.done(), max_walk_steps(vertices.len(), triangles.len())]
}

/// Asserts that a tile takes at most a `factor`th of the allowed steps.
fn check(name: &str, heights: &HeightGrid, max_error_m: f64, factor: u64) {
    let quantum_m = height_quantum_m(max_error_m);
    let tin = triangulate(heights, TinSpec { max_error_m, quantum_m }).expect("usable heights");
    let [steps, allowed] = walk_steps(&tin);
    let size = (tin.vertices().len() + tin.triangles().len()) as u64;
    println!(
        "{name}, max error {max_error_m} m: {} vertices, {} triangles, {steps} steps, {} each, 1/{} of the limit",
        tin.vertices().len(),
        tin.triangles().len(),
        steps / size.max(1),
        allowed / steps.max(1)
    );
    assert!(steps * factor <= allowed, "{name}: {steps} steps of {allowed}");
}

/// Noise of ±50 m per node, the same in every run.
fn noise(column: usize, row: usize) -> f32 {
    let mut state =
        (column as u32).wrapping_mul(0x9e37_79b9) ^ (row as u32).wrapping_mul(0x85eb_ca6b);
    for _ in 0..3 {
        state ^= state >> 15;
        state = state.wrapping_mul(0x2c1b_3c6d);
    }
    (state >> 16) as f32 / 655.36 - 50.0
}

/// All vertices of the two far borders share triangles with one corner of the tile.
#[test]
fn a_fan_of_the_whole_border_stays_below_the_limit() {
    let rim =
        (0..=256_u16).map(|row| (row, 256)).chain((0..256_u16).rev().map(|column| (256, column)));
    let at = [(0, 0)].into_iter().chain(rim);
    let vertices: Vec<TinVertex> =
        at.map(|(row, column)| TinVertex { row, column, height_q: 0 }).collect();
    let triangles: Vec<[u32; 3]> = (1..vertices.len() as u32 - 1).map(|k| [0, k + 1, k]).collect();
    let [steps, allowed] = walk_steps(&Tin::new(vertices, &triangles).expect("a TIN"));
    println!("fan: {steps} steps, 1/{} of the limit", allowed / steps);
    assert!(10 * steps <= allowed, "{steps} steps of {allowed}");
}

/// The limit is just below the number of steps of the whole walk.
#[test]
fn a_walk_beyond_its_limit_is_refused() {
    let tin = triangulate(
        &HeightGrid::from_fn(259, 259, noise),
        TinSpec { max_error_m: 40.0, quantum_m: 1.0 },
    );
    let tin = tin.expect("usable heights");
    let [whole, _] = walk_steps(&tin);
    for limit in [0, whole / 2, whole - whole / 16] {
        let work = StepBudget::new(limit);
        let nodes = GridVertices::new(tin.vertices().iter().map(|v| [v.column, v.row]), &work);
        let mut bits = BitWriter::new(Vec::new());
        let mut recorder = TerrainRecorder::new(tin.vertices().len(), tin.triangles(), &mut bits);
        let outcome = walk(&nodes, tin.triangles().len(), &mut recorder).map(|_| ());
        assert_eq!(outcome, Err(Damage::TooMuchWork { limit }));
    }
}

#[test]
fn real_tiles_stay_far_below_the_limits() {
    for (column, row) in [(0, 0), (300, 500), (700, 100), (900, 900)] {
        let Some(heights) = srtm_heights(SRTM, column, row) else { return };
        for max_error_m in [0.5, 5.0, 22.5] {
            check("SRTM", &heights, max_error_m, 25);
        }
    }
}

#[test]
fn hard_boundaries_stay_below_the_limits() {
    type Hole = fn(usize, usize) -> bool;
    let cases: [(&str, Hole); 9] = [
        ("no voids", |_, _| false),
        ("comb", |c, r| c % 8 < 3 && r > 4),
        ("checkerboard of 8", |c, r| (c / 8 + r / 8) % 2 == 0),
        ("every third node void", |c, r| noise(c, r) < -17.0),
        ("diagonal data edge", |c, r| c + r < 259),
        ("islands", |c, r| c % 16 > 3 || r % 16 > 3),
        ("ring", |c, r| {
            (20_i64.pow(2)..110_i64.pow(2))
                .contains(&((c as i64 - 129).pow(2) + (r as i64 - 129).pow(2)))
        }),
        ("half", |c, _| c > 129),
        ("single voids", |c, r| c % 7 == 3 && r % 5 == 2),
    ];
    for (name, hole) in cases {
        let rough = |c: usize, r: usize| if hole(c, r) { f32::NAN } else { noise(c, r) };
        let ramp = |c: usize, r: usize| if hole(c, r) { f32::NAN } else { c as f32 / 4.0 };
        check(name, &HeightGrid::from_fn(259, 259, ramp), 5.0, 10);
        check(name, &HeightGrid::from_fn(259, 259, rough), 30.0, 10);
    }
    // Few vertices that all see each other: only on the border, and around a peak.
    let is_border = |c: usize, r: usize| c <= 1 || r <= 1 || c >= 257 || r >= 257;
    let frame = |c: usize, r: usize| if is_border(c, r) { noise(c, r) } else { 0.0 };
    check("rough border", &HeightGrid::from_fn(259, 259, frame), 60.0, 10);
    check("rough border", &HeightGrid::from_fn(259, 259, frame), 5.0, 10);
    let cone = |c: usize, r: usize| {
        let distance = (c as f32 - 129.0).hypot(r as f32 - 129.0);
        frame(c, r) + 10.0 * (129.0 - distance).max(0.0)
    };
    check("peak", &HeightGrid::from_fn(259, 259, cone), 5.0, 10);
    // The largest number of triangles of a tile.
    check("every node", &HeightGrid::from_fn(259, 259, noise), 0.01, 10);
    // Rims that share no row except with each other.
    let bowl =
        |c: usize, r: usize| ((c as f32 - 129.0).powi(2) + (r as f32 - 129.0).powi(2)) / 50.0;
    check("bowl", &HeightGrid::from_fn(259, 259, bowl), 0.5, 10);
}

/// Long lines over real ground, each with hundreds of crossings.
#[test]
fn following_roads_stays_far_below_the_limit() {
    let Some(heights) = srtm_heights(SRTM, 300, 500) else { return };
    let spec = TinSpec { max_error_m: 5.0, quantum_m: 0.125 };
    let tin = triangulate(&heights, spec).expect("usable heights");
    let frame = GridFrame::new([0.0; 2], 90.0, NodeIndex { i: 0, j: 256 }, 0).expect("a frame");
    let surface = Surface::new(&tin, Placement::of_tile(&frame, TileId::ROOT, spec.quantum_m));
    let bounds = frame.tile_lattice_bounds(TileId::ROOT);
    let side = bounds.max.u - bounds.min.u;
    let work = StepBudget::new(u64::MAX);
    let mut vertices = 0;
    for way in 0..500_i64 {
        let point = |k: i64| {
            let at = |prime: i64| (way * prime + k * (prime % 977)) * 7919 % side;
            LatticePoint::new(bounds.min.u + at(104_729), bounds.min.v + at(15_485_863))
        };
        let line = Polyline::new((0..20).map(point).collect()).expect("a line");
        for line in drape(&line, &surface).lines {
            let points = line.vertices.iter().filter_map(|vertex| match vertex {
                DrapedVertex::Source { point, .. } => Some(*point),
                _ => None,
            });
            let points: Vec<LatticePoint> =
                line.lead_in.into_iter().chain(points).chain(line.lead_out).collect();
            let leads = [line.lead_in.is_some(), line.lead_out.is_some()];
            let mut route = RouteGuess::new(&surface, &points, leads, &work);
            for &vertex in &line.vertices {
                route.guess().expect("no limit");
                route.go(vertex).expect("no limit");
                vertices += 1;
            }
        }
    }
    println!(
        "{vertices} vertices, {} steps, {:.1} each",
        work.done(),
        work.done() as f64 / f64::from(vertices)
    );
    // The steps of a full section at this rate.
    let full = work.done() / vertices as u64 * crate::limits::MAX_LINE_VERTICES as u64;
    assert!(4 * full <= MAX_ROUTE_STEPS, "{full} steps of {MAX_ROUTE_STEPS}");
}
