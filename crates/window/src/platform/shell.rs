//! The window from its request to its end: the handler of the event loop.

use std::{
    panic::{AssertUnwindSafe, catch_unwind},
    path::PathBuf,
    sync::Arc,
    time::{Duration, Instant},
};

use corniche_viewer::tiles::BlockingPackage;
use winit::{
    application::ApplicationHandler,
    event::WindowEvent,
    event_loop::{ActiveEventLoop, ControlFlow, EventLoopProxy},
    window::WindowId,
};

use super::{
    event_loop::{News, new_event_loop},
    first_tiles::OpenedPackage,
    open_window::OpenWindow,
};
use crate::{Closed, NotSaved, WindowEnd, WindowError, WindowRequest};

/// The interval of checks whether the program must end.
const STOP_S: f64 = 0.2;

/// Opens a window for `package` and returns when it is closed. A flight that is still being
/// recorded is saved, whatever the reason for closing.
///
/// Call this from the program's first thread.
#[must_use]
pub fn run(request: WindowRequest, package: Arc<dyn BlockingPackage + Send + Sync>) -> Closed {
    let mut last_files = Vec::new();
    let end = show(request, package, &mut last_files);
    Closed { end, last_files }
}

fn show(
    request: WindowRequest,
    package: Arc<dyn BlockingPackage + Send + Sync>,
    last_files: &mut Vec<Result<PathBuf, NotSaved>>,
) -> Result<WindowEnd, WindowError> {
    let package = OpenedPackage::new(&request, package)?;
    let event_loop = new_event_loop()?;
    let mut shell = Shell {
        waiting: Some((request, package)),
        news: event_loop.create_proxy(),
        begun: Instant::now(),
        open: None,
        end: None,
        last_files: Vec::new(),
    };
    let ran = event_loop.run_app(&mut shell);
    shell.close();
    last_files.append(&mut shell.last_files);
    match (shell.end, ran) {
        (Some(end), _) => end,
        (None, Ok(())) => Ok(WindowEnd::Closed),
        (None, Err(source)) => Err(WindowError::System { source: source.into() }),
    }
}

/// The handler of the event loop.
struct Shell {
    /// The request and the package; `None` once the window is open.
    waiting: Option<(WindowRequest, OpenedPackage)>,
    news: EventLoopProxy<News>,
    begun: Instant,
    open: Option<OpenWindow>,
    /// The result; `None` until the window ends.
    end: Option<Result<WindowEnd, WindowError>>,
    last_files: Vec<Result<PathBuf, NotSaved>>,
}

impl Shell {
    fn now_s(&self) -> f64 {
        self.begun.elapsed().as_secs_f64()
    }

    /// Ends the event loop. If this is called several times, the first `end` counts.
    fn end(&mut self, event_loop: &ActiveEventLoop, end: Result<WindowEnd, WindowError>) {
        self.end.get_or_insert(end);
        event_loop.exit();
    }

    /// Saves pending files and drops the window. Further calls do nothing.
    fn close(&mut self) {
        let now_s = self.now_s();
        if let Some(open) = self.open.take() {
            self.last_files.extend(open.end(now_s));
        }
    }
}

impl ApplicationHandler<News> for Shell {
    fn resumed(&mut self, event_loop: &ActiveEventLoop) {
        let Some((request, package)) = self.waiting.take() else { return };
        match OpenWindow::new(event_loop, self.news.clone(), request, package) {
            Ok(open) => self.open = Some(open),
            Err(failure) => self.end(event_loop, Err(failure)),
        }
    }

    fn user_event(&mut self, _: &ActiveEventLoop, _: News) {
        if let Some(open) = &self.open {
            open.window.request_redraw();
        }
    }

    fn window_event(&mut self, event_loop: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        let now_s = self.now_s();
        // Nothing is drawn after the end: the window may be gone.
        let Some(open) = self.open.as_mut().filter(|_| self.end.is_none()) else { return };
        let done = match event {
            // `Destroyed` is sent when another program closes the window.
            WindowEvent::CloseRequested | WindowEvent::Destroyed => {
                return self.end(event_loop, Ok(WindowEnd::Closed));
            }
            event if open.end_key.take(&event) => {
                return self.end(event_loop, Ok(WindowEnd::Closed));
            }
            // The window library panics if a window disappears before its event. The recording of a
            // flight must survive this, and also a bug of this program.
            WindowEvent::RedrawRequested => catch_unwind(AssertUnwindSafe(|| open.redraw(now_s)))
                .unwrap_or_else(|_| {
                    let source = "the map cannot be drawn; see above".into();
                    Err(WindowError::System { source })
                }),
            event => {
                open.take(&event, now_s);
                Ok(())
            }
        };
        if let Err(failure) = done {
            self.end(event_loop, Err(failure));
        }
    }

    fn about_to_wait(&mut self, event_loop: &ActiveEventLoop) {
        let now_s = self.now_s();
        let Some(open) = &mut self.open else { return };
        if (open.is_stopped)() {
            return self.end(event_loop, Ok(WindowEnd::Stopped));
        }
        let due_s = open.wake(now_s).map_or(now_s + STOP_S, |due_s| due_s.min(now_s + STOP_S));
        let rest = Duration::from_secs_f64((due_s - now_s).max(0.0));
        event_loop.set_control_flow(ControlFlow::WaitUntil(Instant::now() + rest));
    }

    fn exiting(&mut self, _: &ActiveEventLoop) {
        // The window must be dropped while the display is still there.
        self.close();
    }
}
