//! The walk against brute force: every edge and every triangle by exact fractions, sorted along the line.

use std::{cmp::Ordering, fmt::Write as _};

use corniche_geom::{LatticePoint, Polyline};
use corniche_tin::{Placement, Surface, Tin, TinVertex};
use proptest::prelude::*;

use crate::{DrapedLine, DrapedVertex, check, drape, positions};

/// A position along a segment; denominators above 0. Cross products fit for the small numbers of these tests.
#[derive(Debug, Clone, Copy)]
struct Along(i128, i128);

impl Along {
    fn new(n: i128, d: i128) -> Self {
        if d < 0 { Self(-n, -d) } else { Self(n, d) }
    }
    fn value(self) -> f64 {
        self.0 as f64 / self.1 as f64
    }
}

impl PartialEq for Along {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}
impl Eq for Along {}
impl PartialOrd for Along {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}
impl Ord for Along {
    fn cmp(&self, other: &Self) -> Ordering {
        (self.0 * other.1).cmp(&(other.0 * self.1))
    }
}

const START: Along = Along(0, 1);
const END: Along = Along(1, 1);

/// Twice the area of a, b, c, written down once more.
fn area(a: LatticePoint, b: LatticePoint, c: LatticePoint) -> i128 {
    let wide = |x: i64, y: i64| i128::from(x) - i128::from(y);
    wide(b.u, a.u) * wide(c.v, a.v) - wide(b.v, a.v) * wide(c.u, a.u)
}

/// The part of p → q in a closed triangle, if it is more than a point.
fn part_in_triangle(
    corners: [LatticePoint; 3],
    p: LatticePoint,
    q: LatticePoint,
) -> Option<[Along; 2]> {
    let (mut from, mut to) = (START, END);
    for k in 0..3 {
        let (a, b) = (corners[k], corners[(k + 1) % 3]);
        let (at_p, at_q) = (area(a, b, p), area(a, b, q));
        match (at_p >= 0, at_q >= 0) {
            (true, true) => {}
            (false, false) => return None,
            (true, false) => to = to.min(Along::new(at_p, at_p - at_q)),
            (false, true) => from = from.max(Along::new(at_p, at_p - at_q)),
        }
    }
    (from < to).then_some([from, to])
}

/// Where p → q is over ground: disjoint, in order.
fn ground(surface: &Surface, p: LatticePoint, q: LatticePoint) -> Vec<[Along; 2]> {
    let at = |v: u32| surface.points()[v as usize];
    let mut parts: Vec<_> = surface
        .triangles()
        .iter()
        .filter_map(|corners| part_in_triangle(corners.map(at), p, q))
        .collect();
    parts.sort();
    let mut merged: Vec<[Along; 2]> = Vec::new();
    for [from, to] in parts {
        match merged.last_mut() {
            Some(last) if from <= last[1] => last[1] = last[1].max(to),
            _ => merged.push([from, to]),
        }
    }
    merged
}

/// Edges crossed in their inside and vertices passed, strictly between p and q, in order.
fn events(surface: &Surface, p: LatticePoint, q: LatticePoint) -> Vec<(Along, DrapedVertex)> {
    let at = |v: u32| surface.points()[v as usize];
    let mut edges: Vec<[u32; 2]> = Vec::new();
    for &[a, b, c] in surface.triangles() {
        edges.extend([[a.min(b), a.max(b)], [b.min(c), b.max(c)], [c.min(a), c.max(a)]]);
    }
    edges.sort_unstable();
    edges.dedup();
    let mut events = Vec::new();
    for [a, b] in edges {
        let (side_a, side_b) = (area(p, q, at(a)).signum(), area(p, q, at(b)).signum());
        let (at_p, at_q) = (area(at(a), at(b), p), area(at(a), at(b), q));
        if side_a * side_b == -1 && at_p.signum() * at_q.signum() == -1 {
            events.push((Along::new(at_p, at_p - at_q), DrapedVertex::Crossing { a, b }));
        }
    }
    let mut used: Vec<u32> = surface.triangles().iter().flatten().copied().collect();
    used.sort_unstable();
    used.dedup();
    for vertex in used {
        let point = at(vertex);
        let dot = |x: LatticePoint, y: LatticePoint| {
            i128::from((y.u - x.u) * (q.u - p.u)) + i128::from((y.v - x.v) * (q.v - p.v))
        };
        let along = Along::new(dot(p, point), dot(p, q));
        if area(p, q, point) == 0 && START < along && along < END {
            events.push((along, DrapedVertex::Vertex { vertex }));
        }
    }
    events.sort_by_key(|event| event.0);
    events
}

/// What `drape` should make.
fn expected(line: &Polyline, surface: &Surface) -> (Vec<DrapedLine>, f64) {
    let source = |point| {
        let mut triangles = 0..surface.triangles().len() as u32;
        let triangle = triangles.find(|&t| surface.triangle_holds(t, point)).unwrap();
        DrapedVertex::Source { point, triangle }
    };
    let mut lines: Vec<DrapedLine> = Vec::new();
    let mut off_steps = 0.0;
    let mut open = false;
    for pair in line.points().windows(2) {
        let (p, q) = (pair[0], pair[1]);
        let events = events(surface, p, q);
        let mut covered = 0.0;
        let mut reaches_end = false;
        for [from, to] in ground(surface, p, q) {
            covered += to.value() - from.value();
            if from > START {
                lines.push(DrapedLine { lead_in: Some(p), vertices: vec![], lead_out: None });
            } else if !open {
                lines.push(DrapedLine { lead_in: None, vertices: vec![source(p)], lead_out: None });
            }
            let part = lines.last_mut().unwrap();
            part.vertices.extend(events.iter().filter(|e| from <= e.0 && e.0 <= to).map(|e| e.1));
            reaches_end = to == END;
            if reaches_end {
                part.vertices.push(source(q));
            } else {
                part.lead_out = Some(q);
            }
        }
        open = reaches_end;
        off_steps += (1.0 - covered) * p.distance_steps(q);
    }
    (lines, off_steps)
}

/// The same line travelled the other way.
fn turned(line: &DrapedLine) -> DrapedLine {
    let vertices = line.vertices.iter().rev().copied().collect();
    DrapedLine { lead_in: line.lead_out, vertices, lead_out: line.lead_in }
}

/// Length in plan, and that every edge lies on the TIN: its middle has the height of the triangle beneath.
fn length_on_tin(line: &DrapedLine, surface: &Surface) -> f64 {
    let at = positions(line, surface).unwrap();
    let mut length = 0.0;
    for (k, pair) in at.windows(2).enumerate() {
        let [[u0, v0, z0], [u1, v1, z1]] = [pair[0], pair[1]];
        let middle = [f64::midpoint(u0, u1), f64::midpoint(v0, v1)];
        // Along an edge rounding puts the middle on either side of it, so every triangle that near is tried.
        let gap_m = (0..surface.triangles().len() as u32)
            .filter(|&t| {
                let corners = surface.triangles()[t as usize].map(|v| surface.points()[v as usize]);
                let [a, b, c] = corners.map(|p| [p.u as f64, p.v as f64]);
                let weights = corniche_geom::barycentric(middle, a, b, c);
                weights.iter().all(|&weight| weight > -1e-6)
            })
            .map(|t| (surface.height_in_triangle_m(t, middle) - f64::midpoint(z0, z1)).abs())
            .fold(f64::INFINITY, f64::min);
        assert!(gap_m < 1e-6, "edge {k} is {gap_m} m off the ground");
        length += (u1 - u0).hypot(v1 - v0);
    }
    length
}

/// A source of cases that is the same everywhere (splitmix64).
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }
    fn below(&mut self, limit: i64) -> i64 {
        (self.next() % limit as u64) as i64
    }
}

struct Case {
    tin: Tin,
    placement: Placement,
    line: Polyline,
}

impl Case {
    fn new(seed: u64) -> Option<Self> {
        let mut random = Random(seed);
        let tin = random_tin(&mut random);
        let steps = [1, 2, 3, 4, 6, 12, 60, 1 << 15][random.below(8) as usize];
        let corner = LatticePoint::new(random.below(2000) - 1000, random.below(2000) - 1000);
        let placement = Placement { corner, node_steps: steps, quantum_m: 0.25 };
        let points = random_points(&mut random, &Surface::new(&tin, placement), steps);
        Some(Self { tin, placement, line: Polyline::new(points).ok()? })
    }

    fn check(&self) {
        let Self { tin, placement, line } = self;
        let surface = Surface::new(tin, *placement);
        let draped = drape(line, &surface);
        let (lines, off_steps) = expected(line, &surface);
        assert_eq!(draped.lines, lines);
        let total = line.length_steps();
        assert!(
            (draped.off_ground_steps - off_steps).abs() <= 1e-9 * total,
            "{draped:?} {off_steps}"
        );

        let mut on_steps = 0.0;
        for part in &draped.lines {
            assert_eq!(check(part, &surface), Ok(()));
            on_steps += length_on_tin(part, &surface);
        }
        let error = (on_steps + draped.off_ground_steps - total).abs();
        assert!(error <= 1e-9 * total, "{on_steps} on, {} off, {total}", draped.off_ground_steps);

        // The other way: the same crossings at the same positions, to the last bit.
        let back = Polyline::new(line.points().iter().rev().copied().collect()).unwrap();
        let back = drape(&back, &surface).lines;
        assert_eq!(back.iter().rev().map(turned).collect::<Vec<_>>(), draped.lines);
        for (there, back) in draped.lines.iter().zip(back.iter().rev()) {
            let mut at = positions(back, &surface).unwrap();
            at.reverse();
            assert_eq!(at, positions(there, &surface).unwrap());
        }

        // Far larger numbers, far away, take the 128-bit paths and must decide the same.
        let (wider, far) = (1_i64 << 24, 1_i64 << 55);
        let widen = |p: LatticePoint| LatticePoint::new(far + p.u * wider, p.v * wider - far);
        let corner = widen(placement.corner);
        let wide = Placement { corner, node_steps: placement.node_steps * wider, ..*placement };
        let points = line.points().iter().copied().map(widen).collect();
        let wide = drape(&Polyline::new(points).unwrap(), &Surface::new(tin, wide));
        let widened = draped.lines.iter().map(|part| DrapedLine {
            lead_in: part.lead_in.map(widen),
            vertices: part
                .vertices
                .iter()
                .map(|&vertex| match vertex {
                    DrapedVertex::Source { point, triangle } => {
                        DrapedVertex::Source { point: widen(point), triangle }
                    }
                    other => other,
                })
                .collect(),
            lead_out: part.lead_out.map(widen),
        });
        assert_eq!(wide.lines, widened.collect::<Vec<_>>());
    }

    fn describe(&self) -> String {
        let mut text = String::new();
        let _ = write!(text, "{:?}\n{:?}\n{:?}", self.tin, self.placement, self.line);
        text
    }
}

/// Up to 5 × 5 quadrangles with shifted corners and either diagonal; some triangles missing.
fn random_tin(random: &mut Random) -> Tin {
    let (columns, rows) = (2 + random.below(5), 2 + random.below(5));
    // In a regular grid lines along edges and through many vertices are common.
    let jitter = random.below(2) + 1;
    let missing = [0, 0, 8, 3][random.below(4) as usize];
    let mut vertices = Vec::new();
    for row in 0..rows {
        for column in 0..columns {
            vertices.push(TinVertex {
                row: (3 * row + random.below(jitter)) as u16,
                column: (3 * column + random.below(jitter)) as u16,
                height_q: random.below(4000) as i32,
            });
        }
    }
    let mut triangles = Vec::new();
    for row in 0..rows - 1 {
        for column in 0..columns - 1 {
            let nw = (row * columns + column) as u32;
            let (ne, sw) = (nw + 1, nw + columns as u32);
            let se = sw + 1;
            let pair = if random.below(2) == 0 {
                [[nw, sw, se], [nw, se, ne]]
            } else {
                [[nw, sw, ne], [sw, se, ne]]
            };
            triangles
                .extend(pair.into_iter().filter(|_| missing == 0 || random.below(missing) != 0));
        }
    }
    Tin::new(vertices, &triangles).unwrap()
}

/// Two to seven points, most of them where it hurts.
fn random_points(random: &mut Random, surface: &Surface, steps: i64) -> Vec<LatticePoint> {
    let corner = surface.points()[0];
    let reach = 18 * steps;
    let mut points: Vec<LatticePoint> = Vec::new();
    for _ in 0..2 + random.below(6) {
        let vertex = surface.points()[random.below(surface.points().len() as i64) as usize];
        let last = points.last().copied().unwrap_or(vertex);
        let other = surface.points()[random.below(surface.points().len() as i64) as usize];
        points.push(match random.below(10) {
            0..=2 => vertex,
            // On an edge, or between any two vertices.
            3 => LatticePoint::new(vertex.u.midpoint(other.u), vertex.v.midpoint(other.v)),
            // On along the line through the last point and a vertex.
            4 => LatticePoint::new(2 * vertex.u - last.u, 2 * vertex.v - last.v),
            // Straight, along grid lines.
            5 => LatticePoint::new(last.u, vertex.v),
            6 => LatticePoint::new(vertex.u, last.v),
            // A hairpin.
            7 if points.len() >= 2 => points[points.len() - 2],
            // Far away.
            8 if random.below(4) == 0 => LatticePoint::new(
                last.u + 50 * (vertex.u - other.u),
                last.v + 50 * (vertex.v - other.v),
            ),
            _ => LatticePoint::new(
                corner.u - 2 * steps + random.below(reach),
                corner.v + 2 * steps - random.below(reach),
            ),
        });
    }
    points
}

/// Runs cases from `first` on; names the first that fails.
fn run(first: u64, count: u64) -> u64 {
    let mut ran = 0;
    for seed in first..first + count {
        let Some(case) = Case::new(seed) else {
            continue;
        };
        if let Err(panic) = std::panic::catch_unwind(|| case.check()) {
            println!("case {seed}:\n{}", case.describe());
            std::panic::resume_unwind(panic);
        }
        ran += 1;
    }
    ran
}

#[test]
fn agrees_with_brute_force() {
    assert!(run(0, 10_000) > 9000);
}

/// `cargo test --release -p corniche-drape -- --ignored`; `CORNICHE_DRAPE_CASES` sets how many.
#[test]
#[ignore = "takes minutes"]
fn agrees_with_brute_force_a_million_times() {
    let count = std::env::var("CORNICHE_DRAPE_CASES").ok().and_then(|text| text.parse().ok());
    let ran = run(1_000_000, count.unwrap_or(1_100_000));
    println!("{ran} cases, 0 disagreements");
}

proptest! {
    /// The walk is what brute force makes of it, for seeds proptest chooses.
    #[test]
    fn agrees_with_brute_force_for_any_seed(seed in any::<u64>()) {
        if let Some(case) = Case::new(seed) {
            case.check();
        }
    }
}
