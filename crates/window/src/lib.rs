//! A window on a package: what moves the camera, what is shown beside the map.
//!
//! ```text
//!  system ──► platform ──► app ── inputs ──► Session of corniche-live ──► canvas ──► surface
//!                           ▲
//!                           └───────── panel, overlay ◄── content
//! ```
//!
//! [`run`] opens the window and returns when it is closed; [`watch`] opens one on pictures that
//! come from elsewhere. `platform` is the one module that knows the window system; `canvas` is all
//! that lies on the graphics card, `files` writes. `app` is a session of `corniche-live` and what
//! is shown beside its map: it knows neither a window nor a clock. Nothing is drawn unless
//! something moves, loads or is touched.
//!
//! This crate never reads elevation files or extracts and never computes geometry; pictures of the map are
//! `corniche-viewer`'s.

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
pub use error::{Closed, End, WindowError};
pub use platform::{Watched, run, watch};
pub use window_request::{BeginTrace, WindowRequest};
