//! What was made last, within a budget of memory: made by whoever asks first, and shared by all threads.

use std::{
    collections::BTreeMap,
    sync::{Arc, Mutex},
};

use crate::locked;

/// What an entry takes beside what it holds, about.
const ENTRY_BYTES: u64 = 64;

/// Things by key: those that were used last, within a budget.
///
/// One that is asked for by several threads at once is made by the first of them, and the others wait for it. To make one, others of the same store may
/// be asked for, as long as none comes to need itself; it is kept meanwhile. A thing of which something is still in use after it was given away stays
/// in memory until that ends, and no longer counts.
#[derive(Debug)]
pub struct Recent<K, V> {
    budget_bytes: u64,
    kept: Mutex<Kept<K, V>>,
}

/// Where a thing is, once it was made.
type Slot<V> = Arc<Mutex<Option<Arc<V>>>>;

#[derive(Debug)]
struct Entry<V> {
    slot: Slot<V>,
    /// When it was used last.
    used: u64,
    bytes: u64,
}

#[derive(Debug)]
struct Kept<K, V> {
    by_key: BTreeMap<K, Entry<V>>,
    /// The keys by when they were used last.
    by_use: BTreeMap<u64, K>,
    bytes: u64,
    clock: u64,
}

impl<K: Copy + Ord, V> Recent<K, V> {
    /// Keeps nothing yet. Whenever a thing was made, as much goes as `budget_bytes` ask for; but what was asked for last is kept, and what is in use by those
    /// who ask for it or make it.
    #[must_use]
    pub fn new(budget_bytes: u64) -> Self {
        let kept = Kept { by_key: BTreeMap::new(), by_use: BTreeMap::new(), bytes: 0, clock: 0 };
        Self { budget_bytes, kept: Mutex::new(kept) }
    }

    /// The thing of this key. `make` makes it where it is not kept; `bytes_of` tells what it takes.
    ///
    /// # Errors
    /// Those of `make`; then whoever asks next tries again.
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
        // Large things are freed while others may ask.
        drop(gone);
        Ok(new)
    }
}

impl<K: Copy + Ord, V> Kept<K, V> {
    fn slot(&mut self, key: K) -> Slot<V> {
        self.clock += 1;
        let Self { by_key, by_use, bytes, clock } = self;
        let entry = by_key.entry(key).or_insert_with(|| {
            *bytes += ENTRY_BYTES;
            Entry { slot: Slot::default(), used: 0, bytes: ENTRY_BYTES }
        });
        by_use.remove(&entry.used);
        by_use.insert(*clock, key);
        entry.used = *clock;
        Arc::clone(&entry.slot)
    }

    /// Counts what was put in a slot, and gives away what was used longest ago where it is too much.
    fn count(&mut self, key: K, bytes: u64, budget_bytes: u64) -> Vec<Entry<V>> {
        // It was in use while it was made, so it is still there.
        if let Some(entry) = self.by_key.get_mut(&key) {
            entry.bytes += bytes;
            self.bytes += bytes;
        }
        let mut gone = Vec::new();
        for (&used, &other) in &self.by_use {
            if self.bytes <= budget_bytes {
                break;
            }
            // Who makes a thing, or waits for it, holds its slot. Slots are handed out under the lock only.
            let idle = |entry: &&Entry<V>| other != key && Arc::strong_count(&entry.slot) == 1;
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
