//! The table of contents of a package.

mod contents;
mod counts;
mod levels;

pub(crate) mod check;

pub use contents::{
    ClipRecord, InputRecord, Manifest, PhotoLevelRecord, PhotoRecord, PolygonRecord, ScaleRecord,
    SettingsRecord, VerticalRecord,
};
pub use counts::{Counts, GrowthRow, LeftOutRecord, RoadLoss, SampleCounts};
pub use levels::{Distribution, LevelRecord, SampleErrorRecord};
