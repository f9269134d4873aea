//! A window on a package: what moves the camera, what is shown beside the map.
//!
//! ```text
//!  system ──► platform ──► app ── inputs ──► corniche-live: camera, tiles ──► canvas ──► surface
//!                           ▲
//!                           └───────── panel, overlay ◄── content
//! ```
//!
//! [`run`] opens the window and returns when it is closed; [`watch`] opens one on pictures that come from elsewhere.
//! `platform` is the one module that knows the window system, threads and files; `canvas` is all that lies on the graphics
//! card; `app` is the rest: it knows neither a window nor a clock, and it loads tiles and saves files through two small
//! traits that `platform` implements. Nothing is drawn unless something moves, loads or is touched.
//!
//! This crate never reads elevation files or extracts and never computes geometry; pictures of the map are
//! `corniche-viewer`'s.

mod app;
mod canvas;
mod command;
mod drawing;
mod error;
mod formatting;
mod frame_times;
mod map_pictures;
mod notices;
mod outcome;
mod overlay;
mod panel;
mod platform;
mod save_files;
mod settings;
mod shots;
mod trace;
mod window_content;
mod window_request;

pub use corniche_live::controls::Inertia;
pub use error::{NotSaved, WindowError};
pub use outcome::{Closed, End};
pub use platform::{Watched, run, watch};
pub use window_request::{
    BeginTrace, ClockS, CommandOf, DrawnLine, NamedStyle, Reload, SaveDrawing, ShownView,
    Visibility, WindowRequest,
};
