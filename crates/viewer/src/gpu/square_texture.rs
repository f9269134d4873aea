//! Creates square textures from their texels.

use wgpu::{Extent3d, TextureFormat, TextureUsages, TextureView};

use super::Gpu;

/// Creates a square texture with mip levels, the largest first, each half as large as the previous
/// one: side and texels.
pub(crate) fn square<'a>(
    gpu: &Gpu,
    format: TextureFormat,
    sizes: impl Iterator<Item = (u32, &'a [u8])>,
) -> TextureView {
    let sizes: Vec<_> = sizes.collect();
    let usage = TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST;
    let side = sizes.first().map_or(1, |(side, _)| *side);
    let texture = gpu.texture("tile texture", format, [side; 2], sizes.len() as u32, usage);
    for (mip_level, (side, texels)) in (0..).zip(sizes) {
        let layout = wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(texels.len() as u32 / side),
            rows_per_image: Some(side),
        };
        let size = Extent3d { width: side, height: side, depth_or_array_layers: 1 };
        let into = wgpu::TexelCopyTextureInfo { mip_level, ..texture.as_image_copy() };
        gpu.queue.write_texture(into, texels, layout, size);
    }
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}

/// Creates a square texture with one mip level.
pub(crate) fn of_one_size(
    gpu: &Gpu,
    format: TextureFormat,
    side: usize,
    texels: &[u8],
) -> TextureView {
    square(gpu, format, [(side as u32, texels)].into_iter())
}
