//! The tiles that lie on the graphics card while the view changes.

use std::collections::BTreeMap;

use corniche_geom::TileId;

use super::{DrawTile, Gpu, TileBuffers};
use crate::{lod::Drawn, tiles::TileGeometry};

/// The tiles on the graphics card, for views that change.
#[derive(Default)]
pub struct ResidentTiles(pub(crate) BTreeMap<TileId, TileBuffers>);

impl ResidentTiles {
    /// Removes tiles and uploads others. A tile is shaded by the slopes of its parent too, which must be there before it.
    pub fn change(&mut self, gpu: &Gpu, evict: &[TileId], upload: &[TileGeometry]) {
        for id in evict {
            self.0.remove(id);
        }
        for tile in upload {
            let above = tile.id.parent().and_then(|parent| self.0.get(&parent));
            let buffers = TileBuffers::new(gpu, tile, above.map(TileBuffers::slopes));
            self.0.insert(tile.id, buffers);
        }
    }

    /// Bytes on the graphics card.
    #[must_use]
    pub fn gpu_bytes(&self) -> u64 {
        self.0.values().map(TileBuffers::gpu_bytes).sum()
    }

    /// Removes all.
    pub fn clear(&mut self) {
        self.0.clear();
    }

    /// A tile, to replace what a person draws on it.
    pub fn get_mut(&mut self, id: TileId) -> Option<&mut TileBuffers> {
        self.0.get_mut(&id)
    }

    /// The tiles of a selection, with their skirts; those that are not there are left out.
    #[must_use]
    pub fn draw_list(&self, drawn: &[Drawn]) -> Vec<DrawTile<'_>> {
        let tile = |drawn: &Drawn| {
            let buffers = self.0.get(&drawn.id)?;
            Some(DrawTile { buffers, skirt_depth_m: drawn.skirt_depth_m })
        };
        drawn.iter().filter_map(tile).collect()
    }
}
