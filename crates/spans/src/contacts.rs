//! Decides whether lines that touch, or share a stretch, change sides there.
//!
//! ```text
//!    a      a'         a                a    a'
//!     ╲    ╱            ╲                ╲  ╱
//!   b ─●━━●─ b'      b ──●── b'        b ─●●─ b'
//!                         ╲
//!   no crossing        a crossing      no crossing
//! ```
//!
//! Two lines touch if a node of each is at one position, if a node of one is on the other line, or
//! if they share a stretch. They cross there if one comes from one side of the other and leaves on
//! the other side.

use corniche_geom::{LatticePoint, cross, dot};

use crate::chain_lines::{ChainLine, ChainLines, ChainRay, NextPoint, OnLine, Onward};

/// The maximum number of points of other chains along which lines are followed; no real lines need
/// as many.
const MOST_BEYOND: usize = 4096;

/// The stretch that two lines share where they cross.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Contact {
    /// The segments of both lines at the beginning of the stretch.
    pub segments: [usize; 2],
    /// The start and the end of the stretch along both lines, metres.
    pub along_m: [[f64; 2]; 2],
}

/// A position on both lines.
#[derive(Clone, Copy)]
struct Shared {
    at: LatticePoint,
    on: [OnLine; 2],
}

/// Returns the crossings of two lines at a position: of a shared part that is only this position,
/// and of shared parts that begin here. There is none where the lines do not change sides, where
/// both have the same node, or at the other end of a part. A part ends where one of both chains
/// ends. Whether the lines change sides depends on everything that the chains and their
/// continuations share.
///
/// The number of points visited along other chains is added to `walked`.
pub(crate) fn contacts(
    lines: &ChainLines<'_>,
    both: [&ChainLine; 2],
    (at, on): (LatticePoint, [OnLine; 2]),
    walked: &mut u64,
) -> Vec<Contact> {
    let shared = Shared { at, on };
    if shared.is_joined(both) {
        return Vec::new();
    }
    let [own, others] = shared.rays(lines, both);
    let common: Vec<[&ChainRay; 2]> = own
        .iter()
        .flat_map(|one| others.iter().map(move |other| [one, other]))
        .filter(|[one, other]| is_along(at, one.to, other.to))
        .collect();
    let is_end = [0, 1].iter().any(|&k| both[k].is_end(on[k]));
    let ways_on = match common[..] {
        [] => return Vec::from_iter(crossed_at(both, &shared, [&own, &others])),
        [only] => [None, Some(only)],
        [one, other] if is_end => [Some(one), Some(other)],
        // The position is in the middle of a shared part.
        _ => return Vec::new(),
    };
    let mut walk = |rays: [&ChainRay; 2]| Walk::new(lines, both, &shared).follow(rays, walked);
    let mut found = Vec::new();
    for (forward, backward) in [(ways_on[1], ways_on[0]), (ways_on[0], ways_on[1])] {
        let Some(forward) = forward else { continue };
        let [Onward::Own(one), Onward::Own(other)] = forward.map(|ray| ray.onward) else {
            continue;
        };
        // Each part is found from both of its ends.
        let Some((part, end)) = walk(forward).filter(|(part, _)| part.at > at) else { continue };
        let begin = match backward {
            Some(backward) => walk(backward).map(|(_, end)| end),
            None => Some(End::before(at, forward, [&own, &others])),
        };
        let Some(begin) = begin else { continue };
        let begins = sides(begin.after, |a, b| is_between(begin.at, [begin.before, b], a));
        let ends = sides(end.after, |a, b| is_between(end.at, [b, end.before], a));
        if (begins[0] && ends[1]) || (begins[1] && ends[0]) {
            let segments = [one, other].map(NextPoint::segment);
            let along_m = [0, 1].map(|k| {
                let end_m = both[k].along_of_m(part.segments[k], part.at);
                [both[k].along_of_m(segments[k], at), end_m]
            });
            found.push(Contact { segments, along_m });
        }
    }
    found
}

/// Returns the crossing of two lines that share nothing but one position.
fn crossed_at(
    both: [&ChainLine; 2],
    &Shared { at, on }: &Shared,
    [own, others]: [&[ChainRay]; 2],
) -> Option<Contact> {
    // Where several chains meet, the crossing belongs to the first of them.
    let is_first =
        |line: &ChainLine, rays: &[ChainRay]| rays.iter().all(|ray| line.chain <= ray.chain);
    let is_crossing = is_first(both[0], own)
        && is_first(both[1], others)
        && pairs(others).filter(|[from, to]| !is_along(at, from.to, to.to)).any(|[from, to]| {
            let mut sides = own.iter().map(|ray| is_between(at, [from.to, to.to], ray.to));
            let first = sides.next();
            sides.any(|side| Some(side) != first)
        });
    is_crossing.then(|| {
        let segments = [0, 1].map(|k| both[k].segment_at(on[k]));
        let along_m = [0, 1].map(|k| [both[k].along_of_m(segments[k], at); 2]);
        Contact { segments, along_m }
    })
}

impl Shared {
    fn is_joined(&self, both: [&ChainLine; 2]) -> bool {
        let [own, other] = [0, 1].map(|k| both[k].node(self.on[k]));
        own.is_some() && own == other
    }

    fn rays(&self, lines: &ChainLines<'_>, both: [&ChainLine; 2]) -> [Vec<ChainRay>; 2] {
        [0, 1].map(|k| lines.rays(both[k], self.on[k]))
    }
}

/// The end of a part that two chains share.
struct PartEnd {
    at: LatticePoint,
    /// The segments of both chains that end there.
    segments: [usize; 2],
}

/// The end of everything that two lines share.
struct End {
    at: LatticePoint,
    /// A shared point before the end.
    before: LatticePoint,
    /// The points at which both lines continue.
    after: [Vec<LatticePoint>; 2],
}

impl End {
    /// Returns the end from which two lines continue together along two of the rays that leave it.
    fn before(at: LatticePoint, along: [&ChainRay; 2], leaving: [&[ChainRay]; 2]) -> Self {
        let after = [0, 1].map(|k| {
            let rays = leaving[k].iter().map(|ray| ray.to);
            rays.filter(|&to| !is_along(at, to, along[k].to)).collect()
        });
        Self { at, before: along[0].to, after }
    }
}

/// Follows two lines along the stretch that they share.
struct Walk<'a> {
    lines: &'a ChainLines<'a>,
    both: [&'a ChainLine; 2],
    /// The chains on which the lines continue after they have left their own chain.
    beyond: [Option<ChainLine>; 2],
    before: LatticePoint,
}

impl<'a> Walk<'a> {
    fn new(lines: &'a ChainLines<'a>, both: [&'a ChainLine; 2], from: &Shared) -> Self {
        Self { lines, both, beyond: [None, None], before: from.at }
    }

    fn now(&self) -> [&ChainLine; 2] {
        [0, 1].map(|k| self.beyond[k].as_ref().unwrap_or(self.both[k]))
    }

    /// Returns the end of the part that the first chains share, and the end of the whole shared
    /// stretch. `None` if both have a node in common, if the stretch has no end, or if it is longer
    /// than any real one.
    fn follow(mut self, rays: [&ChainRay; 2], walked: &mut u64) -> Option<(PartEnd, End)> {
        let mut left = MOST_BEYOND;
        let mut next = self.onto(rays, &mut left)?;
        let mut part = None;
        let most = self.both.map(|line| line.points.len()).iter().sum::<usize>() + MOST_BEYOND;
        for _ in 0..most {
            let both = self.now();
            let points = [0, 1].map(|k| both[k].points[next[k].point]);
            // Both points are in the same direction: the nearer one comes first.
            let [own, other] = points.map(|point| square(self.before, point));
            let at = if own <= other { points[0] } else { points[1] };
            let segments = next.map(NextPoint::segment);
            let on = [0, 1].map(|k| {
                if points[k] == at {
                    both[k].at_point(next[k].point)
                } else {
                    OnLine::Segment(segments[k])
                }
            });
            let here = Shared { at, on };
            if here.is_joined(both) {
                return None;
            }
            let onward = here.rays(self.lines, both).map(|mut rays| {
                rays.retain(|ray| !is_along(at, ray.to, self.before));
                rays
            });
            let mut common = onward[0]
                .iter()
                .flat_map(|one| onward[1].iter().map(move |other| [one, other]))
                .filter(|[one, other]| is_along(at, one.to, other.to));
            let Some(rays) = common.next() else {
                let after = onward.map(|rays| rays.into_iter().map(|ray| ray.to).collect());
                let part = part.unwrap_or(PartEnd { at, segments });
                return Some((part, End { at, before: self.before, after }));
            };
            // Distances along a ring do not continue across its beginning, either.
            if [0, 1].iter().any(|&k| both[k].is_end(on[k])) {
                part.get_or_insert(PartEnd { at, segments });
            }
            let before = left;
            next = self.onto(rays, &mut left)?;
            *walked += (before - left) as u64;
            self.before = at;
        }
        None
    }

    /// Returns the next points along two rays, and loads points of other chains.
    fn onto(&mut self, rays: [&ChainRay; 2], left: &mut usize) -> Option<[NextPoint; 2]> {
        let mut next = [NextPoint { point: 0, is_forward: true }; 2];
        for k in 0..2 {
            next[k] = match rays[k].onward {
                Onward::Own(next) => next,
                Onward::Other { is_from_last } => {
                    let line = self.lines.line_within(rays[k].chain, *left)?;
                    *left -= line.points.len();
                    let point = if is_from_last { line.segments() - 1 } else { 1 };
                    self.beyond[k] = Some(line);
                    NextPoint { point, is_forward: !is_from_last }
                }
            };
        }
        Some(next)
    }
}

/// Whether any of the first points is on the right of any of the second, and whether any is on the
/// left.
fn sides(
    [own, others]: [Vec<LatticePoint>; 2],
    is_left: impl Fn(LatticePoint, LatticePoint) -> bool,
) -> [bool; 2] {
    let mut found = [false; 2];
    for &a in &own {
        for &b in &others {
            found[usize::from(is_left(a, b))] = true;
        }
    }
    found
}

/// Whether two points are in the same direction from a position.
fn is_along(at: LatticePoint, one: LatticePoint, other: LatticePoint) -> bool {
    cross(at, one, other) == 0 && dot(at, one, other) > 0
}

/// Whether a point is in the sector that a counterclockwise turn from one direction to another
/// covers. The point is in neither of the two directions.
fn is_between(at: LatticePoint, [from, to]: [LatticePoint; 2], point: LatticePoint) -> bool {
    let is_left = |of: LatticePoint, other: LatticePoint| cross(at, of, other) > 0;
    match cross(at, from, to) {
        0 => is_left(from, point),
        turn if turn > 0 => is_left(from, point) && is_left(point, to),
        _ => !(is_left(to, point) && is_left(point, from)),
    }
}

fn square(at: LatticePoint, to: LatticePoint) -> i128 {
    dot(at, to, to)
}

fn pairs(rays: &[ChainRay]) -> impl Iterator<Item = [&ChainRay; 2]> {
    (1..rays.len()).flat_map(move |k| rays[..k].iter().map(move |one| [one, &rays[k]]))
}

#[cfg(test)]
#[path = "contacts_tests.rs"]
mod tests;
