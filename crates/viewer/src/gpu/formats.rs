//! The texture formats of the targets.

use wgpu::TextureFormat;

/// Colours, encoded as sRGB.
pub(crate) const COLOR: TextureFormat = TextureFormat::Rgba8Unorm;
/// Reversed depth: the depth of the near plane divided by the view depth; 0 where nothing was
/// drawn.
pub(crate) const DEPTH: TextureFormat = TextureFormat::Depth32Float;
/// Depths as ordinary numbers.
pub(crate) const NUMBER: TextureFormat = TextureFormat::R32Float;
/// Road labels, as described in the documentation of `gpu`.
pub(crate) const LABEL: TextureFormat = TextureFormat::R8Unorm;
/// Counts of area volumes, as described in `drawables/areas.rs`.
pub(crate) const STENCIL: TextureFormat = TextureFormat::Stencil8;
/// Numbers of tiles, from 1; the highest bit is set for skirts, the two highest for walls.
pub(crate) const OWNER: TextureFormat = TextureFormat::R32Uint;
