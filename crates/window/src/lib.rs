//! A window that shows a package: camera controls, and a panel with settings.
//!
//! ```text
//!  system ──► platform ──► app ── inputs ──► Session of corniche-live ──► canvas ──► surface
//!                           ▲
//!                           └───────── panel, overlay ◄── content
//! ```
//!
//! [`run`] opens the window and returns when it is closed; [`watch`] opens a window for images from
//! elsewhere. Only `platform` knows the window system; `canvas` holds everything on the GPU, and
//! `files` writes files. `app` is a session of `corniche-live` with the panel and overlay: it knows
//! neither a window nor a clock. Nothing is drawn unless something moves, loads or is touched.
//!
//! This crate never reads elevation files or extracts and never computes geometry;
//! `corniche-viewer` draws the images of the map.

mod app;
mod canvas;
mod error;
mod files;
mod overlay;
mod panel;
mod platform;
mod window_content;
mod window_request;

pub use corniche_live::{
    ClockS, CommandOf, DrawnLine, MapSettings, NamedStyle, NotSaved, Reload, SaveDrawing, ShownView,
};
pub use error::{Closed, WindowEnd, WindowError};
pub use platform::{Watched, run, watch};
pub use window_request::{BeginTrace, WindowRequest};
