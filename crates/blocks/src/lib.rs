//! Blocks of files that are far away: those that were used last are kept, and each is fetched once.
//!
//! This crate never fetches: who asks for a block says how.

mod block_cache;

pub use block_cache::{BlockCache, Limits};
