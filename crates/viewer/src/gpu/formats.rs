//! What the targets store in each texel.

use wgpu::TextureFormat;

/// Colours as sRGB encodes them.
pub(crate) const COLOR: TextureFormat = TextureFormat::Rgba8Unorm;
/// Reversed depth: the near plane's depth divided by the depth of view, 0 where nothing was drawn.
pub(crate) const DEPTH: TextureFormat = TextureFormat::Depth32Float;
/// Road labels, as the documentation of `gpu` says.
pub(crate) const LABEL: TextureFormat = TextureFormat::R8Unorm;
/// Numbers of tiles, from 1; the highest bit is set for skirts.
pub(crate) const OWNER: TextureFormat = TextureFormat::R32Uint;

/// Samples on each side of a block. With smaller blocks fewer samples without a road are drawn again; with larger ones there
/// are fewer blocks to look at. On software Vulkan 8, 16 and 32 take equally long, within the noise.
pub(crate) const BLOCK: u32 = 16;
