//! The manifest: the table of contents of a package.

mod contents;
mod counts;
mod credits;
mod inputs;
mod layers;
mod levels;
mod sample_sums;
mod sv_tails;

pub(crate) mod check;

pub use contents::{
    Manifest, OuterGround, PhotoLevelRecord, SpanCounts, SpansRecord, VerticalRecord,
};
pub use corniche_geom::{ClipRecord, DatumOperationRecord, ScaleRecord};
pub use corniche_settings::{
    LayerTableRecord, PhotoRecord, PolygonRecord, ReliefLevels, SettingsRecord,
};
pub use counts::{GrowthRow, LeftOutRecord, ManifestCounts, RoadLoss, SampleCounts};
pub use credits::{CreditError, check_credit, to_credit};
pub use inputs::{InputKind, InputRecord};
pub use layers::{LayerClassRecord, LayerCounts, LayerRecord};
pub use levels::{Distribution, LevelRecord, SampleErrorRecord, SectionLevelRecord};
pub use sample_sums::SampleSums;
pub use sv_tails::{SvTail, SvTails};
