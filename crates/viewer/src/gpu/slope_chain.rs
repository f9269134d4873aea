//! The slopes of a tile and of the tiles above it, as textures for shading.

use corniche_geom::{TILE_CELLS, TileId};
use wgpu::{TextureFormat, TextureView};

use super::{Gpu, square_texture::of_one_size};
use crate::tiles::{MOST_SLOPES_ABOVE, ShadingSlopes, TileGeometry};

/// The slopes: rise east and north.
const SLOPES: TextureFormat = TextureFormat::Rg16Float;

/// The slopes of a tile and of the tiles above it, on the graphics card: the tile's own first, then those of coarser levels. Where
/// the eye is far, a tile is shaded by the slopes of coarser levels, as `shaders/relief.wgsl` describes.
///
/// The textures of the tiles above are theirs and are not copied, so a tile must not stay on the card longer than its parent;
/// [`Streamer`](crate::stream::Streamer) sees to that.
#[derive(Debug, Clone, Default)]
pub struct SlopeChain {
    textures: Vec<TextureView>,
}

impl SlopeChain {
    /// Slopes of so many levels are bound. A pixel of a tile is rarely more than two levels coarser than the tile, because tiles
    /// are chosen by the size of their cells; beyond the last level, that level is shown.
    pub(crate) const LEVELS: usize = MOST_SLOPES_ABOVE + 1;

    /// Uploads the slopes of a tile. `above` has those of its parent. A tile without slopes has none above it either: it is
    /// shaded by its triangles.
    #[must_use]
    pub fn new(gpu: &Gpu, tile: &TileGeometry, above: Option<&Self>) -> Self {
        let Some(slopes) = &tile.shading else { return Self::default() };
        let texels = bytemuck::cast_slice(&slopes.texels);
        let own = of_one_size(gpu, SLOPES, ShadingSlopes::SIDE, texels);
        let above = above.iter().flat_map(|above| above.textures.iter().cloned());
        Self { textures: std::iter::once(own).chain(above).take(Self::LEVELS).collect() }
    }

    /// Bytes of what [`SlopeChain::new`] uploads.
    #[must_use]
    pub fn bytes_of(tile: &TileGeometry) -> u64 {
        tile.shading.as_ref().map_or(0, |slopes| size_of_val(&slopes.texels) as u64)
    }

    /// All of them, the tile's own first. Where there are fewer levels the last one is repeated; `none` takes the place of
    /// slopes that the tile does not have.
    pub(crate) fn views<'a>(&'a self, none: &'a TextureView) -> [&'a TextureView; Self::LEVELS] {
        let last = self.textures.last().unwrap_or(none);
        std::array::from_fn(|level| self.textures.get(level).unwrap_or(last))
    }

    /// The row `levels` of the block `struct TileTextures`, for a tile with these sides.
    pub(crate) fn row(&self, id: TileId, [east_m, north_m]: [f64; 2]) -> [f32; 4] {
        let coarsest = self.textures.len().saturating_sub(1) as f32;
        // Where the tile is among those with the same coarsest tile above it.
        let [column, row] = [id.x(), id.y()].map(|at| (at % (1 << (Self::LEVELS - 1))) as f32);
        let cell_m = east_m.max(north_m) / TILE_CELLS as f64;
        [column, row, coarsest, libm::log2(cell_m) as f32]
    }
}
