//! Measures the offset of a package's roads from the roads visible in a photo, or in the slope of
//! the ground.
//!
//! ```text
//!  GEO lines of finest tiles ─► samples along roads ─┐
//!                                                    ├─► response of each sample for each shift ─► votes ─► Offset
//!  photo or slope ─► image around a block ───────────┘   (is there a line, darker or brighter      (of roads, regions,
//!                                                         than both sides?)                          of all)
//! ```
//!
//! The crate measures only, and changes nothing: roads of a package are those of the extract.
//!
//! The question comes from Vaaraniemi, Treib & Westermann 2011, *High-Quality Cartographic Roads on
//! High-Resolution DEMs*, section 7 and Figure 16: roads and terrain come from different sources,
//! and may not match.

mod comparison;
mod error;
mod images;
mod report;

mod response;
mod samples;
mod votes;

pub use comparison::{MatchRequest, match_roads};
pub use error::MatchError;
pub use images::MatchTarget;
pub use report::{MatchReport, MatchedRegion, MatchedRoad};
pub use votes::{AlongOffset, Offset};
