//! The segments of an outline: each once, none crossing another, none with a point of another in its middle.

use corniche_geom::{LatticePoint, Side, side};

use crate::assemble::{OutlineError, OutlineWay};

/// Two different points, the smaller first.
pub(crate) type Segment = [LatticePoint; 2];

/// Segments that meet at their ends only.
pub(crate) struct Separated {
    /// In ascending order.
    pub(crate) segments: Vec<Segment>,
    /// How many were there an even number of times; they separate nothing.
    pub(crate) cancelled: u64,
    /// How often a point lay in the middle of a segment, which was then divided there.
    pub(crate) divided: u64,
}

/// Pairs of segments that are compared at most. Real outlines of a million points need a tenth; more would take minutes.
const MOST_COMPARISONS: u64 = 1 << 30;

/// Takes the ways of an outline apart.
pub(crate) fn segments_of(ways: &[OutlineWay<'_>]) -> Result<Separated, OutlineError> {
    let mut all = Vec::new();
    for way in ways {
        let pairs = way.points.array_windows();
        all.extend(pairs.filter(|[from, to]| from != to).map(|&[a, b]| [a.min(b), a.max(b)]));
    }
    let mut cancelled = cancel_pairs(&mut all);
    let touches = touches_of(&all)?;
    let divided = touches.len() as u64;
    if divided > 0 {
        all = divide(&all, touches);
        // A part of a segment may lie on another one.
        cancelled += cancel_pairs(&mut all);
    }
    Ok(Separated { segments: all, cancelled, divided })
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

/// The points in the middle of segments, with the number of the segment; fails at the first pair that crosses.
fn touches_of(segments: &[Segment]) -> Result<Vec<(usize, LatticePoint)>, OutlineError> {
    let mut touches = Vec::new();
    let mut comparisons = 0;
    for (number, &one) in segments.iter().enumerate() {
        // Segments begin at their western end and are sorted by it, so those that begin east of this one are past it.
        let later = segments[number + 1..].iter().take_while(|other| other[0].u <= one[1].u);
        for (ahead, &other) in later.enumerate() {
            comparisons += 1;
            if comparisons > MOST_COMPARISONS {
                return Err(OutlineError::TooIntricate);
            }
            match meeting(one, other) {
                Meeting::Apart => {}
                Meeting::Crossing => return Err(OutlineError::Crossing { at: one[0] }),
                Meeting::Touching => {
                    let other_number = number + 1 + ahead;
                    let inner = |segment: Segment, ends: Segment| {
                        ends.into_iter().filter(move |&end| is_inside(segment, end))
                    };
                    touches.extend(inner(one, other).map(|point| (number, point)));
                    touches.extend(inner(other, one).map(|point| (other_number, point)));
                }
            }
        }
    }
    touches.sort_unstable();
    touches.dedup();
    Ok(touches)
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

/// Divides segments at points in their middle, which come in the order of segments and then of points.
fn divide(segments: &[Segment], touches: Vec<(usize, LatticePoint)>) -> Vec<Segment> {
    let mut divided = Vec::with_capacity(segments.len() + touches.len());
    let mut touches = touches.into_iter().peekable();
    for (number, &[a, b]) in segments.iter().enumerate() {
        let mut from = a;
        while let Some((_, point)) = touches.next_if(|(of, _)| *of == number) {
            divided.push([from, point]);
            from = point;
        }
        divided.push([from, b]);
    }
    divided
}
