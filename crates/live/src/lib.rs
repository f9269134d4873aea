//! An interactive map, independent of window, page and clock.
//!
//! ```text
//!  inputs ──► controls ──► camera ──► tiles ──► MapCanvas: images on the GPU
//!                 ▲                     │
//!                 └── ground, heights ──┘◄── TileLoader: threads, or the workers of a page
//! ```
//!
//! The window and the page in a browser are two front ends of one [`Session`], which holds the
//! state of the map and executes the user's commands. [`controls`] move its camera. [`Tiles`]
//! chooses which tiles are loaded, kept and drawn, and provides the ground under the cursor. A
//! [`MapCanvas`] holds the map's data on the GPU. Times are arguments.
//!
//! This crate draws only through `corniche-viewer`, never opens a file, and knows neither window
//! system nor browser.

mod byte_ranges;
mod camera_control;
mod clicks;
mod commands;
pub mod controls;
mod desk;
mod drawing;
mod first_tiles;
mod flights;
pub mod formatting;
mod frame_pace;
mod ground_probe;
#[cfg(not(target_arch = "wasm32"))]
mod loader_threads;
mod map_canvas;
mod notices;
mod picked_road;
#[cfg(test)]
#[path = "polled_loader_tests.rs"]
mod polled_loader;
mod session;
mod session_json;
mod settings;
mod settings_json;
mod shown_view;
mod style_list;
mod tiles;
mod trace;
mod view_json;
mod views;

#[cfg(not(target_arch = "wasm32"))]
pub use loader_threads::LoaderThreads;
pub use {
    byte_ranges::{RangeCache, merged_ranges},
    camera_control::CameraControl,
    commands::{DrawingCommand, KEY_HELP, MapCommand, Shot},
    desk::{Errand, MapDesk},
    drawing::{ClockS, DrawingContent, DrawingHandle, DrawnLine, LineDrawing, SaveDrawing},
    first_tiles::{FirstLook, KnownTiles, foreseen},
    flights::Flights,
    frame_pace::{FramePace, FrameTimes, Redraw},
    ground_probe::{GroundPoint, GroundProbe},
    map_canvas::{MapCanvas, MapScene, PixelReading, SceneCounts},
    notices::{NotSaved, Notice, Notices},
    picked_road::{PickPlace, PickedRoad},
    session::{Session, SessionStart, SessionStep},
    session_json::FrameRest,
    settings::{Compare, MapSettings, range},
    settings_json::{SettingChanges, StoredSettings},
    shown_view::{CommandOf, ShownView},
    style_list::{NamedStyle, Reload, StyleList},
    tiles::{Loaded, ShownGround, TileLoader, Tiles},
    trace::{Trace, TraceLine},
    view_json::ViewRecord,
    views::{MAX_PITCH_DEG, first_view},
};
