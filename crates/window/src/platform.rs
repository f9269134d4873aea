//! The window system: event loop, surface, loss of either. Nothing else in this crate knows `winit`.
//!
//! A browser would have a module of its own in this one's place.

mod inputs;
mod screen;
mod watch;

use std::{
    panic::{AssertUnwindSafe, catch_unwind},
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
use self::{
    inputs::Inputs,
    screen::{Acquired, Screen},
};
use crate::{
    WindowError, WindowRequest,
    app::{App, FrameInput, Package, Redraw},
    canvas::Canvas,
};

/// Another thread has something new to show.
#[derive(Debug)]
struct News;

/// Opens a window on a package and returns when it is closed.
///
/// Must be called from the program's first thread.
///
/// # Errors
/// When the package cannot be shown, there is no display or nothing to draw with, or the graphics device is lost twice.
pub fn run(request: WindowRequest) -> Result<(), WindowError> {
    let package = Package::open(&request)?;
    let event_loop = event_loop()?;
    let mut shell = Shell {
        waiting: Some((request, package)),
        news: event_loop.create_proxy(),
        begun: Instant::now(),
        open: None,
        failure: None,
    };
    event_loop
        .run_app(&mut shell)
        .map_err(|source| WindowError::System { source: source.into() })?;
    shell.failure.map_or(Ok(()), Err)
}

fn event_loop() -> Result<EventLoop<News>, WindowError> {
    // The window library panics when a library that it loads at run time is missing.
    let built = catch_unwind(AssertUnwindSafe(|| EventLoop::with_user_event().build()));
    let no_display = |reason| WindowError::NoDisplay { reason };
    built
        .map_err(|_| no_display("a library of the window system is missing; see above".to_owned()))?
        .map_err(|error| no_display(error.to_string()))
}

/// What the event loop drives.
struct Shell {
    /// Until there is a window.
    waiting: Option<(WindowRequest, Package)>,
    news: EventLoopProxy<News>,
    begun: Instant,
    open: Option<Open>,
    failure: Option<WindowError>,
}

/// An open window. Fields are dropped in order: what lies on the card before the surface, that before the window.
struct Open {
    app: App,
    canvas: Canvas,
    screen: Screen,
    ui: egui::Context,
    ui_state: egui_winit::State,
    inputs: Inputs,
    window: Arc<Window>,
    is_hidden: bool,
    is_rebuilt: bool,
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
        request: WindowRequest,
        package: Package,
    ) -> Result<Open, WindowError> {
        let [width, height] = request.size_px;
        let name = request.package.file_name().unwrap_or_default().to_string_lossy();
        let attributes = Window::default_attributes()
            .with_title(format!("{name} – Corniche"))
            .with_inner_size(PhysicalSize::new(width, height));
        let window = event_loop
            .create_window(attributes)
            .map_err(|source| WindowError::System { source: source.into() })?;
        let window = Arc::new(window);
        let (screen, gpu) = Screen::new(event_loop, &window)?;
        let canvas = Canvas::new(gpu, screen.format());
        let news = self.news.clone();
        let wake: Arc<dyn Fn() + Send + Sync> = Arc::new(move || {
            // Nobody listens once the event loop has ended.
            let _ = news.send_event(News);
        });
        let size_px = screen.size_px().map(|side| side.max(1));
        let app = App::new(request, package, &canvas, &wake, size_px)?;
        let ui = new_ui(None);
        let ui_state = new_ui_state(&ui, &window, &canvas);
        window.request_redraw();
        Ok(Open {
            app,
            canvas,
            screen,
            ui,
            ui_state,
            inputs: Inputs::default(),
            window,
            is_hidden: false,
            is_rebuilt: false,
            due_s: None,
        })
    }

    fn fail(&mut self, event_loop: &ActiveEventLoop, failure: WindowError) {
        self.failure.get_or_insert(failure);
        event_loop.exit();
    }
}

impl ApplicationHandler<News> for Shell {
    fn resumed(&mut self, event_loop: &ActiveEventLoop) {
        let Some((request, package)) = self.waiting.take() else { return };
        match self.open(event_loop, request, package) {
            Ok(open) => self.open = Some(open),
            Err(failure) => self.fail(event_loop, failure),
        }
    }

    fn user_event(&mut self, _: &ActiveEventLoop, _: News) {
        if let Some(open) = &self.open {
            open.window.request_redraw();
        }
    }

    fn window_event(&mut self, event_loop: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        let now_s = self.now_s();
        let Some(open) = &mut self.open else { return };
        let done = match event {
            WindowEvent::CloseRequested => {
                event_loop.exit();
                Ok(())
            }
            event if open.inputs.is_end(&event) => {
                event_loop.exit();
                Ok(())
            }
            WindowEvent::RedrawRequested => open.redraw(now_s),
            event => {
                open.take(&event, now_s);
                Ok(())
            }
        };
        if let Err(failure) = done {
            self.fail(event_loop, failure);
        }
    }

    fn about_to_wait(&mut self, event_loop: &ActiveEventLoop) {
        let now_s = self.now_s();
        let Some(open) = &mut self.open else { return };
        if open.app.reload(now_s) || open.due_s.is_some_and(|due_s| due_s <= now_s) {
            open.due_s = None;
            open.window.request_redraw();
        }
        let due_s = [open.due_s, open.app.reload_due_s()].into_iter().flatten().reduce(f64::min);
        event_loop.set_control_flow(due_s.map_or(ControlFlow::Wait, |due_s| {
            ControlFlow::WaitUntil(
                Instant::now() + Duration::from_secs_f64((due_s - now_s).max(0.0)),
            )
        }));
    }

    fn exiting(&mut self, _: &ActiveEventLoop) {
        // While the display is still there.
        self.open = None;
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
            return self.rebuild();
        }
        match self.draw(now_s) {
            // Whatever went wrong with a device that is gone went wrong for that.
            Err(_) if self.canvas.gpu().is_lost() => self.rebuild(),
            drawn => drawn,
        }
    }

    fn draw(&mut self, now_s: f64) -> Result<(), WindowError> {
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
            Acquired::Hidden => Redraw::Asked,
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

    /// Everything on the graphics card anew, once: a device that is lost again will be lost for ever.
    fn rebuild(&mut self) -> Result<(), WindowError> {
        if std::mem::replace(&mut self.is_rebuilt, true) {
            return Err(WindowError::DeviceLost);
        }
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
