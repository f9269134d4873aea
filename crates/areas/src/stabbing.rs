//! Finds which of many intervals contain a number.

/// Intervals `[low, high)`, sorted by `low`, as a balanced tree in one list. The middle of a range
/// is the root of the parts left and right of it, and stores the largest `high` of the whole range.
///
/// Source: Cormen, Leiserson, Rivest & Stein, *Introduction to Algorithms* (2009), section 14.3,
/// interval trees.
pub(crate) struct Stabbing {
    intervals: Vec<Interval>,
}

struct Interval {
    low: i64,
    high: i64,
    /// The largest end of an interval in the range whose middle this is.
    largest_high: i64,
    item: usize,
}

impl Stabbing {
    /// Creates the tree from intervals `[low, high)`; items are identified by their position in the
    /// list. Empty intervals are omitted.
    pub(crate) fn new(intervals: impl Iterator<Item = [i64; 2]>) -> Self {
        let mut intervals: Vec<Interval> = intervals
            .enumerate()
            .filter(|(_, [low, high])| low < high)
            .map(|(item, [low, high])| Interval { low, high, largest_high: high, item })
            .collect();
        intervals.sort_unstable_by_key(|interval| (interval.low, interval.item));
        note_largest(&mut intervals);
        Self { intervals }
    }

    /// Calls `take` with each item whose interval contains `number`.
    pub(crate) fn at(&self, number: i64, take: &mut impl FnMut(usize)) {
        visit(&self.intervals, number, take);
    }
}

/// The depth of the recursion is the logarithm of the length.
fn note_largest(intervals: &mut [Interval]) -> i64 {
    let middle = intervals.len() / 2;
    let (left, rest) = intervals.split_at_mut(middle);
    let Some((root, right)) = rest.split_first_mut() else { return i64::MIN };
    root.largest_high = root.high.max(note_largest(left)).max(note_largest(right));
    root.largest_high
}

fn visit(intervals: &[Interval], number: i64, take: &mut impl FnMut(usize)) {
    let (left, rest) = intervals.split_at(intervals.len() / 2);
    let Some((root, right)) = rest.split_first() else { return };
    if number >= root.largest_high {
        return;
    }
    visit(left, number, take);
    if root.low <= number {
        if number < root.high {
            take(root.item);
        }
        visit(right, number, take);
    }
}

#[cfg(test)]
#[path = "stabbing_tests.rs"]
mod tests;
