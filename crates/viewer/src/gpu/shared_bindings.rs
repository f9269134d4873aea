//! Bind groups that several drawables share.
//!
//! | group | contents | changes |
//! |---|---|---|
//! | 0 | the frame's uniform block | with each frame |
//! | 1 | a tile's uniform block | with each tile, by an offset |
//! | 2 | depth and owner of each sample of the ground | with each frame |
//!
//! The terrain uses other groups: 2 for its colours, 3 for a tile's textures
//! ([`tile_textures`](super::tile_textures)). Areas use 3 for their colours.

use std::num::NonZeroU64;

use wgpu::{
    BindGroup, BindGroupLayout, BindingResource, Buffer, BufferUsages, Device, RenderPass,
    TextureSampleType,
};

use super::{
    Gpu,
    bindings::{UNFILTERED, block, group, layout, texture, textures, uniform},
    targets::Targets,
    uniforms,
};
use crate::frame_view::FrameView;

/// The layouts of the shared bind groups, by their numbers.
pub(crate) struct SharedLayouts {
    pub(crate) frame: BindGroupLayout,
    pub(crate) tile: BindGroupLayout,
    pub(crate) ground: BindGroupLayout,
}

impl SharedLayouts {
    pub(crate) fn new(device: &Device) -> Self {
        let tile_bytes = NonZeroU64::new(uniforms::TILE_BYTES);
        let ground = [texture(0, UNFILTERED), texture(1, TextureSampleType::Uint)];
        Self {
            frame: layout(device, "frame", &[uniform(0, None)]),
            tile: layout(device, "tile", &[uniform(0, tile_bytes)]),
            ground: layout(device, "ground", &ground),
        }
    }
}

/// The shared bind groups of one frame.
#[derive(Clone)]
pub(crate) struct SharedBindings {
    pub(crate) frame: BindGroup,
    tiles: BindGroup,
    /// Bytes from one tile's block to the next.
    tile_stride: u32,
    pub(crate) ground: BindGroup,
}

impl SharedBindings {
    /// Uploads the uniform blocks of a frame and of its tiles, in drawing order.
    pub(crate) fn new(
        gpu: &Gpu,
        layouts: &SharedLayouts,
        view: &FrameView<'_>,
        tiles: &[[[f32; 4]; 2]],
        targets: &Targets,
    ) -> Self {
        let tile_stride = u64::from(gpu.device.limits().min_uniform_buffer_offset_alignment)
            .max(uniforms::TILE_BYTES);
        let tiles = tile_blocks(gpu, tiles, tile_stride as usize);
        let tile_block = wgpu::BufferBinding {
            buffer: &tiles,
            offset: 0,
            size: NonZeroU64::new(uniforms::TILE_BYTES),
        };
        let Targets { depth, owners, .. } = targets;
        Self {
            frame: frame_group(gpu, layouts, view, targets),
            tiles: group(gpu, &layouts.tile, &[BindingResource::Buffer(tile_block)]),
            tile_stride: tile_stride as u32,
            ground: textures(gpu, &layouts.ground, &[&depth.view, &owners.view]),
        }
    }

    /// Creates the bindings of a frame with the block of its view: another view of the same tiles
    /// with the same camera.
    pub(crate) fn with_view(frame: DrawnFrame<'_>, layouts: &SharedLayouts) -> Self {
        let DrawnFrame { gpu, shared, view, targets } = frame;
        Self { frame: frame_group(gpu, layouts, view, targets), ..shared.clone() }
    }

    /// Binds the frame.
    pub(crate) fn set_frame(&self, pass: &mut RenderPass<'_>) {
        pass.set_bind_group(0, &self.frame, &[]);
    }

    /// Binds the tile with this index in the list of tiles of the frame.
    pub(crate) fn set_tile(&self, pass: &mut RenderPass<'_>, index: usize) {
        pass.set_bind_group(1, &self.tiles, &[index as u32 * self.tile_stride]);
    }
}

/// The inputs and targets of the passes of a frame.
#[derive(Clone, Copy)]
pub(crate) struct DrawnFrame<'a> {
    pub(crate) gpu: &'a Gpu,
    pub(crate) shared: &'a SharedBindings,
    pub(crate) view: &'a FrameView<'a>,
    pub(crate) targets: &'a Targets,
}

/// Uploads the uniform block of a frame.
fn frame_group(
    gpu: &Gpu,
    layouts: &SharedLayouts,
    view: &FrameView<'_>,
    targets: &Targets,
) -> BindGroup {
    let rows = uniforms::frame_rows(view, targets.picture.samples_per_side);
    block(gpu, "frame", &layouts.frame, &rows)
}

/// Uploads the uniform blocks of tiles, `stride` bytes apart.
fn tile_blocks(gpu: &Gpu, tiles: &[[[f32; 4]; 2]], stride: usize) -> Buffer {
    // There is at least one block, so that a buffer can be bound even without tiles.
    let mut blocks = vec![0_u8; stride * tiles.len().max(1)];
    for (rows, block) in tiles.iter().zip(blocks.chunks_exact_mut(stride)) {
        block[..uniforms::TILE_BYTES as usize].copy_from_slice(bytemuck::cast_slice(rows));
    }
    gpu.buffer("tiles", &blocks, BufferUsages::UNIFORM)
}
