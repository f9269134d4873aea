//! The segments of an outline: each occurs once, none crosses another, and none contains a point of
//! another in its middle.

use corniche_geom::{LatticePoint, Side, cross, dot, side};

use crate::outline::OutlineError;

/// Two different points, the smaller first.
pub(crate) type OrderedSegment = [LatticePoint; 2];

/// Segments that meet only at their ends.
pub(crate) struct Separated {
    /// The segments in ascending order.
    pub segments: Vec<OrderedSegment>,
    /// The number of segments that occurred an even number of times; they separate nothing.
    pub cancelled: u64,
    /// The number of points that were in the middle of a segment, which was then divided there.
    pub divided: u64,
}

/// The maximum number of segment pairs to compare. Real outlines of a million points need a tenth
/// of it; more would take minutes.
const MOST_COMPARISONS: u64 = 1 << 30;

/// Splits the ways of an outline into segments. Fails if segments cross.
pub(crate) fn segments_of(ways: &[impl AsRef<[LatticePoint]>]) -> Result<Separated, OutlineError> {
    let mut all = all_segments(ways);
    let mut cancelled = cancel_pairs(&mut all);
    let Meetings { inner_points, crossings } = meetings_of(&all)?;
    if let Some(&[one, _]) = crossings.first() {
        return Err(OutlineError::Crossing { at: all[one][0] });
    }
    let divided = inner_points.len() as u64;
    if divided > 0 {
        all = divide(&all, inner_points);
        // A part of a segment may be on another segment.
        cancelled += cancel_pairs(&mut all);
    }
    Ok(Separated { segments: all, cancelled, divided })
}

/// The maximum number of rounds in which segments are divided. Each round brings crossing segments
/// together, and a few rounds are enough.
const MOST_ROUNDS: usize = 32;

/// Splits the ways of an outline into segments. Where segments cross, both are routed through the
/// lattice point nearest to the crossing.
///
/// Moved segments may cross others, so this is repeated until none do. A point moves by at most
/// half a step each time.
///
/// Source: Halperin & Packer 2002, *Iterated Snap Rounding*, Computational Geometry 23. Here,
/// points are only as near to the crossing as the lattice allows, and segments are not pulled to
/// points that they pass.
pub(crate) fn uncrossed_segments_of(
    ways: &[impl AsRef<[LatticePoint]>],
) -> Result<Vec<OrderedSegment>, OutlineError> {
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

fn all_segments(ways: &[impl AsRef<[LatticePoint]>]) -> Vec<OrderedSegment> {
    let pairs = ways.iter().flat_map(|way| way.as_ref().array_windows());
    pairs.filter(|[from, to]| from != to).map(|&[a, b]| [a.min(b), a.max(b)]).collect()
}

/// Sorts segments, and keeps one of each that occurs an odd number of times. Returns the number of
/// the others.
///
/// A segment that two ways share has the same area on both sides: two neighbouring outer rings make
/// one area.
fn cancel_pairs(segments: &mut Vec<OrderedSegment>) -> u64 {
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

/// The places where segments meet other than at their ends.
struct Meetings {
    /// Points in the middle of segments, each with the number of the segment.
    inner_points: Vec<(usize, LatticePoint)>,
    /// Segments that cross.
    crossings: Vec<[usize; 2]>,
}

fn meetings_of(segments: &[OrderedSegment]) -> Result<Meetings, OutlineError> {
    let mut meetings = Meetings { inner_points: Vec::new(), crossings: Vec::new() };
    let mut comparisons = 0;
    for (number, &one) in segments.iter().enumerate() {
        // Segments begin at their western end and are sorted by it, so segments that begin east of
        // the end of this one cannot meet it.
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
                    let inner = |segment: OrderedSegment, ends: OrderedSegment| {
                        ends.into_iter().filter(move |&end| is_inside(segment, end))
                    };
                    let points = &mut meetings.inner_points;
                    points.extend(inner(one, other).map(|point| (number, point)));
                    points.extend(inner(other, one).map(|point| (other_number, point)));
                }
            }
        }
    }
    // Two segments may end at the same point in the middle of a third segment.
    meetings.inner_points.sort_unstable();
    meetings.inner_points.dedup();
    Ok(meetings)
}

enum Meeting {
    /// They have no point in common, or only a common end.
    Apart,
    /// An end of one may be in the middle of the other.
    Touching,
    Crossing,
}

fn meeting(one: OrderedSegment, other: OrderedSegment) -> Meeting {
    let range_v = |[a, b]: OrderedSegment| [a.v.min(b.v), a.v.max(b.v)];
    let ([low, high], [other_low, other_high]) = (range_v(one), range_v(other));
    if high < other_low || other_high < low {
        return Meeting::Apart;
    }
    let sides = |[a, b]: OrderedSegment, ends: OrderedSegment| ends.map(|end| side(a, b, end));
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

/// Whether a point is on a segment and is not one of its ends.
fn is_inside([a, b]: OrderedSegment, point: LatticePoint) -> bool {
    // On a line, points are in the order of their coordinates.
    a < point && point < b && side(a, b, point) == Side::On
}

/// Returns the lattice point nearest to the crossing of two segments.
fn crossing_of([a, b]: OrderedSegment, [c, d]: OrderedSegment) -> LatticePoint {
    // Measured from a to b, the crossing is at the fraction `from_a / both`: the distances of a and
    // b from the line c d.
    let from_a = cross(c, d, a);
    let both = from_a - cross(c, d, b);
    let along = |a: i64, b: i64| a + round_div(i128::from(b - a) * from_a, both);
    LatticePoint::new(along(a.u, b.u), along(a.v, b.v))
}

/// Returns the integer nearest to a quotient, with halves rounded upwards. Coordinates below 2^40
/// do not overflow.
fn round_div(dividend: i128, divisor: i128) -> i64 {
    let (dividend, divisor) = (dividend * divisor.signum(), divisor.abs());
    (2 * dividend + divisor).div_euclid(2 * divisor) as i64
}

/// Divides segments at points, which are on the segments or near them, in any order.
fn divide(
    segments: &[OrderedSegment],
    mut points: Vec<(usize, LatticePoint)>,
) -> Vec<OrderedSegment> {
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
