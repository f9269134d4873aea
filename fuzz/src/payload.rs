use corniche_geom::{Frame, NodeIndex, TileId};
use corniche_tileset::{PayloadContext, Sections, decode, encode};

const QUANTUM_M: f64 = 0.25;
/// Bytes before the section table, and of one of its entries.
const HEADER_BYTES: usize = 16;
const ENTRY_BYTES: usize = 20;

/// A tile of these bytes is decoded or refused; what is decoded encodes, and decodes to itself.
///
/// An even first byte: sections follow, each a kind (u8), a length (u16) and its bytes before compression; they are
/// put into a right payload. An odd one: a payload follows, whose checksums are made right.
///
/// # Panics
/// When a promise is broken.
pub fn payload(data: &[u8]) {
    let Some((&first, data)) = data.split_first() else { return };
    let bytes = if first % 2 == 0 { sealed(data) } else { with_right_checksums(data) };
    let context = context();
    let Some(id) = TileId::ROOT.children().nth(1) else { return };
    let read = |bytes: &[u8]| decode(bytes, id, &context.frame, QUANTUM_M, Sections::ALL);
    match read(&bytes) {
        Ok(tile) => {
            let encoded = match encode(&tile, &context) {
                Ok(encoded) => encoded,
                Err(error) => panic!("what was decoded cannot be encoded: {error}"),
            };
            assert_eq!(read(&encoded.bytes).as_ref(), Ok(&tile), "another tile came back");
        }
        Err(error) => assert_eq!(error.tile, id, "the error names the tile: {error}"),
    }
}

/// The grid of the tests in `corniche-tileset`: tile 1/1/0 of a package with three levels.
fn context() -> PayloadContext {
    let frame = Frame::new([0.5, 0.25], 10.0, NodeIndex { i: -512, j: 1024 }, 2);
    let Ok(frame) = frame else { unreachable!("a usable frame") };
    PayloadContext { frame, quantum_m: QUANTUM_M }
}

/// A payload of tile 1/1/0 with the sections that `data` lists, uncompressed.
fn sealed(mut data: &[u8]) -> Vec<u8> {
    let mut sections = Vec::new();
    while let Some((&[kind, low, high], rest)) = data.split_first_chunk() {
        let length = usize::from(u16::from_le_bytes([low, high])).min(rest.len());
        let (section, rest) = rest.split_at(length);
        sections.push((kind, section));
        data = rest;
        if sections.len() == usize::from(u8::MAX) {
            break;
        }
    }
    let mut bytes = b"CRNT\0\0".to_vec();
    bytes.extend([sections.len() as u8, 1]);
    bytes.extend(1_u32.to_le_bytes());
    bytes.extend(0_u32.to_le_bytes());
    let mut offset = HEADER_BYTES + ENTRY_BYTES * sections.len() + 4;
    for (kind, section) in &sections {
        bytes.extend([*kind, 0, 0, 0]);
        for number in [offset, section.len(), section.len(), 0] {
            bytes.extend((number as u32).to_le_bytes());
        }
        offset += section.len();
    }
    bytes.extend([0; 4]);
    for (_, section) in &sections {
        bytes.extend(*section);
    }
    with_right_checksums(&bytes)
}

/// The same payload with checksums that fit, as far as the table can be followed.
fn with_right_checksums(data: &[u8]) -> Vec<u8> {
    let mut bytes = data.to_vec();
    let Some(&count) = bytes.get(6) else { return bytes };
    let table_end = HEADER_BYTES + ENTRY_BYTES * usize::from(count);
    for entry in (HEADER_BYTES..table_end).step_by(ENTRY_BYTES) {
        let number = |at: usize| {
            let four = bytes.get(at..)?.first_chunk()?;
            Some(u32::from_le_bytes(*four) as usize)
        };
        let range = number(entry + 4).zip(number(entry + 8));
        let range = range.and_then(|(from, length)| Some(from..from.checked_add(length)?));
        let Some(section) = range.and_then(|range| bytes.get(range)) else { continue };
        let sum = crc32fast::hash(section).to_le_bytes();
        if let Some(slot) = bytes.get_mut(entry + 16..entry + 20) {
            slot.copy_from_slice(&sum);
        }
    }
    let Some(sum) = bytes.get(..table_end).map(crc32fast::hash) else { return bytes };
    if let Some(slot) = bytes.get_mut(table_end..table_end + 4) {
        slot.copy_from_slice(&sum.to_le_bytes());
    }
    bytes
}
