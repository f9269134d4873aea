//! What can be drawn, one file for each kind of thing, as in `re_renderer/src/renderer/` of rerun.
//!
//! A drawable knows how to draw one kind of thing and is never changed once it is made. Its file has all that belongs to
//! that kind:
//!
//! - its shader's text (`SHADER`, joined from files of `shaders/`),
//! - its own bind group layouts and its pipelines (`new`),
//! - the layout of its vertices or instances, and the buffers that a tile or a frame has of them,
//! - how it is drawn (`draw`).
//!
//! It uses the leaf modules of `gpu` (`pipeline`, `bindings`, `shared_bindings`, `passes`, `formats`), and never the renderer
//! or another drawable; [`level_connectors`] alone hands its volumes to [`sv_roads`].
//!
//! # How a drawable is added
//!
//! 1. Write the shader in `shaders/`. Declarations that it shares with others go into a file that several shaders join.
//! 2. Write `drawables/NAME.rs` with the four parts above, and list its `SHADER` in `shader_tests.rs`: it is then validated
//!    without a GPU.
//! 3. If tiles carry its data: add its buffers to `TileBuffers`, and its bytes to `tile_bytes`.
//! 4. If it draws into a texture of its own: add that to `Targets`, and its format to `formats`.
//! 5. Add it to `Renderer`: a field, a line in `Renderer::new`, and a call in the pass in which it is drawn. A pass of its
//!    own is counted to one of the three times that `timings` measures.
//! 6. If users choose it or how it looks: add that to `RoadOptions` or to a struct beside it, and to `Style`; from there to
//!    the rows in `uniforms`.

pub(crate) mod average;
pub(crate) mod composite;
pub(crate) mod difference;
pub(crate) mod geo_roads;
pub(crate) mod level_connectors;
pub(crate) mod sv_roads;
pub(crate) mod terrain;

#[cfg(test)]
#[path = "shader_tests.rs"]
mod tests;
