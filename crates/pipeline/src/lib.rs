//! Builds packages: the order of the steps, their threads and memory, in one process or in parts on
//! many machines.
//!
//! This crate never parses arguments and never prints. Its threads come from `corniche-work`;
//! `tidy/tests/it/invariants.rs` lists the crates that start threads.

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
    Job, JobSettings, MergeSettings, MergeSummary, PartSettings, PartStep, PartSummary, jobs,
    make_part, merge, plan_with_jobs,
};
