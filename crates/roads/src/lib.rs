//! The roads of a package: their functional road class (FRC), attributes and lines, and their
//! simplification per level.
//!
//! ```text
//!  tags ──► FrcTable::classify ──► class, or why it is no road
//!       └─► attributes         ──► form, bridge/tunnel, oneway, names, widths
//!  Road ──► ClassFilter ──► shown on this level?  ──► simplify ──► Polyline
//! ```
//!
//! This crate never reads terrain or files, and never joins ways.

mod attribute_parts;
mod attributes;
mod class_filter;
mod class_labels;
mod frc_table;
mod grade_limit;
mod listed;
mod loss_reason;
mod quantities;
mod railway;
mod road;
mod simplify;
mod slab_thickness;

pub use attribute_parts::AttributeParts;
pub use attributes::{attributes, structure_and_layer, tags_taken_otherwise};
pub use class_filter::{ClassFilter, ClassFilterError};
pub use frc_table::{Classified, FrcTable, FrcTableError, NotARoad, is_area, is_yes, tag};
pub use grade_limit::grade_limit;
pub use loss_reason::LossReason;
pub use quantities::number_and_unit;
pub use railway::Railway;
pub use road::{
    Form, FunctionalRoadClass, MetNodes, Oneway, OwnWidth, Road, RoadAttributes, Structure,
};
pub use simplify::{kept_points, simplify};
pub use slab_thickness::slab_thickness_m;
