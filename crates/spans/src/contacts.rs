//! Whether lines that touch, or lie on each other for a while, change sides there.
//!
//! ```text
//!    a      a'         a                a    a'        A node of each at one place, a node of one on the other line, or a stretch
//!     ╲    ╱            ╲                ╲  ╱          that both share: they cross where one comes from one side of the other
//!   b ─●━━●─ b'      b ──●── b'        b ─●●─ b'       and leaves on the other side.
//!                         ╲
//!   no crossing        a crossing      no crossing
//! ```

use corniche_geom::{LatticePoint, cross, dot};

use crate::chain_lines::{ChainLine, ChainLines, Next, OnLine, Onward, Ray};

/// Points of other chains along which lines are followed; no real ones have as many.
const MOST_BEYOND: usize = 4096;

/// What two lines have in common where they cross.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Contact {
    /// The segments of both at its beginning.
    pub(crate) segments: [usize; 2],
    /// From where to where it is along both, metres.
    pub(crate) along_m: [[f64; 2]; 2],
}

/// A place on both lines.
#[derive(Clone, Copy)]
struct Shared {
    at: LatticePoint,
    on: [OnLine; 2],
}

/// The crossings of two lines at a place: that of a part in common that is only this place, and those of parts that begin here. None where they do not
/// change sides, where both have the same node, and from the other end of a part. A part ends where one of both chains does; they change sides along all
/// that they and the chains after them have in common.
///
/// What is walked along other chains is added to `walked`.
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
    let common: Vec<[&Ray; 2]> = own
        .iter()
        .flat_map(|one| others.iter().map(move |other| [one, other]))
        .filter(|[one, other]| is_along(at, one.to, other.to))
        .collect();
    let is_end = [0, 1].iter().any(|&k| both[k].is_end(on[k]));
    let ways_on = match common[..] {
        [] => return Vec::from_iter(crossed_at(both, &shared, [&own, &others])),
        [only] => [None, Some(only)],
        [one, other] if is_end => [Some(one), Some(other)],
        // In the middle of it.
        _ => return Vec::new(),
    };
    let mut walk = |rays: [&Ray; 2]| Walk::new(lines, both, &shared).follow(rays, walked);
    let mut found = Vec::new();
    for (forward, backward) in [(ways_on[1], ways_on[0]), (ways_on[0], ways_on[1])] {
        let Some(forward) = forward else { continue };
        let [Onward::Own(one), Onward::Own(other)] = forward.map(|ray| ray.onward) else {
            continue;
        };
        // Each is found from both of its ends.
        let Some((part, end)) = walk(forward).filter(|(part, _)| part.at > at) else { continue };
        let begin = match backward {
            Some(backward) => walk(backward).map(|(_, end)| end),
            None => Some(End::before(at, forward, [&own, &others])),
        };
        let Some(begin) = begin else { continue };
        let begins = sides(begin.after, |a, b| is_between(begin.at, [begin.before, b], a));
        let ends = sides(end.after, |a, b| is_between(end.at, [b, end.before], a));
        if (begins[0] && ends[1]) || (begins[1] && ends[0]) {
            let segments = [one, other].map(Next::segment);
            let along_m = [0, 1].map(|k| {
                let end_m = both[k].along_of_m(part.segments[k], part.at);
                [both[k].along_of_m(segments[k], at), end_m]
            });
            found.push(Contact { segments, along_m });
        }
    }
    found
}

/// The crossing of two lines that have nothing in common but a place.
fn crossed_at(
    both: [&ChainLine; 2],
    &Shared { at, on }: &Shared,
    [own, others]: [&[Ray]; 2],
) -> Option<Contact> {
    // Where several chains meet, the first of them has the crossing.
    let is_first = |line: &ChainLine, rays: &[Ray]| rays.iter().all(|ray| line.chain <= ray.chain);
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

    fn rays(&self, lines: &ChainLines<'_>, both: [&ChainLine; 2]) -> [Vec<Ray>; 2] {
        [0, 1].map(|k| lines.rays(both[k], self.on[k]))
    }
}

/// Where a part in common of two chains ends.
struct PartEnd {
    at: LatticePoint,
    /// The segments of both that end there.
    segments: [usize; 2],
}

/// Where all that lines have in common ends.
struct End {
    at: LatticePoint,
    /// A point of it before its end.
    before: LatticePoint,
    /// Where both lines go on.
    after: [Vec<LatticePoint>; 2],
}

impl End {
    /// The one from which two lines go on in common along two rays of those that leave.
    fn before(at: LatticePoint, along: [&Ray; 2], leaving: [&[Ray]; 2]) -> Self {
        let after = [0, 1].map(|k| {
            let rays = leaving[k].iter().map(|ray| ray.to);
            rays.filter(|&to| !is_along(at, to, along[k].to)).collect()
        });
        Self { at, before: along[0].to, after }
    }
}

/// Follows two lines along what they have in common.
struct Walk<'a> {
    lines: &'a ChainLines<'a>,
    both: [&'a ChainLine; 2],
    /// The chains on which they go on, once they have left their own.
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

    /// Where the part of the first chains ends, and where all does. `None` where both have a node in common, where it has no end, and where it is longer than
    /// any real one.
    fn follow(mut self, rays: [&Ray; 2], walked: &mut u64) -> Option<(PartEnd, End)> {
        let mut left = MOST_BEYOND;
        let mut next = self.onto(rays, &mut left)?;
        let mut part = None;
        let most = self.both.map(|line| line.points.len()).iter().sum::<usize>() + MOST_BEYOND;
        for _ in 0..most {
            let both = self.now();
            let points = [0, 1].map(|k| both[k].points[next[k].point]);
            // Both lie in the same direction: the nearer one comes first.
            let [own, other] = points.map(|point| square(self.before, point));
            let at = if own <= other { points[0] } else { points[1] };
            let segments = next.map(Next::segment);
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
            // Distances along a ring do not go on at its beginning, either.
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

    /// The next points along two rays. Takes what other chains have of points.
    fn onto(&mut self, rays: [&Ray; 2], left: &mut usize) -> Option<[Next; 2]> {
        let mut next = [Next { point: 0, is_forward: true }; 2];
        for k in 0..2 {
            next[k] = match rays[k].onward {
                Onward::Own(next) => next,
                Onward::Other { is_from_last } => {
                    let line = self.lines.line_within(rays[k].chain, *left)?;
                    *left -= line.points.len();
                    let point = if is_from_last { line.segments() - 1 } else { 1 };
                    self.beyond[k] = Some(line);
                    Next { point, is_forward: !is_from_last }
                }
            };
        }
        Some(next)
    }
}

/// Whether some line of the first is on the right of some of the second, and whether some is on the left.
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

/// Whether two points lie in the same direction from a place.
fn is_along(at: LatticePoint, one: LatticePoint, other: LatticePoint) -> bool {
    cross(at, one, other) == 0 && dot(at, one, other) > 0
}

/// Whether a point lies in the sector that one turns through counterclockwise from a direction to another one. It lies in neither of them.
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

fn pairs(rays: &[Ray]) -> impl Iterator<Item = [&Ray; 2]> {
    (1..rays.len()).flat_map(move |k| rays[..k].iter().map(move |one| [one, &rays[k]]))
}

#[cfg(test)]
#[path = "contacts_tests.rs"]
mod tests;
