//! Package to pixels.
//!
//! ```text
//!  package ──► tiles ──► lod::select ──► scene ──► gpu: terrain, roads, composite ──► picture
//!                 ▲            │
//!                 └─ requests ─┘
//! ```
//!
//! [`render`] makes one picture of a package without a window. Its parts are usable alone: [`camera`], [`lod`]
//! and [`style`] are values and pure functions; [`tiles`] decodes; [`gpu`] draws what it is handed.
//! [`Replay`] flies along a [`flight`], frame by frame, with [`stream`] choosing what is loaded and kept.
//!
//! It also builds for WebAssembly, without what waits for files and devices: [`render`], [`Replay`],
//! [`tiles::PackageSource`], [`gpu::Gpu::new`]. A browser takes [`tiles::PackageTiles`], [`gpu::Gpu::request`] and, for
//! pixels, [`gpu::ReadBack`]: nobody can wait for pixels there.
//!
//! This crate never depends on `pipeline`, `dem` or `osm`: it learns everything from the package. It never
//! writes a file.

mod attribution;
pub mod camera;
pub mod eye_height;
pub mod flight;
mod frame_view;
pub mod gpu;
pub mod lod;
mod options;
pub mod pick;
pub mod range;
#[cfg(not(target_arch = "wasm32"))]
mod render;
#[cfg(not(target_arch = "wasm32"))]
mod replay;
mod scene;
pub mod stream;
pub mod tiles;
mod viewpoint;

/// What no program uses, but the tests of this and of other crates.
pub mod for_tests {
    pub use crate::{
        gpu::inspection::Owner,
        scene::{SettleError, draw_list, may_be_clamped, settle},
        tiles::{
            plan_scale::PlanScale,
            roads::{BadRoad, GroundLine, PlanLine},
        },
    };
}

pub use attribution::draw_attribution;
pub use corniche_styles as style;
pub use options::{CapTest, Caps, ClassSet, Outline, RoadMethod, RoadOptions, WidthGrowth};
pub use range::OutOfRange;
#[cfg(not(target_arch = "wasm32"))]
pub use render::{RenderError, RenderReport, RenderRequest, Rendered, render};
#[cfg(not(target_arch = "wasm32"))]
pub use replay::{Detail, FrameRecord, Lifted, Replay, ReplayError, ReplayOptions, default_flight};
pub use viewpoint::{CameraRequest, OffGround, ViewpointError};
