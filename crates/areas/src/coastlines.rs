//! Coastlines joined, and cut by a rectangle.

use std::collections::{HashMap, HashSet, VecDeque};

use corniche_geom::{LatticeBounds, LatticePoint};

/// A way between land on its left and sea on its right.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct Coastline {
    /// The way in OSM.
    pub way_id: i64,
    /// Its points in order; neighbouring ones are joined.
    pub points: Vec<LatticePoint>,
}

/// Coastlines one after the other. A ring has its first point again at the end.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Chain {
    pub(crate) points: Vec<LatticePoint>,
    /// The way of each segment.
    pub(crate) ways: Vec<i64>,
}

impl Chain {
    fn of(coastline: Coastline) -> Self {
        let ways = vec![coastline.way_id; coastline.points.len().saturating_sub(1)];
        Self { points: coastline.points, ways }
    }

    pub(crate) fn is_ring(&self) -> bool {
        self.points.len() > 2 && self.points.first() == self.points.last()
    }

    pub(crate) fn first(&self) -> Option<LatticePoint> {
        self.points.first().copied()
    }

    pub(crate) fn last(&self) -> Option<LatticePoint> {
        self.points.last().copied()
    }

    /// Goes on along `next`.
    pub(crate) fn append(&mut self, next: Self) {
        if self.last() == next.first() {
            self.points.pop();
        } else {
            self.ways.extend(self.ways.last().copied());
        }
        self.points.extend(next.points);
        self.ways.extend(next.ways);
    }

    /// Goes on straight to a point.
    pub(crate) fn push(&mut self, point: LatticePoint) {
        self.points.push(point);
        self.ways.extend(self.ways.last().copied());
    }
}

/// Joins coastlines where one ends and another begins, as far as they go. Where several begin, that with the smallest id goes on.
pub(crate) fn join(mut coastlines: Vec<Coastline>) -> Vec<Chain> {
    coastlines.retain(|coastline| coastline.points.len() >= 2);
    coastlines.sort_unstable();
    coastlines.dedup();
    let mut beginning: HashMap<LatticePoint, VecDeque<usize>> = HashMap::new();
    for (index, coastline) in coastlines.iter().enumerate() {
        beginning.entry(coastline.points[0]).or_default().push_back(index);
    }
    let ends: HashSet<LatticePoint> =
        coastlines.iter().filter_map(|coastline| coastline.points.last().copied()).collect();
    // Chains with an open beginning first; what then is left are rings.
    let (open, rings): (Vec<usize>, Vec<usize>) =
        (0..coastlines.len()).partition(|&index| !ends.contains(&coastlines[index].points[0]));
    let mut left: Vec<Option<Coastline>> = coastlines.into_iter().map(Some).collect();
    let mut chains = Vec::new();
    for index in open.into_iter().chain(rings) {
        let Some(first) = left[index].take() else { continue };
        let mut chain = Chain::of(first);
        while !chain.is_ring()
            && let Some(at) = chain.last()
            && let Some(next) = take_next(&mut beginning, at, &mut left)
        {
            chain.append(Chain::of(next));
        }
        chains.push(chain);
    }
    chains
}

/// The coastline with the smallest id that begins at a point and is not in a chain yet.
fn take_next(
    beginning: &mut HashMap<LatticePoint, VecDeque<usize>>,
    at: LatticePoint,
    left: &mut [Option<Coastline>],
) -> Option<Coastline> {
    let here = beginning.get_mut(&at)?;
    while let Some(index) = here.pop_front() {
        if let Some(coastline) = left[index].take() {
            return Some(coastline);
        }
    }
    None
}

/// The parts of a chain inside a rectangle, its edge included, in order. Only a whole ring stays a ring.
pub(crate) fn cut(chain: &Chain, bounds: &LatticeBounds) -> Vec<Chain> {
    let mut parts: Vec<Chain> = Vec::new();
    let mut open = false;
    for (pair, &way_id) in chain.points.array_windows::<2>().zip(&chain.ways) {
        let &[from, to] = pair;
        let Some([inner_from, inner_to]) = clip([from, to], bounds) else {
            open = false;
            continue;
        };
        match parts.last_mut() {
            Some(part) if open && inner_from == from => {
                part.points.push(inner_to);
                part.ways.push(way_id);
            }
            _ => parts.push(Chain { points: vec![inner_from, inner_to], ways: vec![way_id] }),
        }
        open = inner_to == to;
    }
    // A ring that begins inside goes on at its beginning.
    if chain.is_ring()
        && open
        && parts.len() > 1
        && parts[0].first() == chain.first()
        && let Some(mut last) = parts.pop()
    {
        last.append(parts[0].clone());
        parts[0] = last;
    }
    // A touch from outside is a point.
    parts.retain(|part| part.points.iter().any(|&point| Some(point) != part.first()));
    parts
}

/// The part of a segment inside a rectangle, its edge included; ends on the edge are rounded along it.
fn clip(
    [mut from, mut to]: [LatticePoint; 2],
    bounds: &LatticeBounds,
) -> Option<[LatticePoint; 2]> {
    let LatticeBounds { min, max } = *bounds;
    // Each round brings one end to the line of an edge, and there are four.
    for _ in 0..8 {
        if bounds.contains(from) && bounds.contains(to) {
            return Some([from, to]);
        }
        let is_beside = |beside: &dyn Fn(LatticePoint) -> bool| beside(from) && beside(to);
        if is_beside(&|p| p.u < min.u)
            || is_beside(&|p| p.u > max.u)
            || is_beside(&|p| p.v < min.v)
            || is_beside(&|p| p.v > max.v)
        {
            return None;
        }
        let outer = if bounds.contains(from) { to } else { from };
        let moved = if outer.u < min.u || outer.u > max.u {
            let u = outer.u.clamp(min.u, max.u);
            LatticePoint::new(u, between([from.u, from.v], [to.u, to.v], u))
        } else {
            let v = outer.v.clamp(min.v, max.v);
            LatticePoint::new(between([from.v, from.u], [to.v, to.u], v), v)
        };
        if outer == from {
            from = moved;
        } else {
            to = moved;
        }
    }
    None
}

/// The second coordinate of the point of a segment whose first one is `at`, rounded; the first ones of its ends differ.
fn between(from: [i64; 2], to: [i64; 2], at: i64) -> i64 {
    let [from, to] = [from, to].map(|point| point.map(i128::from));
    let (along, whole) = (i128::from(at) - from[0], to[0] - from[0]);
    let (along, whole) = if whole < 0 { (-along, -whole) } else { (along, whole) };
    let aside = (2 * (to[1] - from[1]) * along + whole).div_euclid(2 * whole.max(1));
    // Between two coordinates of 64 bits there are no others.
    i64::try_from(from[1] + aside).unwrap_or_default()
}

#[cfg(test)]
#[path = "coastlines_tests.rs"]
mod tests;
