//! What is looked for in an extract, areas by a table or a layer of lines, and which keys, tags and roles belong to it.

use corniche_areas::{AreaTable, ClassedLayer};

/// Which objects are looked for.
#[derive(Clone, Copy)]
pub(crate) enum Wanted<'a> {
    /// Areas of a table.
    Areas(&'a AreaTable),
    /// Lines of a layer, of which each way counts, closed or not.
    Lines(ClassedLayer),
}

impl Wanted<'_> {
    /// Whether an object with this key may be one of them.
    pub(crate) fn is_key(self, key: &[u8]) -> bool {
        match self {
            Self::Areas(table) => {
                table.keys().any(|known| known.as_bytes() == key)
                    || table.has_sea() && key == b"natural"
            }
            Self::Lines(layer) => key == layer.table().key.as_bytes(),
        }
    }

    /// The number of the class of an object with these tags.
    pub(crate) fn classify(self, tags: &[(&str, &str)]) -> Option<u8> {
        match self {
            Self::Areas(table) => table.classify(tags).map(corniche_areas::AreaClass::number),
            Self::Lines(layer) => (layer.table().of_tags)(tags),
        }
    }

    /// Whether coastlines are looked for, too.
    pub(crate) fn has_sea(self) -> bool {
        matches!(self, Self::Areas(table) if table.has_sea())
    }

    /// Whether a way that is not closed can be one of them.
    pub(crate) fn has_open_ways(self) -> bool {
        matches!(self, Self::Lines(_))
    }

    /// Whether a way with this role belongs to the outline of a relation.
    pub(crate) fn is_outline(self, role: &[u8]) -> bool {
        match self {
            Self::Areas(_) => true,
            Self::Lines(layer) => {
                layer.table().has_relations && [&b""[..], b"outer", b"inner"].contains(&role)
            }
        }
    }
}
