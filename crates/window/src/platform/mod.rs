//! What the system gives: event loop, surface, loss of either, threads that load tiles, a folder for files. Nothing else in
//! this crate knows `winit`, a thread, a clock or a file.
//!
//! A browser would have a module of its own in this one's place: `run` on the event loop of a page, a `TileLoader` on its
//! fetches (`PackageTiles` and `Gpu::request` wait for nothing), a `SaveFiles` on its downloads. Elsewhere it would still
//! lack two things: `ShownPackage` and `CameraRequest::camera` wait for the first tiles before there is a frame; and
//! `App::end` waits for pictures that are under way.

mod event_loop;
mod files;
mod inputs;
mod loader;
mod open_window;
mod screen;
mod shell;
mod watch;

#[cfg(test)]
pub(crate) use self::{files::FileWriter, loader::LoaderThreads};
pub use self::{
    shell::run,
    watch::{Watched, watch},
};
