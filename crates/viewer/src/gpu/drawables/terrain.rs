//! The ground of tiles: its triangles, its skirts and, if asked for, the edges of its triangles.

use glam::DVec3;
use wgpu::{
    BindGroup, BindGroupLayout, BufferUsages, ColorWrites, CompareFunction, Device,
    PrimitiveTopology, RenderPass, RenderPipeline,
};

use super::super::{
    Gpu,
    bindings::{group, layout, uniform},
    formats::{COLOR, OWNER},
    ground_buffers::{GROUND_VERTICES, GroundBuffers},
    photo_texture::PhotoBindings,
    pipeline::{ENTRIES, PipelineRecipe, Shader, depth_test, shader},
    shared_bindings::{SharedBindings, SharedLayouts},
    uniforms::{color, row},
};
use corniche_styles::Style;

use crate::frame_view::{FrameView, Wireframe};

pub(crate) const SHADER: Shader = shader!("terrain": "common", "photo", "terrain");

/// Draws the ground of tiles.
pub(crate) struct Terrain {
    layout: BindGroupLayout,
    surface: RenderPipeline,
    skirts: RenderPipeline,
    wires: RenderPipeline,
    photos: PhotoBindings,
}

impl Terrain {
    pub(crate) fn new(device: &Device, layouts: &SharedLayouts) -> Self {
        let layout = layout(device, "ground colors", &[uniform(0, None)]);
        let photos = PhotoBindings::new(device);
        let groups =
            [Some(&layouts.frame), Some(&layouts.tile), Some(&layout), Some(&photos.layout)];
        let ground = |constants| PipelineRecipe {
            shader: SHADER,
            entries: ENTRIES,
            groups: &groups,
            buffer: Some(GROUND_VERTICES),
            topology: PrimitiveTopology::TriangleList,
            // From below the ground its underside is seen.
            cull: None,
            depth: Some(depth_test(CompareFunction::Greater, true)),
            targets: &[(COLOR, ColorWrites::ALL), (OWNER, ColorWrites::ALL)],
            blend: None,
            constants,
        };
        let wires = PipelineRecipe {
            entries: ["vertex", "wire_fragment"],
            topology: PrimitiveTopology::LineList,
            depth: Some(depth_test(CompareFunction::GreaterEqual, false)),
            // Alpha and owner still say that there is ground.
            targets: &[(COLOR, ColorWrites::COLOR), (OWNER, ColorWrites::empty())],
            ..ground(&[("PULL_PX", 2.0)])
        };
        let surface = ground(&[("SKIRT", 0.0)]).build(device);
        let skirts = ground(&[("SKIRT", 1.0)]).build(device);
        let wires = wires.build(device);
        Self { layout, surface, skirts, wires, photos }
    }

    /// Draws the ground of some tiles, each given with its index in the list of tiles of the frame, into the targets of the
    /// ground.
    pub(crate) fn draw(
        &self,
        gpu: &Gpu,
        pass: &mut RenderPass<'_>,
        shared: &SharedBindings,
        tiles: &[(usize, &GroundBuffers)],
        view: &FrameView<'_>,
    ) {
        let rows = rows(view);
        let colors =
            gpu.buffer("ground colors", bytemuck::cast_slice(&rows), BufferUsages::UNIFORM);
        shared.set_frame(pass);
        pass.set_bind_group(2, &group(gpu, &self.layout, &[colors.as_entire_binding()]), &[]);
        let photos: Vec<BindGroup> =
            tiles.iter().map(|(_, ground)| self.photos.group(gpu, ground.photo())).collect();
        let set_tile = |pass: &mut RenderPass<'_>, index: usize, photo: &BindGroup| {
            shared.set_tile(pass, index);
            pass.set_bind_group(3, photo, &[]);
        };
        pass.set_pipeline(&self.surface);
        for ((index, ground), photo) in tiles.iter().zip(&photos) {
            set_tile(pass, *index, photo);
            ground.draw_surface(pass);
        }
        pass.set_pipeline(&self.skirts);
        for ((index, ground), photo) in tiles.iter().zip(&photos) {
            set_tile(pass, *index, photo);
            ground.draw_skirts(pass);
        }
        if view.wireframe == Wireframe::Shown {
            pass.set_pipeline(&self.wires);
            for ((index, ground), photo) in tiles.iter().zip(&photos) {
                set_tile(pass, *index, photo);
                ground.draw_edges(gpu, pass);
            }
        }
    }
}

/// The block `struct GroundColors` of `shaders/terrain.wgsl`.
pub(crate) fn rows(view: &FrameView<'_>) -> Vec<[f32; 4]> {
    let style = view.style;
    let [lowest_m, highest_m] = view.height_range_m;
    let mut rows = vec![
        row(direction_to_light(style).extend(f64::from(style.hillshade))),
        [lowest_m as f32, (1.0 / (highest_m - lowest_m).max(1.0)) as f32, style.photo, 0.0],
    ];
    rows.extend(style.tint.iter().map(|(share, rgb)| color(*rgb, *share)));
    rows
}

/// Unit vector towards the light in world space.
fn direction_to_light(style: &Style) -> DVec3 {
    let (azimuth, altitude) =
        (style.light_azimuth_deg.to_radians(), style.light_altitude_deg.to_radians());
    DVec3::new(azimuth.sin() * altitude.cos(), azimuth.cos() * altitude.cos(), altitude.sin())
}
