//! A map in a web page, drawn by the same renderer as `render` and `view`.
//!
//! ```text
//!  page (JavaScript) ── pointers, keys, settings ──► MapView ──► corniche-live, corniche-viewer ──► canvas
//!                                                      │  ▲
//!                                      ranges (fetch) ─┘  └─ decoded tiles ◄── workers: the same module, `work`
//! ```
//!
//! `view::MapView` is a map on a canvas. It draws when the page calls `frame`, and requests frames
//! through the page's `Host`. Bytes come from range requests (`source`). The page's workers decode
//! tiles (`worker`); each is an instance of this module, and no memory is shared, so that any
//! static host will do. Failures are reported as a `problem::Problem`: a kind for programs, a
//! message and advice for people.
//!
//! This crate never computes geometry, and has no controls of its own apart from the calls of the
//! page: the map is a session of `corniche-live`.

#[cfg(any(test, target_arch = "wasm32"))]
mod tables;

#[cfg(target_arch = "wasm32")]
mod canvas;
#[cfg(target_arch = "wasm32")]
pub mod decoders;
#[cfg(target_arch = "wasm32")]
mod fetch;
#[cfg(target_arch = "wasm32")]
pub mod host;
#[cfg(target_arch = "wasm32")]
mod loader;
#[cfg(target_arch = "wasm32")]
mod map;
#[cfg(target_arch = "wasm32")]
mod open;
#[cfg(target_arch = "wasm32")]
mod problem;
#[cfg(target_arch = "wasm32")]
mod source;
#[cfg(target_arch = "wasm32")]
pub mod view;
#[cfg(target_arch = "wasm32")]
pub mod worker;

/// Called when the module is loaded, in the page and in each worker.
#[cfg(target_arch = "wasm32")]
#[wasm_bindgen::prelude::wasm_bindgen(start)]
pub fn start() {
    console_error_panic_hook::set_once();
}
