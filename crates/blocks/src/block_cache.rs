//! A cache of blocks of files: blocks are fetched once, and read ahead when reads are sequential.

use std::{
    collections::{HashMap, VecDeque},
    ops::Range,
    sync::{Condvar, Mutex, MutexGuard, PoisonError},
};

use bytes::Bytes;

/// A read that begins up to this many blocks after the end of an earlier read continues it: a
/// sequential reader may skip blocks.
const LEAP_BLOCKS: u64 = 1;
/// The number of positions of sequential reads that are remembered, since several threads read at
/// the same time.
const PLACES: usize = 16;

/// The size and number of blocks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct CacheLimits {
    /// Bytes per block; the last block of a file has fewer.
    pub block_bytes: u64,
    /// The largest number of cached bytes; the last fetch is always kept. Fetches in progress are
    /// not included.
    pub kept_bytes: u64,
    /// The largest number of blocks per fetch; with 1, nothing is read ahead.
    pub most_blocks: u64,
}

/// The number of a file, and the number of a block in it.
type BlockId = (u64, u64);

/// The most recently used blocks of some files.
#[derive(Debug)]
pub struct BlockCache {
    limits: CacheLimits,
    state: Mutex<State>,
    /// Notifies waiting threads that a fetch has ended.
    fetched: Condvar,
}

#[derive(Debug, Default)]
struct State {
    blocks: HashMap<BlockId, BlockSlot>,
    kept_bytes: u64,
    clock: u64,
    files: u64,
    /// The ends of fetches and their numbers of blocks, the last one at the back.
    ends: VecDeque<(BlockId, u64)>,
}

#[derive(Debug)]
enum BlockSlot {
    /// A thread is fetching the block.
    Coming,
    Kept {
        bytes: Bytes,
        used: u64,
    },
}

impl BlockCache {
    /// Creates an empty cache.
    #[must_use]
    pub fn new(limits: CacheLimits) -> Self {
        Self { limits, state: Mutex::default(), fetched: Condvar::new() }
    }

    /// Bytes per block. The last block of a file may have fewer.
    #[must_use]
    pub fn block_bytes(&self) -> u64 {
        self.limits.block_bytes
    }

    /// Returns a new number for a file, which distinguishes its blocks from those of other files.
    #[must_use]
    pub fn new_file(&self) -> u64 {
        let mut state = self.state();
        state.files += 1;
        state.files
    }

    /// Returns a block of a file of `count` blocks. `wanted` is the number of blocks from this one
    /// on that will be requested next, at least 1.
    ///
    /// `fetch` gets the bytes of a run of blocks. One thread fetches while others that need the
    /// same blocks wait.
    ///
    /// # Errors
    /// The error of `fetch`.
    pub fn get<E>(
        &self,
        (file, number): BlockId,
        wanted: u64,
        count: u64,
        fetch: impl FnOnce(Range<u64>) -> Result<Bytes, E>,
    ) -> Result<Bytes, E> {
        let mut state = self.state();
        while let Some(BlockSlot::Coming) = state.blocks.get(&(file, number)) {
            state = self.fetched.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
        state.clock += 1;
        let now = state.clock;
        if let Some(BlockSlot::Kept { bytes, used }) = state.blocks.get_mut(&(file, number)) {
            *used = now;
            return Ok(bytes.clone());
        }
        let run = state.run((file, number), wanted, count, self.limits.most_blocks);
        for block in run.clone() {
            state.blocks.insert((file, block), BlockSlot::Coming);
        }
        drop(state);
        // Whatever happens, even a panic, other threads must not wait forever.
        let mut coming = Coming { blocks: self, file, run: run.clone(), bytes: None };
        let bytes = fetch(run)?;
        let first = bytes.slice(..bytes.len().min(self.limits.block_bytes as usize));
        coming.bytes = Some(bytes);
        drop(coming);
        Ok(first)
    }

    /// Fills `bytes` from the position `offset` of a file of `length` bytes; the file must contain
    /// all of them. `fetch` gets runs of bytes of whole blocks.
    ///
    /// # Errors
    /// The error of `fetch`.
    pub fn read<E>(
        &self,
        (file, length): (u64, u64),
        mut bytes: &mut [u8],
        mut offset: u64,
        fetch: impl Fn(Range<u64>) -> Result<Bytes, E>,
    ) -> Result<(), E> {
        let block_bytes = self.limits.block_bytes;
        let count = length.div_ceil(block_bytes);
        while !bytes.is_empty() {
            let number = offset / block_bytes;
            let wanted = (offset + bytes.len() as u64).div_ceil(block_bytes) - number;
            let block = self.get((file, number), wanted, count, |run| {
                fetch(run.start * block_bytes..length.min(run.end * block_bytes))
            })?;
            let inside = &block[(offset - number * block_bytes) as usize..];
            let (now, later) = bytes.split_at_mut(inside.len().min(bytes.len()));
            now.copy_from_slice(&inside[..now.len()]);
            offset += now.len() as u64;
            bytes = later;
        }
        Ok(())
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Stores fetched blocks, or removes the marks of a failed fetch.
    fn arrived(&self, file: u64, run: &Range<u64>, bytes: Option<&Bytes>) {
        let block_bytes = self.limits.block_bytes as usize;
        let mut state = self.state();
        for (k, number) in run.clone().enumerate() {
            let rest = bytes.and_then(|bytes| Some((bytes, bytes.get(k * block_bytes..)?)));
            match rest {
                Some((bytes, rest)) => {
                    // A separate copy per block, so that memory is freed block by block.
                    let bytes = match run.end - run.start {
                        1 => bytes.slice(..bytes.len().min(block_bytes)),
                        _ => Bytes::copy_from_slice(&rest[..rest.len().min(block_bytes)]),
                    };
                    let used = state.clock;
                    state.kept_bytes += bytes.len() as u64;
                    state.blocks.insert((file, number), BlockSlot::Kept { bytes, used });
                }
                None => drop(state.blocks.remove(&(file, number))),
            }
        }
        if bytes.is_some() {
            state.ends.push_back(((file, run.end), run.end - run.start));
            if state.ends.len() > PLACES {
                state.ends.pop_front();
            }
        }
        state.forget(self.limits.kept_bytes, file, run);
        drop(state);
        self.fetched.notify_all();
    }
}

impl State {
    /// The blocks to fetch when one is missing: the requested ones, and for sequential reads twice
    /// as many as before. A run ends before a block that is cached or being fetched.
    fn run(&mut self, (file, number): BlockId, wanted: u64, count: u64, most: u64) -> Range<u64> {
        let follows = |&((of, end), _): &(BlockId, u64)| {
            of == file && (end..=end + LEAP_BLOCKS).contains(&number)
        };
        let before = self.ends.iter().rposition(follows).and_then(|at| self.ends.remove(at));
        let ahead = before.map_or(1, |(_, blocks)| 2 * blocks);
        let end = (number + wanted.max(ahead).clamp(1, most)).min(count).max(number + 1);
        let known = (number + 1..end).find(|&block| self.blocks.contains_key(&(file, block)));
        number..known.unwrap_or(end)
    }

    /// Drops the least recently used blocks above the limit, but none of the last run.
    fn forget(&mut self, limit_bytes: u64, file: u64, run: &Range<u64>) {
        while self.kept_bytes > limit_bytes {
            let kept = self.blocks.iter().filter_map(|(&id, block)| match block {
                BlockSlot::Kept { used, .. } if id.0 != file || !run.contains(&id.1) => {
                    Some((*used, id))
                }
                BlockSlot::Kept { .. } | BlockSlot::Coming => None,
            });
            let Some((_, oldest)) = kept.min() else { return };
            if let Some(BlockSlot::Kept { bytes, .. }) = self.blocks.remove(&oldest) {
                self.kept_bytes -= bytes.len() as u64;
            }
        }
    }
}

/// A run that is being fetched.
struct Coming<'a> {
    blocks: &'a BlockCache,
    file: u64,
    run: Range<u64>,
    bytes: Option<Bytes>,
}

impl Drop for Coming<'_> {
    fn drop(&mut self) {
        self.blocks.arrived(self.file, &self.run, self.bytes.as_ref());
    }
}

#[cfg(test)]
#[path = "block_cache_tests.rs"]
mod tests;
