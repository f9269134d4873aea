//! The textures of a tile's ground on the graphics card, in one bind group.

use corniche_tileset::PHOTO_BORDER;
use wgpu::{
    BindGroup, BindGroupLayout, BindGroupLayoutEntry, BindingResource, BindingType, BufferUsages,
    Device, RenderPass, SamplerBindingType, ShaderStages, TextureFormat, TextureSampleType,
    TextureView,
    util::{DeviceExt as _, TextureDataOrder},
};

use super::{
    Gpu,
    bindings::{group, layout, texture, uniform},
    photo_texture,
};
use crate::tiles::{PhotoImage, ShadingSlopes, TileGeometry};

/// The slopes: rise east and north.
const SLOPES: TextureFormat = TextureFormat::Rg16Float;
/// Whether a node is water.
const WATER: TextureFormat = TextureFormat::R8Unorm;

/// The number of the bind group.
const GROUP: u32 = 3;

/// The textures of a tile's ground, as `shaders/relief.wgsl` and `shaders/photo.wgsl` declare them.
pub(crate) struct TileTextures {
    group: BindGroup,
    bytes: u64,
}

/// The layout of the bind group: the block `struct TileTextures`, a sampler, the slopes; the photo, its sampler; the water.
pub(crate) fn layout_of(device: &Device) -> BindGroupLayout {
    let sampler = |binding| BindGroupLayoutEntry {
        binding,
        visibility: ShaderStages::FRAGMENT,
        ty: BindingType::Sampler(SamplerBindingType::Filtering),
        count: None,
    };
    let [slopes, photo, water] =
        [2, 3, 5].map(|binding| texture(binding, TextureSampleType::Float { filterable: true }));
    layout(
        device,
        "tile textures",
        &[uniform(0, None), sampler(1), slopes, photo, sampler(4), water],
    )
}

/// The block `struct TileTextures`.
pub(crate) fn rows(tile: &TileGeometry) -> [[f32; 4]; 2] {
    let [east, north] = tile.size_m.map(|side_m| (1.0 / side_m) as f32);
    let has = |part: bool| if part { 1.0 } else { 0.0 };
    let has_water = tile.shading.as_ref().is_some_and(|slopes| !slopes.water().is_empty());
    [
        [east, north, has(tile.shading.is_some()), has(has_water)],
        [has(tile.photo.is_some()), PHOTO_BORDER as f32, 0.0, 0.0],
    ]
}

impl TileTextures {
    /// Uploads the textures of a tile. What it does not have is one texel that nothing reads.
    pub(crate) fn new(gpu: &Gpu, tile: &TileGeometry) -> Self {
        let none = |format| square(gpu, format, 1, &[0; 4]);
        let side = ShadingSlopes::SIDE as u32;
        let slopes = match &tile.shading {
            Some(slopes) => square(gpu, SLOPES, side, bytemuck::cast_slice(slopes.texels())),
            None => none(SLOPES),
        };
        let water = match tile.shading.as_ref().map(ShadingSlopes::water) {
            Some(water) if !water.is_empty() => square(gpu, WATER, side, water),
            _ => none(WATER),
        };
        let photo = match &tile.photo {
            Some(photo) => photo_texture::upload(gpu, photo),
            None => none(photo_texture::FORMAT),
        };
        let sampler = gpu.device.create_sampler(&wgpu::SamplerDescriptor {
            label: Some("tile textures"),
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            ..Default::default()
        });
        let photo_sampler = photo_texture::sampler(&gpu.device);
        let block =
            gpu.buffer("tile textures", bytemuck::cast_slice(&rows(tile)), BufferUsages::UNIFORM);
        let resources = [
            block.as_entire_binding(),
            BindingResource::Sampler(&sampler),
            BindingResource::TextureView(&slopes),
            BindingResource::TextureView(&photo),
            BindingResource::Sampler(&photo_sampler),
            BindingResource::TextureView(&water),
        ];
        Self { group: group(gpu, &layout_of(&gpu.device), &resources), bytes: Self::bytes_of(tile) }
    }

    /// Bytes of the textures that [`TileTextures::new`] makes.
    pub(crate) fn bytes_of(tile: &TileGeometry) -> u64 {
        let slopes = tile
            .shading
            .as_ref()
            .map_or(4, |slopes| size_of_val(slopes.texels()) + slopes.water().len().max(1));
        let photo = tile.photo.as_ref().map_or(4, PhotoImage::bytes);
        (slopes + size_of_val(&rows(tile))) as u64 + photo
    }

    /// Bytes on the graphics card.
    pub(crate) fn gpu_bytes(&self) -> u64 {
        self.bytes
    }

    /// Binds them.
    pub(crate) fn set(&self, pass: &mut RenderPass<'_>) {
        pass.set_bind_group(GROUP, &self.group, &[]);
    }
}

/// A square texture with these texels.
fn square(gpu: &Gpu, format: TextureFormat, side: u32, texels: &[u8]) -> TextureView {
    let descriptor = wgpu::TextureDescriptor {
        label: Some("relief"),
        size: wgpu::Extent3d { width: side, height: side, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    };
    let order = TextureDataOrder::LayerMajor;
    let texture = gpu.device.create_texture_with_data(&gpu.queue, &descriptor, order, texels);
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}
