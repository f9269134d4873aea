//! The textures of a tile's ground on the GPU, in one bind group.

use corniche_tileset::PHOTO_BORDER;
use wgpu::{
    BindGroup, BindGroupLayout, BindGroupLayoutEntry, BindingResource, BindingType, BufferUsages,
    Device, RenderPass, SamplerBindingType, ShaderStages, TextureFormat, TextureSampleType,
};

use super::{
    Gpu,
    bindings::{group, layout, texture, uniform},
    slope_chain::SlopeChain,
    square_texture::{of_one_size, square},
};
use crate::tiles::{PhotoImage, ShadingSlopes, TileGeometry};

/// Format of photos. Colours are mixed as they are stored, like all other colours of the ground.
const PHOTO: TextureFormat = TextureFormat::Rgba8Unorm;
/// Number of samples of a photo that are averaged in a grazing view, at most.
const ANISOTROPY: u16 = 16;
/// Format of the water mask of nodes.
const WATER: TextureFormat = TextureFormat::R8Unorm;

/// Number of the bind group.
const GROUP: u32 = 3;

/// The textures of a tile's ground, as declared in `shaders/relief.wgsl` and `shaders/photo.wgsl`.
pub(crate) struct TileTextures {
    group: BindGroup,
    pub(crate) slopes: SlopeChain,
    bytes: u64,
}

/// The layout of the bind group: the block `struct TileTextures`, a sampler, the tile's slopes; the
/// photo and its sampler; the water; the slopes of coarser levels.
pub(crate) fn layout_of(device: &Device) -> BindGroupLayout {
    let sampler = |binding| BindGroupLayoutEntry {
        binding,
        visibility: ShaderStages::FRAGMENT,
        ty: BindingType::Sampler(SamplerBindingType::Filtering),
        count: None,
    };
    let filtered = |binding| texture(binding, TextureSampleType::Float { filterable: true });
    let [slopes, photo, water] = [2, 3, 5].map(filtered);
    let mut entries = vec![uniform(0, None), sampler(1), slopes, photo, sampler(4), water];
    entries.extend((6..).map(filtered).take(SlopeChain::LEVELS - 1));
    layout(device, "tile textures", &entries)
}

/// Number of rows of the block `struct TileTextures`.
pub(crate) const ROWS: usize = 3;

/// The block `struct TileTextures`.
fn rows(tile: &TileGeometry, slopes: &SlopeChain) -> [[f32; 4]; ROWS] {
    let [east, north] = tile.size_m.map(|side_m| (1.0 / side_m) as f32);
    let has = |part: bool| if part { 1.0 } else { 0.0 };
    let has_water = tile.shading.as_ref().is_some_and(|slopes| !slopes.water.is_empty());
    [
        [east, north, has(tile.shading.is_some()), has(has_water)],
        [has(tile.photo.is_some()), PHOTO_BORDER as f32, 0.0, 0.0],
        slopes.row(tile.id, tile.size_m),
    ]
}

impl TileTextures {
    /// Uploads the textures of a tile; `above` has the slopes of its ancestors. A missing texture
    /// is replaced by one texel that is never read.
    pub(crate) fn new(gpu: &Gpu, tile: &TileGeometry, above: Option<&SlopeChain>) -> Self {
        let none = of_one_size(gpu, PHOTO, 1, &[0; 4]);
        let slopes = SlopeChain::new(gpu, tile, above);
        let water = match tile.shading.as_ref().map(|slopes| &slopes.water) {
            Some(water) if !water.is_empty() => of_one_size(gpu, WATER, ShadingSlopes::SIDE, water),
            _ => none.clone(),
        };
        let photo = tile.photo.as_ref();
        let photo = photo.map_or(none.clone(), |photo| square(gpu, PHOTO, photo.sizes()));
        let filtering = wgpu::SamplerDescriptor {
            label: Some("tile textures"),
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            ..Default::default()
        };
        let sampler = gpu.device.create_sampler(&filtering);
        let photo_sampler = gpu.device.create_sampler(&wgpu::SamplerDescriptor {
            mipmap_filter: wgpu::MipmapFilterMode::Linear,
            anisotropy_clamp: ANISOTROPY,
            ..filtering
        });
        let block = gpu.buffer(
            "tile textures",
            bytemuck::cast_slice(&rows(tile, &slopes)),
            BufferUsages::UNIFORM,
        );
        let [own, coarser @ ..] = slopes.views(&none);
        let mut resources = vec![
            block.as_entire_binding(),
            BindingResource::Sampler(&sampler),
            BindingResource::TextureView(own),
            BindingResource::TextureView(&photo),
            BindingResource::Sampler(&photo_sampler),
            BindingResource::TextureView(&water),
        ];
        resources.extend(coarser.map(BindingResource::TextureView));
        let group = group(gpu, &layout_of(&gpu.device), &resources);
        Self { group, slopes, bytes: Self::bytes_of(tile) }
    }

    /// Size of the textures that [`TileTextures::new`] creates, bytes.
    pub(crate) fn bytes_of(tile: &TileGeometry) -> u64 {
        let water = tile.shading.as_ref().map_or(0, |slopes| slopes.water.len());
        let photo = tile.photo.as_ref().map_or(0, PhotoImage::bytes);
        // A missing texture takes one texel.
        SlopeChain::bytes_of(tile) + (4 + water + ROWS * size_of::<[f32; 4]>()) as u64 + photo
    }

    /// Size on the GPU, bytes.
    pub(crate) fn gpu_bytes(&self) -> u64 {
        self.bytes
    }

    /// Binds the textures.
    pub(crate) fn set(&self, pass: &mut RenderPass<'_>) {
        pass.set_bind_group(GROUP, &self.group, &[]);
    }
}
