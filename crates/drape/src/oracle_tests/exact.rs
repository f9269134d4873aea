//! The expected result of `drape`: all edges and all triangles by exact fractions, sorted along the
//! line.

use std::cmp::Ordering;

use corniche_geom::{LatticePoint, Polyline};
use corniche_tin::Surface;

use crate::{DrapedLine, DrapedVertex};

/// A position along a segment: numerator and denominator, which is above 0.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Along(i128, i128);

pub(crate) const START: Along = Along(0, 1);
pub(crate) const END: Along = Along(1, 1);

impl Along {
    pub(crate) fn new(n: i128, d: i128) -> Self {
        if d < 0 { Self(-n, -d) } else { Self(n, d) }
    }

    fn value(self) -> f64 {
        self.0 as f64 / self.1 as f64
    }

    /// Returns `from` + `span` · this in f64, with one rounding of the part below 1: the whole part
    /// is exact.
    fn between(self, from: i128, span: i128) -> f64 {
        let Self(n, d) = self;
        let above = span * n;
        let whole = (from + above.div_euclid(d)) as f64;
        whole + above.rem_euclid(d) as f64 / d as f64
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
    /// Compares cross products in 256 bits.
    fn cmp(&self, other: &Self) -> Ordering {
        let (left, right) = (wide_product(self.0, other.1), wide_product(other.0, self.1));
        left.cmp(&right)
    }
}

/// The sign and the magnitude, ordered like the product: high and low 128 bits, both negated for a
/// negative product.
pub(crate) fn wide_product(a: i128, b: i128) -> (bool, [i128; 4]) {
    const LIMB: u128 = (1 << 64) - 1;
    let (x, y) = (a.unsigned_abs(), b.unsigned_abs());
    let low = (x & LIMB) * (y & LIMB);
    let middle = (x >> 64) * (y & LIMB) + (low >> 64);
    let other = (x & LIMB) * (y >> 64) + (middle & LIMB);
    let high = (x >> 64) * (y >> 64) + (middle >> 64) + (other >> 64);
    let limbs = [high >> 64, high & LIMB, other & LIMB, low & LIMB];
    let negative = (a < 0) != (b < 0) && x != 0 && y != 0;
    (!negative, limbs.map(|limb| if negative { -(limb as i128) } else { limb as i128 }))
}

/// Twice the area of a, b, c, computed independently.
pub(crate) fn area(a: LatticePoint, b: LatticePoint, c: LatticePoint) -> i128 {
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

/// The stretches of p → q on ground: disjoint, in order.
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

/// The edges crossed in their interiors and the vertices passed, strictly between p and q, in
/// order.
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
        let wide = |x: i64, y: i64| i128::from(y) - i128::from(x);
        let dot = |x: LatticePoint, y: LatticePoint| {
            wide(x.u, y.u) * wide(p.u, q.u) + wide(x.v, y.v) * wide(p.v, q.v)
        };
        let along = Along::new(dot(p, point), dot(p, q));
        if area(p, q, point) == 0 && START < along && along < END {
            events.push((along, DrapedVertex::Vertex { vertex }));
        }
    }
    events.sort_by_key(|event| event.0);
    events
}

/// The expected result of `drape`: the parts, and the length without ground.
pub(crate) fn expected(line: &Polyline, surface: &Surface) -> (Vec<DrapedLine>, f64) {
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

/// The position where segment p → q crosses the edge between TIN vertices a and b: u, v in steps,
/// and the height in quanta.
pub(crate) fn crossing(
    surface: &Surface,
    [p, q]: [LatticePoint; 2],
    ends: [u32; 2],
    heights_q: [i64; 2],
) -> [f64; 3] {
    let [a, b] = ends.map(|vertex| surface.points()[vertex as usize]);
    let at_a = area(p, q, a);
    let along = Along::new(at_a, at_a - area(p, q, b));
    let on =
        |from: i64, to: i64| along.between(i128::from(from), i128::from(to) - i128::from(from));
    [on(a.u, b.u), on(a.v, b.v), on(heights_q[0], heights_q[1])]
}

/// The height of a triangle's plane above a point, in quanta.
pub(crate) fn height(
    surface: &Surface,
    corners: [u32; 3],
    point: LatticePoint,
    heights_q: [i64; 3],
) -> f64 {
    let [a, b, c] = corners.map(|vertex| surface.points()[vertex as usize]);
    let [za, zb, zc] = heights_q.map(i128::from);
    let rise = area(a, point, c) * (zb - za) + area(a, b, point) * (zc - za);
    Along::new(rise, area(a, b, c)).between(za, 1)
}

#[test]
fn wide_products_are_ordered_as_products() {
    let numbers = [0, 1, -1, 2, -3, 1 << 64, -(1 << 64) - 1, 1 << 120, -(1 << 121), i128::MAX];
    for [a, b, c, d] in (0..10_000_usize).map(|n| [n / 1000, n / 100 % 10, n / 10 % 10, n % 10]) {
        let [a, b, c, d] = [a, b, c, d].map(|index| numbers[index]);
        if let (Some(left), Some(right)) = (a.checked_mul(b), c.checked_mul(d)) {
            assert_eq!(
                wide_product(a, b).cmp(&wide_product(c, d)),
                left.cmp(&right),
                "{a}·{b}, {c}·{d}"
            );
        }
    }
    assert!(wide_product(i128::MAX, i128::MAX) > wide_product(i128::MAX, i128::MAX - 1));
    assert!(wide_product(-i128::MAX, i128::MAX) < wide_product(-i128::MAX, i128::MAX - 1));
}
