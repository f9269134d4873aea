use wgpu::{CommandEncoder, LoadOp, Operations, StoreOp};

use super::{
    Gpu, bindings::FrameBindings, layouts::Layouts, passes::Pipelines, roads_pass::LevelConnectors,
    targets::Targets, tile_buffers::TileBuffers, timings::PassTimer,
};
use crate::frame_view::FrameView;

/// A tile to draw in this frame.
pub struct DrawTile<'a> {
    /// The tile.
    pub buffers: &'a TileBuffers,
    /// How far its skirt hangs, true metres.
    pub skirt_depth_m: f64,
}

/// Knows how to draw tiles; holds nothing of any frame.
pub struct Renderer {
    pub(crate) layouts: Layouts,
    pub(crate) pipelines: Pipelines,
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
        mut timer: Option<&mut PassTimer>,
    ) {
        let bindings = FrameBindings::new(gpu, &self.layouts, view, tiles, targets);
        let connectors = LevelConnectors::new(gpu, view.roads, tiles);
        let descriptor = wgpu::CommandEncoderDescriptor { label: Some("frame") };
        let mut encoder = gpu.device.create_command_encoder(&descriptor);
        let mut mark = |encoder: &mut CommandEncoder, number| {
            if let Some(timer) = &mut timer {
                timer.mark(encoder, number);
            }
        };
        mark(&mut encoder, 0);
        self.terrain_pass(gpu, &mut encoder, &bindings, tiles, view, targets);
        mark(&mut encoder, 1);
        self.roads_pass(&mut encoder, &bindings, tiles, &connectors, view, targets);
        mark(&mut encoder, 2);
        self.composite_pass(&mut encoder, &bindings, view.roads.method, targets);
        self.average_pass(gpu, &mut encoder, targets.picture());
        mark(&mut encoder, 3);
        gpu.queue.submit([encoder.finish()]);
    }
}

/// A pass that starts from nothing: colours 0, depth 0 (infinitely far).
pub(crate) fn begin<'e>(
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
