//! What a build keeps on disk: immutable artifacts by key ([`Artifacts`]), and scratch space in which more records can be
//! sorted than fit in memory ([`Scratch`], [`Sorter`]).
//!
//! [`LocalStore`] keeps artifacts in a folder such that a crash at any moment loses the last seconds and nothing else; [`MemoryStore`] keeps them in
//! memory. All input and output goes through [`Disk`], so that tests can let any call fail.
//!
//! This crate knows no tile and no road: a key is two numbers, an artifact is bytes. It never changes what was put, makes no threads, and
//! removes no file that it did not make.

mod artifacts;
mod disk;
mod error;
mod files;
mod local;
mod memory;
mod scratch;
mod sorter;
mod system_disk;

pub use artifacts::{Artifacts, Key};
pub use disk::{Disk, DiskFile, FileId, Hold, Listed, OpenMode};
pub use error::StoreError;
pub use files::Traffic;
pub use local::{LocalScratch, LocalStore, OwnPart, PlanHash, SYNC_INTERVAL, StoredPlan};
pub use memory::{MemoryScratch, MemoryStore};
pub use scratch::{Scratch, Span};
pub use sorter::{SortRecord, Sorted, Sorter};
pub use system_disk::SystemDisk;
