//! An index of ids for searches in no particular order: a table says where in the list the ids of
//! each range begin.

/// Sorted ids, and the position in the list at which each of many equal ranges begins.
///
/// ```text
///  starts   0 ─────── 3 3 ─── 5 …
///  ids      7 8 9    │ │21 22│ …      the range of an id by a shift, the id among the few of its range by bisection
/// ```
pub(crate) struct IdIndex<'i> {
    ids: &'i [i64],
    least: i64,
    shift: u32,
    /// The start of each range, and one more entry for the end.
    starts: Vec<usize>,
}

/// The number of ids per range. The table then takes one byte per id, and stays in the processor's
/// cache if a region has a million ids.
const IDS_PER_RANGE: usize = 8;

impl<'i> IdIndex<'i> {
    /// Creates an index of `ids`, which ascend without duplicates.
    pub(crate) fn new(ids: &'i [i64]) -> Self {
        let (least, most) = (ids.first().copied().unwrap_or(0), ids.last().copied().unwrap_or(0));
        let span = most.wrapping_sub(least).cast_unsigned();
        let ranges_bits = (ids.len() / IDS_PER_RANGE).max(1).ilog2();
        let span_bits = u64::BITS - span.leading_zeros();
        let shift = span_bits.saturating_sub(ranges_bits);
        let range_of = |id: i64| range_of(id, least, shift);
        let mut starts = Vec::with_capacity(range_of(most) + 2);
        for (number, &id) in ids.iter().enumerate() {
            while starts.len() <= range_of(id) {
                starts.push(number);
            }
        }
        starts.push(ids.len());
        Self { ids, least, shift, starts }
    }

    /// Returns the index of an id. `after` is the index that was found last, because the next id
    /// mostly follows it.
    pub(crate) fn find(&self, id: i64, after: usize) -> Option<usize> {
        if self.ids.get(after + 1) == Some(&id) {
            return Some(after + 1);
        }
        let range = range_of(id, self.least, self.shift);
        let (&start, &end) = (self.starts.get(range)?, self.starts.get(range.checked_add(1)?)?);
        self.ids[start..end].binary_search(&id).ok().map(|place| start + place)
    }
}

/// Returns the range of an id. An id below the smallest one is treated as larger than all others.
fn range_of(id: i64, least: i64, shift: u32) -> usize {
    // Ids at both ends of the number range may need all 64 bits.
    id.wrapping_sub(least).cast_unsigned().checked_shr(shift).unwrap_or(0) as usize
}

#[cfg(test)]
#[path = "id_index_tests.rs"]
mod tests;
