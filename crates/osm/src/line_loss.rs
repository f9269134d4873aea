//! Reasons why a way of a layer of lines is skipped.

use serde::{Deserialize, Serialize};

corniche_roads::listed! {
    /// The reason why a way of a layer of lines is skipped.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
    #[non_exhaustive]
    pub enum LineLoss {
        /// A relation references the way, but the file does not contain it.
        MissingWay = "way of a line is missing",
        /// Too few nodes of the way are in the file: no two consecutive nodes are left.
        MissingNodes = "way of a line lacks nodes",
        /// No two consecutive nodes are on Earth and at different positions.
        OutOfRange = "way of a line is out of range",
        /// No two consecutive nodes have positions in the working CRS that differ.
        OutsideProjection = "way of a line is outside the projection",
    }

    /// Returns the name under which the reason is counted, in words.
    pub fn reason() -> &'static str;
}
