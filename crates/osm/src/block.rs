//! A block read in place: nodes and ways without a copy of each.
//!
//! Only blocks that were audited are read here. So all fields are of their kinds, arrays that belong together are equally long, sums do not
//! overflow, and every tag is in the table.

use std::{borrow::Cow, iter, ops::ControlFlow};

use crate::wire::{self, Numbers, Value, push_varint, zigzag};

/// A block (message `PrimitiveBlock`) that was audited.
pub(crate) struct Block<'a> {
    texts: &'a [u8],
    groups: Vec<&'a [u8]>,
    /// Nanodegrees in a step of the coordinates.
    granularity: i64,
    /// Latitude and longitude of the coordinates 0, nanodegrees.
    offsets: [i64; 2],
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
    /// 0 if it is not known.
    pub(crate) version: i32,
    keys: Packed<'a>,
    values: Packed<'a>,
    refs: Packed<'a>,
    places: [Packed<'a>; 2],
}

impl<'a> Block<'a> {
    pub(crate) fn new(message: &'a [u8]) -> Self {
        let mut block = Self { texts: &[], groups: Vec::new(), granularity: 100, offsets: [0; 2] };
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

    /// The texts of tags, by number.
    pub(crate) fn texts(&self) -> Vec<&'a [u8]> {
        parts(self.texts, 1).collect()
    }

    /// Whether there is something else than nodes in it.
    pub(crate) fn has_others_than_nodes(&self) -> bool {
        let mut fields = self.groups.iter().flat_map(|group| wire::fields(group)).flatten();
        fields.any(|field| !matches!(field.number, 1 | 2))
    }

    /// Whether there is a relation in it.
    pub(crate) fn has_relations(&self) -> bool {
        let mut fields = self.groups.iter().flat_map(|group| wire::fields(group)).flatten();
        fields.any(|field| field.number == 4)
    }

    /// How many nodes there are.
    pub(crate) fn nodes_count(&self) -> u64 {
        let of_group = |group: &&'a [u8]| {
            let dense = parts(group, 2).map(|nodes| Packed::of(nodes, 1).len());
            parts(group, 1).count() + dense.sum::<usize>()
        };
        self.groups.iter().map(|group| of_group(group) as u64).sum()
    }

    /// Hands on the nodes, of each group first those in lists, until `take` wants no more.
    pub(crate) fn try_each_node(
        &self,
        mut take: impl FnMut(BlockNode) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        for group in &self.groups {
            for nodes in parts(group, 2) {
                self.try_each_dense(nodes, &mut take)?;
            }
            parts(group, 1).try_for_each(|node| take(self.node(node)))?;
        }
        ControlFlow::Continue(())
    }

    fn try_each_dense(
        &self,
        nodes: &[u8],
        take: &mut impl FnMut(BlockNode) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let [ids, lats, lons] = [1, 8, 9].map(|number| Packed::of(nodes, number));
        let versions = parts(nodes, 5).last().map(|info| Packed::of(info, 1)).unwrap_or_default();
        let mut versions = versions.numbers().map(to_version).chain(iter::repeat(0));
        let [ids, lats, lons] = [&ids, &lats, &lons].map(Packed::sums);
        for ((id, lat), lon) in ids.zip(lats).zip(lons) {
            take(self.placed(id, [lat, lon], versions.next().unwrap_or_default()))?;
        }
        ControlFlow::Continue(())
    }

    fn node(&self, node: &[u8]) -> BlockNode {
        let (mut id, mut place, mut version) = (0, [0; 2], 0);
        for field in wire::fields(node).flatten() {
            match (field.number, field.value) {
                (1, Value::Varint(number)) => id = zigzag(number),
                (4, Value::Bytes(info)) => version = version_of(info),
                (8, Value::Varint(number)) => place[0] = zigzag(number),
                (9, Value::Varint(number)) => place[1] = zigzag(number),
                _ => {}
            }
        }
        self.placed(id, place, version)
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
        let (mut id, mut version) = (0, 0);
        let [mut keys, mut values, mut refs] = [(); 3].map(|()| Packed::default());
        let mut places = [(); 2].map(|()| Packed::default());
        for field in wire::fields(way).flatten() {
            match (field.number, field.value) {
                (1, Value::Varint(number)) => id = number.cast_signed(),
                (2, value) => keys.add(value),
                (3, value) => values.add(value),
                (4, Value::Bytes(info)) => version = version_of(info),
                (8, value) => refs.add(value),
                (9, value) => places[0].add(value),
                (10, value) => places[1].add(value),
                _ => {}
            }
        }
        Self { block, id, version, keys, values, refs, places }
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

    /// Longitude and latitude of each node, nanodegrees; none in most files.
    pub(crate) fn places_nano_deg(&self) -> impl Iterator<Item = [i64; 2]> {
        let [lats, lons] = self.places.each_ref().map(Packed::sums);
        lons.zip(lats).map(|(lon, lat)| [self.block.nano_deg(1, lon), self.block.nano_deg(0, lat)])
    }
}

/// The numbers of a repeated field, one after the other: as they stand in the message, or joined if they stand there in parts.
#[derive(Default)]
pub(crate) struct Packed<'a>(Cow<'a, [u8]>);

impl<'a> Packed<'a> {
    /// The numbers in a field of a message.
    pub(crate) fn of(message: &'a [u8], number: u32) -> Self {
        let mut packed = Self::default();
        let fields = wire::fields(message).flatten().filter(|field| field.number == number);
        fields.for_each(|field| packed.add(field.value));
        packed
    }

    fn add(&mut self, value: Value<'a>) {
        match value {
            Value::Bytes(bytes) if self.0.is_empty() => self.0 = Cow::Borrowed(bytes),
            Value::Bytes(bytes) => self.0.to_mut().extend(bytes),
            Value::Varint(number) => push_varint(self.0.to_mut(), number),
            Value::Fixed => {}
        }
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// How many there are: each ends in a byte without the top bit.
    fn len(&self) -> usize {
        self.0.iter().filter(|&&byte| byte < 0x80).count()
    }

    pub(crate) fn numbers(&self) -> impl Iterator<Item = u64> {
        Numbers::of(&self.0).map_while(Result::ok)
    }

    /// What they add up to, one after the other, as differences.
    pub(crate) fn sums(&self) -> impl Iterator<Item = i64> {
        self.numbers().scan(0_i64, |sum, step| {
            *sum = sum.wrapping_add(zigzag(step));
            Some(*sum)
        })
    }
}

/// The parts of a message in fields of this number.
pub(crate) fn parts(message: &[u8], number: u32) -> impl Iterator<Item = &[u8]> {
    wire::fields(message).flatten().filter_map(move |field| match field.value {
        Value::Bytes(bytes) if field.number == number => Some(bytes),
        _ => None,
    })
}

/// The version that a message `Info` tells; 0 if it tells none.
fn version_of(info: &[u8]) -> i32 {
    let of_field = |field: wire::Field<'_>| match (field.number, field.value) {
        (1, Value::Varint(version)) => Some(to_version(version)),
        _ => None,
    };
    wire::fields(info).flatten().filter_map(of_field).last().unwrap_or_default()
}

/// An `int32`: of a negative one, ten bytes are written, and what does not fit is no version.
pub(crate) fn to_version(number: u64) -> i32 {
    i32::try_from(number.cast_signed()).unwrap_or(0)
}

#[cfg(test)]
#[path = "block_tests.rs"]
mod tests;
