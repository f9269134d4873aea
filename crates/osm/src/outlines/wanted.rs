//! The objects to look for in an extract, areas by a table or boundaries, with their keys, tags and
//! roles.

use corniche_areas::{AreaClass, AreaTable, BoundaryClass};

/// The kind of objects to look for.
#[derive(Clone, Copy)]
pub(crate) enum WantedObjects<'a> {
    /// Areas of a table.
    Areas(&'a AreaTable),
    /// Boundaries; each of their ways counts, closed or not.
    Boundaries,
}

impl WantedObjects<'_> {
    /// Whether an object with this key may be of this kind.
    pub(crate) fn is_key(self, key: &[u8]) -> bool {
        match self {
            Self::Areas(table) => {
                table.keys().any(|known| known.as_bytes() == key)
                    || table.has_sea() && key == b"natural"
            }
            Self::Boundaries => key == BoundaryClass::KEY.as_bytes(),
        }
    }

    /// Returns the class number of an object with these tags.
    pub(crate) fn classify(self, tags: &[(&str, &str)]) -> Option<u8> {
        match self {
            Self::Areas(table) => table.classify(tags).map(AreaClass::number),
            Self::Boundaries => BoundaryClass::of_tags(tags).map(BoundaryClass::number),
        }
    }

    /// Whether coastlines are also looked for.
    pub(crate) fn has_sea(self) -> bool {
        matches!(self, Self::Areas(table) if table.has_sea())
    }

    /// Whether an open way can be an object of this kind.
    pub(crate) fn has_open_ways(self) -> bool {
        matches!(self, Self::Boundaries)
    }

    /// Whether a way with this role belongs to the outline of a relation.
    pub(crate) fn is_outline(self, role: &[u8]) -> bool {
        match self {
            Self::Areas(_) => true,
            Self::Boundaries => [&b""[..], b"outer", b"inner"].contains(&role),
        }
    }
}
