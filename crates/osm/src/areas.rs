//! Areas of a layer: closed ways and relations with tags of the table.
//!
//! ```text
//!  objects and the located ways of their outlines (`outlines`) ──► hand_parts ──► OutlineWayRecord by object ──► make_areas
//!                                                                                                                 │
//!                                                                          LayerArea, ways first, by id ◄─────────┘
//! ```

mod hand_out_areas;
mod layer_area;
mod make_areas;
mod over_seam;

pub(crate) use hand_out_areas::hand_out_areas;
pub use layer_area::{AreaSummary, KeptAreas, LayerArea};
