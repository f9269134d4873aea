//! Objects of OpenStreetMap: what a line, an area or a point of a layer comes from.

use std::fmt;

use serde::{Deserialize, Serialize};

/// An object of OpenStreetMap: its type and its id.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub enum OsmObject {
    /// A node.
    Node(i64),
    /// A way.
    Way(i64),
    /// A relation.
    Relation(i64),
}

impl OsmObject {
    /// Returns the type of the object, `"node"`, `"way"` or `"relation"`, and its id.
    #[must_use]
    pub const fn parts(self) -> (&'static str, i64) {
        match self {
            Self::Node(id) => ("node", id),
            Self::Way(id) => ("way", id),
            Self::Relation(id) => ("relation", id),
        }
    }

    /// Returns the id, which other types of object may also have.
    #[must_use]
    pub const fn id(self) -> i64 {
        self.parts().1
    }
}

impl fmt::Display for OsmObject {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (kind, id) = self.parts();
        write!(f, "{kind} {id}")
    }
}
