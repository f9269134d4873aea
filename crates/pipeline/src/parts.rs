//! A build in parts: a separate process runs one step for one subtree, and a merge writes the
//! package from all parts.
//!
//! ```text
//!  plan ─┬─ hashes ──────────────────────────────────────┐
//!        ├─ ways ─ nodes ─ roads ───────┐                │
//!        └─ heights of each subtree ─ top ─ tiles of each subtree ─ merge ─► package
//! ```
//!
//! Parts of one column may be built at the same time, in any order, on any machine that has the
//! inputs at the paths of the plan. Artifacts in the stores are not computed again, so it is
//! harmless to build a part twice. Stores are folders, or prefixes in object storage; the package
//! may be written to object storage, too.

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
pub use step::PartStep;
