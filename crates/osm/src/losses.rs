//! Reasons why an object with tags of a layer is skipped.

use serde::{Deserialize, Serialize};

corniche_roads::listed! {
    /// The reason why an object became neither an area nor a point.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
    #[non_exhaustive]
    pub enum AreaLoss {
        /// The way does not end where it begins. Often it is a member of a relation with the same
        /// tags.
        OpenWay = "area way is not closed",
        /// Ends of the outline's ways do not meet, although no way is missing.
        OpenOutline = "outline of an area is open",
        /// Ways of the relation are missing from the file, and the rest is open or empty.
        MissingWays = "outline of an area lacks ways",
        /// Nodes of the outline are missing from the file.
        MissingNodes = "outline of an area lacks nodes",
        /// The node, or nodes of the outline, are beyond ±180° or ±90°.
        OutOfRange = "area or point is out of range",
        /// The outline crosses itself between its points.
        CrossingOutline = "outline of an area crosses itself",
        /// The outline has no segments, or each segment occurs twice.
        NoOutline = "area has no outline",
        /// The outline has too many long segments close together to be checked for crossings.
        TooIntricate = "outline of an area is too intricate",
        /// The node, or nodes of the outline, cannot be converted to the working CRS, or too few
        /// remain.
        OutsideProjection = "area or point is outside the projection",
        /// Several objects of the file have this id; the first is kept.
        Duplicate = "duplicate object of a layer",
        /// The coastline claims sea where another one claims land, or it crosses another one.
        ContradictingCoastline = "coastline contradicts others",
    }

    /// Returns the name under which the reason is counted, in words.
    pub fn reason() -> &'static str;
}

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
