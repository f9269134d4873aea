//! Textures that are read back in bands come back whole.

use std::time::{Duration, Instant};

use super::*;
use crate::gpu::GpuError;

/// A texture of 37 × 11 texels with ascending bytes is read in bands of all rows, in bands of several rows (the last band is
/// shorter), and row by row.
#[test]
fn bands_add_up_to_the_picture() {
    let gpu = match Gpu::new() {
        Ok(gpu) => gpu,
        Err(error @ GpuError::NoAdapter { .. }) => {
            assert!(std::env::var_os("CORNICHE_REQUIRE_GPU").is_none(), "{error}");
            corniche_testing::skip(&error.to_string());
            return;
        }
        Err(error) => panic!("{error}"),
    };
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
        assert!(asking.has_arrived(&gpu).unwrap(), "and stays there");
        assert!(asking.into_texels(&gpu).unwrap() == texels, "{most_bytes}");
    }
    let [mut asked, waited] = [(); 2].map(|()| ReadBack::begin(&gpu, &texture));
    gpu.device.destroy();
    let begun = Instant::now();
    // The bytes that were asked for may still arrive, or the request may fail. It must not stay open.
    while matches!(asked.has_arrived(&gpu), Ok(false)) {
        assert!(begun.elapsed() < Duration::from_mins(1), "the request neither succeeds nor fails");
    }
    if let Ok(arrived) = waited.into_texels(&gpu) {
        assert!(arrived == texels);
    }
    assert!(read_texture(&gpu, &texture).is_err());
}
