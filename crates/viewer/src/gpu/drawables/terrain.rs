//! The ground of tiles: its triangles, its skirts, the walls at its edges and, optionally, a
//! wireframe.

use glam::DVec3;
use wgpu::{
    BindGroupLayout, ColorWrites, CompareFunction, Device, PrimitiveTopology, RenderPass,
    RenderPipeline,
};

use super::super::{
    bindings::{block, layout, uniform},
    formats::{COLOR, OWNER},
    ground_buffers::{GROUND_VERTICES, GroundBuffers},
    pipeline::{PipelineRecipe, Shader, depth_test, shader},
    shared_bindings::{DrawnFrame, SharedLayouts},
    tile_textures::{self, TileTextures},
    uniforms::{color, row},
};
use corniche_styles::{Light, MOST_TINT_STOPS, Style};

use crate::frame_view::FrameView;

pub(crate) const SHADER: Shader =
    shader!("terrain": "common", "tile", "ground_look", "relief", "photo", "terrain");

/// The angle by which the direction of the second light is turned, clockwise.
const SECOND_LIGHT_DEG: f64 = -60.0;

/// The ground of a tile to draw.
pub(crate) struct GroundOfTile<'a> {
    /// The index of the tile in the list of tiles of the frame.
    pub(crate) tile: usize,
    pub(crate) ground: &'a GroundBuffers,
    pub(crate) textures: &'a TileTextures,
}

/// Draws the ground of tiles.
pub(crate) struct TerrainDrawable {
    layout: BindGroupLayout,
    surface: RenderPipeline,
    skirts: RenderPipeline,
    walls: RenderPipeline,
    wires: RenderPipeline,
}

impl TerrainDrawable {
    pub(crate) fn new(device: &Device, layouts: &SharedLayouts) -> Self {
        let layout = layout(device, "ground colors", &[uniform(0, None)]);
        let textures = tile_textures::layout_of(device);
        let groups = [Some(&layouts.frame), Some(&layouts.tile), Some(&layout), Some(&textures)];
        let ground = |constants| PipelineRecipe {
            buffer: Some(GROUND_VERTICES),
            // From below the ground its underside is visible.
            cull: None,
            depth: Some(depth_test(CompareFunction::Greater, true)),
            targets: &[(COLOR, ColorWrites::ALL), (OWNER, ColorWrites::ALL)],
            ..PipelineRecipe::new(SHADER, &groups, constants)
        };
        let wires = PipelineRecipe {
            entries: ["vertex", "wire_fragment"],
            topology: PrimitiveTopology::LineList,
            depth: Some(depth_test(CompareFunction::GreaterEqual, false)),
            // Alpha and owner still mark the ground.
            targets: &[(COLOR, ColorWrites::COLOR), (OWNER, ColorWrites::empty())],
            ..ground(&[("PULL_PX", 2.0)])
        };
        let surface = ground(&[("SKIRT", 0.0)]).build(device);
        let skirts = ground(&[("SKIRT", 1.0)]).build(device);
        let walls = PipelineRecipe {
            entries: ["vertex", "wall_fragment"],
            ..ground(&[("SKIRT", 2.0), ("PULL_PX", -4.0)])
        };
        let [walls, wires] = [walls, wires].map(|recipe| recipe.build(device));
        Self { layout, surface, skirts, walls, wires }
    }

    /// Draws the ground of some tiles into the targets of the ground. Each tile is given with its
    /// index in the list of tiles of the frame.
    pub(crate) fn draw(
        &self,
        DrawnFrame { gpu, shared, view, .. }: DrawnFrame<'_>,
        pass: &mut RenderPass<'_>,
        tiles: &[GroundOfTile<'_>],
    ) {
        let colors = block(gpu, "ground colors", &self.layout, &rows(view));
        shared.set_frame(pass);
        pass.set_bind_group(2, &colors, &[]);
        let mut draw = |pipeline: &RenderPipeline, draw: &dyn Fn(&GroundBuffers, &mut _)| {
            pass.set_pipeline(pipeline);
            for GroundOfTile { tile, ground, textures } in tiles {
                shared.set_tile(pass, *tile);
                textures.set(pass);
                draw(ground, pass);
            }
        };
        draw(&self.surface, &|ground, pass| ground.draw_part(pass, &ground.surface));
        draw(&self.skirts, &|ground, pass| ground.draw_part(pass, &ground.skirts));
        if view.wall_m > 0.0 {
            draw(&self.walls, &|ground, pass| ground.draw_part(pass, &ground.walls));
        }
        if view.is_wireframe {
            draw(&self.wires, &|ground, pass| ground.draw_edges(gpu, pass));
        }
    }
}

/// The block `struct GroundColors` of `shaders/ground_look.wgsl`.
pub(crate) fn rows(view: &FrameView<'_>) -> Vec<[f32; 4]> {
    let Style { light, haze, water, wall, tint, photo, .. } = view.style;
    let [lowest_m, highest_m] = view.height_range_m;
    let stops = tint.stops_m(view.height_range_m, view.latitude_deg);
    let last = stops.last().copied().unwrap_or_default();
    let mut rows = vec![
        row(towards_light(light, 0.0).extend(f64::from(light.hillshade))),
        row(towards_light(light, SECOND_LIGHT_DEG).extend(f64::from(light.sky))),
        [
            lowest_m as f32,
            (1.0 / (highest_m - lowest_m).max(1.0)) as f32,
            light.gentle,
            stops.len() as f32,
        ],
        color(*haze, light.valley_haze),
        color(light.shadow, (1.0 / view.camera.focus_m) as f32),
        color(light.sunlit, (view.wall_m * view.vertical_scale()) as f32),
        color(*water, *photo),
        color(*wall, view.blend_px() as f32),
    ];
    let stops = stops.into_iter().chain(std::iter::repeat(last)).take(MOST_TINT_STOPS);
    rows.extend(stops.map(|(height_m, rgb)| color(rgb, height_m)));
    rows
}

/// Unit vector towards the light in world space, turned by an angle.
fn towards_light(light: &Light, turned_deg: f64) -> DVec3 {
    let [(east, north), (up, along)] = [light.azimuth_deg + turned_deg, light.altitude_deg]
        .map(|deg| libm::sincos(deg.to_radians()));
    DVec3::new(east * along, north * along, up)
}
