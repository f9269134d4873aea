//! An open window: events in, frames out.

use std::{path::PathBuf, sync::Arc};

use corniche_live::{ClockS, LoaderThreads, NotSaved, Redraw};
use winit::{
    event::WindowEvent,
    event_loop::{ActiveEventLoop, EventLoopProxy},
    window::Window,
};

use super::{
    event_loop::{News, new_window},
    first_tiles::OpenedPackage,
    inputs::{self, EndKey, PointerState},
    screen::{Painted, Screen},
};
use crate::{
    WindowError, WindowRequest,
    app::{App, AppPlatform, FrameInput},
    canvas::Canvas,
    files::FileWriter,
};

/// A device that is lost again within this time counts as permanently lost.
const SOON_S: f64 = 60.0;

/// An open window. Fields are dropped in this order: the data on the GPU, then the surface, then
/// the window.
pub(crate) struct OpenWindow {
    app: App,
    canvas: Canvas,
    screen: Screen,
    ui: egui::Context,
    ui_state: egui_winit::State,
    inputs: PointerState,
    pub(crate) end_key: EndKey,
    pub(crate) window: Arc<Window>,
    /// Returns whether the program must end.
    pub(crate) is_stopped: Box<dyn Fn() -> bool>,
    is_hidden: bool,
    /// The time when everything on the GPU was last recreated.
    rebuilt_s: Option<f64>,
    /// The time when a frame is due without any event.
    due_s: Option<f64>,
}

impl OpenWindow {
    /// Opens the window. Other threads send `news` when they have something ready.
    pub(crate) fn new(
        event_loop: &ActiveEventLoop,
        news: EventLoopProxy<News>,
        mut request: WindowRequest,
        package: OpenedPackage,
    ) -> Result<Self, WindowError> {
        let is_stopped = std::mem::replace(&mut request.is_stopped, Box::new(|| false));
        let window = new_window(event_loop, &request.name, request.size_px)?;
        let (screen, gpu) = Screen::new(event_loop, &window)?;
        let canvas = Canvas::new(gpu, screen.configuration.format);
        let wake: Arc<dyn Fn() + Send + Sync> = Arc::new(move || {
            // This call fails once the event loop has ended, and then nothing needs to be reported.
            let _ = news.send_event(News);
        });
        let size_px = screen.size_px.map(|side| side.max(1));
        let ui = new_ui(None);
        let pixels_per_point = egui_winit::pixels_per_point(&ui, &window);
        let files = FileWriter::new(request.folder.clone(), Arc::clone(&wake));
        let threads = LoaderThreads::usual_number();
        let room = request.budget.tiles_in_flight;
        let loader = LoaderThreads::new(&package.tiles, threads, room, &wake)
            .map_err(|source| WindowError::Thread { source })?;
        let begun = std::time::Instant::now();
        let clock_s: ClockS = Box::new(move || begun.elapsed().as_secs_f64());
        let platform = AppPlatform { loader: Box::new(loader), files, clock_s };
        let ground = package.ground(&request)?;
        let screen_size = (size_px, pixels_per_point);
        let app = App::new(request, package.tiles, ground, canvas.gpu(), platform, screen_size)?;
        let ui_state = new_ui_state(&ui, &window, &canvas);
        window.request_redraw();
        Ok(Self {
            app,
            canvas,
            screen,
            ui,
            ui_state,
            inputs: PointerState::default(),
            end_key: EndKey::default(),
            window,
            is_stopped,
            is_hidden: false,
            rebuilt_s: None,
            due_s: None,
        })
    }

    /// Executes what is due at this time; returns when something is due next without any event.
    pub(crate) fn wake(&mut self, now_s: f64) -> Option<f64> {
        if self.app.desk.reload(now_s) || self.due_s.is_some_and(|due_s| due_s <= now_s) {
            self.due_s = None;
            self.window.request_redraw();
        }
        [self.due_s, self.app.desk.session.styles.reload_due_s()]
            .into_iter()
            .flatten()
            .reduce(f64::min)
    }

    /// Closes the window: saves pending files.
    pub(crate) fn end(mut self, now_s: f64) -> Vec<Result<PathBuf, NotSaved>> {
        self.app.end(&self.canvas, now_s)
    }

    /// Handles an event that does not request a frame.
    pub(crate) fn take(&mut self, event: &WindowEvent, now_s: f64) {
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

    /// Draws a frame, after recreating everything on the GPU if the device was lost.
    pub(crate) fn redraw(&mut self, now_s: f64) -> Result<(), WindowError> {
        if self.is_hidden || self.screen.size_px.contains(&0) {
            return Ok(());
        }
        if self.canvas.gpu().is_lost() {
            return self.rebuild(now_s);
        }
        match self.draw(now_s) {
            // After the loss of the device, any error is a consequence of the loss.
            Err(_) if self.canvas.gpu().is_lost() => self.rebuild(now_s),
            drawn => drawn,
        }
    }

    fn draw(&mut self, now_s: f64) -> Result<(), WindowError> {
        self.inputs.hand_on_move(&mut self.app);
        let input = FrameInput {
            now_s,
            size_px: self.screen.size_px,
            pixels_per_point: egui_winit::pixels_per_point(&self.ui, &self.window),
            ui: self.ui_state.take_egui_input(&self.window),
        };
        let frame = self.app.frame(&mut self.canvas, &self.ui, input)?;
        self.ui_state.handle_platform_output(&self.window, frame.platform);
        let shown = (&frame.primitives[..], &frame.screen);
        let redraw = match (self.screen.paint(&mut self.canvas, &self.window, shown)?, frame.redraw)
        {
            (Painted::Later, _) => Redraw::Now,
            // A frame that is due at some time stays due.
            (Painted::Hidden, Redraw::Now) => Redraw::Asked,
            (_, redraw) => redraw,
        };
        self.canvas.free_textures(&frame.unused_textures);
        if let Some(what) = self.canvas.gpu().take_fault() {
            let told = format!("the graphics device failed: {what}");
            self.app.desk.notices.warn(told);
        }
        self.due_s = None;
        match redraw {
            Redraw::Now => self.window.request_redraw(),
            Redraw::At(due_s) => self.due_s = Some(due_s),
            Redraw::Asked => {}
        }
        Ok(())
    }

    /// Recreates everything on the GPU, unless this was done shortly before.
    fn rebuild(&mut self, now_s: f64) -> Result<(), WindowError> {
        if is_soon_after(self.rebuilt_s, now_s) {
            return Err(WindowError::DeviceLost);
        }
        self.rebuilt_s = Some(now_s);
        let gpu = self.screen.rebuild(&self.window)?;
        self.canvas = Canvas::new(gpu, self.screen.configuration.format);
        // The panel's textures were on the GPU too; a new context uploads them again.
        self.ui = new_ui(Some(&self.ui));
        self.ui_state = new_ui_state(&self.ui, &self.window, &self.canvas);
        self.app.begin_again();
        self.window.request_redraw();
        Ok(())
    }
}

fn is_soon_after(last_s: Option<f64>, now_s: f64) -> bool {
    last_s.is_some_and(|last_s| now_s - last_s < SOON_S)
}

/// A context of the panel's toolkit, with the memory of the previous one, if there was one.
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
#[path = "open_window_tests.rs"]
mod tests;
