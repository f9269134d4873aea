//! What the system gives: event loop, surface, loss of either, threads that load tiles, a folder for files. Nothing else in
//! this crate knows `winit`, a thread, a clock or a file.
//!
//! A browser would have a module of its own in this one's place: `run` on the event loop of a page, `Loader` on its fetches
//! (`PackageTiles` and `Gpu::request` wait for nothing), `Files` on its downloads. Elsewhere it would still lack three
//! things: `app` holds a `PackageSource`, which waits for its file; `Package` and `CameraRequest::camera` load the first
//! tiles before there is a frame; `App::end` waits for pictures that are under way.

mod files;
mod inputs;
mod loader;
mod screen;
mod watch;

use std::{
    panic::{AssertUnwindSafe, catch_unwind},
    path::PathBuf,
    sync::Arc,
    time::{Duration, Instant},
};

use winit::{
    application::ApplicationHandler,
    dpi::PhysicalSize,
    event::WindowEvent,
    event_loop::{ActiveEventLoop, ControlFlow, EventLoop, EventLoopProxy},
    window::{Window, WindowId},
};

pub use self::watch::{Watched, watch};
pub(crate) use self::{
    files::Files,
    loader::{Loader, SharedSource},
};
use self::{
    inputs::{EndKey, Inputs},
    screen::{Acquired, Screen},
};
use crate::{
    Closed, End, WindowError, WindowRequest,
    app::{App, FrameInput, Package, Redraw},
    canvas::Canvas,
    shots::NotSaved,
};

/// Whether the program is to end is asked so often.
const STOP_S: f64 = 0.2;
/// A device that is lost again so soon will be lost for ever.
const SOON_S: f64 = 60.0;

/// Another thread has something new to show.
#[derive(Debug)]
struct News;

/// Opens a window on a package and returns when it is closed. A flight that is being recorded then is saved, however the
/// window came to its end.
///
/// Must be called from the program's first thread.
#[must_use]
pub fn run(request: WindowRequest) -> Closed {
    let mut last_files = Vec::new();
    let end = show(request, &mut last_files);
    Closed { end, last_files }
}

fn show(
    request: WindowRequest,
    last_files: &mut Vec<Result<PathBuf, NotSaved>>,
) -> Result<End, WindowError> {
    let package = Package::of(&request)?;
    let event_loop = event_loop()?;
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
        (None, Ok(())) => Ok(End::Closed),
        (None, Err(source)) => Err(WindowError::System { source: source.into() }),
    }
}

fn event_loop() -> Result<EventLoop<News>, WindowError> {
    // The window library panics when a library that it loads at run time is missing.
    let built = catch_unwind(AssertUnwindSafe(|| EventLoop::with_user_event().build()));
    let no_display = |reason| WindowError::NoDisplay { reason };
    built
        .map_err(|_| no_display("a library of the window system is missing; see above".to_owned()))?
        .map_err(|error| no_display(without_source_place(&error.to_string()).to_owned()))
}

/// A window on a package of this name, so large at first.
fn new_window(
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

/// What the window library says of the system's errors begins with a file and a line of its own.
fn without_source_place(words: &str) -> &str {
    let told = words.strip_prefix("os error at ").and_then(|told| told.split_once(".rs:"));
    told.and_then(|(_, told)| told.split_once(": ")).map_or(words, |(_, told)| told)
}

/// What the event loop drives.
struct Shell {
    /// Until there is a window.
    waiting: Option<(WindowRequest, Package)>,
    news: EventLoopProxy<News>,
    begun: Instant,
    open: Option<Open>,
    /// Once it is over.
    end: Option<Result<End, WindowError>>,
    last_files: Vec<Result<PathBuf, NotSaved>>,
}

/// An open window. Fields are dropped in order: what lies on the card before the surface, that before the window.
struct Open {
    app: App,
    canvas: Canvas,
    screen: Screen,
    ui: egui::Context,
    ui_state: egui_winit::State,
    inputs: Inputs,
    end_key: EndKey,
    window: Arc<Window>,
    is_stopped: Box<dyn Fn() -> bool>,
    is_hidden: bool,
    /// When everything on the graphics card was made anew.
    rebuilt_s: Option<f64>,
    /// When a frame is due without any event.
    due_s: Option<f64>,
}

impl Shell {
    fn now_s(&self) -> f64 {
        self.begun.elapsed().as_secs_f64()
    }

    fn open(
        &self,
        event_loop: &ActiveEventLoop,
        mut request: WindowRequest,
        package: Package,
    ) -> Result<Open, WindowError> {
        let is_stopped = std::mem::replace(&mut request.is_stopped, Box::new(|| false));
        let window = new_window(event_loop, &request.name, request.size_px)?;
        let (screen, gpu) = Screen::new(event_loop, &window)?;
        let canvas = Canvas::new(gpu, screen.format());
        let news = self.news.clone();
        let wake: Arc<dyn Fn() + Send + Sync> = Arc::new(move || {
            // Nobody listens once the event loop has ended.
            let _ = news.send_event(News);
        });
        let size_px = screen.size_px().map(|side| side.max(1));
        let ui = new_ui(None);
        let pixels_per_point = egui_winit::pixels_per_point(&ui, &window);
        let app = App::new(request, package, &canvas, &wake, size_px, pixels_per_point)?;
        let ui_state = new_ui_state(&ui, &window, &canvas);
        window.request_redraw();
        Ok(Open {
            app,
            canvas,
            screen,
            ui,
            ui_state,
            inputs: Inputs::default(),
            end_key: EndKey::default(),
            window,
            is_stopped,
            is_hidden: false,
            rebuilt_s: None,
            due_s: None,
        })
    }

    /// Only the first end counts.
    fn end(&mut self, event_loop: &ActiveEventLoop, end: Result<End, WindowError>) {
        self.end.get_or_insert(end);
        event_loop.exit();
    }

    /// Saves what is to be saved, and lets go of the window; once.
    fn close(&mut self) {
        let now_s = self.now_s();
        if let Some(mut open) = self.open.take() {
            self.last_files.extend(open.app.end(&open.canvas, now_s));
        }
    }
}

impl ApplicationHandler<News> for Shell {
    fn resumed(&mut self, event_loop: &ActiveEventLoop) {
        let Some((request, package)) = self.waiting.take() else { return };
        match self.open(event_loop, request, package) {
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
        // Once it is over nothing is drawn: there may be no window any more.
        let Some(open) = self.open.as_mut().filter(|_| self.end.is_none()) else { return };
        let done = match event {
            // Destroyed is what another program closed.
            WindowEvent::CloseRequested | WindowEvent::Destroyed => {
                return self.end(event_loop, Ok(End::Closed));
            }
            event if open.end_key.take(&event) => {
                return self.end(event_loop, Ok(End::Closed));
            }
            // The window library panics where a window is gone before it has said so. What is being recorded must not go
            // with it, nor with any defect of ours.
            WindowEvent::RedrawRequested => catch_unwind(AssertUnwindSafe(|| open.redraw(now_s)))
                .unwrap_or_else(|_| {
                    let source = "it cannot be drawn; see above".into();
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
            return self.end(event_loop, Ok(End::Stopped));
        }
        if open.app.reload(now_s) || open.due_s.is_some_and(|due_s| due_s <= now_s) {
            open.due_s = None;
            open.window.request_redraw();
        }
        let dues_s = [open.due_s, open.app.reload_due_s()];
        let due_s = dues_s.into_iter().flatten().fold(now_s + STOP_S, f64::min);
        let rest = Duration::from_secs_f64((due_s - now_s).max(0.0));
        event_loop.set_control_flow(ControlFlow::WaitUntil(Instant::now() + rest));
    }

    fn exiting(&mut self, _: &ActiveEventLoop) {
        // While the display is still there.
        self.close();
    }
}

impl Open {
    /// An event that is not about drawing.
    fn take(&mut self, event: &WindowEvent, now_s: f64) {
        match event {
            WindowEvent::Resized(size) => {
                self.screen.resize(&self.canvas, [size.width, size.height]);
                self.window.request_redraw();
            }
            WindowEvent::Occluded(is_hidden) => {
                self.is_hidden = *is_hidden;
                self.window.request_redraw();
            }
            _ => {}
        }
        let is_for_ui = !inputs::is_panel_key(event);
        if is_for_ui && self.ui_state.on_window_event(&self.window, event).repaint {
            self.window.request_redraw();
        }
        if self.inputs.take(event, &mut self.app, &self.ui, now_s) {
            self.window.request_redraw();
        }
    }

    fn redraw(&mut self, now_s: f64) -> Result<(), WindowError> {
        if self.is_hidden || self.screen.size_px().contains(&0) {
            return Ok(());
        }
        if self.canvas.gpu().is_lost() {
            return self.rebuild(now_s);
        }
        match self.draw(now_s) {
            // Whatever went wrong with a device that is gone went wrong for that.
            Err(_) if self.canvas.gpu().is_lost() => self.rebuild(now_s),
            drawn => drawn,
        }
    }

    fn draw(&mut self, now_s: f64) -> Result<(), WindowError> {
        self.inputs.hand_on_move(&mut self.app);
        let input = FrameInput {
            now_s,
            size_px: self.screen.size_px(),
            pixels_per_point: egui_winit::pixels_per_point(&self.ui, &self.window),
            ui: self.ui_state.take_egui_input(&self.window),
        };
        let frame = self.app.frame(&mut self.canvas, &self.ui, input)?;
        self.ui_state.handle_platform_output(&self.window, frame.platform);
        let redraw = match self.screen.acquire(&self.canvas, &self.window)? {
            Acquired::Texture(texture) => {
                let view = texture.texture.create_view(&wgpu::TextureViewDescriptor::default());
                self.canvas.paint(&frame.primitives, &frame.screen, &view);
                self.window.pre_present_notify();
                self.canvas.gpu().queue().present(texture);
                frame.redraw
            }
            Acquired::Later => Redraw::Now,
            // What comes at its time still comes.
            Acquired::Hidden => match frame.redraw {
                Redraw::Now => Redraw::Asked,
                later => later,
            },
        };
        self.canvas.free_textures(&frame.unused_textures);
        if let Some(what) = self.canvas.gpu().take_fault() {
            self.app.fault(&what);
        }
        self.due_s = None;
        match redraw {
            Redraw::Now => self.window.request_redraw(),
            Redraw::At(due_s) => self.due_s = Some(due_s),
            Redraw::Asked => {}
        }
        Ok(())
    }

    /// Everything on the graphics card anew, unless it was lost shortly before.
    fn rebuild(&mut self, now_s: f64) -> Result<(), WindowError> {
        if is_soon_after(self.rebuilt_s, now_s) {
            return Err(WindowError::DeviceLost);
        }
        self.rebuilt_s = Some(now_s);
        let gpu = self.screen.rebuild(&self.window)?;
        self.canvas = Canvas::new(gpu, self.screen.format());
        // Textures of the panel were on the card too; a new context makes them again.
        self.ui = new_ui(Some(&self.ui));
        self.ui_state = new_ui_state(&self.ui, &self.window, &self.canvas);
        self.app.begin_again(&self.canvas);
        self.window.request_redraw();
        Ok(())
    }
}

fn is_soon_after(last_s: Option<f64>, now_s: f64) -> bool {
    last_s.is_some_and(|last_s| now_s - last_s < SOON_S)
}

/// The panel's toolkit, remembering what another one did.
fn new_ui(before: Option<&egui::Context>) -> egui::Context {
    let ui = egui::Context::default();
    crate::panel::set_up(&ui);
    if let Some(before) = before {
        let memory = before.memory(Clone::clone);
        ui.memory_mut(|here| *here = memory);
    }
    ui
}

fn new_ui_state(ui: &egui::Context, window: &Window, canvas: &Canvas) -> egui_winit::State {
    egui_winit::State::new(
        ui.clone(),
        egui::ViewportId::ROOT,
        window,
        Some(window.scale_factor() as f32),
        None,
        Some(canvas.gpu().max_side_px() as usize),
    )
}

#[cfg(test)]
#[path = "platform_tests.rs"]
mod tests;
