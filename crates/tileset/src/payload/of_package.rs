//! Decodes payloads of the tiles of a package, with the frame and the height step of its manifest.

use corniche_geom::TileId;
use corniche_tin::{Surface, Tin};

use crate::manifest::Manifest;
use crate::payload::damage::DecodeError;
use crate::payload::decode::decode;
use crate::payload::section_kind::Sections;
use crate::payload::spans::{SpanRun, decode_spans};
use crate::payload::tile_payload::TilePayload;

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
        decode(bytes, id, &self.frame, self.vertical.quantum_m, wanted)
    }

    /// Reads the spans of a tile's payload, as [`decode_spans`] does.
    ///
    /// # Errors
    /// Same as [`decode_spans`].
    pub fn decode_spans(&self, bytes: &[u8], id: TileId) -> Result<Vec<SpanRun>, DecodeError> {
        decode_spans(bytes, id, &self.frame, self.vertical.quantum_m)
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
