//! The tiles that stay on the GPU while the view changes.

use std::collections::BTreeMap;

use corniche_geom::TileId;

use super::{DrawTile, Gpu, TileBuffers};
use crate::{lod::DrawnTile, tiles::TileGeometry};

/// The tiles on the GPU, for views that change.
#[derive(Default)]
pub struct ResidentTiles(pub(crate) BTreeMap<TileId, TileBuffers>);

impl ResidentTiles {
    /// Evicts tiles and uploads others. A tile is also shaded by the slopes of its parent, which
    /// must be resident before it.
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

    /// Size of all tiles on the GPU, bytes.
    #[must_use]
    pub fn gpu_bytes(&self) -> u64 {
        self.0.values().map(TileBuffers::gpu_bytes).sum()
    }

    /// Evicts all tiles.
    pub fn clear(&mut self) {
        self.0.clear();
    }

    /// A tile, for replacing user-drawn lines and areas on it.
    pub fn get_mut(&mut self, id: TileId) -> Option<&mut TileBuffers> {
        self.0.get_mut(&id)
    }

    /// The tiles of a selection, with their skirts; tiles that are not resident are omitted.
    #[must_use]
    pub fn draw_list(&self, drawn: &[DrawnTile]) -> Vec<DrawTile<'_>> {
        let tile = |drawn: &DrawnTile| {
            let buffers = self.0.get(&drawn.id)?;
            Some(DrawTile { buffers, skirt_depth_m: drawn.skirt_depth_m })
        };
        drawn.iter().filter_map(tile).collect()
    }
}
