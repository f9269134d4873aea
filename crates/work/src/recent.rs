//! A cache of recently used values with a memory budget: the first thread that requests a value
//! computes it, and all threads share it.

use std::{
    collections::BTreeMap,
    sync::{Arc, Mutex},
};

use crate::locked;

/// The approximate overhead of an entry in bytes, beyond its value.
const ENTRY_BYTES: u64 = 64;

/// A cache of the most recently used values by key, within a memory budget.
///
/// Concurrent requests for one key compute the value once; the other threads wait. Computing a
/// value may request other keys of the same cache, but not in a cycle (deadlock); the value is kept
/// meanwhile. A value that is still in use after its eviction stays in memory until its last use,
/// and no longer counts.
#[derive(Debug)]
pub struct Recent<K, V> {
    budget_bytes: u64,
    kept: Mutex<CacheState<K, V>>,
}

/// The slot of a value, empty until it is computed.
type Slot<V> = Arc<Mutex<Option<Arc<V>>>>;

#[derive(Debug)]
struct CacheEntry<V> {
    slot: Slot<V>,
    /// The time of the last use.
    used: u64,
    bytes: u64,
}

#[derive(Debug)]
struct CacheState<K, V> {
    by_key: BTreeMap<K, CacheEntry<V>>,
    /// The keys, ordered by the time of their last use.
    by_use: BTreeMap<u64, K>,
    bytes: u64,
    clock: u64,
}

impl<K: Copy + Ord, V> Recent<K, V> {
    /// Creates an empty cache. After each computation, values are evicted until the rest fits
    /// `budget_bytes`; the value requested last and values that are being requested or computed are
    /// kept.
    #[must_use]
    pub fn new(budget_bytes: u64) -> Self {
        let kept =
            CacheState { by_key: BTreeMap::new(), by_use: BTreeMap::new(), bytes: 0, clock: 0 };
        Self { budget_bytes, kept: Mutex::new(kept) }
    }

    /// Returns the value of this key. `make` computes it if it is not cached; `bytes_of` returns
    /// its size.
    ///
    /// # Errors
    /// The errors of `make`; then the next request tries again.
    pub fn get<E>(
        &self,
        key: K,
        make: impl FnOnce() -> Result<V, E>,
        bytes_of: impl FnOnce(&V) -> u64,
    ) -> Result<Arc<V>, E> {
        let slot = locked(&self.kept).slot(key);
        let mut made = locked(&slot);
        if let Some(known) = &*made {
            return Ok(Arc::clone(known));
        }
        let new = Arc::new(make()?);
        *made = Some(Arc::clone(&new));
        drop(made);
        let gone = locked(&self.kept).count(key, bytes_of(&new), self.budget_bytes);
        // Large values are freed outside the lock.
        drop(gone);
        Ok(new)
    }
}

impl<K: Copy + Ord, V> CacheState<K, V> {
    fn slot(&mut self, key: K) -> Slot<V> {
        self.clock += 1;
        let Self { by_key, by_use, bytes, clock } = self;
        let entry = by_key.entry(key).or_insert_with(|| {
            *bytes += ENTRY_BYTES;
            CacheEntry { slot: Slot::default(), used: 0, bytes: ENTRY_BYTES }
        });
        by_use.remove(&entry.used);
        by_use.insert(*clock, key);
        entry.used = *clock;
        Arc::clone(&entry.slot)
    }

    /// Counts the value in a slot, and evicts the least recently used values above the budget.
    fn count(&mut self, key: K, bytes: u64, budget_bytes: u64) -> Vec<CacheEntry<V>> {
        // The entry was in use during the computation, so it still exists.
        if let Some(entry) = self.by_key.get_mut(&key) {
            entry.bytes += bytes;
            self.bytes += bytes;
        }
        let mut gone = Vec::new();
        for (&used, &other) in &self.by_use {
            if self.bytes <= budget_bytes {
                break;
            }
            // A thread that computes a value or waits for it holds its slot. Slots are handed out
            // under the lock only.
            let idle = |entry: &&CacheEntry<V>| other != key && Arc::strong_count(&entry.slot) == 1;
            if let Some(entry) = self.by_key.get(&other).filter(idle) {
                self.bytes -= entry.bytes;
                gone.push((used, other));
            }
        }
        let given = |(used, other)| {
            self.by_use.remove(&used);
            self.by_key.remove(&other)
        };
        gone.into_iter().filter_map(given).collect()
    }
}

#[cfg(test)]
#[path = "recent_tests.rs"]
mod tests;
