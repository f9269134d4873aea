//! A window for images from another thread: a flight while it is being drawn.

use std::{
    sync::{
        Arc,
        mpsc::{Receiver, TryRecvError},
    },
    time::{Duration, Instant},
};

use corniche_viewer::gpu::ReadBackError;
use egui::{Color32, ColorImage, Rect, TextureHandle, TextureOptions, pos2};
use egui_wgpu::ScreenDescriptor;
use image::RgbaImage;
use winit::{
    application::ApplicationHandler,
    event::WindowEvent,
    event_loop::{ActiveEventLoop, ControlFlow},
    window::{Window, WindowId},
};

use super::{
    event_loop::{News, new_event_loop, new_window},
    inputs::EndKey,
    screen::{Painted, Screen},
};
use crate::{WindowError, canvas::Canvas};

/// The interval of checks for the next image.
const PICTURE_TIME: Duration = Duration::from_millis(10);

/// The end of the window.
#[derive(Debug)]
pub enum Watched {
    /// All images were shown.
    ToTheEnd,
    /// The user closed the window before that, by a button of its frame or with Ctrl Q.
    InPart,
    /// The window was lost before that, because its surface or its device failed. The images may be
    /// drawn with another device.
    Lost(WindowError),
}

/// Shows images of the package `name` as they arrive, in a window that has `size_px` pixels at
/// first, until there are no more or the window is closed.
///
/// Call this from the program's first thread; another thread sends the images. Each image is fitted
/// into the window, pixel by pixel while the window has the size of the images.
///
/// # Errors
/// When the window cannot be opened: there is no display, or no graphics device.
pub fn watch(
    name: &str,
    size_px: [u32; 2],
    pictures: Receiver<RgbaImage>,
) -> Result<Watched, WindowError> {
    let event_loop = new_event_loop()?;
    let mut show = Show {
        name: name.to_owned(),
        size_px,
        pictures,
        open: None,
        end_key: EndKey::default(),
        ended: None,
    };
    let ran = event_loop.run_app(&mut show);
    match (show.ended, ran) {
        (Some(ended), _) => ended,
        (None, Ok(())) => Ok(Watched::InPart),
        (None, Err(source)) => Err(WindowError::System { source: source.into() }),
    }
}

struct Show {
    name: String,
    size_px: [u32; 2],
    pictures: Receiver<RgbaImage>,
    open: Option<Open>,
    end_key: EndKey,
    /// The result; `None` until the window ends.
    ended: Option<Result<Watched, WindowError>>,
}

/// An open window. Fields are dropped in this order: the data on the GPU, then the surface, then
/// the window.
struct Open {
    picture: Option<TextureHandle>,
    canvas: Canvas,
    screen: Screen,
    ui: egui::Context,
    window: Arc<Window>,
}

impl Show {
    fn open(&self, event_loop: &ActiveEventLoop) -> Result<Open, WindowError> {
        let window = new_window(event_loop, &self.name, self.size_px)?;
        let (screen, gpu) = Screen::new(event_loop, &window)?;
        let canvas = Canvas::new(gpu, screen.configuration.format);
        window.request_redraw();
        Ok(Open { picture: None, canvas, screen, ui: egui::Context::default(), window })
    }

    /// Ends the event loop. If this is called several times, the first `ended` counts.
    fn end(&mut self, event_loop: &ActiveEventLoop, ended: Result<Watched, WindowError>) {
        self.ended.get_or_insert(ended);
        event_loop.exit();
    }
}

impl ApplicationHandler<News> for Show {
    fn resumed(&mut self, event_loop: &ActiveEventLoop) {
        if self.open.is_none() {
            match self.open(event_loop) {
                Ok(open) => self.open = Some(open),
                Err(error) => self.end(event_loop, Err(error)),
            }
        }
    }

    fn window_event(&mut self, event_loop: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        let Some(open) = &mut self.open else { return };
        match event {
            WindowEvent::CloseRequested => self.end(event_loop, Ok(Watched::InPart)),
            event if self.end_key.take(&event) => self.end(event_loop, Ok(Watched::InPart)),
            WindowEvent::Destroyed => {
                let source = "it was removed".into();
                self.end(event_loop, Ok(Watched::Lost(WindowError::System { source })));
            }
            WindowEvent::Resized(size) => {
                open.screen.resize(&open.canvas, [size.width, size.height]);
                open.window.request_redraw();
            }
            WindowEvent::RedrawRequested => {
                if let Err(error) = open.draw() {
                    self.end(event_loop, Ok(Watched::Lost(error)));
                }
            }
            _ => {}
        }
    }

    fn about_to_wait(&mut self, event_loop: &ActiveEventLoop) {
        let Some(open) = &mut self.open else { return };
        match self.pictures.try_recv() {
            Ok(picture) => open.take(&picture),
            Err(TryRecvError::Empty) => {}
            Err(TryRecvError::Disconnected) => {
                self.end(event_loop, Ok(Watched::ToTheEnd));
            }
        }
        event_loop.set_control_flow(ControlFlow::WaitUntil(Instant::now() + PICTURE_TIME));
    }

    fn exiting(&mut self, _: &ActiveEventLoop) {
        // The window must be dropped while the display is still there.
        self.open = None;
    }
}

impl Open {
    fn take(&mut self, picture: &RgbaImage) {
        let size = [picture.width(), picture.height()].map(|side| side as usize);
        let picture = ColorImage::from_rgba_unmultiplied(size, picture.as_raw());
        match &mut self.picture {
            Some(shown) => shown.set(picture, TextureOptions::LINEAR),
            None => {
                self.picture = Some(self.ui.load_texture("frame", picture, TextureOptions::LINEAR));
            }
        }
        self.window.request_redraw();
    }

    fn draw(&mut self) -> Result<(), WindowError> {
        let size_px = self.screen.size_px;
        if size_px.contains(&0) {
            return Ok(());
        }
        // One point is one pixel: there is no text here, and images keep their pixels.
        let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(size_px[0] as f32, size_px[1] as f32));
        let input = egui::RawInput { screen_rect: Some(whole), ..Default::default() };
        let picture = self.picture.clone();
        let mut output = self.ui.run_ui(input, |ui| {
            if let Some(picture) = &picture {
                let full = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
                ui.painter().image(
                    picture.id(),
                    fitted(picture.size(), whole),
                    full,
                    Color32::WHITE,
                );
            }
        });
        let screen = ScreenDescriptor { size_in_pixels: size_px, pixels_per_point: 1.0 };
        let primitives = self.ui.tessellate(std::mem::take(&mut output.shapes), 1.0);
        let unused = self.canvas.take_textures(output.textures_delta);
        let painted = self.screen.paint(&mut self.canvas, &self.window, (&primitives, &screen))?;
        if painted == Painted::Later {
            self.window.request_redraw();
        }
        self.canvas.free_textures(&unused);
        match self.canvas.gpu().take_fault() {
            Some(what) => Err(ReadBackError::Fault { what }.into()),
            None => Ok(()),
        }
    }
}

/// The largest rectangle with the aspect ratio of an image, in the middle of `room`.
fn fitted([width, height]: [usize; 2], room: Rect) -> Rect {
    let size = egui::vec2(width as f32, height as f32);
    let scale = (room.width() / size.x).min(room.height() / size.y);
    Rect::from_center_size(room.center(), size * scale)
}

#[cfg(test)]
#[path = "watch_tests.rs"]
mod tests;
