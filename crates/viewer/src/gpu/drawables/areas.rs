//! Areas as stencil shadow volumes: which ground is inside is counted in the stencil, then the box around the volumes is coloured where
//! the count is not 0.
//!
//! ```text
//!  bit of the stencil   7         6 … 0
//!                       painted   how many volumes of the class that is being drawn the ground is in, modulo 128
//! ```
//!
//! Classes are drawn one after another, the topmost first. What one has painted no other paints, so colours of classes are not mixed.
//! All tiles use one stencil: a volume counts on its own tile's ground alone.

use corniche_areas::AreaClass;
use corniche_styles::AreaStyle;
use wgpu::{
    BindGroupLayout, BlendComponent, BlendFactor, BlendOperation, BlendState, BufferUsages,
    ColorWrites, CompareFunction, DepthStencilState, Device, Face, FrontFace, PrimitiveTopology,
    RenderPass, RenderPipeline, StencilFaceState, StencilOperation, StencilState,
};

use super::super::{
    Gpu,
    area_buffers::{AreaBuffers, BOXES, CORNERS, WALLS},
    bindings::{group, layout, uniform},
    formats::{COLOR, STENCIL},
    pipeline::{PipelineRecipe, Shader, shader},
    shared_bindings::{SharedBindings, SharedLayouts},
    uniforms::color,
};
use crate::frame_view::FrameView;

pub(crate) const SHADER: Shader = shader!("areas": "common", "tile", "drawn_ground", "areas");

/// The bit that says that a sample is painted.
const PAINTED: u32 = 0x80;
/// The bits that count.
const COUNT: u32 = 0x7F;

/// How the volumes of a tile are counted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Counting {
    /// The faces in front of the ground: walls and upper caps. Only where the near plane cuts off none of them. Lower caps are beneath
    /// all ground, and so behind what is seen of it.
    InFront,
    /// The faces behind the ground, all of them. Right wherever the eye is, and a third more to draw.
    Behind,
}

/// A tile whose areas are drawn, with its index in the list of tiles of the frame.
pub(crate) type AreaTile<'a> = (usize, &'a AreaBuffers, Counting);

/// Draws areas.
pub(crate) struct StencilAreas {
    layout: BindGroupLayout,
    in_front: Counters,
    behind: Counters,
    boxes: RenderPipeline,
}

/// The pipelines of one way of counting.
struct Counters {
    walls: RenderPipeline,
    tops: RenderPipeline,
    bottoms: RenderPipeline,
}

impl StencilAreas {
    pub(crate) fn new(device: &Device, layouts: &SharedLayouts) -> Self {
        let layout = layout(device, "area colors", &[uniform(0, None)]);
        let groups =
            [Some(&layouts.frame), Some(&layouts.tile), Some(&layouts.ground), Some(&layout)];
        let over = BlendComponent {
            src_factor: BlendFactor::SrcAlpha,
            dst_factor: BlendFactor::OneMinusSrcAlpha,
            operation: BlendOperation::Add,
        };
        let boxes = PipelineRecipe {
            shader: SHADER,
            entries: ["box_vertex", "box_fragment"],
            groups: &groups,
            buffer: Some(BOXES),
            topology: PrimitiveTopology::TriangleStrip,
            front_face: FrontFace::Ccw,
            cull: Some(Face::Front),
            depth: Some(stencil_of_boxes()),
            // Alpha still says that there is ground.
            targets: &[(COLOR, ColorWrites::COLOR)],
            blend: Some(BlendState { color: over, alpha: over }),
            constants: &[],
        };
        let boxes = boxes.build(device);
        let [in_front, behind] = [Counting::InFront, Counting::Behind]
            .map(|counting| Counters::new(device, &groups, counting));
        Self { layout, in_front, behind, boxes }
    }

    /// Draws the areas of some tiles over their ground: into its colours and the stencil, which is all 0 before.
    pub(crate) fn draw(
        &self,
        gpu: &Gpu,
        pass: &mut RenderPass<'_>,
        shared: &SharedBindings,
        tiles: &[AreaTile<'_>],
        view: &FrameView<'_>,
    ) {
        let rows = rows(view);
        let colors = gpu.buffer("area colors", bytemuck::cast_slice(&rows), BufferUsages::UNIFORM);
        shared.set_frame(pass);
        pass.set_bind_group(2, &shared.ground, &[]);
        pass.set_bind_group(3, &group(gpu, &self.layout, &[colors.as_entire_binding()]), &[]);
        for class in AreaStyle::TOP_FIRST {
            if view.style.area(class).is_drawn() {
                self.draw_class(pass, shared, tiles, class);
            }
        }
    }

    fn draw_class(
        &self,
        pass: &mut RenderPass<'_>,
        shared: &SharedBindings,
        tiles: &[AreaTile<'_>],
        class: AreaClass,
    ) {
        pass.set_stencil_reference(0);
        for (counting, counters) in
            [(Counting::InFront, &self.in_front), (Counting::Behind, &self.behind)]
        {
            let has_class =
                |tile: &&AreaTile<'_>| tile.1.classes.iter().any(|of| of.class == class);
            let tiles: Vec<_> =
                tiles.iter().filter(|tile| tile.2 == counting).filter(has_class).collect();
            let mut draw = |pipeline: &RenderPipeline, draw: &dyn Fn(&AreaBuffers, &mut _)| {
                pass.set_pipeline(pipeline);
                for (index, areas, _) in &tiles {
                    shared.set_tile(pass, *index);
                    draw(areas, pass);
                }
            };
            draw(&counters.walls, &|areas, pass| areas.draw_walls(pass, class));
            draw(&counters.tops, &|areas, pass| areas.draw_caps(pass, class));
            if counting == Counting::Behind {
                draw(&counters.bottoms, &|areas, pass| areas.draw_caps(pass, class));
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
        let (tops, bottoms) = ([is_fail, ("IS_TOP", 1.0)], [is_fail, ("IS_TOP", 0.0)]);
        let walls = PipelineRecipe {
            shader: SHADER,
            entries: ["wall_vertex", "wall_fragment"],
            groups,
            buffer: Some(WALLS),
            topology: PrimitiveTopology::TriangleStrip,
            front_face: FrontFace::Ccw,
            cull: None,
            depth: Some(stencil_of_faces(counting)),
            targets: &[(COLOR, ColorWrites::empty())],
            blend: None,
            constants: &[is_fail],
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
            // Triangles are counter-clockwise from above, so lower caps are so from inside.
            tops: caps(&tops, FrontFace::Ccw).build(device),
            bottoms: caps(&bottoms, FrontFace::Cw).build(device),
            walls: walls.build(device),
        }
    }
}

/// Counts faces: in front of the ground those that the eye sees from outside add one, behind it they take one away.
fn stencil_of_faces(counting: Counting) -> DepthStencilState {
    let face = |pass_op| StencilFaceState {
        // Only where no class above has painted.
        compare: CompareFunction::Equal,
        pass_op,
        fail_op: StencilOperation::Keep,
        depth_fail_op: StencilOperation::Keep,
    };
    let (more, less) =
        (face(StencilOperation::IncrementWrap), face(StencilOperation::DecrementWrap));
    let (front, back) = match counting {
        Counting::InFront => (more, less),
        Counting::Behind => (less, more),
    };
    stencil(StencilState { front, back, read_mask: PAINTED, write_mask: COUNT })
}

/// Lets through what has a count, and marks it as painted.
fn stencil_of_boxes() -> DepthStencilState {
    let face = StencilFaceState {
        compare: CompareFunction::NotEqual,
        pass_op: StencilOperation::Replace,
        fail_op: StencilOperation::Keep,
        depth_fail_op: StencilOperation::Keep,
    };
    stencil(StencilState { front: face, back: face, read_mask: COUNT, write_mask: PAINTED | COUNT })
}

fn stencil(stencil: StencilState) -> DepthStencilState {
    DepthStencilState {
        format: STENCIL,
        depth_write_enabled: None,
        depth_compare: None,
        stencil,
        bias: wgpu::DepthBiasState::default(),
    }
}

/// A slope that no ground has, where all ground is painted; tangent of the angle.
const ANY_SLOPE: f64 = 1e9;

/// The block `looks` of `shaders/areas.wgsl`.
pub(crate) fn rows(view: &FrameView<'_>) -> Vec<[f32; 4]> {
    let areas = &view.style.areas;
    let steepest = areas.iter().map(|area| {
        let slope =
            area.steepest_deg.map_or(ANY_SLOPE, |deg| libm::tan(f64::from(deg).to_radians()));
        [slope as f32, (slope * AreaStyle::STEEP_SHARE) as f32, 0.0, 0.0]
    });
    areas.iter().map(|area| color(area.color, area.opacity)).chain(steepest).collect()
}
