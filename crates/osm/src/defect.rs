//! Defects of an extract that were survived: each names its object and its reason.

use corniche_areas::ClassedLayer;
use serde::{Deserialize, Serialize};

use crate::{area_loss::AreaLoss, line_loss::LineLoss};

/// Bad input in an extract that was survived: reported with the object's id, and the rest goes on.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[non_exhaustive]
pub enum Defect {
    /// The table does not list this `highway` value; the way is left out.
    UnknownHighway {
        /// The way.
        way_id: i64,
        /// The value.
        value: String,
    },
    /// `area=yes`: the outline of a surface; the way is left out.
    Area {
        /// The way.
        way_id: i64,
    },
    /// Several ways of the file have this id; the first stays.
    DuplicateWay {
        /// The id.
        way_id: i64,
    },
    /// A tag of the way is not UTF-8; what cannot be read is replaced by U+FFFD.
    DamagedText {
        /// The way.
        way_id: i64,
    },
    /// A tag of the way is longer than OSM allows, 255 characters; it is cut there.
    LongText {
        /// The way.
        way_id: i64,
    },
    /// A tag of a road is read as another value; see [`corniche_roads::tags_taken_otherwise`].
    TagTakenOtherwise {
        /// The way.
        way_id: i64,
        /// The tag as `key=value`.
        tag: String,
    },
    /// A way of one node or none; it is left out.
    TooFewNodes {
        /// The way.
        way_id: i64,
        /// How many nodes it has.
        nodes: u32,
    },
    /// Nodes of the way are not in the file: it is cut there.
    MissingNodes {
        /// The way.
        way_id: i64,
        /// How many of its points are affected.
        points: u32,
    },
    /// Nodes of the way lie beyond ±180° or ±90°: it is cut there.
    OutOfRange {
        /// The way.
        way_id: i64,
        /// How many of its points are affected.
        points: u32,
    },
    /// Nodes of the way cannot be placed in the working CRS: it is cut there.
    OutsideProjection {
        /// The way.
        way_id: i64,
        /// How many of its points are affected.
        points: u32,
    },
    /// Cuts left several pieces: each is a road of its own with the same way id.
    Split {
        /// The way.
        way_id: i64,
        /// How many roads it became.
        roads: u32,
    },
    /// Cuts left single points, which do not make a line; they are left out.
    StrayPoints {
        /// The way.
        way_id: i64,
        /// How many points.
        points: u32,
    },
    /// Nothing is left of the way: its points are missing, cannot be placed, or are all the same.
    NoLine {
        /// The way.
        way_id: i64,
    },
    /// The way goes to and fro over one place more often than a road can; it is left out.
    ToAndFro {
        /// The way.
        way_id: i64,
    },
    /// Neighbouring points of the way are the same; they are merged.
    DuplicatePoints {
        /// The way.
        way_id: i64,
        /// How many points were removed.
        points: u32,
    },
    /// The line crosses itself between its points; it is kept as it is.
    SelfCrossing {
        /// The way.
        way_id: i64,
        /// How many pairs of its segments cross; for a way of more than 2000 nodes not all of them may be found.
        crossings: u32,
    },
    /// Two extracts have the way in different versions, of which the newer one stays, or with different content, of which that of the first
    /// stays.
    ConflictingWay {
        /// The way.
        way_id: i64,
    },
    /// Nothing is left of an area.
    LostArea {
        /// Whether it is a relation; else it is a way.
        is_relation: bool,
        /// The object.
        id: i64,
        /// Why it is none.
        loss: AreaLoss,
    },
    /// Ways of an area's relation are not in the file; what the others surround stays.
    MissingWays {
        /// The relation.
        relation_id: i64,
        /// How many.
        ways: u32,
    },
    /// An area's outline has segments twice, or points in the middle of segments; these are divided, and of segments that are there
    /// an even number of times nothing is left.
    MendedOutline {
        /// Whether it is a relation; else it is a way.
        is_relation: bool,
        /// The object.
        id: i64,
        /// How many segments.
        segments: u32,
    },
    /// A coastline ends inside the data where no other begins. A straight line closes the sea there.
    OpenCoastline {
        /// The way.
        way_id: i64,
    },
    /// A way of a layer of lines is left out.
    LostLine {
        /// The layer.
        layer: ClassedLayer,
        /// The way.
        way_id: i64,
        /// Why it is left out.
        loss: LineLoss,
    },
    /// A node has several different places; the first stays, or of several extracts that of the newest version.
    ConflictingNode {
        /// The node.
        node_id: i64,
    },
}

impl Defect {
    /// What kind of defect it is, in words: the name to count it under.
    #[must_use]
    pub const fn reason(&self) -> &'static str {
        match self {
            Self::UnknownHighway { .. } => "unknown highway value",
            Self::Area { .. } => "area",
            Self::DuplicateWay { .. } => "duplicate way",
            Self::DamagedText { .. } => "damaged text",
            Self::LongText { .. } => "long text",
            Self::TagTakenOtherwise { .. } => "tag taken for another value",
            Self::TooFewNodes { .. } => "too few nodes",
            Self::MissingNodes { .. } => "missing nodes",
            Self::OutOfRange { .. } => "coordinates out of range",
            Self::OutsideProjection { .. } => "outside the projection",
            Self::Split { .. } => "split by gaps",
            Self::StrayPoints { .. } => "stray points",
            Self::NoLine { .. } => "no line left",
            Self::ToAndFro { .. } => "to and fro over one place",
            Self::DuplicatePoints { .. } => "duplicate points",
            Self::SelfCrossing { .. } => "self-crossing",
            Self::ConflictingWay { .. } => "conflicting way",
            Self::ConflictingNode { .. } => "conflicting node",
            Self::LostArea { loss, .. } => loss.reason(),
            Self::LostLine { layer, loss, .. } => loss.reason(*layer),
            Self::MissingWays { .. } => "missing ways of an area",
            Self::MendedOutline { .. } => "mended outline of an area",
            Self::OpenCoastline { .. } => "open end of a coastline",
        }
    }

    /// Whether it is nothing wrong with the extract, but something that lies beyond it: a boundary goes on in the country next to it.
    #[must_use]
    pub const fn is_beyond_extract(&self) -> bool {
        matches!(self, Self::LostLine { loss: LineLoss::MissingWay, .. })
    }

    /// What it is about: `"way"`, `"node"` or `"relation"`, and its id.
    #[must_use]
    pub const fn object(&self) -> (&'static str, i64) {
        match *self {
            Self::UnknownHighway { way_id, .. }
            | Self::Area { way_id }
            | Self::DuplicateWay { way_id }
            | Self::DamagedText { way_id }
            | Self::LongText { way_id }
            | Self::TagTakenOtherwise { way_id, .. }
            | Self::TooFewNodes { way_id, .. }
            | Self::MissingNodes { way_id, .. }
            | Self::OutOfRange { way_id, .. }
            | Self::OutsideProjection { way_id, .. }
            | Self::Split { way_id, .. }
            | Self::StrayPoints { way_id, .. }
            | Self::NoLine { way_id }
            | Self::ToAndFro { way_id }
            | Self::DuplicatePoints { way_id, .. }
            | Self::ConflictingWay { way_id }
            | Self::LostLine { way_id, .. }
            | Self::OpenCoastline { way_id }
            | Self::SelfCrossing { way_id, .. } => ("way", way_id),
            Self::ConflictingNode { node_id } => ("node", node_id),
            Self::MissingWays { relation_id, .. } => ("relation", relation_id),
            Self::LostArea { is_relation, id, .. }
            | Self::MendedOutline { is_relation, id, .. } => {
                (if is_relation { "relation" } else { "way" }, id)
            }
        }
    }

    /// How many points, nodes, roads or crossings, where it has such a number.
    #[must_use]
    pub const fn count(&self) -> Option<u32> {
        match *self {
            Self::TooFewNodes { nodes: count, .. }
            | Self::MissingNodes { points: count, .. }
            | Self::OutOfRange { points: count, .. }
            | Self::OutsideProjection { points: count, .. }
            | Self::Split { roads: count, .. }
            | Self::StrayPoints { points: count, .. }
            | Self::DuplicatePoints { points: count, .. }
            | Self::SelfCrossing { crossings: count, .. }
            | Self::MissingWays { ways: count, .. }
            | Self::MendedOutline { segments: count, .. } => Some(count),
            Self::UnknownHighway { .. }
            | Self::TagTakenOtherwise { .. }
            | Self::Area { .. }
            | Self::DuplicateWay { .. }
            | Self::DamagedText { .. }
            | Self::LongText { .. }
            | Self::NoLine { .. }
            | Self::ToAndFro { .. }
            | Self::ConflictingWay { .. }
            | Self::ConflictingNode { .. }
            | Self::OpenCoastline { .. }
            | Self::LostLine { .. }
            | Self::LostArea { .. } => None,
        }
    }

    /// The value that it is about, where it has one.
    #[must_use]
    pub fn detail(&self) -> Option<&str> {
        match self {
            Self::UnknownHighway { value, .. } => Some(value),
            Self::TagTakenOtherwise { tag, .. } => Some(tag),
            _ => None,
        }
    }
}
