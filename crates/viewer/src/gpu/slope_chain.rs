//! The slopes of a tile and of its ancestors, as textures for shading.

use corniche_geom::{TILE_CELLS, TileId};
use wgpu::{TextureFormat, TextureView};

use super::{Gpu, square_texture::of_one_size};
use crate::tiles::{MOST_SLOPES_ABOVE, ShadingSlopes, TileGeometry};

/// Texel format of slopes: rise east and north.
const SLOPES: TextureFormat = TextureFormat::Rg16Float;

/// The slopes of a tile and of its ancestors on the GPU: the tile's own slopes first, then coarser
/// levels. Far from the eye, a tile is shaded by the slopes of coarser levels, as
/// `shaders/relief.wgsl` describes.
///
/// The textures of ancestors are shared, not copied, so a tile must not stay on the GPU longer than
/// its parent; [`Streamer`](crate::stream::Streamer) ensures this.
#[derive(Debug, Clone, Default)]
pub struct SlopeChain {
    textures: Vec<TextureView>,
}

impl SlopeChain {
    /// Number of levels whose slopes are bound. A pixel of a tile is rarely more than two levels
    /// coarser than the tile, because tiles are selected by the size of their cells; beyond the
    /// last level, the last level is used.
    pub(crate) const LEVELS: usize = MOST_SLOPES_ABOVE + 1;

    /// Uploads the slopes of a tile. `above` has the slopes of its parent. If a tile has no slopes,
    /// its ancestors have none either: it is shaded by its triangles.
    #[must_use]
    pub fn new(gpu: &Gpu, tile: &TileGeometry, above: Option<&Self>) -> Self {
        let Some(slopes) = &tile.shading else { return Self::default() };
        let texels = bytemuck::cast_slice(&slopes.texels);
        let own = of_one_size(gpu, SLOPES, ShadingSlopes::SIDE, texels);
        let above = above.iter().flat_map(|above| above.textures.iter().cloned());
        Self { textures: std::iter::once(own).chain(above).take(Self::LEVELS).collect() }
    }

    /// Size of the textures that [`SlopeChain::new`] uploads, bytes.
    #[must_use]
    pub fn bytes_of(tile: &TileGeometry) -> u64 {
        tile.shading.as_ref().map_or(0, |slopes| size_of_val(&slopes.texels) as u64)
    }

    /// All views, the tile's own first. If there are fewer levels, the last view is repeated;
    /// `none` replaces missing slopes of the tile.
    pub(crate) fn views<'a>(&'a self, none: &'a TextureView) -> [&'a TextureView; Self::LEVELS] {
        let last = self.textures.last().unwrap_or(none);
        std::array::from_fn(|level| self.textures.get(level).unwrap_or(last))
    }

    /// The row `levels` of the block `struct TileTextures`, for a tile with these sides.
    pub(crate) fn row(&self, id: TileId, [east_m, north_m]: [f64; 2]) -> [f32; 4] {
        let coarsest = self.textures.len().saturating_sub(1) as f32;
        // The position of the tile among the tiles with the same coarsest ancestor.
        let [column, row] = [id.x(), id.y()].map(|at| (at % (1 << (Self::LEVELS - 1))) as f32);
        let cell_m = east_m.max(north_m) / TILE_CELLS as f64;
        [column, row, coarsest, libm::log2(cell_m) as f32]
    }
}
