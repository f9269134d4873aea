//! Draws packages: tiles are chosen, loaded and rendered to pixels.
//!
//! ```text
//!  package ──► tiles ──► lod::select ──► scene ──► gpu: terrain, areas, roads, lines, points ──► picture
//!                 ▲            │
//!                 └─ requests ─┘
//! ```
//!
//! [`render`] draws one picture of a package without a window. Its parts can be used separately:
//! [`camera`] and [`lod`] are values and pure functions; [`tiles`] decodes; [`gpu`] draws given
//! tiles. [`Replay`] draws a [`flight`], frame by frame; [`stream`] chooses which tiles are loaded
//! and kept.
//!
//! The crate also builds for WebAssembly, without the parts that wait for files or devices:
//! [`render`], [`Replay`], [`tiles::PackageSource`] and [`gpu::Gpu::new`]. In a browser, where no
//! thread may wait, use [`tiles::PackageTiles`], [`gpu::Gpu::request`] and, for pixels,
//! [`gpu::ReadBack`] instead.
//!
//! This crate never depends on `pipeline`, `dem` or `osm`: all its data comes from the package. It
//! never writes a file.

#[cfg(feature = "annotations")]
mod annotations;
pub mod camera;
mod class_scale;
#[cfg(all(feature = "annotations", not(target_arch = "wasm32")))]
mod draw_error;
pub mod eye_height;
pub mod flight;
mod frame_view;
pub mod gpu;
mod layer_class;
mod layer_legend;
mod layer_view;
mod layers;
mod line_places;
pub mod lod;
mod lon_lat;
mod options;
pub mod pick;
#[cfg(all(feature = "annotations", not(target_arch = "wasm32")))]
mod picture_legend;
#[cfg(all(feature = "annotations", not(target_arch = "wasm32")))]
mod picture_options;
pub mod range;
#[cfg(all(feature = "annotations", not(target_arch = "wasm32")))]
mod render;
#[cfg(all(feature = "annotations", not(target_arch = "wasm32")))]
mod replay;
mod scene;
pub mod stream;
pub mod tiles;
mod viewpoint;

/// Items that only tests use.
#[doc(hidden)]
pub mod for_tests {
    pub use crate::{
        gpu::{
            inspection::TileOwner,
            labels::{class_of, is_service, is_tunnel},
        },
        scene::{capped_ways, draw_list, may_be_clamped, settle},
        tiles::{
            plan_scale::PlanScale,
            roads::{BadRoads, GroundLine, PlanLine},
        },
    };
}

#[cfg(feature = "annotations")]
pub use annotations::{
    Legend, LegendEdge, LegendHeights, LegendRoad, LegendRow, LegendSample, OccupiedMargins,
    TitleFlaws, WrittenTitle, bar_length, bar_length_m, draw_attribution, draw_legend, draw_title,
    grouped,
};
pub use class_scale::LevelScales;
#[cfg(all(feature = "annotations", not(target_arch = "wasm32")))]
pub use draw_error::DrawError;
pub use frame_view::FrameView;
pub use layer_class::LayerClass;
pub use layer_legend::{LayerLegend, LayerRow};
pub use layers::{PackageLooks, ShownLayers, UnknownLayer};
pub use lon_lat::{LonLatError, parse_lon_lat};
pub use options::{
    CapTest, Caps, ClassSet, Mapping, Quads, RoadMethod, RoadOptions, RoadOutline, WidthGrowth,
};
#[cfg(all(feature = "annotations", not(target_arch = "wasm32")))]
pub use picture_legend::LegendRequest;
#[cfg(all(feature = "annotations", not(target_arch = "wasm32")))]
pub use picture_options::PictureOptions;
pub use range::OutOfRange;
#[cfg(all(feature = "annotations", not(target_arch = "wasm32")))]
pub use render::{RenderReport, RenderRequest, Rendered, render};
#[cfg(all(feature = "annotations", not(target_arch = "wasm32")))]
pub use replay::{Detail, FrameRecord, Lifted, Replay, ReplayOptions, default_flight};
pub use viewpoint::{CameraRequest, SightedGround, ViewpointOffGround};
