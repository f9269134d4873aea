//! Begins render passes, with uniform rules for clearing.

use wgpu::{CommandEncoder, LoadOp, Operations, RenderPipeline, StoreOp, TextureView};

/// Begins a pass. With `LoadOp::Clear(())` its targets are cleared first: colours to 0, depth to 0,
/// which is infinitely far. With `LoadOp::Load` the pass draws over the results of earlier passes.
pub(crate) fn begin<'e>(
    encoder: &'e mut CommandEncoder,
    label: &str,
    colors: &[&TextureView],
    depth: Option<&TextureView>,
    load: LoadOp<()>,
) -> wgpu::RenderPass<'e> {
    let is_cleared = matches!(load, LoadOp::Clear(()));
    let load_depth = if is_cleared { LoadOp::Clear(0.0) } else { LoadOp::Load };
    let depth = depth.map(|view| wgpu::RenderPassDepthStencilAttachment {
        view,
        depth_ops: Some(Operations { load: load_depth, store: StoreOp::Store }),
        stencil_ops: None,
    });
    begin_with(encoder, label, colors, depth, load)
}

/// Begins a pass that draws over `color`, with a stencil that is 0 everywhere and is discarded at
/// the end.
pub(crate) fn begin_with_stencil<'e>(
    encoder: &'e mut CommandEncoder,
    label: &str,
    color: &TextureView,
    stencil: &TextureView,
) -> wgpu::RenderPass<'e> {
    let stencil = wgpu::RenderPassDepthStencilAttachment {
        view: stencil,
        depth_ops: None,
        stencil_ops: Some(Operations { load: LoadOp::Clear(0), store: StoreOp::Discard }),
    };
    begin_with(encoder, label, &[color], Some(stencil), LoadOp::Load)
}

fn begin_with<'e>(
    encoder: &'e mut CommandEncoder,
    label: &str,
    colors: &[&TextureView],
    depth_stencil: Option<wgpu::RenderPassDepthStencilAttachment<'_>>,
    load: LoadOp<()>,
) -> wgpu::RenderPass<'e> {
    let is_cleared = matches!(load, LoadOp::Clear(()));
    let load_color =
        if is_cleared { LoadOp::Clear(wgpu::Color::TRANSPARENT) } else { LoadOp::Load };
    let attach = |view| {
        Some(wgpu::RenderPassColorAttachment {
            view,
            depth_slice: None,
            resolve_target: None,
            ops: Operations { load: load_color, store: StoreOp::Store },
        })
    };
    let attachments: Vec<_> = colors.iter().map(|view| attach(*view)).collect();
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some(label),
        color_attachments: &attachments,
        depth_stencil_attachment: depth_stencil,
        ..Default::default()
    })
}

/// Begins and ends a pass that draws one triangle over all of `into`.
pub(crate) fn full_screen(
    encoder: &mut CommandEncoder,
    label: &str,
    into: &TextureView,
    pipeline: &RenderPipeline,
    groups: &[&wgpu::BindGroup],
) {
    let mut pass = begin(encoder, label, &[into], None, LoadOp::Clear(()));
    pass.set_pipeline(pipeline);
    for (index, group) in (0..).zip(groups) {
        pass.set_bind_group(index, *group, &[]);
    }
    pass.draw(0..3, 0..1);
}
