//! Reasons for which an object with the tags of an area is left out.

use serde::{Deserialize, Serialize};

/// Why an object with the tags of an area became none.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[non_exhaustive]
pub enum AreaLoss {
    /// A way that does not end where it begins. Often it is a part of a relation that has the same tags.
    OpenWay,
    /// Ends of the outline's ways do not meet, though all of them are there.
    OpenOutline,
    /// Ways of the relation are not in the file, and what is left is open or nothing.
    MissingWays,
    /// Nodes of the outline are not in the file.
    MissingNodes,
    /// Nodes of the outline lie beyond ±180° or ±90°.
    OutOfRange,
    /// The outline crosses itself between its points.
    CrossingOutline,
    /// The outline has no segments, or each of them twice.
    NoOutline,
    /// The outline has too many long segments side by side to be searched for crossings.
    TooIntricate,
    /// Nodes of the outline cannot be placed in the working CRS, or too few are left.
    OutsideProjection,
    /// Several objects of the file have this id; the first stays.
    Duplicate,
    /// A coastline that says that there is sea where another one says that there is land, or that crosses one.
    ContradictingCoastline,
}

impl AreaLoss {
    /// The name to count it under, in words.
    #[must_use]
    pub const fn reason(self) -> &'static str {
        match self {
            Self::OpenWay => "area way is not closed",
            Self::OpenOutline => "outline of an area is open",
            Self::MissingWays => "outline of an area lacks ways",
            Self::MissingNodes => "outline of an area lacks nodes",
            Self::OutOfRange => "outline of an area is out of range",
            Self::CrossingOutline => "outline of an area crosses itself",
            Self::NoOutline => "area has no outline",
            Self::TooIntricate => "outline of an area is too intricate",
            Self::OutsideProjection => "area is outside the projection",
            Self::Duplicate => "duplicate area",
            Self::ContradictingCoastline => "coastline contradicts others",
        }
    }
}
