//! A road's nodes and what it is, as bytes: a fifth of what the same takes as lists and texts.
//!
//! ```text
//!  │ how many nodes │ their ids, as differences │ class form structure layer oneway lanes │ width │ texts │
//! ```
//! The texts are name, ref, surface, highway, maxspeed, `sac_scale`, tracktype.
//! A way that is left out has a mark in place of the class, the reason, and its `highway` value:
//!
//! ```text
//!  │ how many nodes │ their ids, as differences │ 255 reason │ highway value │ structure layer │
//! ```
//! Its structure is counted from 1; 0 is that of a way that carries nothing.
//! Counts and lengths are varints, differences zigzag varints; the width is a varint of millimetres, 0 for none; the six
//! others are a byte each.

use std::io;

use corniche_roads::{AttributeParts, FunctionalRoadClass, RoadAttributes, Structure};

use crate::{
    LeftOutReason,
    spool::damaged,
    wire::{
        push_bytes, push_signed, push_varint, take_array, take_number, take_text, varint, zigzag,
    },
};

/// Writes a road's nodes and what it is.
pub(crate) fn way_bytes(
    node_ids: &[i64],
    class: FunctionalRoadClass,
    attributes: &RoadAttributes,
) -> Box<[u8]> {
    let AttributeParts { codes, width_mm, texts } = attributes.parts();
    let mut bytes = Vec::with_capacity(2 * node_ids.len() + attributes.text_bytes() + 32);
    push_node_ids(&mut bytes, node_ids);
    bytes.push(class.number());
    bytes.extend(codes);
    push_varint(&mut bytes, width_mm.into());
    for text in texts {
        push_bytes(&mut bytes, text.as_bytes());
    }
    bytes.into()
}

/// Stands in place of a class where the way is left out.
const LEFT_OUT: u8 = u8::MAX;

/// What a way is.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum WayKind {
    Road(FunctionalRoadClass, RoadAttributes),
    LeftOut(LeftOutWay<String>),
}

/// A way that is left out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct LeftOutWay<T> {
    pub(crate) reason: LeftOutReason,
    /// Its `highway` value.
    pub(crate) highway: T,
    /// What carries it, and its layer: of a way that is a road of another class. `None` for what is no road.
    pub(crate) carrier: Option<(Structure, i8)>,
}

/// Writes the nodes of a way that is left out, and why.
pub(crate) fn left_out_bytes(node_ids: &[i64], way: LeftOutWay<&str>) -> Box<[u8]> {
    let LeftOutWay { reason, highway, carrier } = way;
    let mut bytes = Vec::with_capacity(2 * node_ids.len() + highway.len() + 16);
    push_node_ids(&mut bytes, node_ids);
    bytes.extend([LEFT_OUT, reason as u8]);
    push_bytes(&mut bytes, highway.as_bytes());
    let (structure, layer) =
        carrier.map_or((0, 0), |(structure, layer)| (structure as u8 + 1, layer));
    bytes.extend([structure, layer.cast_unsigned()]);
    bytes.into()
}

/// Writes the nodes of a way of which nothing else is asked.
pub(crate) fn node_bytes(node_ids: &[i64]) -> Box<[u8]> {
    let mut bytes = Vec::with_capacity(2 * node_ids.len() + 16);
    push_node_ids(&mut bytes, node_ids);
    bytes.into()
}

fn push_node_ids(bytes: &mut Vec<u8>, node_ids: &[i64]) {
    push_varint(bytes, node_ids.len() as u64);
    let mut last = 0_i64;
    for &id in node_ids {
        push_signed(bytes, id.wrapping_sub(last));
        last = id;
    }
}

/// Whether what follows the nodes is that of a way that is left out.
pub(crate) fn is_left_out(after_nodes: &[u8]) -> bool {
    after_nodes.first() == Some(&LEFT_OUT)
}

/// Takes the ids of a road's nodes from the front of its bytes and hands each to `take`; returns how many there are.
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

/// Takes what follows the nodes. `None` if the bytes are damaged.
pub(crate) fn take_way(bytes: &mut &[u8]) -> Option<WayKind> {
    if is_left_out(bytes) {
        let LeftOutWay { reason, highway, carrier } = take_left_out(bytes)?;
        return Some(WayKind::LeftOut(LeftOutWay { reason, highway: highway.to_owned(), carrier }));
    }
    let [class] = take_array(bytes)?;
    let codes = take_array(bytes)?;
    let width_mm = take_number(bytes)?;
    let road = RoadAttributes::from_parts(codes, width_mm, || take_text(bytes).map(str::to_owned))?;
    Some(WayKind::Road(FunctionalRoadClass::new(class)?, road))
}

/// The same for a way that is left out.
pub(crate) fn take_left_out<'b>(bytes: &mut &'b [u8]) -> Option<LeftOutWay<&'b str>> {
    let [_, reason] = take_array(bytes)?;
    let reason = *LeftOutReason::ALL.get(usize::from(reason))?;
    let highway = take_text(bytes)?;
    let [structure, layer] = take_array(bytes)?;
    let carrier = match structure.checked_sub(1) {
        Some(code) => Some((*Structure::ALL.get(usize::from(code))?, layer.cast_signed())),
        None => None,
    };
    Some(LeftOutWay { reason, highway, carrier })
}

/// Whether what follows the nodes is that of a way that carries bridges and tunnels, although it is left out.
pub(crate) fn is_carrier(after_nodes: &[u8]) -> bool {
    matches!(after_nodes, [LEFT_OUT, .., structure, _] if *structure > 0)
}

#[cfg(test)]
#[path = "way_bytes_tests.rs"]
mod tests;
