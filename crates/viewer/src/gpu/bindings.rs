use wgpu::{BindGroup, BindGroupEntry, BindingResource, BufferUsages, TextureView};

use super::{Gpu, layouts::Layouts, renderer::DrawTile, targets::Targets, uniforms};
use crate::frame_view::FrameView;

/// What the passes of one frame share.
pub(crate) struct FrameBindings {
    pub(crate) frame: BindGroup,
    tiles: BindGroup,
    tile_stride: u32,
    pub(crate) ground: BindGroup,
    pub(crate) blocks: BindGroup,
    pub(crate) composite: BindGroup,
}

impl FrameBindings {
    pub(crate) fn new(
        gpu: &Gpu,
        layouts: &Layouts,
        view: &FrameView<'_>,
        tiles: &[DrawTile<'_>],
        targets: &Targets,
    ) -> Self {
        let rows = uniforms::frame_rows(view, targets.samples_per_side());
        let frame = gpu.buffer("frame", bytemuck::cast_slice(&rows), BufferUsages::UNIFORM);

        let stride = u64::from(gpu.device.limits().min_uniform_buffer_offset_alignment)
            .max(uniforms::TILE_BYTES);
        // At least one block, so that there is something to bind without tiles.
        let mut blocks = vec![0_u8; stride as usize * tiles.len().max(1)];
        let in_list = tiles.iter().zip(1..);
        for ((tile, number), block) in in_list.zip(blocks.chunks_exact_mut(stride as usize)) {
            let rows = uniforms::tile_rows(view, tile, number);
            block[..uniforms::TILE_BYTES as usize].copy_from_slice(bytemuck::cast_slice(&rows));
        }
        let tiles = gpu.buffer("tiles", &blocks, BufferUsages::UNIFORM);
        let tile_block = wgpu::BufferBinding {
            buffer: &tiles,
            offset: 0,
            size: std::num::NonZeroU64::new(uniforms::TILE_BYTES),
        };

        let Targets { ground, depth, owners, labels, road_blocks, .. } = targets;
        Self {
            frame: group(gpu, &layouts.frame, &[frame.as_entire_binding()]),
            tiles: group(gpu, &layouts.tile, &[BindingResource::Buffer(tile_block)]),
            tile_stride: stride as u32,
            ground: textures(gpu, &layouts.ground, &[&depth.view, &owners.view]),
            blocks: textures(gpu, &layouts.blocks, &[&labels.view]),
            composite: textures(
                gpu,
                &layouts.composite,
                &[&ground.view, &depth.view, &labels.view, &road_blocks.view],
            ),
        }
    }

    /// Sets the block of the tile with this index in the list.
    pub(crate) fn set_tile(&self, pass: &mut wgpu::RenderPass<'_>, index: usize) {
        pass.set_bind_group(1, &self.tiles, &[index as u32 * self.tile_stride]);
    }
}

/// Binds textures, 0 first.
pub(crate) fn textures(
    gpu: &Gpu,
    layout: &wgpu::BindGroupLayout,
    views: &[&TextureView],
) -> BindGroup {
    let resources: Vec<_> = views.iter().map(|view| BindingResource::TextureView(view)).collect();
    group(gpu, layout, &resources)
}

fn group(
    gpu: &Gpu,
    layout: &wgpu::BindGroupLayout,
    resources: &[BindingResource<'_>],
) -> BindGroup {
    let entries: Vec<_> = resources
        .iter()
        .zip(0..)
        .map(|(resource, binding)| BindGroupEntry { binding, resource: resource.clone() })
        .collect();
    gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout,
        entries: &entries,
    })
}
