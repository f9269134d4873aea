//! Compares the paper's walk in floating point with the exact walk on the TINs of packages: number
//! of errors, and time.
//!
//! ```sh
//! cargo run --release -p corniche-drape --example floating_point_walk -- PACKAGE.pmtiles…
//! ```
//!
//! The lines are the roads of the packages, cut at the borders of tiles; straight lines across the
//! tiles; and difficult lines: through TIN vertices, along edges, along borders of tiles. The first
//! table compares the walks segment by segment. The second has CPU times, all forms in turns, of
//! the lines on which every form is correct.
#![expect(clippy::print_stdout, reason = "an example prints its result")]

mod float_forms;

use std::{collections::BTreeMap, env, error::Error, hint::black_box, path::Path};

use corniche_drape::{DrapedVertex, clip_closed, drape, positions};
use corniche_geom::{LatticeBounds, LatticePoint, Polyline, cross};
use corniche_testing::Random;
use corniche_tileset::{FilePackage, Sections};
use corniche_tin::{NO_TWIN, Placement, Surface};
use rustix::time::{ClockId, clock_gettime};

use float_forms::{Areas, AsWritten, Crossed, Form, Ground, Outcome, trace};

/// Number of straight lines, and of difficult lines, for each tile.
const ACROSS: usize = 128;
const AWKWARD: usize = 600;
/// Positions closer than this are equal, in metres.
const SAME_M: f64 = 1e-3;
const ROUNDS: usize = 15;

/// A tile, its roads, and the lines generated for it.
struct Tile {
    ground: Ground,
    roads: Vec<Polyline>,
    across: Vec<Polyline>,
    awkward: Vec<Polyline>,
}

/// The most difficult situation on a segment.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Meets {
    /// The segment only crosses edges in their interiors, or crosses none.
    Insides,
    /// One of its ends is in the interior of an edge on the boundary of the ground.
    EndOnBorder,
    /// One of its ends is in the interior of another edge.
    EndOnEdge,
    /// A TIN vertex is on it, possibly at an end.
    Vertex,
    /// It runs along an edge.
    AlongEdge,
    /// It runs along an edge on the boundary of the ground.
    AlongBorder,
}

impl Meets {
    fn name(self) -> &'static str {
        match self {
            Self::Insides => "insides of edges alone",
            Self::EndOnBorder => "an end on the border of ground",
            Self::EndOnEdge => "an end on another edge",
            Self::Vertex => "a TIN vertex on it",
            Self::AlongEdge => "along an edge",
            Self::AlongBorder => "along the border of ground",
        }
    }
}

/// The result of comparing the floating-point walk with the exact walk on a segment.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Verdict {
    /// The walks have the same crossings of the same edges.
    Same,
    /// The walks have the same positions to a millimetre, with different names: for example an edge
    /// that ends at a vertex instead of the vertex.
    Renamed,
    /// The walk has all positions of the exact walk, and others on the line.
    Added,
    /// A position of the exact walk is missing: between its neighbours the line leaves the ground.
    Missing,
    /// The walk reached the boundary of the ground, or found no exit, more than a millimetre before
    /// the end.
    Stopped,
    /// The walk did not end.
    Endless,
}

/// The names of the results, in order.
const VERDICTS: [&str; 6] = ["same", "renamed", "added", "missing", "stopped", "endless"];

fn main() -> Result<(), Box<dyn Error>> {
    let files: Vec<String> = env::args().skip(1).collect();
    if files.is_empty() {
        return Err("usage: floating_point_walk PACKAGE.pmtiles…".into());
    }
    let verdicts = VERDICTS.join(" | ");
    println!("| package | lines | what a segment meets | segments | form | {verdicts} |");
    println!("|---|---|---|--:|---|--:|--:|--:|--:|--:|--:|");
    let mut times = Vec::new();
    for file in &files {
        let tiles = read_tiles(file)?;
        let name = Path::new(file).file_stem().unwrap_or_default().to_string_lossy();
        for (what, lines) in KINDS {
            compare_all(&name, what, &tiles, lines);
            if what != "awkward" {
                times.push((name.to_string(), what, time_all(&tiles, lines)));
            }
        }
    }
    println!(
        "\n| package | lines | vertices | exact, ns a vertex | as written | areas | exact with positions |"
    );
    println!("|---|---|--:|--:|--:|--:|--:|");
    for (name, what, Times { vertices, exact_ns, ratios }) in times {
        let [written, areas, with_positions] = ratios.map(|ratio| format!("{ratio:.2} ×"));
        println!(
            "| {name} | {what} | {vertices} | {exact_ns:.1} | {written} | {areas} | {with_positions} |"
        );
    }
    Ok(())
}

type LinesOf = fn(&Tile) -> &[Polyline];
const KINDS: [(&str, LinesOf); 3] = [
    ("roads", |tile| &tile.roads),
    ("across", |tile| &tile.across),
    ("awkward", |tile| &tile.awkward),
];

/// Reads the tiles of all levels that have ground.
fn read_tiles(file: &str) -> Result<Vec<Tile>, Box<dyn Error>> {
    let package = FilePackage::open(Path::new(file))?;
    let manifest = package.manifest();
    let frame = &manifest.frame;
    let mut tiles = Vec::new();
    let mut random = Random::new(1);
    for id in package.tile_ids()? {
        let wanted = Sections::TERRAIN.and(Sections::ROADS_SV);
        let Some(payload) = package.payload(id, wanted)? else { continue };
        let Some(terrain) = payload.terrain else { continue };
        let placement = Placement::of_tile(frame, id, manifest.vertical.quantum_m);
        let surface = Surface::new(&terrain.tin, placement);
        let cell_m = frame.level_cell(id.z()).to_array();
        let step_m = [0, 1].map(|axis| cell_m[axis] / placement.node_steps[axis] as f64);
        let bounds = frame.tile_lattice_bounds(id);
        let whole = payload.roads_sv.into_iter().map(|road| road.line.points);
        let whole = whole.filter_map(|points| Polyline::new(points).ok());
        let roads = whole.flat_map(|line| clip_closed(&line, &bounds)).collect();
        let ground = Ground::new(surface, bounds.min, step_m);
        let across = lines_across(&mut random, &bounds);
        let awkward = awkward_lines(&mut random, &ground.surface, &bounds);
        tiles.push(Tile { ground, roads, across, awkward });
    }
    Ok(tiles)
}

/// Lines of one segment from the west of a tile to its east.
fn lines_across(random: &mut Random, bounds: &LatticeBounds) -> Vec<Polyline> {
    let LatticeBounds { min, max } = *bounds;
    let mut at = |u: i64| LatticePoint::new(u, min.v + random.below(max.v - min.v + 1));
    let ends = (0..ACROSS).map(|_| vec![at(min.u), at(max.u)]);
    ends.filter_map(|ends| Polyline::new(ends).ok()).collect()
}

/// Lines of one segment within the tile: through a TIN vertex, along an edge and beyond its ends,
/// along a side of the tile.
fn awkward_lines(random: &mut Random, surface: &Surface, bounds: &LatticeBounds) -> Vec<Polyline> {
    let LatticeBounds { min, max } = *bounds;
    let mut lines = Vec::new();
    for number in 0..AWKWARD {
        let inside = LatticePoint::new(
            min.u + random.below(max.u - min.u + 1),
            min.v + random.below(max.v - min.v + 1),
        );
        let [from, to] = match number % 3 {
            0 => {
                let vertex = random.one_of(surface.points());
                [inside, LatticePoint::new(2 * vertex.u - inside.u, 2 * vertex.v - inside.v)]
            }
            1 => {
                let half_edge = random.below(3 * surface.triangles().len() as i64) as u32;
                let [a, b] =
                    surface.ends(half_edge).map(|vertex| surface.points()[vertex as usize]);
                // Extend the edge by half its length at both ends; the numbers of lattice steps per
                // cell are even.
                let half = [(b.u - a.u) / 2, (b.v - a.v) / 2];
                [
                    LatticePoint::new(a.u - half[0], a.v - half[1]),
                    LatticePoint::new(b.u + half[0], b.v + half[1]),
                ]
            }
            _ => {
                let other = min.u + random.below(max.u - min.u + 1);
                [inside.u, other]
                    .map(|u| LatticePoint::new(u, if number % 2 == 0 { min.v } else { max.v }))
            }
        };
        let ends = if random.below(2) == 0 { vec![from, to] } else { vec![to, from] };
        lines.extend(
            Polyline::new(ends).ok().into_iter().flat_map(|line| clip_closed(&line, bounds)),
        );
    }
    lines
}

fn compare_all(name: &str, what: &str, tiles: &[Tile], lines: LinesOf) {
    let mut counts: BTreeMap<Meets, [[u64; VERDICTS.len()]; 2]> = BTreeMap::new();
    let mut beside_ground = 0_u64;
    for tile in tiles {
        for pair in lines(tile).iter().flat_map(|line| line.points().windows(2)) {
            let segment = [pair[0], pair[1]];
            let Some(exact) = exact_crossings(&tile.ground, segment) else {
                beside_ground += 1;
                continue;
            };
            let row = counts.entry(meets(&tile.ground.surface, segment)).or_default();
            for (row, verdict) in row.iter_mut().zip([
                verdict::<AsWritten>(&tile.ground, segment, &exact),
                verdict::<Areas>(&tile.ground, segment, &exact),
            ]) {
                row[verdict as usize] += 1;
            }
        }
    }
    for (meets, forms) in counts {
        for (form, found) in ["as written", "areas"].into_iter().zip(forms) {
            let cells = found.map(|count| count.to_string()).join(" | ");
            let all: u64 = found.iter().sum();
            println!("| {name} | {what} | {} | {all} | {form} | {cells} |", meets.name());
        }
    }
    if beside_ground > 0 {
        println!(
            "| {name} | {what} | left out: partly over no ground | {beside_ground} | | | | | | | |"
        );
    }
}

/// The crossings of the exact walk between the ends of a segment, with positions; `None` if the
/// segment is not on ground everywhere.
fn exact_crossings(
    ground: &Ground,
    segment: [LatticePoint; 2],
) -> Option<Vec<(DrapedVertex, [f64; 2])>> {
    let line = Polyline::new(segment.to_vec()).ok()?;
    let laid = drape(&line, &ground.surface);
    let [part] = &laid.lines[..] else { return None };
    if !laid.gaps.is_empty() {
        return None;
    }
    let places = positions(part, &ground.surface).ok()?;
    let vertices = part.vertices.iter().copied().zip(places);
    let inner = vertices.skip(1).take(part.vertices.len() - 2);
    Some(inner.map(|(vertex, [u, v, _])| (vertex, ground.place_of_steps([u, v]))).collect())
}

fn verdict<F: Form>(
    ground: &Ground,
    segment: [LatticePoint; 2],
    exact: &[(DrapedVertex, [f64; 2])],
) -> Verdict {
    let Some(start) = ground.surface.locate(segment[0]) else { return Verdict::Stopped };
    let mut found = Vec::new();
    let outcome = trace::<F>(ground, segment, start, &mut found);
    let is_same = |(found, exact): (&Crossed, &(DrapedVertex, [f64; 2]))| matches!(exact.0, DrapedVertex::Crossing { a, b } if found.ends == [a, b]);
    let ends = segment.map(|point| ground.place(point));
    let away = |one: [f64; 2], other: [f64; 2]| (one[0] - other[0]).hypot(one[1] - other[1]);
    match outcome {
        Outcome::Endless => Verdict::Endless,
        Outcome::Stopped { left_m } if left_m > SAME_M => Verdict::Stopped,
        Outcome::Arrived(_)
            if found.len() == exact.len() && found.iter().zip(exact).all(is_same) =>
        {
            Verdict::Same
        }
        _ => {
            let has = |at: [f64; 2]| found.iter().any(|found| away(found.at, at) <= SAME_M);
            let known = |at: [f64; 2]| {
                exact.iter().map(|exact| exact.1).chain(ends).any(|exact| away(exact, at) <= SAME_M)
            };
            if !exact.iter().all(|exact| has(exact.1)) {
                Verdict::Missing
            } else if found.iter().all(|found| known(found.at)) {
                Verdict::Renamed
            } else {
                Verdict::Added
            }
        }
    }
}

/// Determines the situation on a segment exactly.
fn meets(surface: &Surface, [p, q]: [LatticePoint; 2]) -> Meets {
    let Some(bounds) = LatticeBounds::around(&[p, q]) else { return Meets::Insides };
    let mut near = Vec::new();
    surface.triangles_near(bounds, &mut near);
    let is_on = |a: LatticePoint, b: LatticePoint, point: LatticePoint| {
        let between = |x: i64, y: i64, at: i64| (x.min(y)..=x.max(y)).contains(&at);
        cross(a, b, point) == 0 && between(a.u, b.u, point.u) && between(a.v, b.v, point.v)
    };
    let mut most = Meets::Insides;
    for half_edge in near.into_iter().flat_map(|triangle| 3 * triangle..3 * triangle + 3) {
        let [a, b] = surface.ends(half_edge).map(|vertex| surface.points()[vertex as usize]);
        let is_border = surface.twin(half_edge) == NO_TWIN;
        if cross(p, q, a) == 0 && cross(p, q, b) == 0 {
            // All points are on one line: do edge and segment share more than a point?
            let [low, high] = [a.min(b).max(p.min(q)), a.max(b).min(p.max(q))];
            if low < high {
                most = most.max(if is_border { Meets::AlongBorder } else { Meets::AlongEdge });
            }
        }
        if is_on(p, q, a) {
            most = most.max(Meets::Vertex);
        } else if is_on(a, b, p) || is_on(a, b, q) {
            most = most.max(if is_border { Meets::EndOnBorder } else { Meets::EndOnEdge });
        }
    }
    most
}

/// CPU times, medians over rounds.
struct Times {
    vertices: usize,
    exact_ns: f64,
    /// Times as written, by areas, and exact with positions: each divided by the time of the exact
    /// walk of the same round.
    ratios: [f64; 3],
}

fn time_all(tiles: &[Tile], lines: LinesOf) -> Times {
    // Only lines that are on ground everywhere: the exact walk searches for ground beyond a gap,
    // the other walks end there.
    let over_ground = |&(tile, line): &(&Tile, &Polyline)| {
        let laid = drape(line, &tile.ground.surface);
        laid.gaps.is_empty() && laid.lines.len() == 1
    };
    let all = tiles.iter().flat_map(|tile| lines(tile).iter().map(move |line| (tile, line)));
    let kept: Vec<(&Tile, &Polyline)> = all.filter(over_ground).collect();
    let all = || kept.iter().copied();
    let vertices_of = |tile: &Tile, line: &Polyline| -> usize {
        drape(line, &tile.ground.surface).lines.iter().map(|part| part.vertices.len()).sum()
    };
    let vertices: usize = all().map(|(tile, line)| vertices_of(tile, line)).sum();
    let walk = |(tile, line): (&Tile, &Polyline)| {
        black_box(drape(black_box(line), &tile.ground.surface));
    };
    let with_positions = |(tile, line): (&Tile, &Polyline)| {
        for part in drape(black_box(line), &tile.ground.surface).lines {
            black_box(positions(&part, &tile.ground.surface).ok());
        }
    };
    let mut rounds: Vec<[f64; 4]> = Vec::new();
    for _ in 0..ROUNDS {
        rounds.push([
            cpu_s(|| all().for_each(walk)),
            cpu_s(|| all().for_each(|(tile, line)| trace_line::<AsWritten>(tile, line))),
            cpu_s(|| all().for_each(|(tile, line)| trace_line::<Areas>(tile, line))),
            cpu_s(|| all().for_each(with_positions)),
        ]);
    }
    let median = |of: &dyn Fn(&[f64; 4]) -> f64| {
        let mut values: Vec<f64> = rounds.iter().map(of).collect();
        values.sort_by(f64::total_cmp);
        values[values.len() / 2]
    };
    Times {
        vertices,
        exact_ns: median(&|round| round[0]) * 1e9 / vertices as f64,
        ratios: [1, 2, 3].map(|form| median(&|round| round[form] / round[0])),
    }
}

/// Traces a whole line; if the walk loses the ground, it begins again at the next point.
fn trace_line<F: Form>(tile: &Tile, line: &Polyline) {
    let points = black_box(line.points());
    let mut found = Vec::with_capacity(2 * points.len());
    let mut triangle = tile.ground.surface.locate(points[0]);
    for pair in points.windows(2) {
        triangle = match triangle
            .map(|from| trace::<F>(&tile.ground, [pair[0], pair[1]], from, &mut found))
        {
            Some(Outcome::Arrived(triangle)) => Some(triangle),
            _ => tile.ground.surface.locate(pair[1]),
        };
        found.push(Crossed { ends: [0; 2], at: tile.ground.place(pair[1]) });
    }
    black_box(found);
}

/// The CPU time of this process in seconds.
fn cpu_s(work: impl FnOnce()) -> f64 {
    let now = || {
        let time = clock_gettime(ClockId::ProcessCPUTime);
        time.tv_sec as f64 + time.tv_nsec as f64 * 1e-9
    };
    let before = now();
    work();
    now() - before
}
