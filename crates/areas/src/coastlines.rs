//! Joins coastlines, and clips them to a region.

use std::collections::{HashMap, HashSet, VecDeque};

use corniche_geom::{LatticePoint, LatticeRegion};

/// A way with land on its left and sea on its right.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct Coastline {
    /// The way in OSM.
    pub way_id: i64,
    /// Its points in order; consecutive points are connected.
    pub points: Vec<LatticePoint>,
}

/// Coastlines joined one after the other. A ring repeats its first point at the end.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct CoastlineChain {
    pub points: Vec<LatticePoint>,
    /// The way of each segment.
    pub ways: Vec<i64>,
}

impl CoastlineChain {
    fn from_coastline(coastline: Coastline) -> Self {
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

    /// Appends the chain `next`.
    pub(crate) fn append(&mut self, next: Self) {
        if self.last() == next.first() {
            self.points.pop();
        } else {
            self.ways.extend(self.ways.last().copied());
        }
        self.points.extend(next.points);
        self.ways.extend(next.ways);
    }

    /// Appends a straight segment to a point.
    pub(crate) fn push(&mut self, point: LatticePoint) {
        self.points.push(point);
        self.ways.extend(self.ways.last().copied());
    }
}

/// Joins coastlines where one ends and another begins, as far as possible. Where several begin, the
/// one with the smallest id continues the chain.
pub(crate) fn join(mut coastlines: Vec<Coastline>) -> Vec<CoastlineChain> {
    coastlines.retain(|coastline| coastline.points.len() >= 2);
    coastlines.sort_unstable();
    coastlines.dedup();
    let mut beginning: HashMap<LatticePoint, VecDeque<usize>> = HashMap::new();
    for (index, coastline) in coastlines.iter().enumerate() {
        beginning.entry(coastline.points[0]).or_default().push_back(index);
    }
    let ends: HashSet<LatticePoint> =
        coastlines.iter().filter_map(|coastline| coastline.points.last().copied()).collect();
    // Chains with an open beginning come first; the rest are rings.
    let (open, rings): (Vec<usize>, Vec<usize>) =
        (0..coastlines.len()).partition(|&index| !ends.contains(&coastlines[index].points[0]));
    let mut left: Vec<Option<Coastline>> = coastlines.into_iter().map(Some).collect();
    let mut chains = Vec::new();
    for index in open.into_iter().chain(rings) {
        let Some(first) = left[index].take() else { continue };
        let mut chain = CoastlineChain::from_coastline(first);
        while !chain.is_ring()
            && let Some(at) = chain.last()
            && let Some(next) = take_next(&mut beginning, at, &mut left)
        {
            chain.append(CoastlineChain::from_coastline(next));
        }
        chains.push(chain);
    }
    chains
}

/// Takes the coastline with the smallest id that begins at a point and is not in a chain yet.
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

/// Returns the parts of a chain inside a region, including its edge, in order. Only a whole ring
/// stays a ring.
pub(crate) fn cut(chain: &CoastlineChain, region: &LatticeRegion) -> Vec<CoastlineChain> {
    let mut parts: Vec<CoastlineChain> = Vec::new();
    // Whether the last part continues from the end of the last segment.
    let mut open = false;
    for (&[from, to], &way_id) in chain.points.array_windows::<2>().zip(&chain.ways) {
        let whole = || if region.contains(from) { vec![[0.0, 1.0]] } else { Vec::new() };
        let inside = region.shares_inside([from, to]).unwrap_or_else(whole);
        let is_open = inside.last().is_some_and(|&[_, end]| end >= 1.0);
        for [begin, end] in inside {
            let [inner_from, inner_to] = [begin, end].map(|share| from.share_of_way(to, share));
            match parts.last_mut() {
                Some(part) if open && begin <= 0.0 => {
                    part.points.push(inner_to);
                    part.ways.push(way_id);
                }
                _ => parts.push(CoastlineChain {
                    points: vec![inner_from, inner_to],
                    ways: vec![way_id],
                }),
            }
        }
        open = is_open;
    }
    // A ring that begins inside continues at its beginning.
    if chain.is_ring()
        && open
        && parts.len() > 1
        && parts[0].first() == chain.first()
        && let Some(mut last) = parts.pop()
    {
        last.append(parts[0].clone());
        parts[0] = last;
    }
    // A touch from outside is a single point, so it is dropped.
    parts.retain(|part| part.points.iter().any(|&point| Some(point) != part.first()));
    parts
}

#[cfg(test)]
#[path = "coastlines_tests.rs"]
mod tests;
