//! The manifest: the table of contents of a package.

mod contents;
mod counts;
mod credits;
mod inputs;
mod levels;
mod sample_sums;
mod sv_tails;

pub(crate) mod check;

pub use contents::{
    AreaClassRecord, AreaCounts, AreaLevelRecord, AreasRecord, LineClassRecord, LineCounts,
    LineLevelRecord, LinesRecord, Manifest, OuterGround, PhotoLevelRecord, SpanCounts, SpansRecord,
    VerticalRecord,
};
pub use corniche_geom::{ClipRecord, DatumOperationRecord, ScaleRecord};
pub use corniche_settings::{
    AreaTableRecord, PhotoRecord, PolygonRecord, ReliefLevels, SettingsRecord,
};
pub use counts::{GrowthRow, LeftOutRecord, ManifestCounts, RoadLoss, SampleCounts};
pub use credits::{CreditError, check_credit, to_credit};
pub use inputs::{InputKind, InputRecord};
pub use levels::{Distribution, LevelRecord, SampleErrorRecord};
pub use sample_sums::SampleSums;
pub use sv_tails::{SvTail, SvTails};
