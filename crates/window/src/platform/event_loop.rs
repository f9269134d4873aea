//! The event loop and the window of the window library.

use std::{
    panic::{AssertUnwindSafe, catch_unwind},
    sync::Arc,
};

use winit::{
    dpi::PhysicalSize,
    event_loop::{ActiveEventLoop, EventLoop},
    window::Window,
};

use crate::WindowError;

/// The event that another thread sends to the event loop when there is something new to show.
#[derive(Debug)]
pub(crate) struct News;

/// The event loop of the program.
///
/// # Errors
/// When there is no display, or a library of the window system is missing.
pub(crate) fn new_event_loop() -> Result<EventLoop<News>, WindowError> {
    // The window library panics when a library that it loads at run time is missing.
    let built = catch_unwind(AssertUnwindSafe(|| EventLoop::with_user_event().build()));
    let no_display = |reason| WindowError::NoDisplay { reason };
    built
        .map_err(|_| no_display("a library of the window system is missing; see above".to_owned()))?
        .map_err(|error| no_display(without_source_place(&error.to_string()).to_owned()))
}

/// Opens a window for the package `name`; its inside has `size` pixels at first.
///
/// # Errors
/// When the window system cannot create one.
pub(crate) fn new_window(
    event_loop: &ActiveEventLoop,
    name: &str,
    [width, height]: [u32; 2],
) -> Result<Arc<Window>, WindowError> {
    let attributes = Window::default_attributes()
        .with_title(format!("{name} – Corniche"))
        .with_inner_size(PhysicalSize::new(width, height));
    let window = event_loop.create_window(attributes);
    window.map(Arc::new).map_err(|source| WindowError::System { source: source.into() })
}

/// A message of the window library without its prefix, if that is a file and a line of the
/// library's source.
fn without_source_place(words: &str) -> &str {
    let told = words.strip_prefix("os error at ").and_then(|told| told.split_once(".rs:"));
    told.and_then(|(_, told)| told.split_once(": ")).map_or(words, |(_, told)| told)
}

#[cfg(test)]
#[path = "event_loop_tests.rs"]
mod tests;
