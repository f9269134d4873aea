//! Points: discs of a size in pixels, where the ground does not hide them.

use corniche_styles::PointStyle;
use wgpu::{
    BindGroupLayout, BindGroupLayoutEntry, BlendState, Device, PrimitiveTopology, RenderPass,
    RenderPipeline, ShaderStages,
};

use super::{
    super::{
        bindings::{UNFILTERED, block, layout, texture, textures, uniform},
        pipeline::{PipelineRecipe, Shader, shader},
        point_buffers::{POINTS, PointBuffers},
        shared_bindings::{DrawnFrame, SharedLayouts},
        uniforms::color,
    },
    composite::haze,
};
use crate::{class_scale, frame_view::FrameView, layer_class::LayerClass};

pub(crate) const SHADER: Shader = shader!("points": "common", "tile", "points");

/// A tile whose points are drawn: its index in the list of tiles of the frame, and its points.
pub(crate) type PointTile<'a> = (usize, &'a PointBuffers);

/// Draws points.
pub(crate) struct PointDrawable {
    /// Bind group 2: the depths of the ground.
    ground: BindGroupLayout,
    look: BindGroupLayout,
    pipeline: RenderPipeline,
}

impl PointDrawable {
    pub(crate) fn new(device: &Device, layouts: &SharedLayouts) -> Self {
        let depth =
            BindGroupLayoutEntry { visibility: ShaderStages::VERTEX, ..texture(0, UNFILTERED) };
        let ground = layout(device, "ground under points", &[depth]);
        let look = layout(device, "point look", &[uniform(0, None)]);
        let groups = [Some(&layouts.frame), Some(&layouts.tile), Some(&ground), Some(&look)];
        let recipe = PipelineRecipe {
            buffer: Some(POINTS),
            topology: PrimitiveTopology::TriangleStrip,
            blend: Some(BlendState::ALPHA_BLENDING),
            ..PipelineRecipe::new(SHADER, &groups, &[])
        };
        let pipeline = recipe.build(device);
        Self { ground, look, pipeline }
    }

    /// Draws the points of some tiles over a picture, class by class, the topmost last: those of
    /// the highest layer, and the first class of a layer.
    pub(crate) fn draw(
        &self,
        DrawnFrame { gpu, shared, view, targets }: DrawnFrame<'_>,
        pass: &mut RenderPass<'_>,
        tiles: &[PointTile<'_>],
    ) {
        let classes = tiles.iter().flat_map(|tile| &tile.1.classes).map(|of| of.0);
        pass.set_pipeline(&self.pipeline);
        shared.set_frame(pass);
        pass.set_bind_group(2, &textures(gpu, &self.ground, &[&targets.depth.view]), &[]);
        for class in LayerClass::topmost_first(classes).into_iter().rev() {
            let Some(point) = view.layers.point(class) else { continue };
            let look = block(gpu, "point look", &self.look, &rows(view, point));
            pass.set_bind_group(3, &look, &[]);
            for (index, points) in tiles {
                shared.set_tile(pass, *index);
                points.draw(pass, class);
            }
        }
    }
}

/// The block `look` of `shaders/points.wgsl`.
fn rows(view: &FrameView<'_>, point: PointStyle) -> [[f32; 4]; 4] {
    let edge_px = f32::from(u8::from(point.outline.is_some()));
    let full_m = class_scale::distance_m(point.max_pixel_m, view.camera, view.point_scale);
    [
        color(point.color, point.opacity),
        color(point.outline.unwrap_or(point.color), 1.0),
        haze(view),
        [point.size_px / 2.0, point.size_px / 2.0 + edge_px, full_m as f32, 0.0],
    ]
}
