//! Builds and verifies packages: the order of the stages, their threads, memory, defects and progress.
//!
//! This crate never parses arguments and never prints. Its threads are those of `corniche-work`; which crates start
//! threads stands in `tidy/tests/it/invariants.rs`.

mod areas;
mod artifacts;
mod build;
mod context;
mod defect;
mod error;
mod extract;
mod extract_bounds;
mod heights;
mod hex;
mod inputs;
mod layers;
mod levels;
mod lines;
mod machine;
mod manifest_texts;
mod memory_shares;
mod objects;
mod open_package;
mod parts;
mod photos;
mod plan;
mod plan_error;
mod points_step;
mod roads;
mod settings;
mod settings_record;
mod spans;
mod steps;
mod terrain;
mod tile;
mod tiles_near;
mod true_areas;
mod true_lengths;
mod verify;

use corniche_work::workers;

pub use build::{BuildSummary, build, build_on};
pub use corniche_dem::{
    OpenOptions, PlanOptions, Polygon, PolygonError, libraries, missing_formats, use_files_beside,
};
pub use corniche_objects::Requests;
pub use corniche_osm::{AreaLoss, Defect as OsmDefect, LineLoss, Share};
pub use corniche_store::Existing;
pub use corniche_work::{Silent, Stage};
pub use defect::{Defect, Loss, Observer, span_reason_words, span_reasons};
pub use error::BuildError;
pub use extract_bounds::extract_bounds;
pub use inputs::{PlannedInput, elevation_names, extract_names, input_name, photo_names};
pub use machine::{MIN_MEMORY_BYTES, default_memory_bytes, free_bytes, machine_memory_bytes};
pub use objects::is_in_object_storage;
pub use open_package::open_package;
pub use parts::{
    Job, JobSettings, MergeSettings, MergeSummary, PartSettings, PartSummary, Step, jobs,
    make_part, merge, plan_with_jobs,
};
pub use plan::{
    BuildPlan, Estimate, FrcTableRecord, MemoryEstimate, PlannedGrid, PlannedLevel, Rates, plan,
};
pub use plan_error::{PLAN_VERSION, PlanError};
pub use settings::{
    BuildSettings, Leftovers, PhotoChoice, PhotoSettings, PlanSettings, Resources, RoadSettings,
    TerrainSettings,
};
pub use terrain::recorded::TerrainRecord;
pub use terrain::recorded_grid::grid_of;
pub use verify::{
    Check, CheckId, ErrorFigures, GapFigures, Needs, RecordedElevation, VerifyError, VerifyOsm,
    VerifyReport, VerifySettings, line_names, network, verify,
};
