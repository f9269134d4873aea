//! What the targets store in each texel.

use wgpu::TextureFormat;

/// Colours as sRGB encodes them.
pub(crate) const COLOR: TextureFormat = TextureFormat::Rgba8Unorm;
/// Reversed depth: the near plane's depth divided by the depth of view, 0 where nothing was drawn.
pub(crate) const DEPTH: TextureFormat = TextureFormat::Depth32Float;
/// Depths as ordinary numbers.
pub(crate) const NUMBER: TextureFormat = TextureFormat::R32Float;
/// Road labels, as the documentation of `gpu` says.
pub(crate) const LABEL: TextureFormat = TextureFormat::R8Unorm;
/// Counts of volumes of areas, as `drawables/areas.rs` says.
pub(crate) const STENCIL: TextureFormat = TextureFormat::Stencil8;
/// Numbers of tiles, from 1; the highest bit is set for skirts, the two highest for walls.
pub(crate) const OWNER: TextureFormat = TextureFormat::R32Uint;
