//! Ground, sky and roads into the samples of a picture.

use corniche_styles::{RoadBands, RoadStyle};
use glam::DVec4;
use wgpu::{
    BindGroupLayout, BindGroupLayoutEntry, BindingResource, BufferUsages, ColorWrites,
    CommandEncoder, Device, RenderPass, RenderPipeline, ShaderStages,
};

use super::super::{
    Gpu,
    bindings::{UNFILTERED, group, layout, texture, textures, uniform},
    formats::LABEL,
    passes::full_screen,
    pipeline::{PipelineRecipe, Shader, shader},
    shared_bindings::{SharedBindings, SharedLayouts},
    targets::{BLOCK_SIDE, Targets},
    uniforms::{color, row},
};
use crate::{frame_view::FrameView, options::RoadMethod};

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
        let block = [("BLOCK", f64::from(BLOCK_SIDE))];
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
        let layout =
            layout(device, "composite", &[ground, depth, labels, road_blocks, uniform(4, None)]);
        let groups = [Some(&layouts.frame), Some(&layout)];
        let composite = |entries| {
            let recipe = PipelineRecipe::full_screen(SHADER, &groups, &block);
            PipelineRecipe { entries, ..recipe }.build(device)
        };
        let ground = composite(["vertex", "ground_fragment"]);
        let roads = composite(["block_vertex", "road_fragment"]);
        Self { blocks_layout, blocks, layout, ground, roads }
    }

    /// Finds the blocks with roads. It begins and ends a pass of its own, because nothing else draws into their texture.
    pub(crate) fn find_blocks(
        &self,
        gpu: &Gpu,
        encoder: &mut CommandEncoder,
        shared: &SharedBindings,
        method: RoadMethod,
        targets: &Targets,
    ) {
        if method != RoadMethod::None {
            let bound = textures(gpu, &self.blocks_layout, &[&targets.labels.view]);
            let groups = [shared.frame(), &bound];
            full_screen(encoder, "road blocks", &targets.road_blocks.view, &self.blocks, &groups);
        }
    }

    /// Draws the samples of the picture of `targets`, after ground and roads were drawn and the blocks found. The pass draws
    /// into that picture.
    pub(crate) fn draw(
        &self,
        gpu: &Gpu,
        pass: &mut RenderPass<'_>,
        shared: &SharedBindings,
        view: &FrameView<'_>,
        targets: &Targets,
    ) {
        let rows = rows(view);
        let colors =
            gpu.buffer("picture colors", bytemuck::cast_slice(&rows), BufferUsages::UNIFORM);
        let Targets { ground, depth, labels, road_blocks, .. } = targets;
        let [ground, depth, labels, road_blocks] = [ground, depth, labels, road_blocks]
            .map(|texture| BindingResource::TextureView(&texture.view));
        let resources = [ground, depth, labels, road_blocks, colors.as_entire_binding()];
        shared.set_frame(pass);
        pass.set_bind_group(1, &group(gpu, &self.layout, &resources), &[]);
        pass.set_pipeline(&self.ground);
        pass.draw(0..3, 0..1);
        if view.roads.method != RoadMethod::None {
            pass.set_pipeline(&self.roads);
            pass.draw(0..BLOCK_CORNERS * targets.block_count(), 0..1);
        }
    }
}

/// The plane that is seen where there is no ground, beneath all ground and its walls: the eye's place on it in plan, modulo
/// the last value; the eye's height above it; the widest spacing of lines on it. World metres.
fn void_plane(view: &FrameView<'_>) -> DVec4 {
    let eye = view.camera.eye_in_world();
    let lowest = (view.height_range_m[0] - view.wall_m) * view.vertical_scale();
    // Spacings are powers of two, so that all of them divide this one. In f32, a place then has 2^-24 of it.
    let widest = (4096.0 * view.camera.focus_m()).log2().round().exp2();
    DVec4::new(eye.x.rem_euclid(widest), eye.y.rem_euclid(widest), eye.z - lowest, widest)
}

/// The block `struct PictureColors` of `shaders/composite.wgsl`.
pub(crate) fn rows(view: &FrameView<'_>) -> Vec<[f32; 4]> {
    let style = view.style;
    let mut rows = vec![
        color(style.haze, (f64::from(style.haze_reach) * view.camera.focus_m()) as f32),
        color(style.sky, 0.0),
        color(style.void, 0.0),
        row(void_plane(view)),
    ];
    let roads = &style.roads;
    for road in roads {
        let mut bands = [[0.0; 4]; RoadBands::MOST];
        for (row, band) in bands.iter_mut().zip(road.bands.all()) {
            *row = color(band.color, 1.0);
        }
        rows.extend(bands);
    }
    rows.extend(roads.iter().map(|road| color(road.outline, 1.0)));
    rows.extend(roads.iter().map(|road| color(road.bands.main_color(), 1.0)));
    let thin = |road: &RoadStyle| road.thin.unwrap_or(road.bands.main_color());
    rows.extend(roads.iter().map(|road| color(thin(road), 1.0)));
    rows
}
