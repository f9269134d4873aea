//! A road's nodes and properties as bytes, which take a fifth of the memory of lists and texts.
//!
//! ```text
//!  │ how many nodes │ their ids, as differences │ class form structure layer oneway lanes │ width │ texts │
//! ```
//! The texts are name, ref, surface, highway, maxspeed, `sac_scale`, tracktype.
//! A skipped way has a mark in place of the class, then its `highway` value and a record of the
//! rest. A railway has another mark:
//!
//! ```text
//!  │ how many nodes │ their ids, as differences │ 255 │ highway value │ (reason, carrier, railway) │
//!  │ how many nodes │ their ids, as differences │ 254 │ [`Track`] │
//! ```
//! Counts and lengths are varints, differences zigzag varints; the width is a varint of
//! millimetres, 0 for none; the six others are a byte each.

use std::io;

use corniche_roads::{FunctionalRoadClass, Railway, RoadAttributes, Structure};
use corniche_store::{append_record, take_record};
use serde::{Deserialize, Serialize};

use crate::{
    LeftOutReason,
    spool::damaged,
    wire::{push_bytes, push_signed, push_varint, take_array, take_text, varint, zigzag},
};

/// Writes a road's nodes and properties.
pub(crate) fn way_bytes(
    node_ids: &[i64],
    class: FunctionalRoadClass,
    attributes: &RoadAttributes,
) -> Box<[u8]> {
    let mut bytes = with_node_ids(node_ids, attributes.text_bytes() + 32);
    bytes.push(class.number());
    attributes.push_to(&mut bytes);
    bytes.into()
}

/// The mark in place of the class if the way is skipped.
const LEFT_OUT: u8 = u8::MAX;
/// The mark in place of the class of a railway.
const RAILWAY: u8 = u8::MAX - 1;

/// A road, a skipped way or a railway, with its properties.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum WayKind {
    Road(FunctionalRoadClass, RoadAttributes),
    LeftOut(LeftOutWay<String>),
    Railway(Track),
}

/// A railway: bridges and tunnels cross it, and it has some itself.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(crate) struct Track {
    pub(crate) kind: Railway,
    pub(crate) structure: Structure,
    pub(crate) layer: i8,
}

/// A skipped way.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct LeftOutWay<T> {
    pub(crate) reason: LeftOutReason,
    /// The `highway` value of the way.
    pub(crate) highway: T,
    /// The structure that carries the way and its layer, if the way is a road of another class;
    /// `None` if it is not a road.
    pub(crate) carrier: Option<(Structure, i8)>,
    /// The kind of railway, if the way is also one and its `highway` value is not that of a road.
    pub(crate) railway: Option<Railway>,
}

/// Writes the nodes of a skipped way, and the reason.
pub(crate) fn left_out_bytes(node_ids: &[i64], way: LeftOutWay<&str>) -> Box<[u8]> {
    let LeftOutWay { reason, highway, carrier, railway } = way;
    let mut bytes = with_node_ids(node_ids, highway.len() + 16);
    bytes.push(LEFT_OUT);
    push_bytes(&mut bytes, highway.as_bytes());
    append_record(&mut bytes, (reason, carrier, railway));
    bytes.into()
}

/// Writes the nodes and properties of a railway.
pub(crate) fn railway_bytes(node_ids: &[i64], track: Track) -> Box<[u8]> {
    let mut bytes = with_node_ids(node_ids, 16);
    bytes.push(RAILWAY);
    append_record(&mut bytes, track);
    bytes.into()
}

/// Writes the nodes of a way and its structure, which is all that layers need.
pub(crate) fn node_bytes(node_ids: &[i64], structure: Structure) -> Box<[u8]> {
    let mut bytes = with_node_ids(node_ids, 16);
    bytes.push(structure as u8);
    bytes.into()
}

/// Returns the structure of a way whose bytes end with those of [`node_bytes`].
pub(crate) fn structure_of_layer_way(bytes: &[u8]) -> Option<Structure> {
    Structure::ALL.get(usize::from(*bytes.last()?)).copied()
}

/// Writes node ids, with room for about `more_bytes`.
fn with_node_ids(node_ids: &[i64], more_bytes: usize) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(2 * node_ids.len() + more_bytes);
    push_varint(&mut bytes, node_ids.len() as u64);
    let mut last = 0_i64;
    for &id in node_ids {
        push_signed(&mut bytes, id.wrapping_sub(last));
        last = id;
    }
    bytes
}

/// Whether the bytes after the nodes belong to a skipped way.
pub(crate) fn is_left_out(after_nodes: &[u8]) -> bool {
    after_nodes.first() == Some(&LEFT_OUT)
}

/// Whether the bytes after the nodes belong to a railway.
pub(crate) fn is_railway(after_nodes: &[u8]) -> bool {
    after_nodes.first() == Some(&RAILWAY)
}

/// Takes the ids of a road's nodes from the front of its bytes and passes each to `take`; returns
/// the number of ids.
pub(crate) fn take_node_ids(
    bytes: &mut &[u8],
    mut take: impl FnMut(i64) -> io::Result<()>,
) -> io::Result<u64> {
    let mut number = || varint(bytes).map_err(|_| damaged());
    let count = number()?;
    let mut id = 0_i64;
    for _ in 0..count {
        id = id.wrapping_add(zigzag(number()?));
        take(id)?;
    }
    Ok(count)
}

/// Takes the bytes after the nodes; `None` if they are corrupt.
pub(crate) fn take_way(bytes: &mut &[u8]) -> Option<WayKind> {
    if is_left_out(bytes) {
        let LeftOutWay { reason, highway, carrier, railway } = take_left_out(bytes)?;
        let highway = highway.to_owned();
        return Some(WayKind::LeftOut(LeftOutWay { reason, highway, carrier, railway }));
    }
    if is_railway(bytes) {
        let [_] = take_array(bytes)?;
        return take_record(bytes).map(WayKind::Railway);
    }
    let [class] = take_array(bytes)?;
    let attributes = RoadAttributes::take_from(bytes)?;
    Some(WayKind::Road(FunctionalRoadClass::new(class)?, attributes))
}

/// Takes the bytes of a skipped way after its nodes.
pub(crate) fn take_left_out<'b>(bytes: &mut &'b [u8]) -> Option<LeftOutWay<&'b str>> {
    let [_] = take_array(bytes)?;
    let highway = take_text(bytes)?;
    let (reason, carrier, railway) = take_record(bytes)?;
    Some(LeftOutWay { reason, highway, carrier, railway })
}

/// Whether the bytes after the nodes belong to a way that is no road here, but may carry or cross
/// bridges and tunnels.
pub(crate) fn is_carrier(mut after_nodes: &[u8]) -> bool {
    is_railway(after_nodes)
        || is_left_out(after_nodes)
            && take_left_out(&mut after_nodes).is_some_and(|way| way.carrier.is_some())
}

#[cfg(test)]
#[path = "way_bytes_tests.rs"]
mod tests;
