//! The road attributes section: records by way, with each text stored once.

use corniche_roads::{Form, Oneway, RoadAttributes, Structure};
use serde::{Deserialize, Serialize};

use super::{Damage, MAX_SECTION_BYTES, RoadRecord};

/// The whole section, in `bincode`'s legacy layout: every list starts with its length as u64. Lists after
/// `texts` have one item per way.
#[derive(Default, Serialize, Deserialize)]
struct Record {
    /// Sorted, each once.
    texts: Vec<String>,
    /// Ascending; each as its difference from the one before.
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

const FORMS: [Form; 4] = [Form::Ordinary, Form::DualCarriageway, Form::Link, Form::Roundabout];
const STRUCTURES: [Structure; 3] = [Structure::Ground, Structure::Bridge, Structure::Tunnel];
const ONEWAYS: [Oneway; 3] = [Oneway::No, Oneway::Forward, Oneway::Backward];

pub(super) fn decode(bytes: &[u8]) -> Result<Vec<RoadRecord>, Damage> {
    let config = bincode::config::legacy().with_limit::<MAX_SECTION_BYTES>();
    let (record, taken): (Record, usize) = bincode::serde::decode_from_slice(bytes, config)
        .map_err(|_| Damage::Invalid { what: "the records of the section" })?;
    if taken != bytes.len() {
        return Err(Damage::Invalid { what: "bytes left over at the end" });
    }
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
    if lengths != [count; 7] {
        return Err(Damage::Invalid { what: "lists of different lengths" });
    }
    // A long text named by every way would be copied for each: a small section must not become a large tile.
    let mut room = MAX_SECTION_BYTES;
    let mut text = |index: u32| {
        let text = record
            .texts
            .get(index as usize)
            .ok_or(Damage::Invalid { what: "a text that does not exist" })?;
        room = room.checked_sub(text.len()).ok_or(Damage::TooLarge {
            what: "texts of all ways",
            length: MAX_SECTION_BYTES as u64 + 1,
            limit: MAX_SECTION_BYTES as u64,
        })?;
        Ok::<String, Damage>(text.clone())
    };
    let known = Damage::Invalid { what: "a value that this version does not know" };
    let mut way_id = 0_i64;
    let mut roads = Vec::with_capacity(count);
    for k in 0..count {
        let step = record.way_id_steps[k];
        if k > 0 && step <= 0 {
            return Err(Damage::Invalid { what: "ways are not sorted" });
        }
        way_id = way_id.checked_add(step).ok_or(Damage::Invalid { what: "a way id" })?;
        let attributes = RoadAttributes {
            form: *FORMS.get(usize::from(record.forms[k])).ok_or(known.clone())?,
            structure: *STRUCTURES.get(usize::from(record.structures[k])).ok_or(known.clone())?,
            layer: record.layers[k],
            oneway: *ONEWAYS.get(usize::from(record.oneways[k])).ok_or(known.clone())?,
            name: text(record.names[k])?,
            reference: text(record.references[k])?,
            surface: text(record.surfaces[k])?,
        };
        roads.push(RoadRecord { way_id, attributes });
    }
    Ok(roads)
}

/// The section's bytes, or what of the roads cannot be encoded.
#[cfg(feature = "write")]
pub(super) fn encode(roads: &[RoadRecord]) -> Result<Vec<u8>, &'static str> {
    if !roads.is_sorted_by(|a, b| a.way_id < b.way_id) {
        return Err("ways that are not sorted by id, or occur twice");
    }
    let mut texts: Vec<&str> = roads
        .iter()
        .flat_map(|road| {
            [&road.attributes.name, &road.attributes.reference, &road.attributes.surface]
        })
        .map(String::as_str)
        .collect();
    texts.sort_unstable();
    texts.dedup();
    if texts.len() > u32::MAX as usize {
        return Err("more texts than 32 bits can number");
    }
    let index = |text: &str| texts.partition_point(|&other| other < text) as u32;
    let mut record =
        Record { texts: texts.iter().map(|&text| text.to_owned()).collect(), ..Record::default() };
    let mut previous = 0_i64;
    for RoadRecord { way_id, attributes } in roads {
        record
            .way_id_steps
            .push(way_id.checked_sub(previous).ok_or("way ids that are too far apart")?);
        previous = *way_id;
        // Discriminants are the numbers that the tables above are indexed with.
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
