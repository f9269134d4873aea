//! Sections of layers of any bytes are decoded or rejected, and decoded objects are preserved by
//! encoding.

use corniche_geom::TileId;
use corniche_layers::{AttributeKind, LayerGeometry, TagUnit};
use corniche_testing::{
    package::context,
    payload::{RawSection, payload},
};
use corniche_tileset::{LayerCoding, LayerSlot, decode_layer, encode_layer};

/// The number of the kind of section of the first layer.
const FIRST_KIND: u16 = 64;

/// Decodes or rejects these bytes as the section of a layer; decoded objects can be encoded, and
/// decoding gives the same objects.
///
/// The first byte modulo 3 selects the geometry; the section follows. The layer has three classes
/// and one attribute of each kind.
///
/// # Panics
/// When the decoder or the encoder breaks a promise.
pub fn layers(data: &[u8]) {
    let Some((&first, data)) = data.split_first() else { return };
    let coding = layer_coding(LayerGeometry::ALL[usize::from(first % 3)]);
    let (Some(slot), id, frame) = (LayerSlot::new(0), TileId::ROOT, context().frame) else {
        return;
    };
    let read = |section: Vec<u8>| {
        let payload = payload(id, &[RawSection::plain(FIRST_KIND, section)]);
        decode_layer(&payload, id, &frame, slot, &coding)
    };
    let objects = match read(data.to_vec()) {
        Ok(objects) => objects,
        Err(error) => {
            assert!(error.tile == id && error.part.contains("layer"), "the error says where");
            return;
        }
    };
    let bounds = frame.tile_lattice_bounds(id);
    for object in &objects {
        assert!(usize::from(object.class) < coding.classes, "a class beyond the table");
        assert_eq!(object.values.len(), coding.attributes.len(), "values of each attribute");
        assert!(
            coding.geometry == LayerGeometry::Line
                || object.shape.points().all(|&point| bounds.contains(point)),
            "a point outside the tile"
        );
    }
    // Every point is on the finest lattice.
    let section = match encode_layer(id, &frame, slot, &coding, 1, &objects) {
        Ok(section) => section,
        Err(error) => panic!("decoded objects cannot be encoded: {error}"),
    };
    let again = section.map_or(Ok(Vec::new()), |section| read(section.into_bytes()));
    assert_eq!(again, Ok(objects), "the objects changed when they were encoded and decoded");
}

/// The coding of the layer of the target [`layers`] with this geometry.
#[must_use]
pub fn layer_coding(geometry: LayerGeometry) -> LayerCoding {
    let attributes = vec![
        AttributeKind::Text,
        AttributeKind::Names,
        AttributeKind::YesNo,
        AttributeKind::Number(TagUnit::Metre),
    ];
    LayerCoding { geometry, classes: 3, attributes }
}
