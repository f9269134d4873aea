//! Ground, sky and roads into the samples of a picture.

use wgpu::{
    BindGroupLayout, BindGroupLayoutEntry, ColorWrites, CommandEncoder, Device, RenderPipeline,
    ShaderStages,
};

use super::super::{
    Gpu,
    bindings::{UNFILTERED, layout, texture, textures},
    formats::{BLOCK, LABEL},
    passes::{begin, full_screen},
    pipeline::{PipelineRecipe, Shader, shader},
    shared_bindings::{SharedBindings, SharedLayouts},
    targets::Targets,
};
use crate::options::RoadMethod;

pub(crate) const BLOCKS_SHADER: Shader = shader!("road blocks": "common", "screen", "blocks");
pub(crate) const SHADER: Shader = shader!("composite": "common", "screen", "composite");

/// Corners of the two triangles of a block, as `shaders/composite.wgsl` counts them.
const BLOCK_CORNERS: u32 = 6;

/// Draws ground and sky everywhere, then the blocks with roads again, with their roads.
///
/// These are two draws, because one that looks up the block of each pixel took about twice as long on software Vulkan,
/// which runs both branches of a condition.
pub(crate) struct Composite {
    blocks_layout: BindGroupLayout,
    /// Finds the blocks with roads.
    blocks: RenderPipeline,
    layout: BindGroupLayout,
    /// Draws ground and sky, everywhere.
    ground: RenderPipeline,
    /// Draws ground, sky and roads, block by block.
    roads: RenderPipeline,
}

impl Composite {
    pub(crate) fn new(device: &Device, layouts: &SharedLayouts) -> Self {
        let block = [("BLOCK", f64::from(BLOCK))];
        let blocks_layout = layout(device, "road blocks", &[texture(0, UNFILTERED)]);
        let blocks_groups = [Some(&layouts.frame), Some(&blocks_layout)];
        let blocks = PipelineRecipe {
            targets: &[(LABEL, ColorWrites::ALL)],
            ..PipelineRecipe::full_screen(BLOCKS_SHADER, &blocks_groups, &block)
        }
        .build(device);
        let road_blocks =
            BindGroupLayoutEntry { visibility: ShaderStages::VERTEX, ..texture(3, UNFILTERED) };
        let [ground, depth, labels] = [0, 1, 2].map(|binding| texture(binding, UNFILTERED));
        let layout = layout(device, "composite", &[ground, depth, labels, road_blocks]);
        let groups = [Some(&layouts.frame), Some(&layout)];
        let composite = |entries| {
            let recipe = PipelineRecipe::full_screen(SHADER, &groups, &block);
            PipelineRecipe { entries, ..recipe }.build(device)
        };
        let ground = composite(["vertex", "ground_fragment"]);
        let roads = composite(["block_vertex", "road_fragment"]);
        Self { blocks_layout, blocks, layout, ground, roads }
    }

    /// Draws the samples of the picture of `targets`, into which ground and roads are drawn.
    pub(crate) fn draw(
        &self,
        gpu: &Gpu,
        encoder: &mut CommandEncoder,
        shared: &SharedBindings,
        method: RoadMethod,
        targets: &Targets,
    ) {
        let Targets { ground, depth, labels, road_blocks, .. } = targets;
        let has_roads = method != RoadMethod::None;
        if has_roads {
            let bound = textures(gpu, &self.blocks_layout, &[&labels.view]);
            let groups = [shared.frame(), &bound];
            full_screen(encoder, "road blocks", &road_blocks.view, &self.blocks, &groups);
        }
        let views = [&ground.view, &depth.view, &labels.view, &road_blocks.view];
        let bound = textures(gpu, &self.layout, &views);
        let mut pass = begin(encoder, "composite", &[targets.picture().drawn()], None);
        shared.set_frame(&mut pass);
        pass.set_bind_group(1, &bound, &[]);
        pass.set_pipeline(&self.ground);
        pass.draw(0..3, 0..1);
        if has_roads {
            pass.set_pipeline(&self.roads);
            pass.draw(0..BLOCK_CORNERS * targets.block_count(), 0..1);
        }
    }
}
