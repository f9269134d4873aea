//! A build in parts: one step for one subtree by a process of its own, and the package from all parts.
//!
//! ```text
//!  plan ─┬─ hashes ──────────────────────────────────────┐
//!        ├─ ways ─ nodes ─ roads ───────┐                │
//!        └─ heights of each subtree ─ top ─ tiles of each subtree ─ merge ─► package
//! ```
//!
//! Parts of one column may be made at once, in any order, on any machine that has the inputs at the paths of the plan. What is in the
//! stores already is not made again, so a part may be made twice. Stores are folders, or prefixes in object storage; the package, too, may go there.

mod jobs;
mod merge;
mod needed_parts;
mod package;
mod planned;
mod single_part;
mod step;
mod stores;

pub use jobs::{Job, JobSettings, jobs, plan_with_jobs};
pub use merge::{MergeSettings, MergeSummary, merge};
pub use single_part::{PartSettings, PartSummary, make_part};
pub use step::Step;
