//! A map that a person moves, without a window, a page or a clock.
//!
//! ```text
//!  inputs ──► controls ──► camera ──► tiles ──► changes for the graphics card
//!                 ▲                     │
//!                 └── ground, heights ──┘◄── TileLoader: threads, or the workers of a page
//! ```
//!
//! The window and the page in a browser are made of it. [`controls`] move the camera, [`Tiles`] chooses what is loaded, kept and drawn, and
//! is the ground under the cursor; [`Recorder`] records the camera's way. Times are arguments.
//!
//! This crate never draws, never opens a file and knows neither window system nor browser.

mod camera_control;
mod camera_limits;
mod clicks;
pub mod controls;
mod first_view;
mod ground_probe;
#[cfg(not(target_arch = "wasm32"))]
mod loader_threads;
mod map_scene;
#[doc(hidden)]
pub mod polled_loader;
mod recorder;
mod request_of_view;
mod tile_loader;
mod tiles;
mod typed_place;

#[cfg(not(target_arch = "wasm32"))]
pub use loader_threads::LoaderThreads;
pub use {
    camera_control::CameraControl,
    camera_limits::{MAX_PITCH_DEG, limits},
    first_view::first_view,
    ground_probe::{GroundPoint, GroundProbe},
    map_scene::MapScene,
    recorder::Recorder,
    request_of_view::{camera_request, request_of_view},
    tile_loader::{Loaded, TileLoader},
    tiles::{Changes, ShownGround, Tiles},
    typed_place::place_in_world,
};
