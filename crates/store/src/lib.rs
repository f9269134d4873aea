//! What a build keeps on disk: immutable artifacts by key ([`Artifacts`]), and scratch space in which more records can be
//! sorted than fit in memory ([`Scratch`], [`Sorter`]).
//!
//! [`LocalStore`] keeps artifacts in a folder such that a crash at any moment loses the last seconds and nothing else; [`MemoryStore`] keeps them in
//! memory. All input and output goes through [`Disk`], so that tests can let any call fail.
//!
//! ```
//! # fn main() -> Result<(), corniche_store::StoreError> {
//! # let temporary = tempfile::tempdir().unwrap();
//! # let folder = temporary.path().join("store");
//! use std::sync::Arc;
//! use corniche_store::{Artifacts, Key, LocalStore, SYNC_INTERVAL, StoredPlan, SystemDisk};
//!
//! let plan = StoredPlan { hash: [0; 32], bytes: b"{}".to_vec() };
//! let heights = Key { kind: 0, item: 17 };
//! let store = LocalStore::create(Arc::new(SystemDisk), &folder, &plan, SYNC_INTERVAL)?;
//! store.put(heights, b"made at some cost")?;
//! drop(store); // or the process is killed two seconds later
//!
//! let store = LocalStore::open(Arc::new(SystemDisk), &folder, &plan.hash, SYNC_INTERVAL)?;
//! assert!(store.has(heights));
//! store.remove()?;
//! # Ok(())
//! # }
//! ```
//!
//! A store reads sealed parts from any number of [places](PartsPlace): folders, or what another crate makes one, such as object storage.
//!
//! This crate knows no tile and no road: a key is two numbers, an artifact is bytes. It never changes what was put, makes no threads, and
//! removes no file that it did not make.

mod artifacts;
mod disk;
mod error;
mod files;
mod ids;
mod in_memory_store;
mod local;
mod output_target;
mod parts_place;
mod record_bytes;
mod scratch;
mod sorter;
mod stored_plan;
mod system_disk;

pub use artifacts::{Artifacts, Key};
pub use disk::{Disk, DiskFile, FileId, Hold, Listed, OpenMode};
pub use error::StoreError;
pub use ids::random_digits;
pub use in_memory_store::MemoryStore;
pub use local::{
    FORMAT_VERSION, Folder, LocalScratch, LocalStore, OwnPart, PARTS_NAME, PLAN_NAME, STORE_NAME,
    SYNC_INTERVAL, SealedParts, check_sealed, part_of_sealed, plan_of_header, store_header,
};
pub use output_target::{
    Claim, Existing, LackOfRoom, TargetError, UnfinishedFile, UnfinishedFolder, file_target,
    folder_of, is_same_file, make_own_folder, open_own, sync_folder, sync_tree,
};
pub use parts_place::{PartFile, PartsPlace, Publish};
pub use record_bytes::{append_record, record_bytes, take_record};
pub use scratch::{Scratch, Span};
pub use sorter::{Groups, SerdeRecord, SortRecord, Sorted, Sorter};
pub use stored_plan::{PlanHash, StoredPlan};
pub use system_disk::SystemDisk;
