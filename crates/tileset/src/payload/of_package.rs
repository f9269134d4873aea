//! Decodes payloads of the tiles of a package, with the frame and the height step of its manifest.

use corniche_geom::TileId;
use corniche_layers::LinePlacement;
use corniche_tin::{Surface, Tin};

use crate::{
    layer_slot::LayerSlot,
    manifest::Manifest,
    payload::{
        damage::{Damage, DecodeError},
        decode::decode,
        layers::{LayerCoding, LayerObject, decode_layer},
        section_kind::{SectionKind, Sections},
        spans::{SpanRun, decode_spans},
        tile_payload::TilePayload,
    },
};

impl Manifest {
    /// Reads the wanted sections of a tile's payload, as [`decode`] does.
    ///
    /// # Errors
    /// Same as [`decode`].
    pub fn decode(
        &self,
        bytes: &[u8],
        id: TileId,
        wanted: Sections,
    ) -> Result<TilePayload, DecodeError> {
        if wanted.contains(Sections::LAYERS) {
            for (slot, _) in self.layers() {
                self.decode_layer(bytes, id, slot)?;
            }
        }
        decode(bytes, id, &self.frame, self.vertical.quantum_m, wanted)
    }

    /// Reads the objects of a layer from a tile's payload, as [`decode_layer`] does; empty for a
    /// layer that the package does not have.
    ///
    /// # Errors
    /// Same as [`decode_layer`]; the error names the layer.
    pub fn decode_layer(
        &self,
        bytes: &[u8],
        id: TileId,
        slot: LayerSlot,
    ) -> Result<Vec<LayerObject>, DecodeError> {
        let Some(record) = self.layers.get(slot.index()) else { return Ok(Vec::new()) };
        let coding = LayerCoding::from_table(&record.table);
        decode_layer(bytes, id, &self.frame, slot, &coding).map_err(|error| {
            let part = if error.part == "header" {
                error.part
            } else {
                format!("section of layer {:?}", record.table.id).into()
            };
            DecodeError { part, ..error }
        })
    }

    /// Reads the spans of a tile's payload, as [`decode_spans`] does.
    ///
    /// # Errors
    /// Same as [`decode_spans`], and when a run belongs to a layer that the package does not have,
    /// or whose lines are on the ground everywhere.
    pub fn decode_spans(&self, bytes: &[u8], id: TileId) -> Result<Vec<SpanRun>, DecodeError> {
        let runs = decode_spans(bytes, id, &self.frame, self.vertical.quantum_m)?;
        let has_spans = |slot: LayerSlot| {
            let record = self.layers.get(slot.index());
            record.is_some_and(|record| record.table.placement == LinePlacement::Spans)
        };
        if runs.iter().all(|run| run.owner.layer().is_none_or(has_spans)) {
            return Ok(runs);
        }
        Err(SectionKind::Spans.damaged(id)(Damage::Invalid("the layer of a run")))
    }

    /// Returns the ground of a tile with this TIN, on the package's lattice.
    ///
    /// # Panics
    /// When the tile's level is beyond the package's finest level.
    #[must_use]
    pub fn surface(&self, id: TileId, tin: &Tin) -> Surface {
        Surface::of_tile(tin, &self.frame, id, self.vertical.quantum_m)
    }
}
