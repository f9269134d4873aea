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
//! Decks of bridges are drawn after the roads, from the terrain's depth alone: into a depth of their own, then into labels of their own. The composite
//! draws their colours last, over ground and roads.
//!
//! Between the terrain and the roads, an areas pass paints areas over the ground's colour, if there are some; depth and owner
//! say where, and a stencil counts.
//!
//! # Labels
//!
//! The label of a sample says which class of road it shows, and which of its bands (`labels.rs`). More important roads have larger
//! labels, and so have inner bands. Those of tunnels are below all others: every road above the ground hides them. There are
//! labels instead of colours for two reasons. The composite pass can find the edges between classes, and tests can compare
//! the class of every sample with a reference.
//!
//! The paper draws roads without blending, one class after another over all tiles, the least important class first. Here
//! the target keeps the largest label, by blending with *max*. A label is a whole number of steps of the 8-bit format, so
//! blending does not round it. The result is the same picture, whatever the order of drawing. It needs one draw per tile
//! instead of one per tile and class.
//!
//! # Samples
//!
//! Edges are smoothed by samples: everything is drawn at two to four times the picture's size and averaged at the end.
//! Another way would be coverage, computed from the distance to the road's edge. It would cost much less. But with coverage
//! each road has only a share of a pixel. Where several roads meet in a pixel, their shares would have to be blended with
//! each other and with the ground, in order of class. With samples each sample shows exactly one class. So a reference
//! computed in f64 can check each sample exactly. Outlines, crests, borders of tiles and the ground itself are smoothed by
//! the same rule.
//!
//! With n samples on a side the passes over pixels cost n² times as much, and geometry costs the same. The targets of a
//! frame of 1600 × 1200 pixels with 2 × 2 samples take 131 MB, and 38 MB more with bridges.
//!
//! # Blocks
//!
//! The composite reads at least nine samples of the labels to find the edge of a road. Most of a picture has no road. So a
//! small pass first divides the picture into blocks of 16 × 16 samples. For each block it finds the largest label in the
//! block and around it, as far as an outline may reach. The composite then draws ground and sky everywhere. Over them it
//! draws the blocks that have a label, with roads and edges.
//!
//! # Owners
//!
//! The owner of a sample is the tile whose ground it shows. Shadow volumes (SV) paint the ground of their own tile only.
//! This is enough, because each tile has all roads that are near enough to reach its ground. The stencil buffer could mark
//! tiles too. But it can tell only 255 tiles apart, and a pass cannot write the stencil of a texture whose depth it reads.
//! Comparing the number of the owner costs one texture read.
//!
//! How a new kind of thing is drawn is described in `drawables.rs`.

mod adapter;
mod area_buffers;
mod bindings;
mod device;
mod drawables;
mod error;
mod formats;
mod ground_buffers;
pub(crate) mod inspection;
pub(crate) mod labels;
#[cfg(test)]
pub(crate) mod labels_tests;
mod passes;
mod picture;
mod pipeline;
mod read_back;
mod renderer;
mod resident_tiles;
mod road_instances;
#[cfg(all(feature = "annotations", not(target_arch = "wasm32")))]
pub(crate) mod seen;
mod shared_bindings;
mod slope_chain;
mod square_texture;
mod target_texture;
mod targets;
mod tile_buffers;
mod tile_textures;
mod timings;
mod uniforms;

pub use self::{
    device::{Gpu, backends},
    drawables::difference::{DIFFERENCE_COLORS, DifferenceColors},
    error::{GpuError, ReadBackError},
    picture::{MAX_SAMPLES_PER_SIDE, Picture},
    read_back::ReadBack,
    renderer::Renderer,
    resident_tiles::ResidentTiles,
    slope_chain::SlopeChain,
    targets::Targets,
    tile_buffers::{DrawTile, TileBuffers, tile_bytes},
    timings::{PassTimer, PassTimes},
};
