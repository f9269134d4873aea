//! The report of a comparison: offsets of ways, of regions and of the whole package.

use corniche_roads::{FunctionalRoadClass, RoadAttributes};

use crate::votes::{AlongOffset, Offset};

/// What was found.
#[derive(Debug, Clone, PartialEq)]
pub struct MatchReport {
    /// All roads together; `None` where the image shows none of them.
    pub all: Option<Offset>,
    /// Length of the roads that were compared, metres, and the places on them that an image covers.
    pub length_m: f64,
    /// Places that were looked at.
    pub samples: u64,
    /// The largest shift that was tried to each side, and the step between shifts, metres.
    pub reach_m: f64,
    /// See [`MatchReport::reach_m`].
    pub step_m: f64,
    /// Squares of the package's grid that have roads, from the south-west.
    pub regions: Vec<MatchedRegion>,
    /// Roads by way id.
    pub roads: Vec<MatchedRoad>,
}

/// A square with roads.
#[derive(Debug, Clone, PartialEq)]
pub struct MatchedRegion {
    /// Its middle, working metres.
    pub center_m: [f64; 2],
    /// Places on roads in it.
    pub samples: u64,
    /// The offset; `None` where the image shows nothing.
    pub offset: Option<Offset>,
}

/// A way.
#[derive(Debug, Clone, PartialEq)]
pub struct MatchedRoad {
    /// OSM's id of the way.
    pub way_id: i64,
    /// Functional road class.
    pub class: FunctionalRoadClass,
    /// What its tags say.
    pub attributes: RoadAttributes,
    /// Its length on the finest level, metres in plan.
    pub length_m: f64,
    /// Places on it that an image covers.
    pub samples: u64,
    /// The offset; `None` where the image shows nothing.
    pub offset: Option<Offset>,
    /// The offset across the road, along `across`, if only such shifts are tried.
    pub across_offset: Option<AlongOffset>,
    /// The direction across the road, of length 1, eastwards.
    pub across: [f64; 2],
    /// 0 for a straight road, whose offset is known across it alone; 1 for one that goes in all
    /// directions alike.
    pub bends: f64,
    /// Its lines, working metres.
    pub lines: Vec<Vec<[f64; 2]>>,
}
