//! Drawables: one file for each kind of thing that can be drawn, as in `re_renderer/src/renderer/`
//! of rerun.
//!
//! A drawable knows how to draw one kind of thing and is immutable after its creation. Its file
//! contains everything for that kind:
//!
//! - the text of its shader (`SHADER`, joined from files of `shaders/`),
//! - its own bind group layouts and its pipelines (`new` or `pipeline`),
//! - the uniforms that only this drawable needs (`rows`), in the order of the shader's structure,
//! - the layout of its vertices or instances, and the buffers that a tile or a frame has of them,
//! - the draw calls (`draw`).
//!
//! Terrain, roads, connectors and composite draw into a pass that the renderer began, so that
//! several drawables can share one pass. [`average`], [`difference`], [`depth_numbers`], the search
//! for blocks with roads ([`composite`]) and depths and labels of [`decks`] begin and end passes of
//! their own: each of them replaces the whole contents of its target, and no other drawable can
//! share that pass.
//!
//! A drawable may use
//!
//! - the leaf modules of `gpu`: `pipeline`, `bindings`, `shared_bindings`, `uniforms`, `passes`,
//!   `formats`, `targets`, `picture`, `ground_buffers`, `area_buffers`, `point_buffers`,
//!   `tile_textures` and `road_instances`;
//! - of the crate: `tiles`, `scene`, `options`, `frame_view` and `style`.
//!
//! It uses neither the renderer nor another drawable, with two exceptions: [`level_connectors`]
//! creates instances in the formats of [`sv_roads`] and [`decks`]; [`decks`] and [`points`] use the
//! colours of [`composite`].
//!
//! # How to add a drawable
//!
//! 1. Write the shader in `shaders/`. Put declarations that several shaders need into a file of
//!    their own, which these shaders join.
//! 2. Write `drawables/NAME.rs` with the parts above. `shader_tests.rs` finds each `shader!`
//!    automatically and validates it without a GPU. If there are new uniforms, add the structure to
//!    the test of their lengths.
//! 3. If tiles carry its data: add its buffers to `TileBuffers`, and its bytes to `tile_bytes`. If
//!    it draws the triangles of the ground: `ground_buffers` has them, with the layout of their
//!    vertices, and `pipeline::depth_test` the depth state.
//! 4. If it draws into a texture of its own: add the texture to `Targets`, and its format to
//!    `formats`.
//! 5. Add it to `Renderer`: a field, a line in `Renderer::new`, and a call in the pass in which it
//!    is drawn. Things over the map are drawn after the composite. `passes::begin` begins a pass
//!    that clears its targets or keeps their contents. A new pass counts towards one of the five
//!    times that `timings` measures.
//! 6. If users choose it or its look: add the option to `RoadOptions` or to a struct next to it,
//!    and to `Style`; from there to the drawable's `rows`, or to `uniforms` if other drawables need
//!    it, too.

pub(crate) mod areas;
pub(crate) mod average;
pub(crate) mod composite;
pub(crate) mod decks;
pub(crate) mod depth_numbers;
pub(crate) mod difference;
pub(crate) mod geo_roads;
pub(crate) mod label_blocks;
pub(crate) mod label_colors;
pub(crate) mod level_connectors;
pub(crate) mod line_layers;
pub(crate) mod points;
pub(crate) mod sv_roads;
pub(crate) mod terrain;

#[cfg(test)]
#[path = "drawables/shader_tests.rs"]
mod tests;
