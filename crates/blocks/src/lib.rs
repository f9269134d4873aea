//! A cache of blocks of remote files: it keeps the most recently used blocks, and each is fetched
//! once.
//!
//! This crate never fetches anything itself: the caller passes a function that does.

mod block_cache;

pub use block_cache::{BlockCache, CacheLimits};
