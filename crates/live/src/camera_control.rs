//! Turns mouse and keyboard input into a camera for each frame.

use corniche_viewer::{camera::Camera, flight::Pose};
use glam::DVec2;

use crate::{
    clicks::Clicks,
    controls::{Button, CameraView, Input, KnownGround, Modifiers, Navigator},
};

/// Tiles are loaded in advance for the camera position after this time.
const AHEAD_S: f64 = 0.5;

/// The camera, moved by mouse and keys.
pub struct CameraControl {
    /// The navigator that moves the camera.
    pub navigator: Navigator,
    clicks: Clicks,
    /// Whether a mouse button that was pressed on the map is held down.
    pub is_dragging: bool,
    /// Pixels per point of the screen, as in the last frame.
    pub pixels_per_point: f64,
    /// Time and view of the last frame.
    last_view: Option<(f64, CameraView)>,
    /// When the camera moved last.
    moved_s: f64,
}

impl CameraControl {
    /// Creates the control of `navigator`, on a screen with this many pixels per point.
    #[must_use]
    pub fn new(navigator: Navigator, pixels_per_point: f32) -> Self {
        Self {
            navigator,
            clicks: Clicks::default(),
            is_dragging: false,
            pixels_per_point: f64::from(pixels_per_point),
            last_view: None,
            moved_s: f64::NEG_INFINITY,
        }
    }

    /// Handles a press of a mouse button on the map.
    pub fn press(
        &mut self,
        button: Button,
        at_px: DVec2,
        modifiers: Modifiers,
        now_s: f64,
        ground: &dyn KnownGround,
    ) {
        let at = self.in_points(at_px);
        let input = if button == Button::Left && self.clicks.press(at, now_s) {
            Input::DoubleClick { at_px, modifiers }
        } else {
            Input::Press { button, at_px, modifiers }
        };
        self.input(&input, now_s, ground);
    }

    /// Handles any other input, and a press that is never the second of a double click.
    pub fn input(&mut self, input: &Input, now_s: f64, ground: &dyn KnownGround) {
        match input {
            Input::Press { .. } => self.is_dragging = true,
            Input::Move { at_px } => self.clicks.move_to(self.in_points(*at_px)),
            Input::Release { button } => {
                self.is_dragging = false;
                if *button == Button::Left {
                    self.clicks.release();
                }
            }
            Input::LetGo => {
                self.is_dragging = false;
                self.clicks.let_go();
            }
            _ => {}
        }
        self.navigator.handle(input, now_s, ground);
    }

    fn in_points(&self, at_px: DVec2) -> DVec2 {
        at_px / self.pixels_per_point
    }

    /// Moves the camera for a frame in a window of this size.
    pub fn advance(
        &mut self,
        now_s: f64,
        size_px: [u32; 2],
        pixels_per_point: f32,
        ground: &dyn KnownGround,
    ) -> Camera {
        self.pixels_per_point = f64::from(pixels_per_point);
        self.navigator.resize(size_px);
        self.navigator.set_pixels_per_point(self.pixels_per_point);
        self.navigator.advance(now_s, ground);
        self.navigator.camera()
    }

    /// Predicts the camera from its movement since the last frame; `None` if it did not move. Call
    /// this once per frame.
    pub fn look_ahead(&mut self, now_s: f64, size_px: [u32; 2]) -> Option<Camera> {
        let view = self.view();
        let ahead = self.last_view.and_then(|(last_s, last)| {
            let passed_s = now_s - last_s;
            let way = view.eye_in_world - last.eye_in_world;
            let is_moving = passed_s > 0.0 && passed_s < AHEAD_S && way.length() > 0.0;
            is_moving.then(|| {
                let eye_in_world = view.eye_in_world + way * (AHEAD_S / passed_s);
                CameraView { eye_in_world, ..view }.camera(size_px)
            })
        });
        if self.last_view.is_some_and(|(_, last)| last != view) {
            self.moved_s = now_s;
        }
        self.last_view = Some((now_s, view));
        ahead
    }

    /// Seconds since the camera last moved.
    #[must_use]
    pub fn at_rest_s(&self, now_s: f64) -> f64 {
        now_s - self.moved_s
    }

    /// The current view.
    #[must_use]
    pub fn view(&self) -> CameraView {
        self.navigator.view()
    }

    /// Width and height of the window in the last frame, pixels.
    #[must_use]
    pub fn size_px(&self) -> [u32; 2] {
        self.navigator.camera().size_px
    }

    /// The camera with its true height, as flights store it.
    #[must_use]
    pub fn pose(&self, vertical_scale: f64) -> Pose {
        let CameraView { eye_in_world: eye, orientation, .. } = self.view();
        Pose { eye_m: [eye.x, eye.y, eye.z / vertical_scale], orientation }
    }
}

#[cfg(test)]
#[path = "camera_control_tests.rs"]
mod tests;
