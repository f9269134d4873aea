//! Defects of an extract that do not stop the reading: each names its object and its reason.

use corniche_layers::OsmObject;
use serde::{Deserialize, Serialize};

use crate::losses::{AreaLoss, LineLoss};

/// Invalid input in an extract that does not stop the reading: it is reported with the object's id,
/// and the reading continues.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[non_exhaustive]
pub enum ExtractDefect {
    /// The table does not list this `highway` value; the way is skipped.
    UnknownHighway {
        /// The way.
        way_id: i64,
        /// The value.
        value: String,
    },
    /// The way has `area=yes`, so it is the outline of a surface; it is skipped.
    Area {
        /// The way.
        way_id: i64,
    },
    /// Several ways of the file have this id; the first is kept.
    DuplicateWay {
        /// The id.
        way_id: i64,
    },
    /// A tag of the way is not UTF-8; unreadable characters are replaced by U+FFFD.
    DamagedText {
        /// The way.
        way_id: i64,
    },
    /// A tag of the way is longer than 255 characters, OSM's limit; it is cut there.
    LongText {
        /// The way.
        way_id: i64,
    },
    /// A tag of a road is interpreted as another value; see
    /// [`corniche_roads::tags_taken_otherwise`].
    TagTakenOtherwise {
        /// The way.
        way_id: i64,
        /// The tag as `key=value`.
        tag: String,
    },
    /// The way has one node or none; it is skipped.
    TooFewNodes {
        /// The way.
        way_id: i64,
        /// The number of its nodes.
        nodes: u32,
    },
    /// Nodes of the way are missing from the file; the way is cut there.
    MissingNodes {
        /// The way.
        way_id: i64,
        /// The number of affected points.
        points: u32,
    },
    /// Nodes of the way are beyond ±180° or ±90°; the way is cut there.
    OutOfRange {
        /// The way.
        way_id: i64,
        /// The number of affected points.
        points: u32,
    },
    /// Nodes of the way cannot be converted to the working CRS; the way is cut there.
    OutsideProjection {
        /// The way.
        way_id: i64,
        /// The number of affected points.
        points: u32,
    },
    /// Cuts left several pieces; each is a separate road with the same way id.
    Split {
        /// The way.
        way_id: i64,
        /// The number of roads that the way became.
        roads: u32,
    },
    /// Cuts left single points, which do not form a line; they are dropped.
    StrayPoints {
        /// The way.
        way_id: i64,
        /// The number of dropped points.
        points: u32,
    },
    /// No line is left of the way: its points are missing, cannot be converted, or are all equal.
    NoLine {
        /// The way.
        way_id: i64,
    },
    /// The way goes to and fro over one place more often than a road can; it is skipped.
    ToAndFro {
        /// The way.
        way_id: i64,
    },
    /// Neighbouring points of the way are equal; they are merged.
    DuplicatePoints {
        /// The way.
        way_id: i64,
        /// The number of removed points.
        points: u32,
    },
    /// The line crosses itself between its points; it is kept unchanged.
    SelfCrossing {
        /// The way.
        way_id: i64,
        /// The number of pairs of segments that cross. In a way of more than 2000 nodes, some of
        /// them may not be found.
        crossings: u32,
    },
    /// Two extracts contain the way in different versions or with different content. The newer
    /// version is kept; if the versions are equal, the content of the first extract is kept.
    ConflictingWay {
        /// The way.
        way_id: i64,
    },
    /// An object with tags of a layer of areas or points became neither.
    LostArea {
        /// The object.
        object: OsmObject,
        /// The reason why it was lost.
        loss: AreaLoss,
    },
    /// Ways of an area's relation are missing from the file; the area that the other ways surround
    /// is kept.
    MissingWays {
        /// The relation.
        relation_id: i64,
        /// The number of missing ways.
        ways: u32,
    },
    /// An area's outline has repeated segments, or points in the middle of segments. Such segments
    /// are divided, and segments that occur an even number of times are removed.
    MendedOutline {
        /// The object.
        object: OsmObject,
        /// The number of segments.
        segments: u32,
    },
    /// A coastline ends inside the data where no other coastline begins. A straight line closes the
    /// sea there.
    OpenCoastline {
        /// The way.
        way_id: i64,
    },
    /// The value of an attribute is not of the kind that the layer requires; the object has no such
    /// value.
    UnreadValue {
        /// The object.
        object: OsmObject,
        /// The key of the attribute.
        key: String,
    },
    /// A way of a layer of lines is skipped.
    LostLine {
        /// The way.
        way_id: i64,
        /// The reason why it is skipped.
        loss: LineLoss,
    },
    /// A node has several different positions. The first is kept; of several extracts, the position
    /// of the newest version is kept.
    ConflictingNode {
        /// The node.
        node_id: i64,
    },
}

impl ExtractDefect {
    /// Returns the kind of the defect in words, which is the name under which it is counted.
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
            Self::LostLine { loss, .. } => loss.reason(),
            Self::MissingWays { .. } => "missing ways of an area",
            Self::MendedOutline { .. } => "mended outline of an area",
            Self::OpenCoastline { .. } => "open end of a coastline",
            Self::UnreadValue { .. } => "attribute value not read",
        }
    }

    /// Whether the extract is not at fault, because the missing data is outside it: a boundary
    /// continues in a neighbouring country.
    #[must_use]
    pub const fn is_beyond_extract(&self) -> bool {
        matches!(self, Self::LostLine { loss: LineLoss::MissingWay, .. })
    }

    /// Returns the object that the defect concerns: `"way"`, `"node"` or `"relation"`, and its id.
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
            Self::LostArea { object, .. }
            | Self::MendedOutline { object, .. }
            | Self::UnreadValue { object, .. } => object.parts(),
        }
    }

    /// Returns the number of points, nodes, roads or crossings, if the defect has such a number.
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
            _ => None,
        }
    }

    /// Returns the value or tag that the defect concerns, if it has one.
    #[must_use]
    pub fn detail(&self) -> Option<&str> {
        match self {
            Self::UnknownHighway { value, .. } => Some(value),
            Self::TagTakenOtherwise { tag, .. } => Some(tag),
            Self::UnreadValue { key, .. } => Some(key),
            _ => None,
        }
    }
}
