use wgpu::{
    BindGroup, BindGroupEntry, BindingResource, CommandEncoder, LoadOp, Operations, StoreOp,
    util::DeviceExt,
};

use super::{
    Gpu,
    passes::{Layouts, Pipelines},
    roads_pass::Bridges,
    targets::Targets,
    tile_buffers::TileBuffers,
    timings::PassTimer,
    uniforms,
};
use crate::{RoadOptions, camera::Camera, style::Style};

/// What a picture shows and how, apart from the tiles.
#[derive(Debug, Clone, Copy)]
pub struct FrameView<'a> {
    /// The eye; its size is the targets'.
    pub camera: &'a Camera,
    /// Colours and widths.
    pub style: &'a Style,
    /// How roads are drawn.
    pub roads: RoadOptions,
    /// Factor on heights.
    pub exaggeration: f64,
    /// Length in the working CRS over true length: heights and widths are multiplied by it.
    pub point_scale: f64,
    /// True heights that the tint spans.
    pub height_range_m: [f64; 2],
    /// Pixels of the targets per pixel of the final picture, along each side.
    pub supersampling: u32,
}

impl FrameView<'_> {
    /// World height of one metre of true height.
    #[must_use]
    pub fn vertical_scale(&self) -> f64 {
        self.exaggeration * self.point_scale
    }
}

/// A tile to draw in this frame.
pub struct DrawTile<'a> {
    /// The tile.
    pub buffers: &'a TileBuffers,
    /// How far its skirt hangs, true metres.
    pub skirt_depth_m: f64,
}

/// Knows how to draw tiles; holds nothing of any frame.
pub struct Renderer {
    layouts: Layouts,
    pub(super) pipelines: Pipelines,
}

/// What the passes of one frame share.
pub(super) struct FrameBindings {
    pub(super) frame: BindGroup,
    tiles: BindGroup,
    tile_stride: u32,
    pub(super) ground: BindGroup,
    composite: BindGroup,
}

impl FrameBindings {
    /// Sets the block of the tile with this index in the list.
    pub(super) fn set_tile(&self, pass: &mut wgpu::RenderPass<'_>, index: usize) {
        pass.set_bind_group(1, &self.tiles, &[index as u32 * self.tile_stride]);
    }
}

impl Renderer {
    /// Builds the pipelines.
    #[must_use]
    pub fn new(gpu: &Gpu) -> Self {
        let layouts = Layouts::new(&gpu.device);
        let pipelines = Pipelines::new(&gpu.device, &layouts);
        Self { layouts, pipelines }
    }

    /// Draws terrain, roads and composite into `targets`.
    pub fn draw(&self, gpu: &Gpu, view: &FrameView<'_>, tiles: &[DrawTile<'_>], targets: &Targets) {
        self.draw_timed(gpu, view, tiles, targets, None);
    }

    /// The same, and `timer` notes how long each pass takes.
    pub fn draw_timed(
        &self,
        gpu: &Gpu,
        view: &FrameView<'_>,
        tiles: &[DrawTile<'_>],
        targets: &Targets,
        timer: Option<&PassTimer>,
    ) {
        let bindings = self.bind(gpu, view, tiles, targets);
        let bridges = Bridges::new(gpu, view.roads.method, tiles);
        let descriptor = wgpu::CommandEncoderDescriptor { label: Some("frame") };
        let mut encoder = gpu.device.create_command_encoder(&descriptor);
        let mark = |encoder: &mut CommandEncoder, number| {
            if let Some(timer) = timer {
                timer.mark(encoder, number);
            }
        };
        mark(&mut encoder, 0);
        self.terrain_pass(&mut encoder, &bindings, tiles, targets);
        mark(&mut encoder, 1);
        self.roads_pass(&mut encoder, &bindings, tiles, &bridges, view, targets);
        mark(&mut encoder, 2);
        self.composite_pass(&mut encoder, &bindings, targets);
        mark(&mut encoder, 3);
        gpu.queue.submit([encoder.finish()]);
    }

    fn bind(
        &self,
        gpu: &Gpu,
        view: &FrameView<'_>,
        tiles: &[DrawTile<'_>],
        targets: &Targets,
    ) -> FrameBindings {
        let uniform = |label, contents: &[u8]| {
            let usage = wgpu::BufferUsages::UNIFORM;
            gpu.device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
                label: Some(label),
                contents,
                usage,
            })
        };
        let group = |label, layout, entries: &[BindGroupEntry<'_>]| {
            gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some(label),
                layout,
                entries,
            })
        };
        let frame = uniform("frame", bytemuck::cast_slice(&uniforms::frame_rows(view)));

        let stride = u64::from(gpu.device.limits().min_uniform_buffer_offset_alignment)
            .max(uniforms::TILE_BYTES);
        // At least one block, so that there is something to bind without tiles.
        let mut blocks = vec![0_u8; stride as usize * tiles.len().max(1)];
        let in_list = tiles.iter().zip(1..);
        for ((tile, number), block) in in_list.zip(blocks.chunks_exact_mut(stride as usize)) {
            let rows = uniforms::tile_rows(view, tile, number);
            block[..uniforms::TILE_BYTES as usize].copy_from_slice(bytemuck::cast_slice(&rows));
        }
        let tiles = uniform("tiles", &blocks);
        let tile_block = wgpu::BufferBinding {
            buffer: &tiles,
            offset: 0,
            size: std::num::NonZeroU64::new(uniforms::TILE_BYTES),
        };

        let [ground, depth] = [targets.ground_view(), targets.depth_view()];
        let [owners, labels] = [targets.owners_view(), targets.labels_view()];
        let texture = |binding, view| BindGroupEntry {
            binding,
            resource: BindingResource::TextureView(view),
        };
        FrameBindings {
            frame: group(
                "frame",
                &self.layouts.frame,
                &[BindGroupEntry { binding: 0, resource: frame.as_entire_binding() }],
            ),
            tiles: group(
                "tiles",
                &self.layouts.tile,
                &[BindGroupEntry { binding: 0, resource: BindingResource::Buffer(tile_block) }],
            ),
            tile_stride: stride as u32,
            ground: group(
                "ground",
                &self.layouts.ground,
                &[texture(0, &depth), texture(1, &owners)],
            ),
            composite: group(
                "composite",
                &self.layouts.composite,
                &[texture(0, &ground), texture(1, &depth), texture(2, &labels)],
            ),
        }
    }

    fn terrain_pass(
        &self,
        encoder: &mut CommandEncoder,
        bindings: &FrameBindings,
        tiles: &[DrawTile<'_>],
        targets: &Targets,
    ) {
        let mut pass = begin(
            encoder,
            "terrain",
            &[&targets.ground_view(), &targets.owners_view()],
            Some(&targets.depth_view()),
        );
        pass.set_bind_group(0, &bindings.frame, &[]);
        for is_skirts in [false, true] {
            let Pipelines { terrain, skirts, .. } = &self.pipelines;
            pass.set_pipeline(if is_skirts { skirts } else { terrain });
            for (index, tile) in tiles.iter().enumerate() {
                let Some(ground) = &tile.buffers.ground else { continue };
                let part = if is_skirts { &ground.skirts } else { &ground.surface };
                bindings.set_tile(&mut pass, index);
                pass.set_vertex_buffer(0, ground.vertices.slice(..));
                pass.set_index_buffer(ground.indices.slice(..), wgpu::IndexFormat::Uint32);
                pass.draw_indexed(part.clone(), 0, 0..1);
            }
        }
    }

    fn composite_pass(
        &self,
        encoder: &mut CommandEncoder,
        bindings: &FrameBindings,
        targets: &Targets,
    ) {
        let mut pass = begin(encoder, "composite", &[&targets.picture_view()], None);
        pass.set_pipeline(&self.pipelines.composite);
        pass.set_bind_group(0, &bindings.frame, &[]);
        pass.set_bind_group(1, &bindings.composite, &[]);
        pass.draw(0..3, 0..1);
    }
}

/// A pass that starts from nothing: colours 0, depth 0 (infinitely far).
pub(super) fn begin<'e>(
    encoder: &'e mut CommandEncoder,
    label: &str,
    colors: &[&wgpu::TextureView],
    depth: Option<&wgpu::TextureView>,
) -> wgpu::RenderPass<'e> {
    let attach = |view| {
        Some(wgpu::RenderPassColorAttachment {
            view,
            depth_slice: None,
            resolve_target: None,
            ops: Operations {
                load: LoadOp::Clear(wgpu::Color::TRANSPARENT),
                store: StoreOp::Store,
            },
        })
    };
    let attachments: Vec<_> = colors.iter().map(|view| attach(*view)).collect();
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some(label),
        color_attachments: &attachments,
        depth_stencil_attachment: depth.map(|view| wgpu::RenderPassDepthStencilAttachment {
            view,
            depth_ops: Some(Operations { load: LoadOp::Clear(0.0), store: StoreOp::Store }),
            stencil_ops: None,
        }),
        timestamp_writes: None,
        occlusion_query_set: None,
        multiview_mask: None,
    })
}
