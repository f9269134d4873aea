//! What the system gives: event loop, surface, loss of either, threads that load tiles, a folder for files. Nothing else in
//! this crate knows `winit`, a thread, a clock or a file.
//!
//! A browser would have a module of its own in this one's place: `run` on the event loop of a page, a `TileLoader` on its
//! fetches (`PackageTiles` and `Gpu::request` wait for nothing), a `SaveFiles` on its downloads, and what `first_tiles` does,
//! awaiting the tiles: `app` takes a package whose tiles nothing waits for. Elsewhere it would still lack two things: the
//! height of the ground at a place is looked up by `TileStore` only, which waits for tiles; and `App::end` waits for pictures
//! that are under way.

mod event_loop;
mod files;
mod first_tiles;
mod inputs;
mod open_window;
mod screen;
mod shell;
mod watch;

#[cfg(test)]
pub(crate) use self::files::FileWriter;
pub use self::{
    shell::run,
    watch::{Watched, watch},
};
