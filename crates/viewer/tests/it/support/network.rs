//! The length of the part of the road network to which a line of a tile belongs, by distances
//! between all pairs of lines.

use std::collections::BTreeSet;

use corniche_geom::Bounds;
use corniche_viewer::{for_tests::PlanLine, tiles::RoadLook};
use glam::DVec2;

/// The minimum and maximum length of each line's part, metres; infinite if the part continues
/// beyond the area known to the tile. They differ if lines are so far apart that rounding decides
/// whether they are connected.
pub(crate) fn part_lengths_m(lines: &[PlanLine], tile: Bounds, margin_m: f64) -> Vec<[f64; 2]> {
    let cell_m = tile.width().min(tile.height()) / 256.0;
    let ranges: Vec<[DVec2; 2]> = lines.iter().map(range).collect();
    let near: Vec<(usize, usize, f64)> = pairs(lines)
        .filter(|(a, b)| may_be_near(ranges[*a], ranges[*b], 3.0 * cell_m))
        .map(|(a, b)| (a, b, apart_m(&lines[a], &lines[b])))
        .collect();
    let known_m: Vec<f64> =
        lines.iter().map(|line| known_m(line, tile, margin_m, cell_m)).collect();
    // Lines are connected if they cross or pass through adjacent squares.
    let [least, most] = [1e-6 * cell_m, 2.0 * 2.0_f64.sqrt() * cell_m].map(|most_m| {
        let mut beside = vec![Vec::new(); lines.len()];
        for &(a, b, _) in near.iter().filter(|(.., apart_m)| *apart_m <= most_m) {
            beside[a].push(b);
            beside[b].push(a);
        }
        lengths_m(lines, &known_m, &beside)
    });
    least.into_iter().zip(most).map(<[f64; 2]>::from).collect()
}

fn pairs(lines: &[PlanLine]) -> impl Iterator<Item = (usize, usize)> {
    let count = lines.len();
    (0..count).flat_map(move |a| (a + 1..count).map(move |b| (a, b)))
}

/// For each line the length of its part, given the lines that are connected to each line. Computed
/// separately for each rank, with all lines that are shown as early.
fn lengths_m(lines: &[PlanLine], known_m: &[f64], beside: &[Vec<usize>]) -> Vec<f64> {
    let rank = |line: &PlanLine| (line.kind.class.number(), line.kind.look == RoadLook::Service);
    let ranks: BTreeSet<(u8, bool)> = lines.iter().map(rank).collect();
    let mut lengths_m = vec![0.0; lines.len()];
    for most in ranks {
        let mut is_seen: Vec<bool> = lines.iter().map(|line| rank(line) > most).collect();
        for first in 0..lines.len() {
            if is_seen[first] {
                continue;
            }
            is_seen[first] = true;
            let mut part = vec![first];
            let mut next = 0;
            while let Some(&from) = part.get(next) {
                next += 1;
                for &to in &beside[from] {
                    if !std::mem::replace(&mut is_seen[to], true) {
                        part.push(to);
                    }
                }
            }
            let length_m: f64 = part.iter().map(|line| known_m[*line]).sum();
            for line in part.into_iter().filter(|line| rank(&lines[*line]) == most) {
                lengths_m[line] = length_m;
            }
        }
    }
    lengths_m
}

/// The length of a line; infinite if it is not completely known.
fn known_m(line: &PlanLine, tile: Bounds, margin_m: f64, cell_m: f64) -> f64 {
    let points: Vec<DVec2> = line.points_m.iter().map(|at| DVec2::from_array(*at)).collect();
    let middle = DVec2::from_array(tile.center());
    let half = DVec2::new(tile.width(), tile.height()) / 2.0;
    // Distance of a point beyond the tile's sides: negative inside.
    let beyond: Vec<DVec2> = points.iter().map(|at| (*at - middle).abs() - half).collect();
    let inside = beyond.iter().all(|by| by.max_element() < 0.0);
    let whole = beyond.iter().all(|by| by.max_element() < margin_m - cell_m);
    let beside = [DVec2::X, DVec2::Y, -DVec2::X, -DVec2::Y]
        .into_iter()
        .any(|side| points.iter().all(|at| (*at - middle).dot(side) > half.dot(side.abs())));
    if inside || (whole && beside) {
        points.windows(2).map(|pair| pair[0].distance(pair[1])).sum()
    } else {
        f64::INFINITY
    }
}

/// The lowest and the highest coordinates of a line.
fn range(line: &PlanLine) -> [DVec2; 2] {
    let points = line.points_m.iter().map(|at| DVec2::from_array(*at));
    points
        .fold([DVec2::INFINITY, DVec2::NEG_INFINITY], |[low, high], at| [low.min(at), high.max(at)])
}

fn may_be_near([low, high]: [DVec2; 2], [other_low, other_high]: [DVec2; 2], most_m: f64) -> bool {
    (other_low - high).max(low - other_high).max_element() <= most_m
}

/// The distance between two lines.
fn apart_m(a: &PlanLine, b: &PlanLine) -> f64 {
    let mut least = f64::INFINITY;
    for first in a.points_m.windows(2) {
        for second in b.points_m.windows(2) {
            let [p, q] = [0, 1].map(|k| DVec2::from_array(first[k]));
            let [r, s] = [0, 1].map(|k| DVec2::from_array(second[k]));
            let sides = |from: DVec2, to: DVec2, at: DVec2| (to - from).perp_dot(at - from);
            let crosses =
                sides(p, q, r) * sides(p, q, s) < 0.0 && sides(r, s, p) * sides(r, s, q) < 0.0;
            let ends = [to_segment_m(p, [r, s]), to_segment_m(q, [r, s])]
                .into_iter()
                .chain([to_segment_m(r, [p, q]), to_segment_m(s, [p, q])]);
            least = ends.fold(if crosses { 0.0 } else { least }, f64::min);
        }
    }
    least
}

fn to_segment_m(at: DVec2, [a, b]: [DVec2; 2]) -> f64 {
    let along = if a == b { 0.0 } else { (at - a).dot(b - a) / a.distance_squared(b) };
    at.distance(a + (b - a) * along.clamp(0.0, 1.0))
}
