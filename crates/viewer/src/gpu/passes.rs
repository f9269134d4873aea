use wgpu::{CommandEncoder, LoadOp, Operations, RenderPipeline, StoreOp, TextureView};

/// Begins a pass into cleared targets: colours 0, depth 0, which is infinitely far.
pub(crate) fn begin<'e>(
    encoder: &'e mut CommandEncoder,
    label: &str,
    colors: &[&TextureView],
    depth: Option<&TextureView>,
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

/// A pass that draws one triangle over all of `into`.
pub(crate) fn full_screen(
    encoder: &mut CommandEncoder,
    label: &str,
    into: &TextureView,
    pipeline: &RenderPipeline,
    groups: &[&wgpu::BindGroup],
) {
    let mut pass = begin(encoder, label, &[into], None);
    pass.set_pipeline(pipeline);
    for (index, group) in (0..).zip(groups) {
        pass.set_bind_group(index, *group, &[]);
    }
    pass.draw(0..3, 0..1);
}
