//! The artifacts of a build on disk, which are immutable bytes by key ([`Artifacts`]), and scratch
//! space for sorting more records than fit in memory ([`ScratchSpace`], [`Sorter`]).
//!
//! [`LocalStore`] keeps artifacts in a folder; a crash at any moment loses only the last seconds.
//! [`MemoryStore`] keeps artifacts in memory. All input and output uses [`Disk`], so that tests can
//! let any call fail.
//!
//! ```
//! # fn main() -> Result<(), corniche_store::StoreError> {
//! # let temporary = tempfile::tempdir().unwrap();
//! # let folder = temporary.path().join("store");
//! use std::sync::Arc;
//! use corniche_store::{ArtifactKey, Artifacts, LocalStore, SYNC_INTERVAL, StoredPlan, SystemDisk};
//!
//! let plan = StoredPlan { hash: [0; 32], bytes: b"{}".to_vec() };
//! let heights = ArtifactKey { kind: 0, item: 17 };
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
//! A store reads sealed parts from any number of [places](PartsPlace): folders, or places of other
//! crates, such as object storage.
//!
//! This crate knows no tiles and no roads: a key consists of two numbers, an artifact is bytes. It
//! never changes a stored artifact, starts no threads, and deletes no file that it did not create.

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

pub use artifacts::{ArtifactKey, Artifacts};
pub use disk::{Disk, DiskFile, FileId, FolderItem, Hold, OpenMode};
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
pub use scratch::{ScratchRange, ScratchSpace};
pub use sorter::{Groups, SerdeRecord, SortRecord, Sorted, Sorter};
pub use stored_plan::{PlanHash, StoredPlan};
pub use system_disk::SystemDisk;
