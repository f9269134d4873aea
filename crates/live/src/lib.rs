//! A map that a person moves, without a window, a page or a clock.
//!
//! ```text
//!  inputs ──► controls ──► camera ──► tiles ──► MapCanvas: pictures on the graphics card
//!                 ▲                     │
//!                 └── ground, heights ──┘◄── TileLoader: threads, or the workers of a page
//! ```
//!
//! The window and the page in a browser are two faces of one [`Session`]: it has the state of the
//! map and does what people ask of it. [`controls`] move its camera, [`Tiles`] chooses what is
//! loaded, kept and drawn, and is the ground under the cursor; a [`MapCanvas`] is what it has on
//! the graphics card. Times are arguments.
//!
//! This crate never draws but through `corniche-viewer`, never opens a file and knows neither
//! window system nor browser.

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
    commands::{Command, DrawingCommand, KEY_HELP, Shot},
    desk::{Errand, MapDesk},
    drawing::{ClockS, Drawing, DrawingContent, DrawingHandle, DrawnLine, SaveDrawing},
    first_tiles::{FirstLook, KnownTiles, foreseen, sighted_ground},
    flights::Flights,
    frame_pace::{FramePace, FrameTimes, Redraw},
    ground_probe::{GroundPoint, GroundProbe},
    map_canvas::{Counts, MapCanvas, MapScene, PixelReading},
    notices::{NotSaved, Notice, Notices},
    picked_road::{PickPlace, PickedRoad},
    session::{Session, SessionStart, SessionStep},
    session_json::FrameRest,
    settings::{Compare, MapSettings, range},
    settings_json::{SettingChanges, SettingsRecord},
    shown_view::{CommandOf, ShownView},
    style_list::{NamedStyle, Reload, StyleList},
    tiles::{Loaded, ShownGround, TileLoader, Tiles},
    trace::{Trace, TraceLine},
    view_json::ViewRecord,
    views::{MAX_PITCH_DEG, first_view},
};
