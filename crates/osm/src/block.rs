//! A block that is read in place: nodes and ways are not copied.
//!
//! Only audited blocks are read here. So all fields have the right type, parallel arrays have the
//! same length, sums do not overflow, and every tag is in the table.

use std::{cell::OnceCell, ops::ControlFlow};

use crate::{
    location::{Location, location_from_nano},
    object_info::{Info, to_version},
    packed::PackedField,
    wire::{self, WireValue, zigzag},
};

/// The reason for rejecting a block whose dense nodes have fewer tags than it claims.
const INCOMPLETE_TAGS: &str = "the tags of dense nodes are incomplete";

/// An audited block (message `PrimitiveBlock`).
pub(crate) struct AuditedBlock<'a> {
    texts: &'a [u8],
    groups: Vec<&'a [u8]>,
    /// Nanodegrees in a step of the coordinates.
    granularity: i64,
    /// Latitude and longitude of the coordinate 0, nanodegrees.
    offsets: [i64; 2],
    /// The dense nodes, which are read at the first use.
    dense: OnceCell<Vec<DenseNodes<'a>>>,
}

/// The nodes of a dense list: their ids as numbers, the rest as it is in the block.
pub(crate) struct DenseNodes<'a> {
    pub(crate) ids: Vec<i64>,
    /// Latitudes and longitudes in steps.
    places: [PackedField<'a>; 2],
    /// The versions. There may be fewer versions than nodes, or none; the same applies to the marks
    /// of visible nodes.
    pub(crate) versions: PackedField<'a>,
    pub(crate) visible: PackedField<'a>,
    /// For each node, the numbers of the texts of its keys and values, and a 0; or nothing if no
    /// node has a tag.
    tags: PackedField<'a>,
}

impl<'a> DenseNodes<'a> {
    fn from_message(nodes: &'a [u8]) -> Self {
        let [ids, lats, lons, tags] =
            [1, 8, 9, 10].map(|number| PackedField::from_message(nodes, number));
        let info = parts(nodes, 5).last().unwrap_or_default();
        let [versions, visible] = [1, 6].map(|number| PackedField::from_message(info, number));
        // Allocated at full size: a growing list checks for space before each number.
        let mut known = vec![0; ids.len()];
        known.iter_mut().zip(ids.sums()).for_each(|(id, sum)| *id = sum);
        Self { ids: known, places: [lats, lons], versions, visible, tags }
    }
}

/// A node of a block.
pub(crate) struct BlockNode {
    pub(crate) id: i64,
    pub(crate) lon_nano_deg: i64,
    pub(crate) lat_nano_deg: i64,
    /// The version; 0 if it is unknown.
    pub(crate) version: i32,
}

/// A way of a block.
pub(crate) struct BlockWay<'b, 'a> {
    block: &'b AuditedBlock<'a>,
    pub(crate) id: i64,
    pub(crate) info: Info,
    keys: PackedField<'a>,
    values: PackedField<'a>,
    refs: PackedField<'a>,
    places: [PackedField<'a>; 2],
}

impl<'a> AuditedBlock<'a> {
    pub(crate) fn new(message: &'a [u8]) -> Self {
        let mut block = Self {
            texts: &[],
            groups: Vec::new(),
            granularity: 100,
            offsets: [0; 2],
            dense: OnceCell::new(),
        };
        for field in wire::fields(message).flatten() {
            match (field.number, field.value) {
                (1, WireValue::Bytes(texts)) => block.texts = texts,
                (2, WireValue::Bytes(group)) => block.groups.push(group),
                (17, WireValue::Varint(number)) => block.granularity = number.cast_signed(),
                (19, WireValue::Varint(number)) => block.offsets[0] = number.cast_signed(),
                (20, WireValue::Varint(number)) => block.offsets[1] = number.cast_signed(),
                _ => {}
            }
        }
        block
    }

    /// Returns the groups of objects (messages `PrimitiveGroup`).
    pub(crate) fn groups(&self) -> &[&'a [u8]] {
        &self.groups
    }

    /// Returns the texts of tags, by number.
    pub(crate) fn texts(&self) -> Vec<&'a [u8]> {
        parts(self.texts, 1).collect()
    }

    /// Returns the field numbers of the block's objects, which identify their types.
    fn kinds(&self) -> impl Iterator<Item = u32> {
        self.groups.iter().flat_map(|group| wire::fields(group)).flatten().map(|field| field.number)
    }

    /// Whether the block contains anything other than nodes.
    pub(crate) fn has_others_than_nodes(&self) -> bool {
        self.kinds().any(|kind| !matches!(kind, 1 | 2))
    }

    /// Whether the block contains a relation.
    pub(crate) fn has_relations(&self) -> bool {
        self.kinds().any(|kind| kind == 4)
    }

    /// Whether the block contains ways and nothing else.
    pub(crate) fn has_ways_alone(&self) -> bool {
        let mut kinds = self.kinds();
        kinds.next() == Some(3) && kinds.all(|kind| kind == 3)
    }

    /// Returns the number of nodes.
    pub(crate) fn nodes_count(&self) -> u64 {
        let dense = self.dense().iter().map(|nodes| nodes.ids.len() as u64).sum::<u64>();
        dense + self.groups.iter().map(|group| parts(group, 1).count() as u64).sum::<u64>()
    }

    /// Returns the nodes in dense lists, group by group. In an audited block, no group has two
    /// lists.
    pub(crate) fn dense(&self) -> &[DenseNodes<'a>] {
        self.dense.get_or_init(|| {
            self.groups
                .iter()
                .flat_map(|group| parts(group, 2))
                .map(DenseNodes::from_message)
                .collect()
        })
    }

    /// Returns the nodes outside dense lists.
    pub(crate) fn plain_nodes(&self) -> impl Iterator<Item = BlockNode> {
        self.groups.iter().flat_map(|group| parts(group, 1)).map(|node| self.node(node))
    }

    /// Passes the nodes for whose ids `find` returns something to `take`, until `take` wants no
    /// more. In each group, dense nodes come first.
    pub(crate) fn try_each_node<T>(
        &self,
        mut find: impl FnMut(i64) -> Option<T>,
        mut take: impl FnMut(T, BlockNode) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let mut dense = self.dense().iter();
        for group in &self.groups {
            for (_, nodes) in parts(group, 2).zip(&mut dense) {
                let mut node_at = self.node_at(nodes);
                for (index, &id) in nodes.ids.iter().enumerate() {
                    if let Some(found) = find(id) {
                        take(found, node_at(index))?;
                    }
                }
            }
            for node in parts(group, 1).map(|node| self.node(node)) {
                if let Some(found) = find(node.id) {
                    take(found, node)?;
                }
            }
        }
        ControlFlow::Continue(())
    }

    /// Returns a function for the nodes of a dense list, whose indices must ascend. It reads
    /// coordinates and versions up to the last node requested.
    fn node_at(&self, nodes: &DenseNodes<'_>) -> impl FnMut(usize) -> BlockNode {
        let [mut lats, mut lons] = nodes.places.each_ref().map(PackedField::sums);
        let mut versions = nodes.versions.numbers();
        let mut passed = 0;
        move |index| {
            let skipped = index - passed;
            passed = index + 1;
            let place = [&mut lats, &mut lons].map(|sums| sums.nth(skipped).unwrap_or_default());
            let version = versions.nth(skipped).map_or(0, to_version);
            self.placed(nodes.ids[index], place, version)
        }
    }

    /// Passes the nodes with a key that `is_wanted` accepts to `take`, with the numbers of the
    /// texts of their tags. Dense nodes come first.
    ///
    /// # Errors
    /// When tags are incomplete, which the audit does not find, and those of `take`.
    pub(crate) fn try_each_tagged<E: From<&'static str>>(
        &self,
        is_wanted: impl Fn(usize) -> bool,
        mut take: impl FnMut(BlockNode, &[[usize; 2]]) -> Result<(), E>,
    ) -> Result<(), E> {
        let mut pairs: Vec<[usize; 2]> = Vec::new();
        for nodes in self.dense().iter().filter(|nodes| !nodes.tags.is_empty()) {
            let mut texts = nodes.tags.numbers().map(|number| number as usize);
            let mut node_at = self.node_at(nodes);
            for index in 0..nodes.ids.len() {
                pairs.clear();
                loop {
                    match texts.next().ok_or(INCOMPLETE_TAGS)? {
                        0 => break,
                        key => pairs.push([key, texts.next().ok_or(INCOMPLETE_TAGS)?]),
                    }
                }
                if pairs.iter().any(|&[key, _]| is_wanted(key)) {
                    take(node_at(index), &pairs)?;
                }
            }
        }
        for node in self.groups.iter().flat_map(|group| parts(group, 1)) {
            let [keys, values] = [2, 3].map(|number| PackedField::from_message(node, number));
            let texts = keys.numbers().zip(values.numbers());
            pairs.clear();
            pairs.extend(texts.map(|(key, value)| [key as usize, value as usize]));
            if pairs.iter().any(|&[key, _]| is_wanted(key)) {
                take(self.node(node), &pairs)?;
            }
        }
        Ok(())
    }

    fn node(&self, node: &[u8]) -> BlockNode {
        let (mut id, mut place, mut info) = (0, [0; 2], Info::default());
        for field in wire::fields(node).flatten() {
            match (field.number, field.value) {
                (1, WireValue::Varint(number)) => id = zigzag(number),
                (4, WireValue::Bytes(message)) => info.read(message),
                (8, WireValue::Varint(number)) => place[0] = zigzag(number),
                (9, WireValue::Varint(number)) => place[1] = zigzag(number),
                _ => {}
            }
        }
        self.placed(id, place, info.version)
    }

    fn placed(&self, id: i64, place: [i64; 2], version: i32) -> BlockNode {
        let [lat_nano_deg, lon_nano_deg] = [0, 1].map(|axis| self.nano_deg(axis, place[axis]));
        BlockNode { id, lon_nano_deg, lat_nano_deg, version }
    }

    fn nano_deg(&self, axis: usize, steps: i64) -> i64 {
        self.offsets[axis].wrapping_add(self.granularity.wrapping_mul(steps))
    }

    /// Returns the ways, in their order.
    pub(crate) fn ways(&self) -> impl Iterator<Item = BlockWay<'_, 'a>> {
        let ways = self.groups.iter().flat_map(|group| parts(group, 3));
        ways.map(|way| BlockWay::new(self, way))
    }
}

impl<'b, 'a> BlockWay<'b, 'a> {
    fn new(block: &'b AuditedBlock<'a>, way: &'a [u8]) -> Self {
        let (mut id, mut info) = (0, Info::default());
        let [mut keys, mut values, mut refs] = [(); 3].map(|()| PackedField::default());
        let mut places = [(); 2].map(|()| PackedField::default());
        for field in wire::fields(way).flatten() {
            match (field.number, field.value) {
                (1, WireValue::Varint(number)) => id = number.cast_signed(),
                (2, value) => keys.add(value),
                (3, value) => values.add(value),
                (4, WireValue::Bytes(message)) => info.read(message),
                (8, value) => refs.add(value),
                (9, value) => places[0].add(value),
                (10, value) => places[1].add(value),
                _ => {}
            }
        }
        Self { block, id, info, keys, values, refs, places }
    }

    /// Returns the numbers of the way's keys in the table of texts.
    pub(crate) fn keys(&self) -> impl Iterator<Item = usize> {
        self.keys.numbers().map(|number| number as usize)
    }

    /// Returns the numbers of the way's keys and values, tag by tag.
    pub(crate) fn pairs(&self) -> impl Iterator<Item = [usize; 2]> {
        self.keys().zip(self.values.numbers()).map(|(key, value)| [key, value as usize])
    }

    /// Returns the ids of the way's nodes.
    pub(crate) fn refs(&self) -> impl Iterator<Item = i64> {
        self.refs.sums()
    }

    /// Writes the way's node ids to `ids`, and appends the positions of the nodes to `located` if
    /// the way contains them. In most files no way does.
    pub(crate) fn take_nodes(&self, ids: &mut Vec<i64>, located: &mut Vec<(i64, Location)>) {
        ids.clear();
        ids.extend(self.refs());
        // The block was checked: it has one position for each node, or none at all.
        let [lats, lons] = self.places.each_ref().map(PackedField::sums);
        located.extend(ids.iter().copied().zip(lons.zip(lats).map(|(lon, lat)| {
            location_from_nano(self.block.nano_deg(1, lon), self.block.nano_deg(0, lat))
        })));
    }
}

/// Returns the parts of a message that are in fields with this number.
pub(crate) fn parts(message: &[u8], number: u32) -> impl Iterator<Item = &[u8]> {
    wire::fields(message).flatten().filter_map(move |field| match field.value {
        WireValue::Bytes(bytes) if field.number == number => Some(bytes),
        _ => None,
    })
}

#[cfg(test)]
#[path = "block_tests.rs"]
mod tests;
