//! The road attributes section: one record per way, with each text stored once. Later additions are
//! in the road tags section.

use corniche_roads::{Form, Oneway, RoadAttributes, Structure};
use serde::de::DeserializeOwned;

use crate::{
    limits::{MAX_SECTION_BYTES, MAX_TEXT_BYTES, MAX_WAYS},
    payload::{
        damage::{Damage, Result},
        number_codes::take_room,
        tile_payload::RoadRecord,
    },
};

/// The whole section, in `bincode`'s legacy layout: every list begins with its length as a u64.
/// Lists after `texts` have one item per way.
#[derive(Default)]
#[cfg_attr(feature = "write", derive(serde::Serialize))]
struct AttributesTable {
    /// The texts, sorted, each once.
    texts: Vec<String>,
    /// The way ids, ascending; each as its difference from the id before.
    way_id_steps: Vec<i64>,
    forms: Vec<u8>,
    structures: Vec<u8>,
    layers: Vec<i8>,
    oneways: Vec<u8>,
    /// Indices into `texts`.
    names: Vec<u32>,
    references: Vec<u32>,
    surfaces: Vec<u32>,
}

/// Decodes the section's bytes into lists, and checks that their lengths and indices match.
fn decode_record(bytes: &[u8]) -> Result<AttributesTable> {
    let mut rest = bytes;
    let record = AttributesTable {
        texts: list(&mut rest, 3 * MAX_WAYS)?,
        way_id_steps: list(&mut rest, MAX_WAYS)?,
        forms: list(&mut rest, MAX_WAYS)?,
        structures: list(&mut rest, MAX_WAYS)?,
        layers: list(&mut rest, MAX_WAYS)?,
        oneways: list(&mut rest, MAX_WAYS)?,
        names: list(&mut rest, MAX_WAYS)?,
        references: list(&mut rest, MAX_WAYS)?,
        surfaces: list(&mut rest, MAX_WAYS)?,
    };
    Damage::invalid_if(!rest.is_empty(), "bytes left over at the end")?;
    let count = record.way_id_steps.len();
    let lengths = [
        record.forms.len(),
        record.structures.len(),
        record.layers.len(),
        record.oneways.len(),
        record.names.len(),
        record.references.len(),
        record.surfaces.len(),
    ];
    Damage::invalid_if(lengths != [count; 7], "lists of different lengths")?;
    Ok(record)
}

pub(crate) fn decode(bytes: &[u8]) -> Result<Vec<RoadRecord>> {
    let record = decode_record(bytes)?;
    let count = record.way_id_steps.len();
    // A long text that every way uses is copied for each way. The limit prevents a small section
    // from becoming a large tile.
    let mut room = MAX_TEXT_BYTES;
    let mut text = |index: u32| {
        let text = record
            .texts
            .get(index as usize)
            .ok_or(Damage::Invalid("a text that does not exist"))?;
        take_room(&mut room, text.len(), MAX_TEXT_BYTES, "texts of all ways")?;
        Ok::<String, Damage>(text.clone())
    };
    let known = Damage::Invalid("a value that this version does not know");
    let mut way_id = 0_i64;
    let mut roads = Vec::with_capacity(count);
    for k in 0..count {
        let step = record.way_id_steps[k];
        Damage::invalid_if(k > 0 && step <= 0, "ways are not sorted")?;
        way_id = way_id.checked_add(step).ok_or(Damage::Invalid("a way id"))?;
        let attributes = RoadAttributes {
            form: *Form::ALL.get(usize::from(record.forms[k])).ok_or(known.clone())?,
            structure: *Structure::ALL
                .get(usize::from(record.structures[k]))
                .ok_or(known.clone())?,
            layer: record.layers[k],
            oneway: *Oneway::ALL.get(usize::from(record.oneways[k])).ok_or(known.clone())?,
            name: text(record.names[k])?,
            reference: text(record.references[k])?,
            surface: text(record.surfaces[k])?,
            ..RoadAttributes::default()
        };
        roads.push(RoadRecord { way_id, attributes });
    }
    Ok(roads)
}

/// Takes one list of the record from the front of the bytes. Its length is checked before its items
/// are read.
fn list<T: DeserializeOwned>(bytes: &mut &[u8], limit: usize) -> Result<Vec<T>> {
    let length = bytes.first_chunk().map(|&length| u64::from_le_bytes(length));
    let length = length.ok_or(Damage::TooShort)?;
    Damage::limit("ways of a section", length, limit)?;
    let config = bincode::config::legacy().with_limit::<MAX_SECTION_BYTES>();
    let (list, taken) = bincode::serde::decode_from_slice(bytes, config)
        .map_err(|_| Damage::Invalid("the records of the section"))?;
    *bytes = bytes.get(taken..).ok_or(Damage::TooShort)?;
    Ok(list)
}

/// Encodes the section; an error describes what cannot be encoded.
#[cfg(feature = "write")]
pub(crate) fn encode(roads: &[RoadRecord]) -> Result<Vec<u8>, &'static str> {
    use crate::payload::damage::refuse_if;

    refuse_if(
        !roads.is_sorted_by(|a, b| a.way_id < b.way_id),
        "ways that are not sorted by id, or occur twice",
    )?;
    refuse_if(roads.len() > MAX_WAYS, "more than a million ways")?;
    refuse_if(
        roads.iter().map(|road| road.attributes.text_bytes()).sum::<usize>() > MAX_TEXT_BYTES,
        "more than 64 MiB of texts",
    )?;
    let mut texts: Vec<&str> = roads
        .iter()
        .flat_map(|road| {
            [&road.attributes.name, &road.attributes.reference, &road.attributes.surface]
        })
        .map(String::as_str)
        .collect();
    texts.sort_unstable();
    texts.dedup();
    let index = |text: &str| texts.partition_point(|&other| other < text) as u32;
    let mut record = AttributesTable {
        texts: texts.iter().map(|&text| text.to_owned()).collect(),
        ..AttributesTable::default()
    };
    let mut previous = 0_i64;
    for RoadRecord { way_id, attributes } in roads {
        record
            .way_id_steps
            .push(way_id.checked_sub(previous).ok_or("way ids that are too far apart")?);
        previous = *way_id;
        // The number of a variant is its index in the list `ALL`, by which it is read.
        record.forms.push(attributes.form as u8);
        record.structures.push(attributes.structure as u8);
        record.layers.push(attributes.layer);
        record.oneways.push(attributes.oneway as u8);
        record.names.push(index(&attributes.name));
        record.references.push(index(&attributes.reference));
        record.surfaces.push(index(&attributes.surface));
    }
    bincode::serde::encode_to_vec(&record, bincode::config::legacy())
        .map_err(|_| "the records of the section")
}
