//! A road's nodes and what it is, as bytes: a fifth of what the same takes as lists and texts.
//!
//! ```text
//!  │ how many nodes │ their ids, as differences │ class form structure oneway layer │ name │ ref │ surface │
//! ```
//! Counts and lengths are varints, differences zigzag varints, the five others a byte each.

use std::io;

use corniche_roads::{Form, FunctionalRoadClass, Oneway, RoadAttributes, Structure};

use crate::{
    spool::damaged,
    wire::{push_varint, to_zigzag, varint, zigzag},
};

/// Writes a road's nodes and what it is.
pub(crate) fn way_bytes(
    node_ids: &[i64],
    class: FunctionalRoadClass,
    attributes: &RoadAttributes,
) -> Box<[u8]> {
    let RoadAttributes { form, structure, layer, oneway, name, reference, surface } = attributes;
    let texts = [name, reference, surface];
    let text_bytes: usize = texts.iter().map(|text| text.len() + 2).sum();
    let mut bytes = Vec::with_capacity(2 * node_ids.len() + text_bytes + 16);
    push_varint(&mut bytes, node_ids.len() as u64);
    let mut last = 0_i64;
    for &id in node_ids {
        push_varint(&mut bytes, to_zigzag(id.wrapping_sub(last)));
        last = id;
    }
    bytes.extend([class.number(), *form as u8, *structure as u8, *oneway as u8]);
    bytes.push(layer.cast_unsigned());
    for text in texts {
        push_varint(&mut bytes, text.len() as u64);
        bytes.extend(text.as_bytes());
    }
    bytes.into()
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
pub(crate) fn take_road(bytes: &mut &[u8]) -> Option<(FunctionalRoadClass, RoadAttributes)> {
    let (&[class, form, structure, oneway, layer], rest) = bytes.split_first_chunk::<5>()?;
    *bytes = rest;
    let road = RoadAttributes {
        form: *Form::ALL.get(usize::from(form))?,
        structure: *Structure::ALL.get(usize::from(structure))?,
        layer: layer.cast_signed(),
        oneway: *Oneway::ALL.get(usize::from(oneway))?,
        name: take_text(bytes)?,
        reference: take_text(bytes)?,
        surface: take_text(bytes)?,
    };
    Some((FunctionalRoadClass::new(class)?, road))
}

fn take_text(bytes: &mut &[u8]) -> Option<String> {
    let length = varint(bytes).ok()?.try_into().ok()?;
    let (text, rest) = bytes.split_at_checked(length)?;
    *bytes = rest;
    str::from_utf8(text).ok().map(str::to_owned)
}

#[cfg(test)]
#[path = "way_bytes_tests.rs"]
mod tests;
