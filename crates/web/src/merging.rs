//! Ranges that are asked for at the same time and lie near each other are fetched as one.

/// Where at most this lies between two ranges, it costs less than another request.
const MOST_GAP_BYTES: u64 = 4096;
/// Merged ranges are no longer than this: tiles that come first are decoded while others are on their way.
const MOST_MERGED_BYTES: u64 = 128 << 10;

/// Groups of ranges to fetch at once, as places in `ranges` (first byte, length), by position. A range that is longer than what is merged
/// is a group by itself.
#[must_use]
pub(crate) fn merged(ranges: &[[u64; 2]]) -> Vec<Vec<usize>> {
    let mut order: Vec<usize> = (0..ranges.len()).collect();
    order.sort_by_key(|place| ranges[*place]);
    let mut groups: Vec<(u64, u64, Vec<usize>)> = Vec::new();
    for place in order {
        let [first, length] = ranges[place];
        let end = first.saturating_add(length);
        match groups.last_mut() {
            Some((from, to, group))
                if first <= to.saturating_add(MOST_GAP_BYTES)
                    && end.max(*to) - *from <= MOST_MERGED_BYTES =>
            {
                *to = end.max(*to);
                group.push(place);
            }
            _ => groups.push((first, end, vec![place])),
        }
    }
    groups.into_iter().map(|(.., group)| group).collect()
}

#[cfg(test)]
#[path = "merging_tests.rs"]
mod tests;
