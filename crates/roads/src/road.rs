//! A road: its way, its functional road class, its attributes and its line.

use serde::{Deserialize, Serialize};
use std::{
    fmt,
    num::{NonZeroU8, NonZeroU32},
};

use corniche_geom::Polyline;

/// Functional road class, 0 to 8: 0 is for motorways, 7 for the least of the roads for cars, 8 for paths, steps and cycleways.
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
    /// How many classes there are.
    pub const COUNT: usize = 9;
    /// The least important one.
    pub const LEAST: Self = Self(Self::COUNT as u8 - 1);

    /// The class with this number; `None` above 8.
    #[must_use]
    pub const fn new(class: u8) -> Option<Self> {
        if (class as usize) < Self::COUNT { Some(Self(class)) } else { None }
    }

    /// Its number.
    #[must_use]
    pub const fn number(self) -> u8 {
        self.0
    }

    /// All classes, most important first.
    pub fn all() -> impl DoubleEndedIterator<Item = Self> {
        (0..Self::COUNT as u8).map(Self)
    }
}

impl fmt::Display for FunctionalRoadClass {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "FRC {}", self.0)
    }
}

/// Declares an enum together with the list of its variants, so that the list has all of them.
macro_rules! listed {
    (
        $(#[$about:meta])*
        pub enum $name:ident {
            $($(#[$of_variant:meta])* $variant:ident,)+
        }
    ) => {
        $(#[$about])*
        pub enum $name {
            $($(#[$of_variant])* $variant,)+
        }

        impl $name {
            /// All of them, in the order of their numbers, which are their indices here.
            pub const ALL: &'static [Self] = &[$(Self::$variant),+];
        }
    };
}

listed! {
    /// How a road is built, as far as the tags say.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash)]
    pub enum Form {
        /// One carriageway, or unknown.
        #[default]
        Ordinary,
        /// One of two separate carriageways.
        DualCarriageway,
        /// A slip road (`*_link`).
        Link,
        /// A roundabout.
        Roundabout,
    }
}

impl Form {
    /// How a road is built, in one word.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Ordinary => "ordinary",
            Self::DualCarriageway => "dual_carriageway",
            Self::Link => "link",
            Self::Roundabout => "roundabout",
        }
    }
}

listed! {
    /// What carries a road where the ground does not.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash, Serialize, Deserialize)]
    pub enum Structure {
        /// The ground.
        #[default]
        Ground,
        /// A bridge.
        Bridge,
        /// A tunnel.
        Tunnel,
    }
}

impl Structure {
    /// What carries a road, in one word.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Ground => "ground",
            Self::Bridge => "bridge",
            Self::Tunnel => "tunnel",
        }
    }
}

listed! {
    /// Permitted direction relative to the way's own.
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
}

/// What the tags of a road say of its width.
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

/// What is kept of a way's tags.
#[derive(Debug, Clone, PartialEq, Eq, Default, Hash)]
pub struct RoadAttributes {
    /// How it is built.
    pub form: Form,
    /// What carries it.
    pub structure: Structure,
    /// OSM's `layer`, −5…5 as a rule.
    pub layer: i8,
    /// Permitted direction.
    pub oneway: Oneway,
    /// `name`, empty without.
    pub name: String,
    /// `ref`, empty without.
    pub reference: String,
    /// `surface`, empty without.
    pub surface: String,
    /// `highway`; empty only where a package does not say it.
    pub highway: String,
    /// `lanes`: how many, in both directions together.
    pub lanes: Option<NonZeroU8>,
    /// `width`, whole millimetres.
    pub width_mm: Option<NonZeroU32>,
    /// `maxspeed`: a number is km/h, `30 mph` miles an hour; else as tagged, such as `none` or `walk`. Empty without.
    pub max_speed: String,
    /// `sac_scale`, empty without.
    pub sac_scale: String,
    /// `tracktype`, empty without.
    pub tracktype: String,
}

impl RoadAttributes {
    /// `width` in metres.
    #[must_use]
    pub fn width_m(&self) -> Option<f64> {
        self.width_mm.map(|mm| f64::from(mm.get()) / 1e3)
    }

    /// The same without spaces around its texts, as packages of before have them.
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

    /// What the tags say of the road's width: `width`, or else `lanes`.
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
    /// What else the tags say.
    pub attributes: RoadAttributes,
    /// The centre-line on the package's lattice.
    pub line: Polyline,
    /// Indices into the line's points that no simplification may remove: its ends and every node that
    /// another road shares (junctions). Ascending.
    pub fixed: Vec<u32>,
    /// For each of `fixed` OSM's id of the node there, by which roads are joined; `None` for a place that is no node. Empty where ids were not
    /// asked for.
    pub node_ids: Vec<Option<i64>>,
    /// Pairs of nodes of the way that lie at one place of the lattice, and may both join other roads. Of each pair one stands in `node_ids`.
    pub same_places: Vec<[i64; 2]>,
    /// Where ways join it that are no roads because their classes are off or not known.
    pub met: MetNodes,
}

/// Nodes of a road at which only ways join whose classes are off or not known: they carry bridges and tunnels, too.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct MetNodes {
    /// Which points of the line they are, ascending, and their ids; none of them is one of [`Road::fixed`] but for its ends.
    pub nodes: Vec<(u32, i64)>,
    /// Pairs of nodes that lie at one place, of which at least one is such a node.
    pub same_places: Vec<[i64; 2]>,
}

#[cfg(test)]
#[path = "road_tests.rs"]
mod tests;
