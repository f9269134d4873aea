//! Textures that are read back in bands are complete.

use std::time::{Duration, Instant};

use super::*;
use crate::gpu::{
    GpuError, drawables::depth_numbers::depth_numbers, formats::DEPTH,
    target_texture::TargetTexture,
};

fn gpu() -> Option<Gpu> {
    match Gpu::new() {
        Ok(gpu) => Some(gpu),
        Err(error @ GpuError::NoAdapter { .. }) => {
            assert!(std::env::var_os("CORNICHE_REQUIRE_GPU").is_none(), "{error}");
            corniche_testing::skip(&error.to_string());
            None
        }
        Err(error) => panic!("{error}"),
    }
}

/// Reads a texture of 37 × 11 texels with ascending bytes in one band of all rows, in bands of
/// several rows (the last band is shorter), and row by row.
#[test]
fn bands_add_up_to_the_picture() {
    let Some(gpu) = gpu() else { return };
    let size = wgpu::Extent3d { width: 37, height: 11, depth_or_array_layers: 1 };
    let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size,
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Rgba8Unorm,
        usage: wgpu::TextureUsages::COPY_SRC | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    let texels: Vec<u8> = (0..37 * 11 * 4_u32).map(|k| (k % 251) as u8).collect();
    let layout =
        TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(37 * 4), rows_per_image: Some(11) };
    gpu.queue.write_texture(texture.as_image_copy(), &texels, layout, size);
    for most_bytes in [1 << 20, 4 * 256, 256, 1] {
        assert!(read_by_bands(&gpu, &texture, most_bytes).unwrap() == texels, "{most_bytes}");
        let waiting = ReadBack::by_bands(&gpu, &texture, most_bytes);
        assert!(waiting.into_texels(&gpu).unwrap() == texels, "{most_bytes}");

        let mut asking = ReadBack::by_bands(&gpu, &texture, most_bytes);
        let begun = Instant::now();
        while !asking.has_arrived(&gpu).unwrap() {
            assert!(begun.elapsed() < Duration::from_mins(1), "{most_bytes}");
        }
        assert!(asking.has_arrived(&gpu).unwrap(), "and stays available");
        assert!(asking.into_texels(&gpu).unwrap() == texels, "{most_bytes}");
    }
    let [mut asked, waited] = [(); 2].map(|()| ReadBack::begin(&gpu, &texture));
    gpu.device.destroy();
    let begun = Instant::now();
    // The requested bytes may still arrive, or the request may fail. It must not stay pending.
    while matches!(asked.has_arrived(&gpu), Ok(false)) {
        assert!(begun.elapsed() < Duration::from_mins(1), "the request neither succeeds nor fails");
    }
    if let Ok(arrived) = waited.into_texels(&gpu) {
        assert!(arrived == texels);
    }
    assert!(read_texture(&gpu, &texture).is_err());
}

/// Depths can be read back in bands, too, although a depth texture itself cannot.
#[test]
fn depths_are_read_in_bands() {
    let Some(gpu) = gpu() else { return };
    let depth = TargetTexture::new(&gpu, "depth", DEPTH, [70, 11]);
    let descriptor = wgpu::CommandEncoderDescriptor { label: None };
    let mut encoder = gpu.device.create_command_encoder(&descriptor);
    // A value that uses all digits of a float.
    let value = 0.123_456_79_f32;
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: None,
        color_attachments: &[],
        depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
            view: &depth.view,
            depth_ops: Some(wgpu::Operations {
                load: wgpu::LoadOp::Clear(value),
                store: wgpu::StoreOp::Store,
            }),
            stencil_ops: None,
        }),
        ..Default::default()
    });
    gpu.queue.submit([encoder.finish()]);
    let numbers = depth_numbers(&gpu, &depth);
    for most_bytes in [1 << 20, 3 * 512, 1] {
        let texels = read_by_bands(&gpu, &numbers.texture, most_bytes).unwrap();
        assert_eq!(texels.len(), 70 * 11 * 4);
        assert!(texels.chunks_exact(4).all(|texel| texel == value.to_le_bytes()), "{most_bytes}");
    }
}
