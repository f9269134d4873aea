//! How far the roads of a package lie beside what a photo, or the slope of the ground, shows of
//! them.
//!
//! ```text
//!  GEO lines of finest tiles ─► samples along roads ─┐
//!                                                    ├─► response of each sample for each shift ─► votes ─► Offset
//!  photo or slope ─► image around a block ───────────┘   (is there a line, darker or brighter      (of roads, regions,
//!                                                         than both sides?)                          of all)
//! ```
//!
//! It measures and changes nothing: roads of a package are those of the extract.
//!
//! The question is that of Vaaraniemi, Treib & Westermann 2011, *High-Quality Cartographic Roads on
//! High-Resolution DEMs*, section 7 and Figure 16: roads and terrain come from different sources,
//! and may not fit.

mod comparison;
mod error;
mod images;
mod report;

mod response;
mod samples;
mod votes;

pub use comparison::{MatchRequest, match_roads};
pub use error::MatchError;
pub use images::Target;
pub use report::{MatchReport, MatchedRegion, MatchedRoad};
pub use votes::{AlongOffset, Offset};
