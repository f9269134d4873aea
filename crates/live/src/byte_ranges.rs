//! Ranges of bytes of a file on a web server: those that were read are kept, and those that lie
//! near each other are fetched as one.

use std::{collections::BTreeMap, rc::Rc};

/// What is kept of what was read.
const CACHE_BYTES: usize = 64 << 20;

/// Where at most this lies between two ranges, it costs less than another request.
const MOST_GAP_BYTES: u64 = 4096;
/// Merged ranges are no longer than this: tiles that come first are decoded while others are on their way.
const MOST_MERGED_BYTES: u64 = 128 << 10;

/// Groups of ranges to fetch at once, as places in `ranges` (first byte, length), by position. A range that is longer than what is merged
/// is a group by itself.
#[must_use]
pub fn merged_ranges(ranges: &[[u64; 2]]) -> Vec<Vec<usize>> {
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

/// Ranges that were read, by their first byte.
#[derive(Default)]
pub struct RangeCache {
    ranges: BTreeMap<u64, (Rc<[u8]>, u64)>,
    bytes: usize,
    clock: u64,
}

impl RangeCache {
    /// What there is of some bytes, from the first of them on; maybe nothing. They may lie in several ranges.
    pub fn get(&mut self, offset: u64, length: usize) -> Vec<u8> {
        let mut found = Vec::new();
        while found.len() < length {
            let more = self.get_in_one(offset + found.len() as u64, length - found.len());
            if more.is_empty() {
                break;
            }
            found.extend(more);
        }
        found
    }

    /// The same, as far as one range has them.
    fn get_in_one(&mut self, offset: u64, length: usize) -> Vec<u8> {
        self.clock += 1;
        let Some((from, (bytes, used))) = self.ranges.range_mut(..=offset).next_back() else {
            return Vec::new();
        };
        let behind = usize::try_from(offset - from).ok().and_then(|at| bytes.get(at..));
        let found = behind.map(|behind| behind[..length.min(behind.len())].to_vec());
        let found = found.unwrap_or_default();
        if !found.is_empty() {
            *used = self.clock;
        }
        found
    }

    /// Keeps bytes that were read, and drops those that were used longest ago where there are too
    /// many.
    pub fn put(&mut self, offset: u64, bytes: Rc<[u8]>) {
        self.clock += 1;
        self.bytes += bytes.len();
        if let Some((old, _)) = self.ranges.insert(offset, (bytes, self.clock)) {
            self.bytes -= old.len();
        }
        while self.bytes > CACHE_BYTES && self.ranges.len() > 1 {
            let Some(oldest) =
                self.ranges.iter().min_by_key(|(_, (_, used))| *used).map(|(at, _)| *at)
            else {
                return;
            };
            if let Some((old, _)) = self.ranges.remove(&oldest) {
                self.bytes -= old.len();
            }
        }
    }
}

#[cfg(test)]
#[path = "byte_ranges_tests.rs"]
mod tests;
