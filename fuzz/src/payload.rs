//! Payloads of any bytes are decoded or rejected, and a decoded payload is preserved by encoding.

use corniche_geom::TileId;
use corniche_testing::{
    package::{QUANTUM_M, context},
    payload::{RawSection, payload as payload_of, with_right_checksums},
};
use corniche_tileset::{
    PayloadContext, Sections, decode, decode_photo, decode_spans, encode, encode_spans,
};

/// Decodes or rejects these bytes as a tile; a decoded tile can be encoded, and decoding gives the
/// same tile.
///
/// If the first byte is even, sections follow, each with a kind (u8), a length (u16) and its bytes
/// before compression; they are put into a valid payload. If it is odd, a payload follows, whose
/// checksums are corrected.
///
/// # Panics
/// When the decoder or the encoder breaks a promise.
pub fn payload(data: &[u8]) {
    let Some((&first, data)) = data.split_first() else { return };
    let bytes = if first % 2 == 0 { sealed(data) } else { with_right_checksums(data.to_vec()) };
    let context = context();
    let Some(id) = id() else { return };
    let read = |bytes: &[u8]| decode(bytes, id, &context.frame, QUANTUM_M, Sections::ALL);
    if let Err(error) = decode_photo(&bytes, id) {
        assert_eq!(error.tile, id, "the error names the tile: {error}");
    }
    match read(&bytes) {
        Ok(tile) => {
            let encoded = match encode(&tile, &context) {
                Ok(encoded) => encoded,
                Err(error) => panic!("a decoded tile cannot be encoded: {error}"),
            };
            assert_eq!(
                read(&encoded.bytes).as_ref(),
                Ok(&tile),
                "the tile changed when it was encoded and decoded"
            );
            spans_come_back(&bytes, id, &context);
        }
        Err(error) => assert_eq!(error.tile, id, "the error names the tile: {error}"),
    }
}

/// Encodes the spans of a decoded tile; decoding must give the same spans.
fn spans_come_back(bytes: &[u8], id: TileId, context: &PayloadContext) {
    let runs = match decode_spans(bytes, id, &context.frame, context.quantum_m) {
        Ok(runs) => runs,
        Err(error) => panic!("a checked tile cannot be decoded: {error}"),
    };
    let section = match encode_spans(id, &context.frame, &runs) {
        Ok(section) => section,
        Err(error) => panic!("decoded spans cannot be encoded: {error}"),
    };
    let again = section.map(|section| section.spans(id, &context.frame));
    assert_eq!(
        again.unwrap_or(Ok(Vec::new())),
        Ok(runs),
        "the spans changed when they were encoded and decoded"
    );
}

/// Tile 1/1/0 of the small package's grid.
fn id() -> Option<TileId> {
    TileId::ROOT.children().nth(1)
}

/// A payload of tile 1/1/0 with the sections that `data` lists, uncompressed.
fn sealed(mut data: &[u8]) -> Vec<u8> {
    let mut sections = Vec::new();
    while let Some((&[kind, low, high], rest)) = data.split_first_chunk() {
        let length = usize::from(u16::from_le_bytes([low, high])).min(rest.len());
        let (section, rest) = rest.split_at(length);
        sections.push(RawSection::plain(u16::from(kind), section.to_vec()));
        data = rest;
        if sections.len() == usize::from(u8::MAX) {
            break;
        }
    }
    let Some(id) = id() else { return Vec::new() };
    payload_of(id, &sections)
}
