//! Blocks of a file: kept, fetched once, and read ahead where reads follow each other.

use std::{
    collections::{HashMap, VecDeque},
    ops::Range,
    sync::{Condvar, Mutex, MutexGuard, PoisonError},
};

use bytes::Bytes;

/// Bytes of a block; the last one of a file has fewer.
///
/// The first one holds header, root directory and manifest of most packages, so one request opens them. In the packages that were measured
/// a tile has 10 to 350 kB. With smaller blocks a picture takes more requests, with larger ones more bytes (`docs/lab/remote.md`).
pub(crate) const BLOCK_BYTES: u64 = 64 << 10;
/// The most blocks of one request: 4 MiB, a second at 32 Mbit/s.
const MOST_BLOCKS: u64 = 64;
/// So many blocks are kept: 64 MiB.
const KEPT_BLOCKS: usize = 1024;
/// A read that begins so many blocks behind an earlier one goes on with it: tiles that nobody asks for may lie between.
const LEAP_BLOCKS: u64 = 1;
/// So many places where reads went on are remembered: threads read side by side.
const PLACES: usize = 16;

/// The blocks of one file.
#[derive(Debug, Default)]
pub(crate) struct Blocks {
    state: Mutex<State>,
    /// A fetch ended.
    fetched: Condvar,
}

#[derive(Debug, Default)]
struct State {
    blocks: HashMap<u64, Block>,
    clock: u64,
    /// Where fetches ended, and how many blocks they had; the last one at the back.
    ends: VecDeque<(u64, u64)>,
}

#[derive(Debug)]
enum Block {
    /// A thread fetches it.
    Coming,
    Kept {
        bytes: Bytes,
        used: u64,
    },
}

impl Blocks {
    /// A block of a file of `count` blocks. `wanted` is how many from this one on are asked for next, at least 1.
    ///
    /// `fetch` gets the bytes of a run of blocks; one thread fetches while others that want the same wait.
    pub(crate) fn get<E>(
        &self,
        number: u64,
        wanted: u64,
        count: u64,
        fetch: impl FnOnce(Range<u64>) -> Result<Bytes, E>,
    ) -> Result<Bytes, E> {
        let mut state = self.state();
        while let Some(Block::Coming) = state.blocks.get(&number) {
            state = self.fetched.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
        state.clock += 1;
        let now = state.clock;
        if let Some(Block::Kept { bytes, used }) = state.blocks.get_mut(&number) {
            *used = now;
            return Ok(bytes.clone());
        }
        let run = state.run(number, wanted, count);
        for block in run.clone() {
            state.blocks.insert(block, Block::Coming);
        }
        drop(state);
        // Whatever happens, also a panic, others must not wait for ever.
        let mut coming = Coming { blocks: self, run: run.clone(), bytes: None };
        let bytes = fetch(run)?;
        let first = bytes.slice(..bytes.len().min(BLOCK_BYTES as usize));
        coming.bytes = Some(bytes);
        drop(coming);
        Ok(first)
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Puts in what was fetched, or takes the marks away.
    fn arrived(&self, run: Range<u64>, bytes: Option<&Bytes>) {
        let mut state = self.state();
        for (k, number) in run.clone().enumerate() {
            let from = k * BLOCK_BYTES as usize;
            // A copy of its own, so that memory is given back block by block.
            let block = bytes
                .and_then(|bytes| bytes.get(from..))
                .map(|rest| Bytes::copy_from_slice(&rest[..rest.len().min(BLOCK_BYTES as usize)]));
            match block {
                Some(bytes) => {
                    let used = state.clock;
                    state.blocks.insert(number, Block::Kept { bytes, used });
                }
                None => drop(state.blocks.remove(&number)),
            }
        }
        if bytes.is_some() {
            state.ends.push_back((run.end, run.end - run.start));
            if state.ends.len() > PLACES {
                state.ends.pop_front();
            }
        }
        state.forget();
        drop(state);
        self.fetched.notify_all();
    }
}

impl State {
    /// Which blocks are fetched for a block that is not there: what is wanted, and where reads follow each other twice as many as before.
    /// A run ends before a block that is there or comes.
    fn run(&mut self, number: u64, wanted: u64, count: u64) -> Range<u64> {
        let follows = |&(end, _): &(u64, u64)| (end..=end + LEAP_BLOCKS).contains(&number);
        let before = self.ends.iter().rposition(follows).and_then(|at| self.ends.remove(at));
        let ahead = before.map_or(1, |(_, blocks)| 2 * blocks);
        let most = number + wanted.max(ahead).clamp(1, MOST_BLOCKS);
        let end = (number + 1..most.min(count)).find(|block| self.blocks.contains_key(block));
        number..end.unwrap_or_else(|| most.min(count).max(number + 1))
    }

    /// Gives up the blocks that were used longest ago, beyond what is kept.
    fn forget(&mut self) {
        while self.blocks.len() > KEPT_BLOCKS {
            let kept = self.blocks.iter().filter_map(|(&number, block)| match block {
                Block::Kept { used, .. } => Some((*used, number)),
                Block::Coming => None,
            });
            let Some((_, oldest)) = kept.min() else { return };
            self.blocks.remove(&oldest);
        }
    }
}

/// A run that is being fetched.
struct Coming<'a> {
    blocks: &'a Blocks,
    run: Range<u64>,
    bytes: Option<Bytes>,
}

impl Drop for Coming<'_> {
    fn drop(&mut self) {
        self.blocks.arrived(self.run.clone(), self.bytes.as_ref());
    }
}

#[cfg(test)]
#[path = "blocks_tests.rs"]
mod tests;
