use corniche_geom::Bounds;
use corniche_viewer::camera::{Camera, Orientation};
use glam::{DVec2, DVec3};

use super::{
    flying::Flying,
    input::{Button, Input, Key, KeyState, Modifiers},
    view::{KnownGround, View},
};

/// Heading per point of a drag, `MapLibre`'s; a point is a pixel of a screen that is not a fine one.
const HEADING_DEG_PER_POINT: f64 = 0.8;
/// Tilt per point of a drag, `MapLibre`'s.
const PITCH_DEG_PER_POINT: f64 = 0.5;
/// Both, per point, in fly mode.
const LOOK_DEG_PER_POINT: f64 = 0.15;
/// Zoom levels of a notch of the wheel: three of them halve the distance.
const LEVELS_PER_NOTCH: f64 = 1.0 / 3.0;
/// An arrow pans by so much, `MapLibre`'s.
const PAN_STEP_POINTS: f64 = 100.0;
/// Shift and an arrow turn by so much, `MapLibre`'s.
const HEADING_STEP_DEG: f64 = 15.0;
/// Shift and an arrow tilt by so much, `MapLibre`'s.
const PITCH_STEP_DEG: f64 = 10.0;
/// What is still to be done of a step shrinks to a third in this time.
const STEP_DECAY_S: f64 = 0.08;
/// What is left of a throw after a drag shrinks to a third in this time.
const GLIDE_DECAY_S: f64 = 0.25;
/// A throw's speed is measured over the last moments before the button goes up.
const THROW_WINDOW_S: f64 = 0.08;
/// Slower than so many pixels a second nothing glides.
const GLIDE_MIN_PX_PER_S: f64 = 60.0;
/// The longest time step: a program that was asleep does not jump. It is longer than most frames that a processor
/// draws, for whoever flies without a graphics card is to be no slower for it.
const MAX_STEP_S: f64 = 0.5;
/// Way back to the first view.
const RETURN_S: f64 = 0.8;
/// A drag over rising ground is solved at most so many times.
const PAN_SOLUTIONS: u32 = 64;
/// The eye is lifted by so much more than it lacks.
const LIFT_MARGIN_M: f64 = 1e-3;
/// What is less than this of a step, in its unit, is done at once.
const DONE: f64 = 1e-3;

/// How far the camera may go.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    /// The data in plan; the eye strays from them by no more than their larger side.
    pub data: Bounds,
    /// The eye stays so far above the ground, world metres.
    pub clearance_m: f64,
    /// Farthest tilt from straight down in map mode.
    pub max_pitch_deg: f64,
}

impl Limits {
    /// The farthest that anything may be grabbed, and the highest that the eye may go.
    fn far_m(&self) -> f64 {
        4.0 * self.data.width().max(self.data.height()).max(100.0)
    }
}

/// How a drag means the camera.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mode {
    /// As one moves a map on a table.
    Map,
    /// As one flies.
    Fly,
}

/// Whether movements run out softly or happen at once.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Inertia {
    /// They run out softly, and a map thrown glides on.
    On,
    /// They happen at once; for scripts and people whom movement disturbs.
    Off,
}

#[derive(Debug, Clone, Copy)]
enum Gesture {
    Pan { button: Button, anchor: DVec3 },
    Turn { button: Button, pivot: DVec3 },
    Look { button: Button },
}

impl Gesture {
    fn button(self) -> Button {
        match self {
            Self::Pan { button, .. } | Self::Turn { button, .. } | Self::Look { button } => button,
        }
    }
}

/// Movement that is still to come.
#[derive(Debug, Clone, Copy, Default)]
struct Pending {
    pan_px: DVec2,
    heading_deg: f64,
    pitch_deg: f64,
    zoom_levels: f64,
    /// Zoom is about this; about the middle without it.
    pivot: Option<DVec3>,
}

#[derive(Debug, Clone, Copy)]
struct Return {
    from: View,
    begun_s: f64,
}

/// Moves the camera as a person wants.
#[derive(Debug, Clone)]
pub struct Navigator {
    home: View,
    view: View,
    limits: Limits,
    size_px: [u32; 2],
    pixels_per_point: f64,
    mode: Mode,
    inertia: Inertia,
    cursor_px: DVec2,
    gesture: Option<Gesture>,
    /// Times and eyes of the last moves of a drag.
    trail: Vec<(f64, DVec3)>,
    glide_m_per_s: DVec3,
    pending: Pending,
    returning: Option<Return>,
    flying: Flying,
    now_s: f64,
    /// When a frame was last begun.
    advanced_s: f64,
}

impl Navigator {
    /// Begins with a view, to which [`Input::Reset`] returns. No side of the picture may be 0.
    #[must_use]
    pub fn new(home: View, limits: Limits, size_px: [u32; 2], inertia: Inertia) -> Self {
        Self {
            home,
            view: home,
            limits,
            size_px,
            pixels_per_point: 1.0,
            mode: Mode::Map,
            inertia,
            cursor_px: DVec2::ZERO,
            gesture: None,
            trail: Vec::new(),
            glide_m_per_s: DVec3::ZERO,
            pending: Pending::default(),
            returning: None,
            flying: Flying::default(),
            now_s: 0.0,
            advanced_s: 0.0,
        }
    }

    /// What is seen now.
    #[must_use]
    pub fn view(&self) -> View {
        self.view
    }

    /// The camera for it.
    #[must_use]
    pub fn camera(&self) -> Camera {
        self.view.camera(self.size_px)
    }

    /// Map or fly mode.
    #[must_use]
    pub fn mode(&self) -> Mode {
        self.mode
    }

    /// The picture has another size now; no side may be 0.
    pub fn resize(&mut self, size_px: [u32; 2]) {
        self.size_px = size_px;
    }

    /// The screen has so many pixels to a point: on a fine one, the same way of a hand is more of them.
    pub fn set_pixels_per_point(&mut self, pixels_per_point: f64) {
        self.pixels_per_point = pixels_per_point;
    }

    /// Movements run out softly from now on, or happen at once.
    pub fn set_inertia(&mut self, inertia: Inertia) {
        self.inertia = inertia;
    }

    /// Looks from elsewhere at once, and forgets whatever moved it.
    pub fn jump_to(&mut self, view: View) {
        self.stop();
        self.gesture = None;
        self.view = view;
    }

    /// All heights become `factor` times what they were: the middle of the picture keeps its place. `ground` is the
    /// ground before.
    pub fn rescale_heights(&mut self, factor: f64, ground: &dyn KnownGround) {
        let pivot = self.middle(ground);
        self.view.eye_in_world.z += pivot.z * (factor - 1.0);
        self.home.eye_in_world.z += ground.base_height() * (factor - 1.0);
        if let Some(Gesture::Pan { anchor: held, .. } | Gesture::Turn { pivot: held, .. }) =
            &mut self.gesture
        {
            held.z *= factor;
        }
        self.pending.pivot = None;
    }

    /// Whether the camera moves on without any further input.
    #[must_use]
    pub fn is_moving(&self) -> bool {
        self.returning.is_some()
            || self.flying.is_moving()
            || self.glide_m_per_s != DVec3::ZERO
            || self.pending.is_some()
    }

    /// Takes an input at a time, in seconds of any clock that does not run back.
    pub fn handle(&mut self, input: &Input, now_s: f64, ground: &dyn KnownGround) {
        let was_moving = self.is_moving();
        match *input {
            Input::Press { button, at_px, modifiers } => {
                self.stop();
                self.cursor_px = at_px;
                self.gesture = self.begin(button, modifiers, ground);
                self.trail = vec![(now_s, self.view.eye_in_world)];
            }
            Input::Move { at_px } => self.drag(at_px, now_s, ground),
            Input::Release { button } => {
                if self.gesture.is_some_and(|gesture| gesture.button() == button) {
                    self.throw(now_s);
                    self.gesture = None;
                }
            }
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
            Input::Key { key, state, modifiers } => self.key(key, state, modifiers, ground),
            Input::Modify { modifiers } => self.flying.set_fast(modifiers.shift),
            Input::LetGo => {
                self.gesture = None;
                self.flying.let_go();
            }
            Input::NorthUp => {
                self.stop();
                self.pending.heading_deg = -half_turn(self.view.orientation.heading_deg);
            }
            Input::Reset => {
                self.stop();
                self.gesture = None;
                self.mode = Mode::Map;
                self.returning = Some(Return { from: self.view, begun_s: now_s });
            }
            Input::ToggleFly => {
                self.stop();
                self.gesture = None;
                self.flying.let_go();
                self.mode = match self.mode {
                    Mode::Map => Mode::Fly,
                    Mode::Fly => Mode::Map,
                };
                let pitch_deg = self.view.orientation.pitch_deg.min(self.limits.max_pitch_deg);
                self.view.orientation.pitch_deg = pitch_deg;
            }
        }
        self.settle(ground);
        // What moved before has yet to move for the time since the last step: a key held down repeats itself, and what
        // it says again must not take that time away.
        if !was_moving {
            self.now_s = now_s;
        }
    }

    /// Lets time pass.
    pub fn advance(&mut self, now_s: f64, ground: &dyn KnownGround) {
        let dt_s = (now_s - self.now_s).clamp(0.0, MAX_STEP_S);
        self.now_s = now_s;
        self.advanced_s = now_s;
        if let Some(back) = self.returning {
            self.go_back(back, now_s);
        }
        if self.flying.is_moving() {
            self.view.eye_in_world = self.flying.moved(&self.view, dt_s);
        }
        if self.glide_m_per_s != DVec3::ZERO {
            self.view.eye_in_world += self.glide_m_per_s * dt_s;
            self.glide_m_per_s *= (-dt_s / GLIDE_DECAY_S).exp();
            if self.glide_m_per_s.length() < GLIDE_MIN_PX_PER_S / 4.0 * self.pixel_m() {
                self.glide_m_per_s = DVec3::ZERO;
            }
        }
        if self.pending.is_some() {
            let share = match self.inertia {
                Inertia::On => 1.0 - (-dt_s / STEP_DECAY_S).exp(),
                Inertia::Off => 1.0,
            };
            self.do_pending(share, ground);
        }
        self.settle(ground);
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
        let grabbed = || self.ground_at(self.cursor_px, ground);
        match button {
            Button::Left if modifiers.control => {
                Some(Gesture::Turn { button, pivot: self.middle(ground) })
            }
            Button::Left => grabbed().map(|anchor| Gesture::Pan { button, anchor }),
            Button::Right => Some(Gesture::Turn { button, pivot: self.middle(ground) }),
            Button::Middle => grabbed().map(|pivot| Gesture::Turn { button, pivot }),
        }
    }

    fn drag(&mut self, at_px: DVec2, now_s: f64, ground: &dyn KnownGround) {
        let moved_points = (at_px - self.cursor_px) / self.pixels_per_point;
        self.cursor_px = at_px;
        let Orientation { heading_deg, pitch_deg } = self.view.orientation;
        match self.gesture {
            None => return,
            Some(Gesture::Pan { anchor, .. }) => self.pan_to(anchor, ground),
            Some(Gesture::Turn { pivot, .. }) => {
                let heading_deg = heading_deg + HEADING_DEG_PER_POINT * moved_points.x;
                let pitch_deg = pitch_deg - PITCH_DEG_PER_POINT * moved_points.y;
                self.turn(pivot, heading_deg, pitch_deg, ground);
            }
            Some(Gesture::Look { .. }) => {
                self.view.orientation = Orientation {
                    heading_deg: heading_deg - LOOK_DEG_PER_POINT * moved_points.x,
                    pitch_deg: (pitch_deg + LOOK_DEG_PER_POINT * moved_points.y).clamp(0.0, 90.0),
                };
            }
        }
        // One move from before the window stays: where frames are slow there is no other to measure a speed by.
        let is_old = |(time_s, _): &(f64, DVec3)| now_s - time_s > THROW_WINDOW_S;
        let old = self.trail.iter().take_while(|mark| is_old(mark)).count();
        self.trail.drain(..old.saturating_sub(1));
        self.trail.push((now_s, self.view.eye_in_world));
    }

    /// Brings what was grabbed under the cursor. Ground in the way lifts the eye, which takes the grabbed point from
    /// under the cursor, so the plan is solved again. Where the ground behind the eye rises as steeply as the cursor's
    /// ray, that has no end; then the map stays where it is, as it does when thrown beyond the horizon.
    fn pan_to(&mut self, anchor: DVec3, ground: &dyn KnownGround) {
        let far_m = self.limits.far_m();
        let mut view = self.view;
        for _ in 0..PAN_SOLUTIONS {
            let Some(dragged) = view.dragged(anchor, self.cursor_px, self.size_px, far_m) else {
                return;
            };
            view = dragged;
            let lacks_m = view.lacks_m(self.limits.clearance_m, ground);
            if lacks_m <= 0.0 {
                self.view = view;
                return;
            }
            // A hair higher, so that halving the rest ends.
            view.eye_in_world.z += lacks_m + LIFT_MARGIN_M;
        }
    }

    /// Turns about a point, as far as the eye stays above the ground.
    fn turn(&mut self, pivot: DVec3, heading_deg: f64, pitch_deg: f64, ground: &dyn KnownGround) {
        let pitch_deg = pitch_deg.clamp(0.0, self.limits.max_pitch_deg);
        let with = |pitch_deg| {
            let heading_deg = half_turn(heading_deg);
            self.view.turned_about(pivot, Orientation { heading_deg, pitch_deg })
        };
        let lacks = |view: &View| view.lacks_m(self.limits.clearance_m, ground) > 0.0;
        let wanted = with(pitch_deg);
        // Steeper down one is higher above the pivot.
        self.view = if lacks(&wanted) {
            with(self.view.orientation.pitch_deg.min(pitch_deg))
        } else {
            wanted
        };
    }

    /// After a fast drag the map glides on.
    fn throw(&mut self, now_s: f64) {
        let is_pan = matches!(self.gesture, Some(Gesture::Pan { .. }));
        let (Some((from_s, from)), Some((to_s, to))) = (self.trail.first(), self.trail.last())
        else {
            return;
        };
        let is_throw =
            is_pan && self.inertia == Inertia::On && now_s - to_s <= THROW_WINDOW_S / 2.0;
        // What was done while a frame was drawn is heard of when it is, all at once: it may have taken as long as that.
        let dt_s = (to_s - from_s).max(now_s - self.advanced_s);
        if is_throw && dt_s > 0.0 {
            let velocity = ((*to - *from) / dt_s).with_z(0.0);
            if velocity.length() > GLIDE_MIN_PX_PER_S * self.pixel_m() {
                self.glide_m_per_s = velocity;
            }
        }
    }

    fn zoom(&mut self, levels: f64, at_px: DVec2, ground: &dyn KnownGround) {
        self.glide_m_per_s = DVec3::ZERO;
        self.returning = None;
        self.pending.pivot = self.ground_at(at_px, ground);
        self.pending.zoom_levels += levels;
    }

    fn key(&mut self, key: Key, state: KeyState, modifiers: Modifiers, ground: &dyn KnownGround) {
        if state == KeyState::Released {
            self.flying.release(key);
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
        self.returning = None;
        match key {
            Key::Left => turn(&mut self.pending, -1.0, 0.0),
            Key::Right => turn(&mut self.pending, 1.0, 0.0),
            Key::Up => turn(&mut self.pending, 0.0, 1.0),
            Key::Down => turn(&mut self.pending, 0.0, -1.0),
            Key::ZoomIn => self.zoom(levels, self.middle_px(), ground),
            Key::ZoomOut => self.zoom(-levels, self.middle_px(), ground),
            _ if self.mode == Mode::Fly => self.flying.press(key),
            _ => {}
        }
    }

    fn do_pending(&mut self, share: f64, ground: &dyn KnownGround) {
        let Pending { pan_px, heading_deg, pitch_deg, zoom_levels, pivot } = self.pending;
        let left = Pending {
            pan_px: pan_px * (1.0 - share),
            heading_deg: heading_deg * (1.0 - share),
            pitch_deg: pitch_deg * (1.0 - share),
            zoom_levels: zoom_levels * (1.0 - share),
            pivot,
        };
        // The last of it at once, so that it comes to an end.
        let (share, left) = if left.is_some() { (share, left) } else { (1.0, Pending::default()) };
        self.pending = left;
        if zoom_levels != 0.0 {
            let pivot = pivot.unwrap_or_else(|| self.middle(ground));
            self.zoom_by(pivot, zoom_levels * share, ground);
        }
        if heading_deg != 0.0 || pitch_deg != 0.0 {
            let middle = self.middle(ground);
            let Orientation { heading_deg: heading, pitch_deg: pitch } = self.view.orientation;
            let (heading, pitch) = (heading + heading_deg * share, pitch + pitch_deg * share);
            match self.mode {
                Mode::Map => self.turn(middle, heading, pitch, ground),
                Mode::Fly => {
                    let pitch_deg = pitch.clamp(0.0, 90.0);
                    let heading_deg = half_turn(heading);
                    self.view.orientation = Orientation { heading_deg, pitch_deg };
                }
            }
        }
        let axes = self.view.world_from_view();
        let ahead = DVec3::Z.cross(axes.x_axis);
        let step_px = pan_px * share;
        self.view.eye_in_world += (axes.x_axis * step_px.x + ahead * step_px.y) * self.pixel_m();
    }

    /// Zooms in until the eye would be too low or too near, out until it is too far.
    fn zoom_by(&mut self, pivot: DVec3, levels: f64, ground: &dyn KnownGround) {
        let zoomed = self.view.zoomed_at(pivot, (-levels).exp2());
        let distance_m = zoomed.eye_in_world.distance(pivot);
        let is_too_low = levels > 0.0
            && (zoomed.lacks_m(self.limits.clearance_m, ground) > 0.0
                || distance_m < 2.0 * self.limits.clearance_m);
        let is_too_far = levels < 0.0 && distance_m > self.limits.far_m();
        if is_too_low || is_too_far {
            self.pending.zoom_levels = 0.0;
        } else {
            self.view = zoomed;
        }
    }

    fn go_back(&mut self, Return { from, begun_s }: Return, now_s: f64) {
        let t = match self.inertia {
            Inertia::On => ((now_s - begun_s) / RETURN_S).clamp(0.0, 1.0),
            Inertia::Off => 1.0,
        };
        let share = t * t * (3.0 - 2.0 * t);
        let home = self.home;
        let turn_deg = half_turn(home.orientation.heading_deg - from.orientation.heading_deg);
        let pitch_deg = from.orientation.pitch_deg
            + share * (home.orientation.pitch_deg - from.orientation.pitch_deg);
        self.view = View {
            eye_in_world: from.eye_in_world.lerp(home.eye_in_world, share),
            orientation: Orientation {
                heading_deg: from.orientation.heading_deg + share * turn_deg,
                pitch_deg,
            },
            focus_m: home.focus_m,
        };
        if t >= 1.0 {
            self.view = home;
            self.returning = None;
        }
    }

    /// Keeps the eye over the data and above the ground, and the focus with it.
    fn settle(&mut self, ground: &dyn KnownGround) {
        let Bounds { min_x, min_y, max_x, max_y } = self.limits.data;
        let stray_m = (max_x - min_x).max(max_y - min_y).max(100.0);
        let eye = &mut self.view.eye_in_world;
        let home = self.home.eye_in_world;
        // The first view is allowed, wherever it is.
        eye.x = eye.x.clamp((min_x - stray_m).min(home.x), (max_x + stray_m).max(home.x));
        eye.y = eye.y.clamp((min_y - stray_m).min(home.y), (max_y + stray_m).max(home.y));
        eye.z = eye.z.min((ground.base_height() + self.limits.far_m()).max(home.z));
        let lacks_m = self.view.lacks_m(self.limits.clearance_m, ground);
        self.view.eye_in_world.z += lacks_m.max(0.0);
        self.view = self.view.refocused(ground);
    }

    fn stop(&mut self) {
        self.glide_m_per_s = DVec3::ZERO;
        self.pending = Pending::default();
        self.returning = None;
    }

    fn middle_px(&self) -> DVec2 {
        let [width, height] = self.size_px.map(f64::from);
        DVec2::new(width / 2.0, height / 2.0)
    }

    fn ground_at(&self, at_px: DVec2, ground: &dyn KnownGround) -> Option<DVec3> {
        self.view.ground_at(at_px, self.size_px, self.limits.far_m(), ground)
    }

    /// The ground in the middle of the picture; over the horizon, what is as far away as the focus.
    fn middle(&self, ground: &dyn KnownGround) -> DVec3 {
        self.ground_at(self.middle_px(), ground).unwrap_or_else(|| {
            self.view.eye_in_world - self.view.world_from_view().z_axis * self.view.focus_m
        })
    }

    /// Side of a pixel in the middle of the picture, world metres.
    fn pixel_m(&self) -> f64 {
        self.camera().pixel_at_unit_depth_m() * self.view.focus_m
    }
}

impl Pending {
    fn is_some(&self) -> bool {
        self.pan_px.abs().max_element() > DONE
            || self.heading_deg.abs() > DONE
            || self.pitch_deg.abs() > DONE
            || self.zoom_levels.abs() > DONE
    }
}

/// The same direction between −180° and 180°.
fn half_turn(heading_deg: f64) -> f64 {
    (heading_deg + 180.0).rem_euclid(360.0) - 180.0
}

#[cfg(test)]
#[path = "navigator_tests.rs"]
mod tests;
