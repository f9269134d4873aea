//! A road: its way, its functional road class, its attributes and its line.

use serde::{Deserialize, Serialize};
use std::{
    fmt,
    num::{NonZeroU8, NonZeroU32},
};

use corniche_geom::Polyline;

/// Functional road class (FRC), 0 to 8: 0 is for motorways, 7 for the least important roads for
/// cars, 8 for paths, steps and cycleways.
///
/// Lower is more important. Source: OpenLR White Paper v1.5 names 0 to 7; TomTom's products add 8.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(try_from = "u8", into = "u8")]
pub struct FunctionalRoadClass(u8);

impl TryFrom<u8> for FunctionalRoadClass {
    type Error = String;

    fn try_from(number: u8) -> Result<Self, String> {
        Self::new(number).ok_or_else(|| format!("there is no functional road class {number}"))
    }
}

impl From<FunctionalRoadClass> for u8 {
    fn from(class: FunctionalRoadClass) -> Self {
        class.number()
    }
}

impl FunctionalRoadClass {
    /// The number of classes.
    pub const COUNT: usize = 9;
    /// The least important class.
    pub const LEAST: Self = Self(Self::COUNT as u8 - 1);

    /// Returns the class with this number; `None` above 8.
    #[must_use]
    pub const fn new(class: u8) -> Option<Self> {
        if (class as usize) < Self::COUNT { Some(Self(class)) } else { None }
    }

    /// Returns the number of the class.
    #[must_use]
    pub const fn number(self) -> u8 {
        self.0
    }

    /// Returns all classes, most important first.
    pub fn all() -> impl DoubleEndedIterator<Item = Self> {
        (0..Self::COUNT as u8).map(Self)
    }
}

impl fmt::Display for FunctionalRoadClass {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "FRC {}", self.0)
    }
}

crate::listed! {
    /// How a road is built, as far as the tags say.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash)]
    pub enum Form {
        /// One carriageway, or unknown.
        #[default]
        Ordinary = "ordinary",
        /// One of two separate carriageways.
        DualCarriageway = "dual_carriageway",
        /// A slip road (`*_link`).
        Link = "link",
        /// A roundabout.
        Roundabout = "roundabout",
    }

    /// Returns the form in one word.
    pub fn name() -> &'static str;
}

crate::listed! {
    /// The structure that carries a road where it is not on the ground.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash, Serialize, Deserialize)]
    pub enum Structure {
        /// The ground.
        #[default]
        Ground = "ground",
        /// A bridge.
        Bridge = "bridge",
        /// A tunnel.
        Tunnel = "tunnel",
    }

    /// Returns the structure in one word.
    pub fn name() -> &'static str;
}

/// Permitted direction of travel relative to the direction of the way.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash)]
pub enum Oneway {
    /// Both directions.
    #[default]
    No,
    /// Along the way.
    Forward,
    /// Against the way.
    Backward,
}

impl Oneway {
    /// All directions, in the order of their numbers, which are their indices here.
    pub const ALL: [Self; 3] = [Self::No, Self::Forward, Self::Backward];
}

/// The width of a road according to its tags.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash, Serialize, Deserialize)]
pub enum OwnWidth {
    /// Nothing is known of the width.
    #[default]
    Unknown,
    /// The width in millimetres.
    Millimetres(NonZeroU32),
    /// The number of lanes.
    Lanes(NonZeroU8),
}

/// The attributes of a road, from its tags.
#[derive(Debug, Clone, PartialEq, Eq, Default, Hash)]
pub struct RoadAttributes {
    /// The form of the road.
    pub form: Form,
    /// The structure that carries the road.
    pub structure: Structure,
    /// OSM's `layer`, −5…5 as a rule.
    pub layer: i8,
    /// Permitted direction.
    pub oneway: Oneway,
    /// `name`, or empty.
    pub name: String,
    /// `ref`, or empty.
    pub reference: String,
    /// `surface`, or empty.
    pub surface: String,
    /// `highway`; empty only if a package does not contain it.
    pub highway: String,
    /// `lanes`: the number of lanes in both directions together.
    pub lanes: Option<NonZeroU8>,
    /// `width` in whole millimetres.
    pub width_mm: Option<NonZeroU32>,
    /// `maxspeed`: a number is km/h, `30 mph` is miles per hour; any other value is as tagged, such
    /// as `none` or `walk`. Empty if there is no tag.
    pub max_speed: String,
    /// `sac_scale`, or empty.
    pub sac_scale: String,
    /// `tracktype`, or empty.
    pub tracktype: String,
}

impl RoadAttributes {
    /// Returns `width` in metres.
    #[must_use]
    pub fn width_m(&self) -> Option<f64> {
        self.width_mm.map(|mm| f64::from(mm.get()) / 1e3)
    }

    /// Returns the same attributes without spaces around their texts, as packages of earlier
    /// versions contain them.
    #[must_use]
    pub fn trimmed(&self) -> Self {
        let mut trimmed = self.clone();
        let Self { name, reference, surface, highway, max_speed, sac_scale, tracktype, .. } =
            &mut trimmed;
        for text in [name, reference, surface, highway, max_speed, sac_scale, tracktype] {
            *text = text.trim().to_owned();
        }
        trimmed
    }

    /// Returns the road's width according to its tags: `width`, or else `lanes`.
    #[must_use]
    pub fn own_width(&self) -> OwnWidth {
        match (self.width_mm, self.lanes) {
            (Some(mm), _) => OwnWidth::Millimetres(mm),
            (None, Some(lanes)) => OwnWidth::Lanes(lanes),
            (None, None) => OwnWidth::Unknown,
        }
    }
}

/// One OSM way as a road.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Road {
    /// OSM's id of the way.
    pub way_id: i64,
    /// Functional road class.
    pub class: FunctionalRoadClass,
    /// The attributes of the road.
    pub attributes: RoadAttributes,
    /// The centre-line on the package's lattice.
    pub line: Polyline,
    /// Indices of the line's points that simplification must keep: the ends and every node that
    /// another road shares (junctions). Ascending.
    pub fixed: Vec<u32>,
    /// OSM's id of the node at each of `fixed`, which joins roads; `None` for a point that is not a
    /// node. Empty if ids were not requested.
    pub node_ids: Vec<Option<i64>>,
    /// Pairs of nodes of the way that are at the same point of the lattice and may both join other
    /// roads. One node of each pair is in `node_ids`.
    pub same_places: Vec<[i64; 2]>,
    /// The nodes at which ways join the road that are not roads here, because their classes are off
    /// or unknown.
    pub met: MetNodes,
}

/// Nodes of a road that only ways share whose classes are off or unknown. Such ways carry bridges
/// and tunnels, too.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct MetNodes {
    /// The indices of these nodes among the line's points, ascending, and their ids. Except for the
    /// ends of the line, none of them is in [`Road::fixed`].
    pub nodes: Vec<(u32, i64)>,
    /// Pairs of nodes at the same point of which at least one is such a node.
    pub same_places: Vec<[i64; 2]>,
}

#[cfg(test)]
#[path = "road_tests.rs"]
mod tests;
