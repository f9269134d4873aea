//! What a build keeps on disk: immutable artifacts by key ([`Artifacts`]), and scratch space in which more records can be
//! sorted than fit in memory ([`Scratch`], [`Sorter`]).
//!
//! This crate knows no tile and no road: a key is two numbers, an artifact is bytes.

mod artifacts;
mod error;
mod memory;
mod scratch;
mod sorter;

pub use artifacts::{Artifacts, Key};
pub use error::StoreError;
pub use memory::{MemoryScratch, MemoryStore};
pub use scratch::{Scratch, Span};
pub use sorter::{SortRecord, Sorted, Sorter};
