//! The objects of a layer to look for in an extract, with their keys, tags and roles.

use corniche_layers::{AttributeValue, LayerGeometry, LayerTable, LinePlacement};

/// The objects of a layer.
#[derive(Clone, Copy)]
pub(crate) struct WantedObjects<'a> {
    pub(crate) table: &'a LayerTable,
    /// Whether the objects become areas, lines or points.
    pub(crate) geometry: LayerGeometry,
}

impl WantedObjects<'_> {
    /// Whether an object with this key may be of the layer.
    pub(crate) fn is_key(self, key: &[u8]) -> bool {
        let keys = self.table.needed_keys();
        keys.binary_search_by(|known| known.as_bytes().cmp(key)).is_ok()
    }

    /// Returns the class number of an object with these tags.
    pub(crate) fn classify(self, tags: &[(&str, &str)]) -> Option<u8> {
        self.table.classify(tags)
    }

    /// Returns the values that the layer keeps of an object, and the numbers of the attributes with
    /// values that are not of their kind.
    pub(crate) fn values(self, tags: &[(&str, &str)]) -> (Vec<Option<AttributeValue>>, Vec<u8>) {
        let mut unread = Vec::new();
        let values = self.table.values(tags, |key| {
            let number = self.table.attributes().position(|(own, _)| own == key);
            unread.extend(number.map(|number| number as u8));
        });
        (values, unread)
    }

    /// Whether ways and relations with the tags are objects of the layer.
    pub(crate) fn has_ways(self) -> bool {
        self.geometry != LayerGeometry::Point || self.table.form().closed_ways
    }

    /// Whether nodes with the tags are objects of the layer.
    pub(crate) fn has_nodes(self) -> bool {
        self.geometry == LayerGeometry::Point
    }

    /// Whether the layer's lines may be on bridges and in tunnels.
    pub(crate) fn has_spans(self) -> bool {
        self.table.form().placement == LinePlacement::Spans
    }

    /// Whether coastlines are also looked for.
    pub(crate) fn has_sea(self) -> bool {
        self.table.coastline_class().is_some()
    }

    /// Whether an open way can be an object of the layer.
    pub(crate) fn has_open_ways(self) -> bool {
        self.geometry == LayerGeometry::Line
    }

    /// Whether ways of relations with this value of `type` are ways of the layer.
    pub(crate) fn is_relation_type(self, value: &str) -> bool {
        match (self.geometry, &self.table.form().members) {
            (LayerGeometry::Line, members) => {
                members.as_ref().is_some_and(|members| members.types.iter().any(|own| own == value))
            }
            _ => ["multipolygon", "boundary"].contains(&value),
        }
    }

    /// Whether a way with this role belongs to a relation's outline, or is one of its lines.
    pub(crate) fn is_role(self, role: &[u8]) -> bool {
        let members = self.table.form().members.as_ref();
        members.is_none_or(|members| {
            members.roles.is_empty() || members.roles.iter().any(|own| own.as_bytes() == role)
        })
    }
}
