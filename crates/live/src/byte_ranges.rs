//! Byte ranges of a file on a web server: ranges that were read are cached, and neighbouring ranges
//! are fetched in one request.

use std::{collections::BTreeMap, rc::Rc};

/// The capacity of the cache of ranges.
const CACHE_BYTES: usize = 64 << 20;

/// A gap between two ranges up to this length costs less than another request.
const MOST_GAP_BYTES: u64 = 4096;
/// Merged ranges are no longer than this, so that the first tiles are decoded while others are
/// still loading.
const MOST_MERGED_BYTES: u64 = 128 << 10;

/// Groups the ranges to fetch in one request, as indices into `ranges` (first byte, length), sorted
/// by position. A range longer than the limit for merged ranges is a group by itself.
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

/// A cache of ranges that were read, by their first byte.
#[derive(Default)]
pub struct RangeCache {
    ranges: BTreeMap<u64, (Rc<[u8]>, u64)>,
    bytes: usize,
    clock: u64,
}

impl RangeCache {
    /// Returns the cached bytes from `offset` on, up to the first gap; may be empty. The bytes may
    /// come from several ranges.
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

    /// Returns the same bytes, but only as far as one range has them.
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

    /// Stores bytes that were read, and drops the least recently used ranges when the cache is
    /// full.
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
