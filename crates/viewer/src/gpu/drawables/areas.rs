//! Areas as stencil shadow volumes: the stencil counts which ground is inside, then the box around
//! the volumes is coloured where the count is not 0.
//!
//! ```text
//!  bit of the stencil   7         6 … 0
//!                       painted   how many volumes of the class that is being drawn the ground is in, modulo 128
//! ```
//!
//! Classes are drawn one after another, the topmost first: those of the highest layer, and the
//! first class of a layer. No class paints over another, so colours of classes are not mixed. All
//! tiles use one stencil: a volume counts only on the ground of its own tile.

use corniche_styles::AreaStyle;
use wgpu::{
    BindGroupLayout, BlendState, ColorWrites, CompareFunction, DepthStencilState, Device, Face,
    FrontFace, PrimitiveTopology, RenderPass, RenderPipeline, StencilFaceState, StencilOperation,
    StencilState,
};

use super::super::{
    area_buffers::{AreaBuffers, BOXES, CORNERS, WALLS},
    bindings::{block, layout, uniform},
    formats::{COLOR, STENCIL},
    pipeline::{PipelineRecipe, Shader, shader},
    shared_bindings::{DrawnFrame, SharedBindings, SharedLayouts},
    uniforms::color,
};
use crate::{layer_class::LayerClass, tiles::ClassVolumes};

pub(crate) const SHADER: Shader =
    shader!("areas": "common", "tile", "drawn_ground", "boxes", "areas");

/// The bit that marks a painted sample.
const PAINTED: u32 = 0x80;
/// The bits of the count.
const COUNT: u32 = 0x7F;

/// How the volumes of a tile are counted (z-pass or z-fail).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Counting {
    /// Counts the faces in front of the ground: walls and upper caps. Only if the near plane cuts
    /// off none of them. Lower caps are below all ground, and so behind the visible ground.
    InFront,
    /// Counts all faces behind the ground. Correct for any position of the eye, but draws a third
    /// more.
    Behind,
}

/// A tile whose areas are drawn, with its index in the list of tiles of the frame.
pub(crate) type AreaTile<'a> = (usize, &'a AreaBuffers, Counting);

/// Draws areas.
pub(crate) struct StencilAreas {
    layout: BindGroupLayout,
    counters: [Counters; 2],
    boxes: RenderPipeline,
}

/// The pipelines of one way of counting.
struct Counters {
    counting: Counting,
    walls: RenderPipeline,
    tops: RenderPipeline,
    bottoms: RenderPipeline,
}

impl StencilAreas {
    pub(crate) fn new(device: &Device, layouts: &SharedLayouts) -> Self {
        let layout = layout(device, "area look", &[uniform(0, None)]);
        let groups =
            [Some(&layouts.frame), Some(&layouts.tile), Some(&layouts.ground), Some(&layout)];
        let boxes = PipelineRecipe {
            entries: ["box_vertex", "box_fragment"],
            buffer: Some(BOXES),
            topology: PrimitiveTopology::TriangleStrip,
            cull: Some(Face::Front),
            depth: Some(stencil_of_boxes()),
            // Alpha still marks the ground.
            targets: &[(COLOR, ColorWrites::COLOR)],
            blend: Some(BlendState::ALPHA_BLENDING),
            ..PipelineRecipe::new(SHADER, &groups, &[])
        };
        let boxes = boxes.build(device);
        let counters = [Counting::InFront, Counting::Behind]
            .map(|counting| Counters::new(device, &groups, counting));
        Self { layout, counters, boxes }
    }

    /// Draws the areas of some tiles over their ground: into its colours and the stencil, which
    /// must be 0 everywhere.
    pub(crate) fn draw(
        &self,
        DrawnFrame { gpu, shared, view, .. }: DrawnFrame<'_>,
        pass: &mut RenderPass<'_>,
        tiles: &[AreaTile<'_>],
    ) {
        shared.set_frame(pass);
        pass.set_bind_group(2, &shared.ground, &[]);
        let classes = tiles.iter().flat_map(|tile| &tile.1.classes).map(|of| of.class);
        for class in LayerClass::topmost_first(classes) {
            if let Some(area) = view.layers.area(class) {
                let look = block(gpu, "area look", &self.layout, &rows(area));
                pass.set_bind_group(3, &look, &[]);
                self.draw_class(pass, shared, tiles, class);
            }
        }
    }

    fn draw_class(
        &self,
        pass: &mut RenderPass<'_>,
        shared: &SharedBindings,
        tiles: &[AreaTile<'_>],
        class: LayerClass,
    ) {
        pass.set_stencil_reference(0);
        for Counters { counting, walls, tops, bottoms } in &self.counters {
            let tiles = tiles.iter().filter(|tile| tile.2 == *counting);
            let tiles = tiles
                .filter_map(|(index, areas, _)| Some((*index, *areas, areas.of_class(class)?)));
            let tiles: Vec<_> = tiles.collect();
            let mut draw =
                |pipeline, draw: fn(&AreaBuffers, &mut RenderPass<'_>, &ClassVolumes)| {
                    pass.set_pipeline(pipeline);
                    for (index, areas, volumes) in &tiles {
                        shared.set_tile(pass, *index);
                        draw(areas, pass, volumes);
                    }
                };
            draw(walls, AreaBuffers::draw_walls);
            draw(tops, AreaBuffers::draw_caps);
            if *counting == Counting::Behind {
                draw(bottoms, AreaBuffers::draw_caps);
            }
        }
        pass.set_stencil_reference(PAINTED);
        pass.set_pipeline(&self.boxes);
        for (index, areas, _) in tiles {
            shared.set_tile(pass, *index);
            areas.draw_box(pass, class);
        }
    }
}

impl Counters {
    fn new(device: &Device, groups: &[Option<&BindGroupLayout>], counting: Counting) -> Self {
        let is_fail = ("IS_FAIL", f64::from(u8::from(counting == Counting::Behind)));
        let constants = [is_fail];
        let (tops, bottoms) = ([is_fail, ("IS_TOP", 1.0)], [is_fail, ("IS_TOP", 0.0)]);
        let walls = PipelineRecipe {
            entries: ["wall_vertex", "wall_fragment"],
            buffer: Some(WALLS),
            topology: PrimitiveTopology::TriangleStrip,
            depth: Some(stencil_of_faces(counting)),
            targets: &[(COLOR, ColorWrites::empty())],
            ..PipelineRecipe::new(SHADER, groups, &constants)
        };
        let caps = |constants, front_face| PipelineRecipe {
            entries: ["cap_vertex", "cap_fragment"],
            buffer: Some(CORNERS),
            topology: PrimitiveTopology::TriangleList,
            front_face,
            constants,
            ..walls.clone()
        };
        Self {
            // Triangles are counter-clockwise from above, so lower caps are counter-clockwise from
            // inside.
            tops: caps(&tops, FrontFace::Ccw).build(device),
            bottoms: caps(&bottoms, FrontFace::Cw).build(device),
            walls: walls.build(device),
            counting,
        }
    }
}

fn stencil_face(compare: CompareFunction, pass_op: StencilOperation) -> StencilFaceState {
    StencilFaceState { compare, pass_op, ..StencilFaceState::IGNORE }
}

/// Counts faces: in front of the ground, faces that the eye sees from outside add one; behind it
/// they subtract one.
fn stencil_of_faces(counting: Counting) -> DepthStencilState {
    // Only where no higher class has painted.
    let face = |pass_op| stencil_face(CompareFunction::Equal, pass_op);
    let (more, less) =
        (face(StencilOperation::IncrementWrap), face(StencilOperation::DecrementWrap));
    let (front, back) = match counting {
        Counting::InFront => (more, less),
        Counting::Behind => (less, more),
    };
    let state = StencilState { front, back, read_mask: PAINTED, write_mask: COUNT };
    DepthStencilState::stencil(STENCIL, state)
}

/// Passes samples with a count, and marks them as painted.
fn stencil_of_boxes() -> DepthStencilState {
    let face = stencil_face(CompareFunction::NotEqual, StencilOperation::Replace);
    let write_mask = PAINTED | COUNT;
    let state = StencilState { front: face, back: face, read_mask: COUNT, write_mask };
    DepthStencilState::stencil(STENCIL, state)
}

/// A slope steeper than any ground, for classes that paint all ground; tangent of the angle.
const ANY_SLOPE: f64 = 1e9;

/// The block `look` of `shaders/areas.wgsl`.
fn rows(area: AreaStyle) -> [[f32; 4]; 2] {
    let slope = area.steepest_deg.map_or(ANY_SLOPE, |deg| libm::tan(f64::from(deg).to_radians()));
    let steepest = [slope as f32, (slope * AreaStyle::STEEP_SHARE) as f32, 0.0, 0.0];
    [color(area.color, area.opacity), steepest]
}
