//! Passes over the whole picture: composite, average of samples, difference of two pictures.

use wgpu::{CommandEncoder, RenderPipeline, TextureView};

use super::{
    Gpu, GpuError,
    bindings::{FrameBindings, textures},
    picture::Picture,
    renderer::{Renderer, begin},
    targets::Targets,
};
use crate::{options::RoadMethod, style::Rgb};

/// Corners of a block's two triangles, as `shaders/composite.wgsl` counts them.
const BLOCK_CORNERS: u32 = 6;

/// What [`Renderer::draw_difference`] paints.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DifferenceColors {
    /// Road in the first only.
    pub first_only: Rgb,
    /// Road in the second only.
    pub second_only: Rgb,
    /// Road in both, but of another class, or a centre line in one of them.
    pub other_label: Rgb,
}

/// Vermilion, blue, and a reddish purple: told apart by all kinds of eyes.
///
/// Source: Okabe & Ito 2008, *Color Universal Design*. `shaders/difference.wgsl` has the same.
pub const DIFFERENCE_COLORS: DifferenceColors = DifferenceColors {
    first_only: [213.0 / 255.0, 94.0 / 255.0, 0.0],
    second_only: [0.0, 114.0 / 255.0, 178.0 / 255.0],
    other_label: [204.0 / 255.0, 121.0 / 255.0, 167.0 / 255.0],
};

impl Renderer {
    /// Shows in `into` where the roads of two drawings differ, over the first one's picture in pale grey. Both were
    /// drawn with the same camera; all three have the same size and samples.
    ///
    /// # Errors
    /// When the sizes differ.
    pub fn draw_difference(
        &self,
        gpu: &Gpu,
        first: &Targets,
        second: &Targets,
        into: &Picture,
    ) -> Result<(), GpuError> {
        let sizes_px = [first.picture(), second.picture(), into].map(Picture::sampled_px);
        let is_same = sizes_px.iter().all(|size_px| *size_px == sizes_px[0])
            && first.samples_per_side() == into.samples_per_side();
        if !is_same {
            return Err(GpuError::SizesDiffer { sizes_px });
        }
        let views = [&first.labels.view, &second.labels.view, first.picture().drawn()];
        let bound = textures(gpu, &self.layouts.difference, &views);
        let descriptor = wgpu::CommandEncoderDescriptor { label: Some("difference") };
        let mut encoder = gpu.device.create_command_encoder(&descriptor);
        full_screen(
            &mut encoder,
            "difference",
            into.drawn(),
            &self.pipelines.difference,
            &[&bound],
        );
        self.average_pass(gpu, &mut encoder, into);
        gpu.queue.submit([encoder.finish()]);
        Ok(())
    }

    /// Ground and sky everywhere, then the blocks with roads once more, with them. Two draws, because one that looks its
    /// block up for each pixel took about twice as long on software Vulkan, which runs both branches of a condition.
    pub(crate) fn composite_pass(
        &self,
        encoder: &mut CommandEncoder,
        bindings: &FrameBindings,
        method: RoadMethod,
        targets: &Targets,
    ) {
        let has_roads = method != RoadMethod::None;
        if has_roads {
            full_screen(
                encoder,
                "road blocks",
                &targets.road_blocks.view,
                &self.pipelines.blocks,
                &[&bindings.frame, &bindings.blocks],
            );
        }
        let mut pass = begin(encoder, "composite", &[targets.picture().drawn()], None);
        pass.set_bind_group(0, &bindings.frame, &[]);
        pass.set_bind_group(1, &bindings.composite, &[]);
        pass.set_pipeline(&self.pipelines.composite);
        pass.draw(0..3, 0..1);
        if has_roads {
            pass.set_pipeline(&self.pipelines.composite_roads);
            pass.draw(0..BLOCK_CORNERS * targets.block_count(), 0..1);
        }
    }

    /// The mean of the samples of each pixel; nothing to do where there is one.
    pub(crate) fn average_pass(&self, gpu: &Gpu, encoder: &mut CommandEncoder, picture: &Picture) {
        let Some(samples) = picture.samples() else { return };
        let bound = textures(gpu, &self.layouts.average, &[samples]);
        let pipeline = &self.pipelines.averages[picture.samples_per_side() as usize - 2];
        full_screen(encoder, "average", picture.view(), pipeline, &[&bound]);
    }
}

/// Draws one triangle that covers all of `into`.
fn full_screen(
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
