//! What the targets store in each texel.

use corniche_roads::FunctionalRoadClass;
use wgpu::TextureFormat;

/// Colours as sRGB encodes them.
pub(crate) const COLOR: TextureFormat = TextureFormat::Rgba8Unorm;
/// Reversed depth: the near plane's depth divided by the depth of view, 0 where nothing was drawn.
pub(crate) const DEPTH: TextureFormat = TextureFormat::Depth32Float;
/// Road labels; see [`label_class`].
pub(crate) const LABEL: TextureFormat = TextureFormat::R8Unorm;
/// Numbers of tiles, from 1; see [`Owner`](super::Owner).
pub(crate) const OWNER: TextureFormat = TextureFormat::R32Uint;

/// Samples on each side of a block. With smaller blocks fewer samples without a road are drawn again; with larger ones there
/// are fewer blocks to look at. On software Vulkan 8, 16 and 32 take equally long, within the noise.
pub(crate) const BLOCK: u32 = 16;

/// The class that a label stands for; `None` where there is no road.
#[must_use]
pub fn label_class(label: u8) -> Option<FunctionalRoadClass> {
    (label > 1)
        .then(|| (FunctionalRoadClass::COUNT as u8).checked_sub(label / 2))
        .flatten()
        .and_then(FunctionalRoadClass::new)
}
