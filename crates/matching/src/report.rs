//! The report of a comparison: offsets of ways, of regions and of the whole package.

use corniche_roads::{FunctionalRoadClass, RoadAttributes};

use crate::votes::{AlongOffset, Offset};

/// The results of a comparison.
#[derive(Debug, Clone, PartialEq)]
pub struct MatchReport {
    /// The offset of all roads together; `None` if the image shows none of them.
    pub all: Option<Offset>,
    /// Length of the roads that were compared, metres, and the number of places on them that the
    /// image covers.
    pub length_m: f64,
    /// The number of places that were compared.
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
    /// The number of places on roads in it.
    pub samples: u64,
    /// The offset; `None` if the image shows no road there.
    pub offset: Option<Offset>,
}

/// A way.
#[derive(Debug, Clone, PartialEq)]
pub struct MatchedRoad {
    /// OSM's id of the way.
    pub way_id: i64,
    /// Functional road class.
    pub class: FunctionalRoadClass,
    /// The attributes from its tags.
    pub attributes: RoadAttributes,
    /// Its length on the finest level, metres in plan.
    pub length_m: f64,
    /// The number of places on it that the image covers.
    pub samples: u64,
    /// The offset; `None` if the image does not show the road.
    pub offset: Option<Offset>,
    /// The offset across the road, along `across`, if only shifts in that direction are tried.
    pub across_offset: Option<AlongOffset>,
    /// The direction across the road, of length 1, eastwards.
    pub across: [f64; 2],
    /// 0 for a straight road, whose offset is known only across it; 1 for a road that runs equally
    /// in all directions.
    pub bends: f64,
    /// Its lines, working metres.
    pub lines: Vec<Vec<[f64; 2]>>,
}
