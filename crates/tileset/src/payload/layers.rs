//! The objects of a layer in a tile: lines, areas or points, with their classes and attributes.
//! They are read and written separately from the rest of the payload, because most readers do not
//! need them.
//!
//! ```text
//!   spacing │ count │ class and type │ id │ texts │ a column for each attribute │ shapes
//!                                                                                 lines:  planes
//!                                                                                 areas:  range-coded
//!                                                                                 points: planes
//! ```

mod attribute_columns;
mod decode;
#[cfg(feature = "write")]
mod encode;
mod layer_object;
mod plane_points;
mod ring_coder;
mod text_table;

use corniche_geom::{GridFrame, TileId};

use crate::{
    layer_slot::LayerSlot,
    payload::{damage::DecodeError, envelope, section_kind::SectionKind},
};

use decode::decode;
#[cfg(feature = "write")]
pub use encode::encode_layer;
pub use layer_object::{AreaPolygon, LayerCoding, LayerObject, LayerShape};

/// Reads the objects of a layer from the bytes of a tile's payload; empty if it has none. `coding`
/// is that of the layer's table. Memory stays within the [`limits`](crate::limits), whatever the
/// bytes say.
///
/// # Errors
/// When the bytes are not a payload of tile `id`, or the section is damaged.
pub fn decode_layer(
    bytes: &[u8],
    id: TileId,
    frame: &GridFrame,
    slot: LayerSlot,
    coding: &LayerCoding,
) -> Result<Vec<LayerObject>, DecodeError> {
    let bounds = frame.tile_lattice_bounds(id);
    let kind = SectionKind::Layer(slot);
    envelope::read_part(bytes, id, kind, |sections| {
        let section = envelope::section(sections, kind)?;
        let objects = section.map(|bytes| decode(&bytes, coding, bounds)).transpose()?;
        Ok(objects.unwrap_or_default())
    })
}

#[cfg(test)]
#[path = "layers_tests.rs"]
mod tests;
