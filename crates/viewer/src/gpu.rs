//! Drawing on the GPU: device, targets, passes, buffers of tiles.
//!
//! ```text
//!  terrain pass ──► ground colour, depth, owner ──┬────────────► composite pass ──► samples ──► average ──► picture
//!                                                 ▼                   ▲
//!                                     roads pass ──► road labels ─────┤
//!                                                         ▼           │
//!                                                    road blocks ─────┘
//! ```
//!
//! Decks of bridges are drawn after the roads and use only the terrain's depth: first into a depth
//! target of their own, then into label targets of their own. The composite draws their colours
//! last, over ground and roads.
//!
//! If there are areas, an areas pass between terrain and roads paints them over the ground's
//! colour; depth and owner tell where, and a stencil counts.
//!
//! # Labels
//!
//! The label of a sample is the class of the road that it shows, and the band of the road
//! (`labels.rs`). More important roads have larger labels, and so have inner bands. Labels of
//! tunnels are below all others: every road above the ground hides tunnels. There are two reasons
//! for labels instead of colours: the composite pass can find the edges between classes, and tests
//! can compare the class of every sample with a reference.
//!
//! The paper draws roads without blending, one class after another over all tiles, the least
//! important class first. Here the target keeps the largest label, by blending with *max*. A label
//! is a whole number of steps of the 8-bit format, so blending does not round it. The result is the
//! same picture in any order of drawing, with one draw call per tile instead of one per tile and
//! class.
//!
//! # Samples
//!
//! Edges are antialiased by supersampling: everything is drawn at two to four times the picture's
//! size and averaged at the end. The alternative is coverage, computed from the distance to the
//! road's edge. It would be much cheaper. But with coverage each road has only a share of a pixel,
//! and where several roads meet in a pixel, their shares would have to be blended with each other
//! and with the ground, in order of class. With supersampling each sample shows exactly one class,
//! so a reference computed in f64 can check each sample exactly. Outlines, crests, borders of tiles
//! and the ground itself are antialiased by the same rule.
//!
//! With n samples per side, the passes over pixels take n² times as long, and the work for geometry
//! stays the same. The targets of a frame of 1600 × 1200 pixels with 2 × 2 samples take 131 MB, and
//! 38 MB more with bridges.
//!
//! # Blocks
//!
//! The composite reads at least nine samples of the labels to find the edge of a road. Most of a
//! picture has no road. So a small pass first divides the picture into blocks of 16 × 16 samples.
//! For each block it finds the largest label in the block and around it, as far as an outline may
//! reach. The composite then draws ground and sky everywhere. Over them it draws the blocks that
//! have a label, with roads and edges.
//!
//! # Owners
//!
//! The owner of a sample is the tile whose ground it shows. Shadow volumes (SV) paint the ground of
//! their own tile only. This is enough, because each tile has all roads that are near enough to
//! reach its ground. The stencil buffer could mark tiles, too. But it can distinguish only 255
//! tiles, and a pass cannot write the stencil of a texture whose depth it reads. Comparing the
//! owner's number takes one texture read.
//!
//! `drawables.rs` describes how to add a new kind of drawable.

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
mod point_buffers;
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
