//! The segments of an outline: each once, none crossing another, none with a point of another in its middle.

use corniche_geom::{LatticePoint, Side, cross, dot, side};

use crate::outline::{OutlineError, OutlineWay};

/// Two different points, the smaller first.
pub(crate) type Segment = [LatticePoint; 2];

/// Segments that meet at their ends only.
pub(crate) struct Separated {
    /// The segments in ascending order.
    pub(crate) segments: Vec<Segment>,
    /// How many were there an even number of times; they separate nothing.
    pub(crate) cancelled: u64,
    /// How often a point lay in the middle of a segment, which was then divided there.
    pub(crate) divided: u64,
}

/// Pairs of segments that are compared at most. Real outlines of a million points need a tenth; more would take minutes.
const MOST_COMPARISONS: u64 = 1 << 30;

/// Takes the ways of an outline apart. Fails where segments cross.
pub(crate) fn segments_of(ways: &[OutlineWay<'_>]) -> Result<Separated, OutlineError> {
    let mut all = all_segments(ways);
    let mut cancelled = cancel_pairs(&mut all);
    let Meetings { inner_points, crossings } = meetings_of(&all)?;
    if let Some(&[one, _]) = crossings.first() {
        return Err(OutlineError::Crossing { at: all[one][0] });
    }
    let divided = inner_points.len() as u64;
    if divided > 0 {
        all = divide(&all, inner_points);
        // A part of a segment may lie on another one.
        cancelled += cancel_pairs(&mut all);
    }
    Ok(Separated { segments: all, cancelled, divided })
}

/// How often segments are divided at most; each time brings what crosses together, and a few times are enough.
const MOST_ROUNDS: usize = 32;

/// Takes the ways of an outline apart; where segments cross, both are led through the lattice point that is nearest to the
/// crossing.
///
/// Moved segments may cross others, so this is done until none do. A point moves by half a step at most each time.
///
/// Source: Halperin & Packer 2002, *Iterated Snap Rounding*, Computational Geometry 23; with points that are only as near to the
/// crossing as the lattice allows, and without pulling segments to points that they pass by.
pub(crate) fn uncrossed_segments_of(ways: &[OutlineWay<'_>]) -> Result<Vec<Segment>, OutlineError> {
    let mut all = all_segments(ways);
    for _ in 0..MOST_ROUNDS {
        cancel_pairs(&mut all);
        let Meetings { mut inner_points, crossings } = meetings_of(&all)?;
        for [one, other] in crossings {
            let at = crossing_of(all[one], all[other]);
            let is_new = |&number: &usize| !all[number].contains(&at);
            inner_points.extend([one, other].into_iter().filter(is_new).map(|number| (number, at)));
        }
        if inner_points.is_empty() {
            return Ok(all);
        }
        all = divide(&all, inner_points);
    }
    Err(OutlineError::TooIntricate)
}

fn all_segments(ways: &[OutlineWay<'_>]) -> Vec<Segment> {
    let pairs = ways.iter().flat_map(|way| way.points.array_windows());
    pairs.filter(|[from, to]| from != to).map(|&[a, b]| [a.min(b), a.max(b)]).collect()
}

/// Sorts segments and leaves one of each that is there an odd number of times. Returns how many others there were.
///
/// A segment that two ways share separates the same from the same: two neighbouring outer rings make one area.
fn cancel_pairs(segments: &mut Vec<Segment>) -> u64 {
    segments.sort_unstable();
    let mut kept = Vec::with_capacity(segments.len());
    let mut cancelled = 0;
    for same in segments.chunk_by(|a, b| a == b) {
        if same.len() % 2 == 1 {
            kept.push(same[0]);
        }
        cancelled += u64::from(same.len() > 1);
    }
    *segments = kept;
    cancelled
}

/// Where segments meet beside their ends.
struct Meetings {
    /// Points in the middle of segments, with the number of the segment.
    inner_points: Vec<(usize, LatticePoint)>,
    /// Segments that cross.
    crossings: Vec<[usize; 2]>,
}

fn meetings_of(segments: &[Segment]) -> Result<Meetings, OutlineError> {
    let mut meetings = Meetings { inner_points: Vec::new(), crossings: Vec::new() };
    let mut comparisons = 0;
    for (number, &one) in segments.iter().enumerate() {
        // Segments begin at their western end and are sorted by it, so those that begin east of this one are past it.
        let later = segments[number + 1..].iter().take_while(|other| other[0].u <= one[1].u);
        for (ahead, &other) in later.enumerate() {
            comparisons += 1;
            if comparisons > MOST_COMPARISONS {
                return Err(OutlineError::TooIntricate);
            }
            let other_number = number + 1 + ahead;
            match meeting(one, other) {
                Meeting::Apart => {}
                Meeting::Crossing => meetings.crossings.push([number, other_number]),
                Meeting::Touching => {
                    let inner = |segment: Segment, ends: Segment| {
                        ends.into_iter().filter(move |&end| is_inside(segment, end))
                    };
                    let points = &mut meetings.inner_points;
                    points.extend(inner(one, other).map(|point| (number, point)));
                    points.extend(inner(other, one).map(|point| (other_number, point)));
                }
            }
        }
    }
    // Two segments may end at the same point in the middle of a third.
    meetings.inner_points.sort_unstable();
    meetings.inner_points.dedup();
    Ok(meetings)
}

enum Meeting {
    /// They have no point in common, or an end of both.
    Apart,
    /// An end of one may lie in the middle of the other.
    Touching,
    Crossing,
}

fn meeting(one: Segment, other: Segment) -> Meeting {
    let range_v = |[a, b]: Segment| [a.v.min(b.v), a.v.max(b.v)];
    let ([low, high], [other_low, other_high]) = (range_v(one), range_v(other));
    if high < other_low || other_high < low {
        return Meeting::Apart;
    }
    let sides = |[a, b]: Segment, ends: Segment| ends.map(|end| side(a, b, end));
    let (of_other, of_one) = (sides(one, other), sides(other, one));
    let is_on = |sides: [Side; 2]| sides.contains(&Side::On);
    if is_on(of_other) || is_on(of_one) {
        Meeting::Touching
    } else if of_other[0] != of_other[1] && of_one[0] != of_one[1] {
        Meeting::Crossing
    } else {
        Meeting::Apart
    }
}

/// Whether a point lies on a segment and is none of its ends.
fn is_inside([a, b]: Segment, point: LatticePoint) -> bool {
    // On the line, points are in the order of their coordinates.
    a < point && point < b && side(a, b, point) == Side::On
}

/// The lattice point nearest to where two segments cross.
fn crossing_of([a, b]: Segment, [c, d]: Segment) -> LatticePoint {
    // From a to b it is at the share `from_a / both` of the way: the distances of a and b from the line c d.
    let from_a = cross(c, d, a);
    let both = from_a - cross(c, d, b);
    let along = |a: i64, b: i64| a + round_div(i128::from(b - a) * from_a, both);
    LatticePoint::new(along(a.u, b.u), along(a.v, b.v))
}

/// The whole number nearest to a quotient, halves upwards. Coordinates below 2^40 do not overflow.
fn round_div(dividend: i128, divisor: i128) -> i64 {
    let (dividend, divisor) = (dividend * divisor.signum(), divisor.abs());
    (2 * dividend + divisor).div_euclid(2 * divisor) as i64
}

/// Divides segments at points, which lie on them or near to them, and come in any order.
fn divide(segments: &[Segment], mut points: Vec<(usize, LatticePoint)>) -> Vec<Segment> {
    let along = |&(number, point): &(usize, LatticePoint)| {
        let [a, b] = segments[number];
        dot(a, b, point)
    };
    points.sort_unstable_by_key(|own| (own.0, along(own), own.1));
    points.dedup();
    let mut divided = Vec::with_capacity(segments.len() + points.len());
    let mut points = points.into_iter().peekable();
    for (number, &[a, b]) in segments.iter().enumerate() {
        let mut from = a;
        let mut lead_to = |to: LatticePoint| {
            if from != to {
                divided.push([from.min(to), from.max(to)]);
            }
            from = to;
        };
        while let Some((_, point)) = points.next_if(|(of, _)| *of == number) {
            lead_to(point);
        }
        lead_to(b);
    }
    divided
}
