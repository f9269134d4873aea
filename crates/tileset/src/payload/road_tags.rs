//! The road tags section: further tags of the ways in the road attributes section, one column per
//! tag. A tag that no way of the tile has takes one byte.

use std::num::{NonZeroU8, NonZeroU32};

use corniche_roads::RoadAttributes;

use crate::{
    limits::MAX_TEXT_BYTES,
    payload::{
        damage::{Damage, Result},
        number_codes::{Cursor, Planes, take_room},
        tile_payload::RoadRecord,
    },
};

/// Number of columns of texts.
const TEXT_COLUMNS: usize = 4;

/// The texts of a way, in the order of their columns.
#[cfg(feature = "write")]
fn texts(attributes: &RoadAttributes) -> [&String; TEXT_COLUMNS] {
    let RoadAttributes { highway, max_speed, sac_scale, tracktype, .. } = attributes;
    [highway, max_speed, sac_scale, tracktype]
}

/// The texts of a way as mutable references, in the order of their columns.
fn texts_mut(attributes: &mut RoadAttributes) -> [&mut String; TEXT_COLUMNS] {
    let RoadAttributes { highway, max_speed, sac_scale, tracktype, .. } = attributes;
    [highway, max_speed, sac_scale, tracktype]
}

/// Adds the tags in the section's bytes to the ways of the tile.
pub(crate) fn decode(bytes: &[u8], roads: &mut [RoadRecord]) -> Result<()> {
    let cursor = &mut Cursor::new(bytes);
    let known = known_texts(cursor, roads.len())?;
    let text_columns: Vec<Planes<'_>> =
        (0..TEXT_COLUMNS).map(|_| cursor.planes(roads.len())).collect::<Result<_, _>>()?;
    let [lanes, widths] = cursor.columns(roads.len())?;
    cursor.finish()?;
    // A shared text is copied for each way, as in the road attributes section.
    let used: usize = roads.iter().map(|road| road.attributes.text_bytes()).sum();
    let mut room = MAX_TEXT_BYTES.saturating_sub(used);
    for (column, indices) in text_columns.into_iter().enumerate() {
        for (road, index) in roads.iter_mut().zip(indices.iter()).filter(|(_, index)| *index > 0) {
            let text = usize::try_from(index - 1).ok().and_then(|index| known.get(index));
            let text = text.ok_or(Damage::Invalid("a text that does not exist"))?;
            take_room(&mut room, text.len(), MAX_TEXT_BYTES, "texts of all ways")?;
            (*text).clone_into(texts_mut(&mut road.attributes)[column]);
        }
    }
    for ((road, lanes), width_mm) in roads.iter_mut().zip(lanes.iter()).zip(widths.iter()) {
        let lanes = u8::try_from(lanes).map_err(|_| Damage::Invalid("a number of lanes"))?;
        let width_mm = u32::try_from(width_mm).map_err(|_| Damage::Invalid("a width"))?;
        road.attributes.lanes = NonZeroU8::new(lanes);
        road.attributes.width_mm = NonZeroU32::new(width_mm);
    }
    Ok(())
}

/// Reads the texts that the columns refer to: sorted, each once, none empty.
fn known_texts<'a>(cursor: &mut Cursor<'a>, ways: usize) -> Result<Vec<&'a str>> {
    let count = cursor.bounded(TEXT_COLUMNS * ways, "number of texts")?;
    // A text takes at least its length and one byte.
    if count > cursor.left() / 2 {
        return Err(Damage::TooShort);
    }
    let mut texts: Vec<&str> = Vec::with_capacity(count);
    for _ in 0..count {
        let length = cursor.bounded(cursor.left(), "length of a text")?;
        let text = str::from_utf8(cursor.take(length)?)
            .map_err(|_| Damage::Invalid("a text that is not UTF-8"))?;
        Damage::invalid_if(
            texts.last().copied().unwrap_or_default() >= text,
            "texts are not sorted",
        )?;
        texts.push(text);
    }
    Ok(texts)
}

/// Encodes the section; `None` if no way has any of the tags. The caller has checked the ways and
/// their texts.
#[cfg(feature = "write")]
pub(crate) fn encode(roads: &[RoadRecord]) -> Option<Vec<u8>> {
    use corniche_varints::push_varint;

    use crate::payload::number_codes::put_planes;

    let mut known: Vec<&str> = roads
        .iter()
        .flat_map(|road| texts(&road.attributes))
        .map(String::as_str)
        .filter(|text| !text.is_empty())
        .collect();
    known.sort_unstable();
    known.dedup();
    let lanes = |road: &RoadRecord| road.attributes.lanes.map_or(0, |lanes| lanes.get().into());
    let width = |road: &RoadRecord| road.attributes.width_mm.map_or(0, |mm| mm.get().into());
    let lanes: Vec<u64> = roads.iter().map(lanes).collect();
    let widths: Vec<u64> = roads.iter().map(width).collect();
    if known.is_empty() && lanes.iter().chain(&widths).all(|&number| number == 0) {
        return None;
    }
    let mut bytes = Vec::new();
    push_varint(&mut bytes, known.len() as u64);
    for text in &known {
        push_varint(&mut bytes, text.len() as u64);
        bytes.extend(text.as_bytes());
    }
    for column in 0..TEXT_COLUMNS {
        let index = |road: &RoadRecord| match texts(&road.attributes)[column].as_str() {
            "" => 0,
            text => known.partition_point(|&other| other < text) as u64 + 1,
        };
        put_planes(&mut bytes, &roads.iter().map(index).collect::<Vec<_>>());
    }
    put_planes(&mut bytes, &lanes);
    put_planes(&mut bytes, &widths);
    Some(bytes)
}

#[cfg(all(test, feature = "write"))]
#[path = "road_tags_tests.rs"]
mod tests;
