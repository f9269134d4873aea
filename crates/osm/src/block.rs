//! A block read in place: nodes and ways without a copy of each.
//!
//! Only blocks that were audited are read here. So all fields are of their kinds, arrays that belong together are equally long, sums do not
//! overflow, and every tag is in the table.

use std::{cell::OnceCell, ops::ControlFlow};

use crate::{
    location::{Location, location_from_nano},
    object_info::{Info, to_version},
    packed::Packed,
    wire::{self, Value, zigzag},
};

/// A block (message `PrimitiveBlock`) that was audited.
pub(crate) struct Block<'a> {
    texts: &'a [u8],
    groups: Vec<&'a [u8]>,
    /// Nanodegrees in a step of the coordinates.
    granularity: i64,
    /// Latitude and longitude of the coordinates 0, nanodegrees.
    offsets: [i64; 2],
    /// Read when they are asked for.
    dense: OnceCell<Vec<DenseNodes<'a>>>,
}

/// The nodes of a list: their ids as numbers, the rest as it stands in the block.
pub(crate) struct DenseNodes<'a> {
    pub(crate) ids: Vec<i64>,
    /// Steps of latitudes and longitudes.
    places: [Packed<'a>; 2],
    /// May be fewer than the nodes, or none; so may the marks of those that are not deleted.
    pub(crate) versions: Packed<'a>,
    pub(crate) visible: Packed<'a>,
}

impl<'a> DenseNodes<'a> {
    fn of(nodes: &'a [u8]) -> Self {
        let [ids, lats, lons] = [1, 8, 9].map(|number| Packed::of(nodes, number));
        let info = parts(nodes, 5).last().unwrap_or_default();
        let [versions, visible] = [1, 6].map(|number| Packed::of(info, number));
        // Of its size at once: a list that grows asks for room before each number.
        let mut known = vec![0; ids.len()];
        known.iter_mut().zip(ids.sums()).for_each(|(id, sum)| *id = sum);
        Self { ids: known, places: [lats, lons], versions, visible }
    }
}

/// A node of a block.
pub(crate) struct BlockNode {
    pub(crate) id: i64,
    pub(crate) lon_nano_deg: i64,
    pub(crate) lat_nano_deg: i64,
    /// 0 if it is not known.
    pub(crate) version: i32,
}

/// A way of a block.
pub(crate) struct BlockWay<'b, 'a> {
    block: &'b Block<'a>,
    pub(crate) id: i64,
    pub(crate) info: Info,
    keys: Packed<'a>,
    values: Packed<'a>,
    refs: Packed<'a>,
    places: [Packed<'a>; 2],
}

impl<'a> Block<'a> {
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
                (1, Value::Bytes(texts)) => block.texts = texts,
                (2, Value::Bytes(group)) => block.groups.push(group),
                (17, Value::Varint(number)) => block.granularity = number.cast_signed(),
                (19, Value::Varint(number)) => block.offsets[0] = number.cast_signed(),
                (20, Value::Varint(number)) => block.offsets[1] = number.cast_signed(),
                _ => {}
            }
        }
        block
    }

    /// The groups of objects (messages `PrimitiveGroup`).
    pub(crate) fn groups(&self) -> &[&'a [u8]] {
        &self.groups
    }

    /// The texts of tags, by number.
    pub(crate) fn texts(&self) -> Vec<&'a [u8]> {
        parts(self.texts, 1).collect()
    }

    /// The numbers of the fields with its objects, which say of what kind these are.
    fn kinds(&self) -> impl Iterator<Item = u32> {
        self.groups.iter().flat_map(|group| wire::fields(group)).flatten().map(|field| field.number)
    }

    /// Whether there is something else than nodes in it.
    pub(crate) fn has_others_than_nodes(&self) -> bool {
        self.kinds().any(|kind| !matches!(kind, 1 | 2))
    }

    /// Whether there is a relation in it.
    pub(crate) fn has_relations(&self) -> bool {
        self.kinds().any(|kind| kind == 4)
    }

    /// Whether there are ways in it, and nothing else.
    pub(crate) fn has_ways_alone(&self) -> bool {
        let mut kinds = self.kinds();
        kinds.next() == Some(3) && kinds.all(|kind| kind == 3)
    }

    /// How many nodes there are.
    pub(crate) fn nodes_count(&self) -> u64 {
        let dense = self.dense().iter().map(|nodes| nodes.ids.len() as u64).sum::<u64>();
        dense + self.groups.iter().map(|group| parts(group, 1).count() as u64).sum::<u64>()
    }

    /// The nodes in lists, group by group. Of a block that was audited no group has two lists.
    pub(crate) fn dense(&self) -> &[DenseNodes<'a>] {
        self.dense.get_or_init(|| {
            self.groups.iter().flat_map(|group| parts(group, 2)).map(DenseNodes::of).collect()
        })
    }

    /// The nodes that are not in lists.
    pub(crate) fn plain_nodes(&self) -> impl Iterator<Item = BlockNode> {
        self.groups.iter().flat_map(|group| parts(group, 1)).map(|node| self.node(node))
    }

    /// Hands on the nodes for which `find` finds something by their ids, of each group first those in lists, until `take` wants no more.
    pub(crate) fn try_each_node<T>(
        &self,
        mut find: impl FnMut(i64) -> Option<T>,
        mut take: impl FnMut(T, BlockNode) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let mut dense = self.dense().iter();
        for group in &self.groups {
            for nodes in parts(group, 2).zip(&mut dense).map(|(_, nodes)| nodes) {
                self.try_each_dense(nodes, &mut find, &mut take)?;
            }
            for node in parts(group, 1).map(|node| self.node(node)) {
                if let Some(found) = find(node.id) {
                    take(found, node)?;
                }
            }
        }
        ControlFlow::Continue(())
    }

    /// Places and versions are read up to the last node that is found, and not at all if none is.
    fn try_each_dense<T>(
        &self,
        nodes: &DenseNodes<'_>,
        mut find: impl FnMut(i64) -> Option<T>,
        take: &mut impl FnMut(T, BlockNode) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let [mut lats, mut lons] = nodes.places.each_ref().map(Packed::sums);
        let mut versions = nodes.versions.numbers();
        let mut passed = 0;
        for (index, &id) in nodes.ids.iter().enumerate() {
            let Some(found) = find(id) else { continue };
            let skipped = index - passed;
            passed = index + 1;
            let [lat, lon] =
                [&mut lats, &mut lons].map(|sums| sums.nth(skipped).unwrap_or_default());
            let version = versions.nth(skipped).map_or(0, to_version);
            take(found, self.placed(id, [lat, lon], version))?;
        }
        ControlFlow::Continue(())
    }

    fn node(&self, node: &[u8]) -> BlockNode {
        let (mut id, mut place, mut info) = (0, [0; 2], Info::default());
        for field in wire::fields(node).flatten() {
            match (field.number, field.value) {
                (1, Value::Varint(number)) => id = zigzag(number),
                (4, Value::Bytes(message)) => info.read(message),
                (8, Value::Varint(number)) => place[0] = zigzag(number),
                (9, Value::Varint(number)) => place[1] = zigzag(number),
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

    /// The ways, in their order.
    pub(crate) fn ways(&self) -> impl Iterator<Item = BlockWay<'_, 'a>> {
        let ways = self.groups.iter().flat_map(|group| parts(group, 3));
        ways.map(|way| BlockWay::new(self, way))
    }
}

impl<'b, 'a> BlockWay<'b, 'a> {
    fn new(block: &'b Block<'a>, way: &'a [u8]) -> Self {
        let (mut id, mut info) = (0, Info::default());
        let [mut keys, mut values, mut refs] = [(); 3].map(|()| Packed::default());
        let mut places = [(); 2].map(|()| Packed::default());
        for field in wire::fields(way).flatten() {
            match (field.number, field.value) {
                (1, Value::Varint(number)) => id = number.cast_signed(),
                (2, value) => keys.add(value),
                (3, value) => values.add(value),
                (4, Value::Bytes(message)) => info.read(message),
                (8, value) => refs.add(value),
                (9, value) => places[0].add(value),
                (10, value) => places[1].add(value),
                _ => {}
            }
        }
        Self { block, id, info, keys, values, refs, places }
    }

    /// The numbers of its keys in the table of texts.
    pub(crate) fn keys(&self) -> impl Iterator<Item = usize> {
        self.keys.numbers().map(|number| number as usize)
    }

    /// The numbers of its values, in the order of the keys.
    pub(crate) fn values(&self) -> impl Iterator<Item = usize> {
        self.values.numbers().map(|number| number as usize)
    }

    /// Its nodes.
    pub(crate) fn refs(&self) -> impl Iterator<Item = i64> {
        self.refs.sums()
    }

    /// Makes a list of its nodes, and adds to another one where they lie, if the way says so: in most files none does.
    pub(crate) fn take_nodes(&self, ids: &mut Vec<i64>, located: &mut Vec<(i64, Location)>) {
        ids.clear();
        ids.extend(self.refs());
        // The block was checked: one place for each node, or none at all.
        let [lats, lons] = self.places.each_ref().map(Packed::sums);
        located.extend(ids.iter().copied().zip(lons.zip(lats).map(|(lon, lat)| {
            location_from_nano(self.block.nano_deg(1, lon), self.block.nano_deg(0, lat))
        })));
    }
}

/// The parts of a message in fields of this number.
pub(crate) fn parts(message: &[u8], number: u32) -> impl Iterator<Item = &[u8]> {
    wire::fields(message).flatten().filter_map(move |field| match field.value {
        Value::Bytes(bytes) if field.number == number => Some(bytes),
        _ => None,
    })
}

#[cfg(test)]
#[path = "block_tests.rs"]
mod tests;
