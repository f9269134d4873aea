//! The navigator turns inputs and time into views of the camera.

use corniche_viewer::camera::{Camera, Orientation};
use glam::{DVec2, DVec3};

use super::{
    bounded_view::BoundedView,
    fingers::{FingerStep, Fingers},
    flying::Flying,
    input::{Button, CameraKey, Input, Modifiers},
    movement::{Gesture, Pending, Trail, Travel},
    options::{CameraLimits, Mode},
    view::{CameraView, KnownGround, half_turn},
};

/// The change of heading per point of a drag, as in `MapLibre`. A point is a pixel, except on
/// screens with small pixels.
const HEADING_DEG_PER_POINT: f64 = 0.8;
/// The change of tilt per point of a drag, as in `MapLibre`.
const PITCH_DEG_PER_POINT: f64 = 0.5;
/// The change of heading and tilt per point of a drag in fly mode.
const LOOK_DEG_PER_POINT: f64 = 0.15;
/// Zoom levels for a notch of the wheel: three notches halve the distance.
const LEVELS_PER_NOTCH: f64 = 1.0 / 3.0;
/// An arrow key pans by this much, as in `MapLibre`.
const PAN_STEP_POINTS: f64 = 100.0;
/// Shift and an arrow key turn by this much, as in `MapLibre`.
const HEADING_STEP_DEG: f64 = 15.0;
/// Shift and an arrow key tilt by this much, as in `MapLibre`.
const PITCH_STEP_DEG: f64 = 10.0;
/// The remainder of a step shrinks by the factor e in this time.
const STEP_DECAY_S: f64 = 0.08;
/// The speed after a throw shrinks by the factor e in this time.
const GLIDE_DECAY_S: f64 = 0.25;
/// The map glides after a drag only if the drag was faster than this.
const GLIDE_MIN_PX_PER_S: f64 = 60.0;
/// The longest time step, so that the camera does not jump after the program was suspended. It is
/// longer than most frames drawn by the CPU, so that flying is not slower without a GPU.
const MAX_STEP_S: f64 = 0.5;

/// Moves the camera according to the user's input.
#[derive(Debug, Clone)]
pub struct Navigator {
    seen: BoundedView,
    pixels_per_point: f64,
    /// Map mode or fly mode.
    pub mode: Mode,
    /// Whether movements slow down gradually and the map glides on after a fast drag. Otherwise
    /// movements end at once, for scripts and for users whom movement disturbs.
    pub has_inertia: bool,
    cursor_px: DVec2,
    gesture: Option<Gesture>,
    fingers: Option<Fingers>,
    trail: Trail,
    glide_m_per_s: DVec3,
    pending: Pending,
    travel: Option<Travel>,
    /// The last requested view. It is shown exactly as requested until something moves it, so it
    /// matches the image that `render` draws.
    placed: Option<CameraView>,
    /// The last view in map mode that showed some of the data; `None` if there is no such view to
    /// return to.
    sighted: Option<CameraView>,
    flying: Flying,
    /// The time up to which the camera has moved.
    now_s: f64,
    /// The time at which the last frame began.
    advanced_s: f64,
}

impl Navigator {
    /// Starts with a view, to which [`Input::Reset`] returns. No side of the image may be 0.
    #[must_use]
    pub fn new(
        home: CameraView,
        limits: CameraLimits,
        size_px: [u32; 2],
        has_inertia: bool,
    ) -> Self {
        Self {
            seen: BoundedView { view: home, home, limits, size_px },
            pixels_per_point: 1.0,
            mode: Mode::Map,
            has_inertia,
            cursor_px: DVec2::ZERO,
            gesture: None,
            fingers: None,
            trail: Trail::default(),
            glide_m_per_s: DVec3::ZERO,
            pending: Pending::default(),
            travel: None,
            placed: Some(home),
            sighted: None,
            flying: Flying::default(),
            now_s: 0.0,
            advanced_s: 0.0,
        }
    }

    /// The current view.
    #[must_use]
    pub fn view(&self) -> CameraView {
        self.seen.view
    }

    /// The camera of the current view.
    #[must_use]
    pub fn camera(&self) -> Camera {
        self.seen.camera()
    }

    /// Sets the size of the image; no side may be 0.
    pub fn resize(&mut self, size_px: [u32; 2]) {
        self.seen.size_px = size_px;
    }

    /// Sets the pixels per point of the screen: with smaller pixels, the same movement of the hand
    /// covers more of them.
    pub fn set_pixels_per_point(&mut self, pixels_per_point: f64) {
        self.pixels_per_point = pixels_per_point;
    }

    /// Multiplies all heights by `factor`; the middle of the image keeps its place. `ground` is the
    /// ground before the change.
    pub fn rescale_heights(&mut self, factor: f64, ground: &dyn KnownGround) {
        self.seen.rescale_heights(factor, ground);
        if let Some(held) = self.gesture.as_mut().and_then(Gesture::held_mut) {
            held.z *= factor;
        }
        if let Some(fingers) = &mut self.fingers {
            fingers.anchor.z *= factor;
        }
        self.pending.pivot = None;
        self.sighted = None;
        if let Some(travel) = &mut self.travel {
            travel.to.eye_in_world.z += ground.base_height() * (factor - 1.0);
        }
    }

    /// Whether the camera keeps moving without further input.
    #[must_use]
    pub fn is_moving(&self) -> bool {
        self.travel.is_some()
            || !self.flying.held.is_empty()
            || self.glide_m_per_s != DVec3::ZERO
            || self.pending.is_some()
    }

    /// Handles an input at a time, in seconds of any monotonic clock.
    pub fn handle(&mut self, input: &Input, now_s: f64, ground: &dyn KnownGround) {
        let was_moving = self.is_moving();
        match *input {
            Input::Press { button, at_px, modifiers } => {
                self.stop();
                self.cursor_px = at_px;
                self.gesture = self.begin(button, modifiers, ground);
                self.trail = Trail::begin(now_s, self.seen.view.eye_in_world);
            }
            Input::Move { at_px } => self.drag(at_px, now_s, ground),
            Input::Release { button } => {
                if self.gesture.is_some_and(|gesture| gesture.button() == button) {
                    self.throw(now_s);
                    self.gesture = None;
                }
            }
            Input::TwoFingers { at_px } => self.move_fingers(at_px, ground),
            Input::EndTwoFingers => self.fingers = None,
            Input::Wheel { steps, at_px } => {
                self.cursor_px = at_px;
                match self.mode {
                    Mode::Map => self.zoom(steps * LEVELS_PER_NOTCH, at_px, ground),
                    Mode::Fly => self.flying.turn_wheel(steps),
                }
            }
            Input::DoubleClick { at_px, modifiers } => {
                let levels = if modifiers.shift { -1.0 } else { 1.0 };
                self.zoom(levels, at_px, ground);
            }
            Input::Key { key, is_down, modifiers } => self.key(key, is_down, modifiers, ground),
            Input::Modify { modifiers } => self.flying.is_fast = modifiers.shift,
            Input::LetGo => {
                self.gesture = None;
                self.fingers = None;
                self.flying.let_go();
            }
            Input::NorthUp => {
                self.stop();
                self.pending.heading_deg = -half_turn(self.seen.view.orientation.heading_deg);
            }
            Input::Reset => self.travel_to(self.seen.home, now_s),
            Input::GoTo { target_in_world } => {
                self.travel_to(self.seen.looking_at(target_in_world, ground), now_s);
            }
            Input::ToggleFly => self.toggle_fly(),
            Input::ToggleAbove => self.toggle_above(ground),
        }
        self.settle(ground);
        self.keep_data_in_view(ground);
        // A camera that was already moving has yet to move for the time since the last step. A held
        // key repeats itself, and its repetitions must not consume that time.
        if !was_moving {
            self.now_s = now_s;
        }
    }

    /// Advances the time.
    pub fn advance(&mut self, now_s: f64, ground: &dyn KnownGround) {
        let dt_s = (now_s - self.now_s).clamp(0.0, MAX_STEP_S);
        self.now_s = now_s;
        self.advanced_s = now_s;
        if let Some(travel) = self.travel {
            let (view, is_done) = travel.view(now_s, self.has_inertia);
            self.seen.view = view;
            if is_done {
                self.travel = None;
            }
        }
        if !self.flying.held.is_empty() {
            self.seen.view.eye_in_world = self.flying.moved(&self.seen.view, dt_s);
        }
        if self.glide_m_per_s != DVec3::ZERO {
            self.seen.view.eye_in_world += self.glide_m_per_s * dt_s;
            self.glide_m_per_s *= libm::exp(-dt_s / GLIDE_DECAY_S);
            if self.glide_m_per_s.length() < GLIDE_MIN_PX_PER_S / 4.0 * self.seen.pixel_m() {
                self.glide_m_per_s = DVec3::ZERO;
            }
        }
        if self.pending.is_some() {
            let share = if self.has_inertia { 1.0 - libm::exp(-dt_s / STEP_DECAY_S) } else { 1.0 };
            self.do_pending(share, ground);
        }
        self.settle(ground);
        self.keep_data_in_view(ground);
    }

    /// Moves the eye back within its limits, and adapts the focus if the view was moved.
    fn settle(&mut self, ground: &dyn KnownGround) {
        let was = self.seen.view;
        self.seen.settle(ground);
        let is_where_it_was = self.seen.view.eye_in_world == was.eye_in_world;
        if self.placed == Some(was) && is_where_it_was {
            self.seen.view = was;
        }
    }

    /// In map mode, undoes a movement that leaves none of the data in view. A flight and the way to
    /// another view may leave the data; after them, the map moves freely until some of the data is
    /// in view again.
    fn keep_data_in_view(&mut self, ground: &dyn KnownGround) {
        if self.mode == Mode::Fly || self.travel.is_some() {
            self.sighted = None;
        } else if self.seen.shows_data(&self.seen.view, ground) {
            self.sighted = Some(self.seen.view);
        } else if let Some(last) = self.sighted
            // The data may have been seen in a window of another size.
            && self.seen.shows_data(&last, ground)
        {
            self.seen.view = last;
            self.glide_m_per_s = DVec3::ZERO;
            self.pending = Pending::default();
        }
    }

    /// Switches to another view at once, and stops all movements.
    pub fn jump_to(&mut self, view: CameraView) {
        self.drop_all();
        self.sighted = None;
        self.placed = Some(view);
        self.seen.view = view;
    }

    /// Moves to another view within the usual duration.
    pub fn travel_to(&mut self, view: CameraView, now_s: f64) {
        self.drop_all();
        self.mode = Mode::Map;
        if view.from_above.is_none() {
            self.seen.view = self.seen.view.in_perspective();
        }
        self.placed = Some(view);
        self.travel = Some(Travel { from: self.seen.view, to: view, begun_s: now_s });
    }

    fn toggle_above(&mut self, ground: &dyn KnownGround) {
        self.drop_all();
        self.flying.let_go();
        self.mode = Mode::Map;
        // Returning to a view in perspective would undo this movement.
        self.sighted = None;
        let view = &self.seen.view;
        self.seen.view = match view.from_above {
            None => {
                let middle = self.seen.middle(ground);
                let limits = &self.seen.limits;
                let range_m = [2.0 * limits.clearance_m, limits.far_m()];
                view.seen_from_above(middle, range_m, ground.heights())
            }
            Some(_) => view.in_perspective(),
        };
    }

    fn toggle_fly(&mut self) {
        self.drop_all();
        self.seen.view = self.seen.view.in_perspective();
        self.flying.let_go();
        self.mode = match self.mode {
            Mode::Map => Mode::Fly,
            Mode::Fly => Mode::Map,
        };
        let orientation = &mut self.seen.view.orientation;
        orientation.pitch_deg = orientation.pitch_deg.min(self.seen.limits.max_pitch_deg);
    }

    fn begin(
        &self,
        button: Button,
        modifiers: Modifiers,
        ground: &dyn KnownGround,
    ) -> Option<Gesture> {
        if self.mode == Mode::Fly {
            return Some(Gesture::Look { button });
        }
        let grabbed = || self.seen.ground_at(self.cursor_px, ground);
        match button {
            Button::Left if modifiers.control => {
                Some(Gesture::Turn { button, pivot: self.seen.middle(ground) })
            }
            Button::Left => grabbed().map(|anchor| Gesture::Pan { button, anchor }),
            Button::Right => Some(Gesture::Turn { button, pivot: self.seen.middle(ground) }),
            Button::Middle => grabbed().map(|pivot| Gesture::Turn { button, pivot }),
        }
    }

    fn drag(&mut self, at_px: DVec2, now_s: f64, ground: &dyn KnownGround) {
        let moved_points = (at_px - self.cursor_px) / self.pixels_per_point;
        self.cursor_px = at_px;
        let Orientation { heading_deg, pitch_deg } = self.seen.view.orientation;
        match self.gesture {
            None => return,
            Some(Gesture::Pan { anchor, .. }) => self.seen.pan_to(anchor, at_px, ground),
            Some(Gesture::Turn { pivot, .. }) => {
                let heading_deg = heading_deg + HEADING_DEG_PER_POINT * moved_points.x;
                let pitch_deg = pitch_deg - PITCH_DEG_PER_POINT * moved_points.y;
                self.seen.turn(pivot, heading_deg, pitch_deg, ground);
            }
            Some(Gesture::Look { .. }) => self.seen.look(
                heading_deg - LOOK_DEG_PER_POINT * moved_points.x,
                pitch_deg + LOOK_DEG_PER_POINT * moved_points.y,
            ),
        }
        self.trail.push(now_s, self.seen.view.eye_in_world);
    }

    /// Zooms, rotates or tilts. The ground grabbed between the fingers stays between them, or at
    /// its place while the map tilts.
    fn move_fingers(&mut self, at_px: [DVec2; 2], ground: &dyn KnownGround) {
        if self.mode == Mode::Fly {
            return;
        }
        let Some(fingers) = &mut self.fingers else {
            self.stop();
            self.gesture = None;
            let between_px = at_px[0].midpoint(at_px[1]);
            let anchor = self.seen.ground_at(between_px, ground);
            self.fingers = anchor.map(|anchor| Fingers::begin(anchor, at_px));
            return;
        };
        let anchor = fingers.anchor;
        let Orientation { heading_deg, pitch_deg } = self.seen.view.orientation;
        match fingers.move_to(at_px, self.pixels_per_point) {
            FingerStep::None => {}
            FingerStep::Tilt { points } => {
                let pitch_deg = pitch_deg - PITCH_DEG_PER_POINT * points;
                self.seen.turn(anchor, heading_deg, pitch_deg, ground);
            }
            FingerStep::Pinch { levels, clockwise_deg, between_px } => {
                // The zoom has reached its limit: the map still rotates and moves.
                self.seen.zoom_by(anchor, levels, ground);
                self.seen.turn(anchor, heading_deg - clockwise_deg, pitch_deg, ground);
                self.seen.pan_to(anchor, between_px, ground);
            }
        }
    }

    /// Makes the map glide on after a fast drag.
    fn throw(&mut self, now_s: f64) {
        let is_pan = matches!(self.gesture, Some(Gesture::Pan { .. }));
        if let Some(speed) = self.trail.speed_m_per_s(now_s, self.advanced_s)
            && is_pan
            && self.has_inertia
            && speed.length() > GLIDE_MIN_PX_PER_S * self.seen.pixel_m()
        {
            self.glide_m_per_s = speed;
        }
    }

    fn zoom(&mut self, levels: f64, at_px: DVec2, ground: &dyn KnownGround) {
        self.glide_m_per_s = DVec3::ZERO;
        self.travel = None;
        self.pending.pivot = self.seen.ground_at(at_px, ground);
        self.pending.zoom_levels += levels;
    }

    fn key(
        &mut self,
        key: CameraKey,
        is_down: bool,
        modifiers: Modifiers,
        ground: &dyn KnownGround,
    ) {
        if !is_down {
            self.flying.held.remove(&key);
            return;
        }
        let step_px = PAN_STEP_POINTS * self.pixels_per_point;
        let turn = |pending: &mut Pending, sideways: f64, upward: f64| {
            if modifiers.shift {
                pending.heading_deg += HEADING_STEP_DEG * sideways;
                pending.pitch_deg += PITCH_STEP_DEG * upward;
            } else {
                pending.pan_px += DVec2::new(sideways, upward) * step_px;
            }
        };
        let levels = if modifiers.shift { 2.0 } else { 1.0 };
        self.glide_m_per_s = DVec3::ZERO;
        self.travel = None;
        match key {
            CameraKey::Left => turn(&mut self.pending, -1.0, 0.0),
            CameraKey::Right => turn(&mut self.pending, 1.0, 0.0),
            CameraKey::Up => turn(&mut self.pending, 0.0, 1.0),
            CameraKey::Down => turn(&mut self.pending, 0.0, -1.0),
            CameraKey::ZoomIn => self.zoom(levels, self.seen.middle_px(), ground),
            CameraKey::ZoomOut => self.zoom(-levels, self.seen.middle_px(), ground),
            _ if self.mode == Mode::Fly => drop(self.flying.held.insert(key)),
            _ => {}
        }
    }

    /// Applies this share of the requested steps.
    fn do_pending(&mut self, share: f64, ground: &dyn KnownGround) {
        let asked = self.pending;
        let Pending { pan_px, heading_deg, pitch_deg, zoom_levels, pivot } =
            self.pending.take(share);
        if asked.zoom_levels != 0.0 {
            let pivot = pivot.unwrap_or_else(|| self.seen.middle(ground));
            if !self.seen.zoom_by(pivot, zoom_levels, ground) {
                self.pending.zoom_levels = 0.0;
            }
        }
        if asked.heading_deg != 0.0 || asked.pitch_deg != 0.0 {
            let middle = self.seen.middle(ground);
            let Orientation { heading_deg: heading, pitch_deg: pitch } = self.seen.view.orientation;
            let (heading, pitch) = (heading + heading_deg, pitch + pitch_deg);
            match self.mode {
                Mode::Map => self.seen.turn(middle, heading, pitch, ground),
                Mode::Fly => self.seen.look(half_turn(heading), pitch),
            }
        }
        self.seen.pan_by(pan_px);
    }

    /// Stops all movements and releases everything that a button or fingers hold.
    fn drop_all(&mut self) {
        self.stop();
        self.gesture = None;
        self.fingers = None;
    }

    fn stop(&mut self) {
        self.glide_m_per_s = DVec3::ZERO;
        self.pending = Pending::default();
        self.travel = None;
    }
}

#[cfg(test)]
#[path = "navigator_tests.rs"]
mod tests;
