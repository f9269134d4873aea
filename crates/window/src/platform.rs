//! The interface to the operating system: event loop, surface, the loss of either, threads that
//! load tiles. Nothing else in this crate knows `winit` or a clock.

mod event_loop;
mod first_tiles;
mod inputs;
mod open_window;
mod screen;
mod shell;
mod watch;

pub use self::{
    shell::run,
    watch::{Watched, watch},
};
