//! Decks of bridges: which of them is nearest at each pixel, what is seen of it, and its colours over the picture.

use std::ops::Range;

use wgpu::{
    BindGroup, BindGroupLayout, BindGroupLayoutEntry, BindingResource, BlendState, CommandEncoder,
    CompareFunction, Device, LoadOp, RenderPass, RenderPipeline, ShaderStages, vertex_attr_array,
};

use super::{
    super::{
        Gpu,
        bindings::{UNFILTERED, group, layout, texture, textures, uniform},
        passes::begin,
        pipeline::{PipelineRecipe, Shader, depth_test, shader},
        road_instances::{RoadBuffers, RoadInstance, RoadPipeline, RoadRecipe, own_width_value},
        shared_bindings::{SharedBindings, SharedLayouts},
        targets::{DeckTargets, LabelTargets, Targets},
    },
    composite::colors_of,
    label_blocks::{BLOCK_CORNERS, block_constant},
};
use crate::{frame_view::FrameView, options::ClassSet, tiles::DeckPiece};

pub(crate) const SHADER: Shader =
    shader!("decks": "common", "tile", "drawn_decks", "deck_labels", "coverage", "boxes", "decks");
pub(crate) const COLORS: Shader = shader!("deck colors": "common", "screen", "labelled", "road_colors", "deck_labels", "deck_colors");

/// Bytes of an instance: two places of three f32, two mitres of two, thickness, width factor as f32, class, look and landings as u32, own width, two numbers for
/// dashes, lengths of the network's part and of the deck as f32.
const INSTANCE_BYTES: u64 = 72;
/// Corners of the strip of triangles around a box, as `shaders/boxes.wgsl` counts them.
const CORNERS: Range<u32> = 0..14;

/// Draws decks.
pub(crate) struct Decks {
    /// What is bound at group 2: the depths of the ground and of decks, and the labels of roads on the ground.
    seen: BindGroupLayout,
    depths: RoadPipeline,
    roads: RoadPipeline,
    sides: RoadPipeline,
    colors_layout: BindGroupLayout,
    colors: RenderPipeline,
}

impl Decks {
    pub(crate) fn new(device: &Device, layouts: &SharedLayouts) -> Self {
        let seen = layout(device, "decks", &[0, 1, 2].map(|binding| texture(binding, UNFILTERED)));
        let pipeline = |fragment, depth, has_labels| {
            let recipe = RoadRecipe {
                shader: SHADER,
                instance_bytes: INSTANCE_BYTES,
                attributes: &vertex_attr_array![
                    0 => Float32x3, 1 => Float32x3, 2 => Float32x4, 3 => Float32x2, 4 => Uint32, 5 => Float32,
                    6 => Float32x2, 7 => Float32x2
                ],
                // As of volumes: one fragment for each pixel and box.
                cull: Some(wgpu::Face::Front),
                corners: CORNERS,
                drawn: &seen,
                entries: ["vertex", fragment],
                depth,
                has_labels,
            };
            RoadPipeline::new(device, layouts, &recipe)
        };
        let nearest = depth_test(CompareFunction::Greater, true);
        let depths = pipeline("depth_fragment", Some(nearest), false);
        let roads = pipeline("road_fragment", None, true);
        let sides = pipeline("side_fragment", None, true);
        let blocks =
            BindGroupLayoutEntry { visibility: ShaderStages::VERTEX, ..texture(2, UNFILTERED) };
        let [ground, labels, depth, beneath] =
            [0, 1, 4, 5].map(|binding| texture(binding, UNFILTERED));
        let uniform = uniform(3, None);
        let colors_layout =
            layout(device, "deck colors", &[ground, labels, blocks, uniform, depth, beneath]);
        let groups = [Some(&layouts.frame), Some(&colors_layout)];
        let constants = block_constant();
        let recipe = PipelineRecipe {
            entries: ["block_vertex", "deck_fragment"],
            blend: Some(BlendState::PREMULTIPLIED_ALPHA_BLENDING),
            ..PipelineRecipe::full_screen(COLORS, &groups, &constants)
        };
        let colors = recipe.build(device);
        Self { seen, depths, roads, sides, colors_layout, colors }
    }

    /// Draws depths and labels of the decks of some tiles, each given with its index in the list of tiles of the frame and the classes to draw.
    /// `more` draws other pieces with the same pipelines.
    pub(crate) fn draw<'a>(
        &self,
        gpu: &Gpu,
        encoder: &mut CommandEncoder,
        shared: &SharedBindings,
        tiles: &(impl Iterator<Item = (usize, &'a RoadBuffers, ClassSet)> + Clone),
        (targets, decks): (&Targets, &DeckTargets),
        more: &dyn Fn(&mut RenderPass<'_>, &BindGroup, &RoadPipeline),
    ) {
        let roads = &targets.roads.labels.view;
        let bound = |second| textures(gpu, &self.seen, &[&targets.depth.view, second, roads]);
        {
            let ground_alone: BindGroup = bound(&targets.depth.view);
            let depth = Some(&decks.depth.view);
            let mut pass = begin(encoder, "deck depths", &[], depth, LoadOp::Clear(()));
            self.depths.draw(&mut pass, shared, &ground_alone, tiles.clone());
            more(&mut pass, &ground_alone, &self.depths);
        }
        let both = bound(&decks.depth.view);
        let labels = [&decks.labels.labels.view];
        let mut pass = begin(encoder, "deck labels", &labels, None, LoadOp::Clear(()));
        for pipeline in [&self.roads, &self.sides] {
            pipeline.draw(&mut pass, shared, &both, tiles.clone());
            more(&mut pass, &both, pipeline);
        }
    }

    /// Draws the colours of decks over the samples of the picture.
    pub(crate) fn draw_colors(
        &self,
        gpu: &Gpu,
        pass: &mut RenderPass<'_>,
        shared: &SharedBindings,
        view: &FrameView<'_>,
        (targets, decks): (&Targets, &DeckTargets),
    ) {
        let colors = colors_of(gpu, view);
        let LabelTargets { labels, blocks } = &decks.labels;
        let [ground, labels, blocks, depth, roads] =
            [&targets.depth, labels, blocks, &decks.depth, &targets.roads.labels]
                .map(|texture| BindingResource::TextureView(&texture.view));
        let resources = [ground, labels, blocks, colors.as_entire_binding(), depth, roads];
        shared.set_frame(pass);
        pass.set_bind_group(1, &group(gpu, &self.colors_layout, &resources), &[]);
        pass.set_pipeline(&self.colors);
        pass.draw(0..BLOCK_CORNERS * targets.block_count(), 0..1);
    }
}

impl RoadInstance for DeckPiece {
    type Words = [u32; INSTANCE_BYTES as usize / 4];

    fn words(&self) -> Self::Words {
        let [[a, b, c], [d, e, f]] =
            [self.start_in_tile, self.end_in_tile].map(|at| at.map(f32::to_bits));
        let [[g, h], [i, j]] = self.mitres.map(|mitre| mitre.map(f32::to_bits));
        let [slab, width] = [self.slab_m, self.width_factor].map(f32::to_bits);
        let [start, end] = self.lands.map(u32::from);
        let is_ribbon = u32::from(self.slab_m <= 0.0);
        let flags = self.look.number() << 4 | start << 7 | end << 8 | is_ribbon << 9;
        let class = u32::from(self.class.number()) | flags;
        let own_width = own_width_value(self.own_width).to_bits();
        let [dash_start, dash_rate] = self.dash.numbers().map(f32::to_bits);
        let [part, deck] = [self.part_m, self.deck_m].map(f32::to_bits);
        [
            a, b, c, d, e, f, g, h, i, j, slab, width, class, own_width, dash_start, dash_rate,
            part, deck,
        ]
    }
}
