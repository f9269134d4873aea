//! Builds packages: the order of the steps, their threads and memory, alone or in parts that many machines make.
//!
//! This crate never parses arguments and never prints. Its threads are those of `corniche-work`; which crates start
//! threads stands in `tidy/tests/it/invariants.rs`.

mod build;
mod context;
mod error;
mod objects;
mod parts;
mod steps;
mod tile;

pub use build::{BuildSummary, build, build_on};
pub use error::BuildError;
pub use objects::is_in_object_storage;
pub use parts::{
    Job, JobSettings, MergeSettings, MergeSummary, PartSettings, PartSummary, Step, jobs,
    make_part, merge, plan_with_jobs,
};
