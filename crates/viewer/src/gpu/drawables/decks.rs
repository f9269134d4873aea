//! Decks of bridges: the nearest deck at each pixel, its visible part, and its colours over the
//! picture.

use std::ops::Range;

use wgpu::{
    BindGroup, BindGroupLayout, BlendState, CommandEncoder, CompareFunction, Device, Face, LoadOp,
    RenderPass, VertexAttribute, vertex_attr_array,
};

use super::{
    super::{
        Gpu,
        bindings::{UNFILTERED, layout, texture, textures},
        passes::begin,
        pipeline::{Shader, depth_test, shader},
        road_instances::{RoadInstance, RoadPipeline, RoadsOfTile, kind_bits, own_width_value},
        shared_bindings::{DrawnFrame, SharedLayouts},
        target_texture::TargetTexture,
        targets::LabelTargets,
    },
    composite::rows,
    label_colors::LabelColors,
    level_connectors::LevelConnectors,
};
use crate::tiles::DeckPiece;

pub(crate) const COLORS: Shader = shader!("deck colors": "common", "screen", "labelled", "road_colors", "deck_labels", "deck_colors");

/// Draws decks.
pub(crate) struct DeckDrawable {
    /// Bind group 2: the depths of the ground and of decks, and the labels of roads on the ground.
    seen: BindGroupLayout,
    depths: RoadPipeline,
    roads: RoadPipeline,
    sides: RoadPipeline,
    colors: LabelColors,
}

impl DeckDrawable {
    pub(crate) fn new(device: &Device, layouts: &SharedLayouts) -> Self {
        let seen = layout(device, "decks", &[0, 1, 2].map(|binding| texture(binding, UNFILTERED)));
        let pipeline = |fragment, depth| {
            RoadPipeline::new::<DeckPiece>(device, layouts, &seen, ["vertex", fragment], depth)
        };
        let nearest = depth_test(CompareFunction::Greater, true);
        let depths = pipeline("depth_fragment", Some(nearest));
        let [roads, sides] =
            ["road_fragment", "side_fragment"].map(|fragment| pipeline(fragment, None));
        let blend = Some(BlendState::PREMULTIPLIED_ALPHA_BLENDING);
        let colors = LabelColors::new(device, layouts, (COLORS, "deck_fragment"), blend, 2);
        Self { seen, depths, roads, sides, colors }
    }

    /// Draws the depths of the decks of some tiles and of their connectors. Each tile is given with
    /// its index in the list of tiles of the frame and the classes to draw. Depths of other decks
    /// are cleared or kept.
    pub(crate) fn draw_depths(
        &self,
        DrawnFrame { gpu, shared, targets, .. }: DrawnFrame<'_>,
        encoder: &mut CommandEncoder,
        (tiles, connectors): (&[RoadsOfTile<'_>], &LevelConnectors),
        others: LoadOp<()>,
    ) {
        let textures = [&targets.depth, &targets.depth, &targets.roads.labels];
        let ground_alone = self.bound(gpu, textures);
        let depth = Some(&targets.decks(gpu).depth.view);
        let mut pass = begin(encoder, "deck depths", &[], depth, others);
        self.depths.draw(&mut pass, shared, &ground_alone, tiles);
        connectors.draw(&mut pass, shared, &ground_alone, &self.depths);
    }

    /// Draws the labels of decks into `labels`, where no other deck hides them. The depths of all
    /// decks must have been drawn. `ground` are the labels of the same roads on the ground.
    pub(crate) fn draw_labels(
        &self,
        DrawnFrame { gpu, shared, targets, .. }: DrawnFrame<'_>,
        encoder: &mut CommandEncoder,
        (tiles, connectors): (&[RoadsOfTile<'_>], &LevelConnectors),
        [labels, ground]: [&LabelTargets; 2],
    ) {
        let both = self.bound(gpu, [&targets.depth, &targets.decks(gpu).depth, &ground.labels]);
        let labels = [&labels.labels.view];
        let mut pass = begin(encoder, "deck labels", &labels, None, LoadOp::Clear(()));
        for pipeline in [&self.roads, &self.sides] {
            pipeline.draw(&mut pass, shared, &both, tiles);
            connectors.draw(&mut pass, shared, &both, pipeline);
        }
    }

    fn bound(&self, gpu: &Gpu, seen: [&TargetTexture; 3]) -> BindGroup {
        textures(gpu, &self.seen, &seen.map(|texture| &texture.view))
    }

    /// Draws the colours of decks over the samples of the picture, from their labels and those of
    /// the same roads on the ground. `are_lines`: the frame has lines in place of roads.
    pub(crate) fn draw_colors(
        &self,
        frame: DrawnFrame<'_>,
        pass: &mut RenderPass<'_>,
        [labels, ground]: [&LabelTargets; 2],
        are_lines: bool,
    ) {
        let DrawnFrame { gpu, view, targets, .. } = frame;
        let mut rows = rows(view);
        if let Some([.., of_slabs]) = rows.last_mut() {
            *of_slabs = if are_lines { 1.0 } else { 0.0 };
        }
        let more = [&targets.decks(gpu).depth, &ground.labels];
        self.colors.bind(frame, pass, &rows, labels, &more);
        self.colors.draw(pass, targets);
    }
}

impl RoadInstance for DeckPiece {
    /// Two positions of three f32, two mitres of two, thickness, width factor as f32, class, look
    /// and landings as u32, own width, two numbers for dashes, lengths of the network's part and of
    /// the deck as f32.
    type Words = [u32; 18];

    const SHADER: Shader = shader!("decks": "common", "tile", "drawn_decks", "deck_labels", "coverage", "boxes", "decks");
    const ATTRIBUTES: &[VertexAttribute] = &vertex_attr_array![
        0 => Float32x3, 1 => Float32x3, 2 => Float32x4, 3 => Float32x2, 4 => Uint32, 5 => Float32,
        6 => Float32x2, 7 => Float32x2
    ];
    /// The corners of the triangle strip around a box, in the order of `shaders/boxes.wgsl`.
    const CORNERS: Range<u32> = 0..14;
    /// One fragment per pixel and box.
    const CULL: Option<Face> = Some(Face::Front);

    fn words(&self) -> Self::Words {
        let [[a, b, c], [d, e, f]] =
            [self.start_in_tile, self.end_in_tile].map(|at| at.map(f32::to_bits));
        let [[g, h], [i, j]] = self.mitres.map(|mitre| mitre.map(f32::to_bits));
        let [slab, width] = [self.slab_m, self.width_factor].map(f32::to_bits);
        let is_ribbon = u32::from(self.slab_m <= 0.0);
        let class = kind_bits(self.kind, self.lands) | is_ribbon << 9;
        let own_width = own_width_value(self.kind.own_width).to_bits();
        let [dash_start, dash_rate] = self.dash.0.map(f32::to_bits);
        let [part, deck] = [self.part_m, self.deck_m].map(f32::to_bits);
        [
            a, b, c, d, e, f, g, h, i, j, slab, width, class, own_width, dash_start, dash_rate,
            part, deck,
        ]
    }
}
