//! Everything that talks to the graphics card: device, targets, passes, buffers of tiles.
//!
//! ```text
//!  terrain pass ──► ground colour, depth, owner ──┬────────────► composite pass ──► picture
//!                                                 ▼                   ▲
//!                                     roads pass ──► road labels ─────┘
//! ```
//!
//! A label is 0 without a road, else `2 · (9 − class)`, plus 1 on a centre line: larger is more important.
//! Labels instead of colours let the composite pass find edges between classes, and let tests compare every
//! pixel's class with a reference.
//!
//! The owner of a pixel is the tile whose ground it shows. Volumes (SV) paint the ground of their own tile only;
//! each tile has all roads near enough. Marking tiles in the stencil buffer instead would allow 255 of them, and
//! a pass cannot write the stencil of a texture whose depth it reads; comparing a number costs one texture read.

mod bindings;
mod device;
mod passes;
mod picture;
mod renderer;
mod roads_pass;
mod screen_passes;
mod targets;
mod terrain_pass;
mod tile_buffers;
mod tile_bytes;
mod timings;
mod uniforms;

pub use self::{
    device::{Gpu, GpuError},
    picture::{MAX_SAMPLES_PER_SIDE, Picture, ReadBackError},
    renderer::{DrawTile, FrameView, Renderer, Wireframe},
    screen_passes::{DIFFERENCE_COLORS, DifferenceColors},
    targets::{Owner, Targets, label_class},
    tile_buffers::TileBuffers,
    tile_bytes::tile_bytes,
    timings::{PassTimer, PassTimes},
};
