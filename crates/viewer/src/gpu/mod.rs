//! Everything that talks to the graphics card: device, targets, passes, buffers of tiles.
//!
//! ```text
//!  terrain pass ──► ground colour, depth, owner ──┬────────────► composite pass ──► samples ──► average ──► picture
//!                                                 ▼                   ▲
//!                                     roads pass ──► road labels ─────┤
//!                                                         ▼           │
//!                                                    road blocks ─────┘
//! ```
//!
//! A label is 0 without a road, else `2 · (9 − class)`, plus 1 on a centre line: larger is more important.
//! Labels instead of colours let the composite pass find edges between classes, and let tests compare every
//! pixel's class with a reference.
//!
//! The paper draws roads without blending, least important class first across all tiles. Here the target keeps the
//! largest label (blending with *max*, which is exact for the whole steps of an 8-bit format). That is the same picture by
//! definition, in any order, with one draw per tile instead of one per tile, class and band.
//!
//! Edges are smoothed by samples: everything is drawn at two to four times the picture's size and averaged at the end.
//! Coverage computed from the distance to the road's edge would cost a fraction of that. But coverage is a share, and the
//! shares of several roads in one pixel must be blended in order of class, with the ground beneath. A label says which
//! single class a sample is. So an f64 reference can check each sample exactly, and outlines, crests, borders of tiles and
//! the ground itself are smoothed by the same rule. With n samples on a side the passes over pixels cost
//! n² times as much (a frame of 1600 × 1200 with 2 × 2 samples holds 131 MB of targets); geometry costs the same.
//!
//! The composite reads nine pixels or more to find the edge of a road, and most of a picture has no road. So a small pass
//! finds, for each block of 16 × 16 samples, the largest label in it and within the outline's reach around it; the
//! composite draws ground and sky everywhere and, over that, only the blocks with a label with their roads and edges.
//!
//! The owner of a pixel is the tile whose ground it shows. Volumes (SV) paint the ground of their own tile only;
//! each tile has all roads that are near enough. If tiles were marked in the stencil buffer instead, there could be only
//! 255 of them, and a pass cannot write the stencil of a texture whose depth it reads. Comparing a number costs one texture
//! read.
//!
//! How a new kind of thing is drawn is described in `drawables/mod.rs`.

mod adapter;
mod bindings;
mod device;
mod drawables;
mod error;
mod formats;
pub(crate) mod inspection;
mod passes;
mod picture;
mod pipeline;
mod plane;
mod read_back;
mod renderer;
mod road_instances;
mod shared_bindings;
mod targets;
mod tile_buffers;
mod timings;
mod uniforms;

pub use self::{
    device::Gpu,
    drawables::difference::{DIFFERENCE_COLORS, DifferenceColors},
    error::{GpuError, ReadBackError},
    picture::{MAX_SAMPLES_PER_SIDE, Picture},
    read_back::ReadBack,
    renderer::Renderer,
    targets::Targets,
    tile_buffers::{DrawTile, TileBuffers, tile_bytes},
    timings::{PassTimer, PassTimes},
};
pub use crate::frame_view::{FrameView, Wireframe};
