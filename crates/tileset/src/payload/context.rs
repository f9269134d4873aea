//! The reference of the numbers in a payload: corner, placement and scale.

use corniche_geom::{GridFrame, LatticePoint, TILE_NODES, TileId};
use corniche_tin::Placement;

use crate::{
    manifest::check::is_height_quantum,
    payload::{
        damage::{Damage, DecodeError, Result},
        envelope::{self, StoredSection},
        terrain::record::Scale,
    },
};

/// The values that positions and heights in a payload are relative to.
#[derive(Debug, Clone, Copy)]
pub(crate) struct CodingContext {
    pub corner: LatticePoint,
    pub placement: Placement,
    pub scale: Scale,
}

impl CodingContext {
    /// Opens the payload of a tile, and returns its sections and the reference of its numbers.
    pub(crate) fn open<'b>(
        bytes: &'b [u8],
        id: TileId,
        frame: &GridFrame,
        quantum_m: f64,
    ) -> Result<(Self, Vec<StoredSection<'b>>), DecodeError> {
        let failed = |damage: Damage| damage.in_header(id);
        let context = Self::new(id, frame, quantum_m).map_err(failed)?;
        Ok((context, envelope::open_read(bytes, id).map_err(failed)?))
    }

    pub(crate) fn new(id: TileId, frame: &GridFrame, quantum_m: f64) -> Result<Self> {
        if id.z() > frame.max_level() {
            return Err(Damage::Level { level: id.z(), finest: frame.max_level() });
        }
        Damage::invalid_if(!is_height_quantum(quantum_m), "the height quantum")?;
        let placement = Placement::of_tile(frame, id, quantum_m);
        Ok(Self {
            corner: placement.corner,
            placement,
            scale: Scale {
                quantum_m,
                cell: frame.level_cell(id.z()),
                nodes_beneath: (frame.stride(id.z()) as u64 * TILE_NODES as u64).pow(2),
            },
        })
    }
}
