//! The walk agrees with brute force, for TINs and lines of every difficult kind.

pub(crate) mod exact;
mod lines;
mod terrains;

use std::collections::BTreeMap;

use corniche_geom::{LatticePoint, Polyline};
use corniche_testing::Random;
use corniche_tin::{Placement, Surface, Tin};
use proptest::prelude::*;

use self::{
    exact::{crossing, expected, height},
    lines::Course,
    terrains::Terrain,
};
use crate::{Drape, DrapedLine, DrapedVertex, check, drape, positions};

const QUANTUM_M: f64 = 0.25;

/// The same line in the opposite direction.
fn turned(line: &DrapedLine) -> DrapedLine {
    let vertices = line.vertices.iter().rev().copied().collect();
    DrapedLine { lead_in: line.lead_out, vertices, lead_out: line.lead_in }
}

/// Returns the length in plan, and checks that every edge is on the TIN: its middle has the height
/// of the triangle beneath, as closely as f64 can determine which triangle that is. (Over a sliver
/// the ground may rise by a million metres per step.)
fn length_on_tin(line: &DrapedLine, surface: &Surface) -> f64 {
    let at = positions(line, surface).unwrap();
    let mut length = 0.0;
    for (k, pair) in at.windows(2).enumerate() {
        let [[u0, v0, z0], [u1, v1, z1]] = [pair[0], pair[1]];
        let middle = [f64::midpoint(u0, u1), f64::midpoint(v0, v1)];
        // Along an edge rounding moves the middle to either side of it, so every triangle this near
        // is tried.
        let beyond_rounding_m = |t: u32| {
            let height_m = |east: f64, north: f64| {
                surface.height_in_triangle_m(t, [middle[0] + east, middle[1] + north])
            };
            let here_m = height_m(0.0, 0.0);
            let slope = (height_m(1.0, 0.0) - here_m).abs() + (height_m(0.0, 1.0) - here_m).abs();
            (here_m - f64::midpoint(z0, z1)).abs() - 1e-10 * slope
        };
        let gap_m = (0..surface.triangles().len() as u32)
            .filter(|&t| {
                let corners = surface.triangles()[t as usize].map(|v| surface.points()[v as usize]);
                let [a, b, c] = corners.map(|p| [p.u as f64, p.v as f64]);
                let weights = corniche_geom::barycentric(middle, a, b, c);
                weights.iter().all(|&weight| weight > -1e-6)
            })
            .map(beyond_rounding_m)
            .fold(f64::INFINITY, f64::min);
        assert!(gap_m < 1e-6, "edge {k} is {gap_m} m off the ground");
        length += (u1 - u0).hypot(v1 - v0);
    }
    length
}

/// The length in plan without ground, in lattice steps.
pub(crate) fn off_ground_steps(line: &Polyline, draped: &Drape) -> f64 {
    let points = line.points();
    draped.gaps.iter().fold(0.0, |sum, gap| {
        let length_steps = points[gap.segment].distance_steps(points[gap.segment + 1]);
        sum + (gap.shares[1] - gap.shares[0]) * length_steps
    })
}

#[derive(Debug)]
struct Case {
    terrain: Terrain,
    course: Course,
    tin: Tin,
    placement: Placement,
    line: Polyline,
}

impl Case {
    /// Creates a random case; `None` if there is no TIN, or a line of one point.
    fn new(seed: u64) -> Option<Self> {
        let mut random = Random::new(seed);
        let terrain = random.one_of(&Terrain::ALL);
        let course = random.one_of(&Course::ALL);
        let tin = terrain.make(&mut random)?;
        let steps = random.one_of(&[1, 2, 3, 4, 6, 12, 60, 1 << 9]);
        let corner = LatticePoint::new(random.around(1000), random.around(1000));
        let placement = Placement { corner, node_steps: [steps; 2], quantum_m: QUANTUM_M };
        let surface = Surface::new(&tin, placement);
        if surface.triangles().is_empty() {
            return None;
        }
        let points = course.make(&mut random, &surface);
        let line = Polyline::new(points).ok()?;
        Some(Self { terrain, course, tin, placement, line })
    }

    fn check(&self) {
        let Self { tin, placement, line, .. } = self;
        let surface = Surface::new(tin, *placement);
        let draped = drape(line, &surface);
        let (lines, off_steps) = expected(line, &surface);
        assert_eq!(draped.lines, lines);
        let total = corniche_testing::length_steps(line);
        assert!(
            (off_ground_steps(line, &draped) - off_steps).abs() <= 1e-9 * total,
            "{draped:?} {off_steps}"
        );

        let mut on_steps = 0.0;
        for part in &draped.lines {
            assert_eq!(check(part, &surface), Ok(()));
            self.check_positions(part, &surface);
            on_steps += length_on_tin(part, &surface);
        }
        let off_steps = off_ground_steps(line, &draped);
        let error = (on_steps + off_steps - total).abs();
        assert!(error <= 1e-9 * total, "{on_steps} on, {off_steps} off, {total}");

        // The opposite direction has the same crossings at the same positions, to the last bit.
        let back = Polyline::new(line.points().iter().rev().copied().collect()).unwrap();
        let back = drape(&back, &surface).lines;
        assert_eq!(back.iter().rev().map(turned).collect::<Vec<_>>(), draped.lines);
        for (there, back) in draped.lines.iter().zip(back.iter().rev()) {
            let mut at = positions(back, &surface).unwrap();
            at.reverse();
            assert_eq!(at, positions(there, &surface).unwrap());
        }
        if line.points().iter().all(|p| p.u.abs().max(p.v.abs()) < 1 << 30) {
            self.check_wide(&draped.lines);
            self.check_far(&draped.lines);
        }
    }

    /// Positions and heights are those of exact arithmetic: in plan to 2^-20 of a step, the line's
    /// own points and the TIN's vertices exactly, heights on edges to 2^-40 of a quantum, in
    /// triangles to 2^-36.
    fn check_positions(&self, part: &DrapedLine, surface: &Surface) {
        let near = |point: LatticePoint| [point.u as f64, point.v as f64];
        let height_q = |vertex: u32| i64::from(self.tin.vertices()[vertex as usize].height_q);
        let sources = || {
            let own = part.vertices.iter().filter_map(|vertex| match *vertex {
                DrapedVertex::Source { point, .. } => Some(point),
                _ => None,
            });
            part.lead_in.into_iter().chain(own).chain(part.lead_out)
        };
        let mut before = usize::from(part.lead_in.is_some());
        for (vertex, at) in part.vertices.iter().zip(positions(part, surface).unwrap()) {
            match *vertex {
                DrapedVertex::Source { point, triangle } => {
                    before += 1;
                    assert_eq!(at[..2], near(point));
                    let corners = surface.triangles()[triangle as usize];
                    let off =
                        at[2] / QUANTUM_M - height(surface, corners, point, corners.map(height_q));
                    assert!(
                        off.abs() <= 1.0 / (1_u64 << 36) as f64,
                        "{off} quanta off at {vertex:?}"
                    );
                }
                DrapedVertex::Vertex { vertex } => {
                    assert_eq!(at[..2], near(surface.points()[vertex as usize]));
                    assert_eq!(at[2..], [height_q(vertex) as f64 * QUANTUM_M]);
                }
                DrapedVertex::Crossing { a, b } => {
                    let ends: Vec<_> = sources().skip(before - 1).take(2).collect();
                    let [u, v, q] =
                        crossing(surface, [ends[0], ends[1]], [a, b], [height_q(a), height_q(b)]);
                    let (plan, height) =
                        ((at[0] - u).abs().max((at[1] - v).abs()), at[2] / QUANTUM_M - q);
                    assert!(plan <= 1.0 / f64::from(1 << 20), "{plan} steps off at {vertex:?}");
                    assert!(
                        height.abs() <= 1.0 / (1_u64 << 40) as f64,
                        "{height} quanta off at {vertex:?}"
                    );
                }
            }
        }
    }

    /// Far larger coordinates, which take the 128-bit paths, must give the same decisions.
    fn check_wide(&self, lines: &[DrapedLine]) {
        let Self { tin, placement, line, .. } = self;
        let (wider, far) = (1_i64 << 24, 1_i64 << 55);
        let widen = |p: LatticePoint| LatticePoint::new(far + p.u * wider, p.v * wider - far);
        let corner = widen(placement.corner);
        let wide = Placement {
            corner,
            node_steps: placement.node_steps.map(|steps| steps * wider),
            ..*placement
        };
        let points = line.points().iter().copied().map(widen).collect();
        let wide = drape(&Polyline::new(points).unwrap(), &Surface::new(tin, wide));
        assert_eq!(wide.lines, lines.iter().map(|part| moved(part, widen)).collect::<Vec<_>>());
    }

    /// At the largest distance at which positions are computed, their error is at most an eighth of
    /// a step; heights do not change.
    fn check_far(&self, lines: &[DrapedLine]) {
        let Self { tin, placement, line, .. } = self;
        let far = (1_i64 << 50) - (1 << 31);
        let shift = |p: LatticePoint| LatticePoint::new(p.u - far, p.v + far);
        let shifted =
            Surface::new(tin, Placement { corner: shift(placement.corner), ..*placement });
        let points = line.points().iter().copied().map(shift).collect();
        let draped = drape(&Polyline::new(points).unwrap(), &shifted).lines;
        assert_eq!(draped, lines.iter().map(|part| moved(part, shift)).collect::<Vec<_>>());
        let surface = Surface::new(tin, *placement);
        for (here, there) in lines.iter().zip(&draped) {
            let (here, there) = (positions(here, &surface), positions(there, &shifted));
            for (here, there) in here.unwrap().iter().zip(there.unwrap()) {
                let off = [there[0] + far as f64 - here[0], there[1] - far as f64 - here[1]];
                assert!(off.iter().all(|off| off.abs() <= 0.126), "{off:?} steps off, far out");
                assert_eq!(there[2..], here[2..]);
            }
        }
    }
}

/// The same line with moved points.
fn moved(line: &DrapedLine, place: impl Fn(LatticePoint) -> LatticePoint + Copy) -> DrapedLine {
    let vertex = |&vertex: &DrapedVertex| match vertex {
        DrapedVertex::Source { point, triangle } => {
            DrapedVertex::Source { point: place(point), triangle }
        }
        other => other,
    };
    DrapedLine {
        lead_in: line.lead_in.map(place),
        vertices: line.vertices.iter().map(vertex).collect(),
        lead_out: line.lead_out.map(place),
    }
}

/// The numbers of cases of each kind, of parts and of vertices.
type Counts = BTreeMap<(Terrain, Course), [u64; 3]>;

/// Runs cases from `first` on; reports the first that fails.
fn run(first: u64, count: u64) -> Counts {
    let mut counts = Counts::new();
    for seed in first..first + count {
        let Some(case) = Case::new(seed) else {
            continue;
        };
        if let Err(panic) = std::panic::catch_unwind(|| case.check()) {
            println!("case {seed}:\n{case:?}");
            std::panic::resume_unwind(panic);
        }
        let parts = drape(&case.line, &Surface::new(&case.tin, case.placement)).lines;
        let vertices: usize = parts.iter().map(|part| part.vertices.len()).sum();
        let [cases, all_parts, all_vertices] =
            counts.entry((case.terrain, case.course)).or_default();
        *cases += 1;
        *all_parts += parts.len() as u64;
        *all_vertices += vertices as u64;
    }
    counts
}

fn cases(counts: &Counts) -> u64 {
    counts.values().map(|[cases, ..]| cases).sum()
}

#[test]
fn agrees_with_brute_force() {
    let counts = run(0, 8_000);
    assert!(cases(&counts) > 7000);
    for terrain in Terrain::ALL {
        for course in Course::ALL {
            let [cases, parts, _] = counts.get(&(terrain, course)).copied().unwrap_or_default();
            assert!(cases > 20, "{cases} cases of {course:?} on {terrain:?}");
            assert_eq!(parts == 0, course == Course::Outside, "{course:?} on {terrain:?}");
        }
    }
}

/// `CORNICHE_DRAPE_CASES` sets the number of cases.
#[test]
#[ignore = "slow: minutes of brute force"]
fn agrees_with_brute_force_a_million_times() {
    if !corniche_testing::is_full("minutes of brute force") {
        return;
    }
    let count = std::env::var("CORNICHE_DRAPE_CASES").ok().and_then(|text| text.parse().ok());
    let threads = std::thread::available_parallelism().map_or(1, |threads| threads.get() as u64);
    let share = count.unwrap_or(1_200_000_u64).div_ceil(threads);
    let mut counts = Counts::new();
    std::thread::scope(|scope| {
        let run = |n: u64| scope.spawn(move || run(1_000_000 + n * share, share));
        for part in (0..threads).map(run).collect::<Vec<_>>() {
            for (kind, [cases, parts, vertices]) in part.join().unwrap() {
                let [all_cases, all_parts, all_vertices] = counts.entry(kind).or_default();
                *all_cases += cases;
                *all_parts += parts;
                *all_vertices += vertices;
            }
        }
    });
    println!("{:12} {:17} {:>8} {:>8} {:>9}", "terrain", "course", "cases", "parts", "vertices");
    for ((terrain, course), [cases, parts, vertices]) in &counts {
        let (terrain, course) = (format!("{terrain:?}"), format!("{course:?}"));
        println!("{terrain:12} {course:17} {cases:8} {parts:8} {vertices:9}");
    }
    println!("{} cases, 0 disagreements", cases(&counts));
}

proptest! {
    /// The walk agrees with brute force, for seeds that proptest chooses.
    #[test]
    fn agrees_with_brute_force_for_any_seed(seed in any::<u64>()) {
        if let Some(case) = Case::new(seed) {
            case.check();
        }
    }
}
