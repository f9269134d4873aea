//! Events of the window system, translated into inputs and commands of the app.

use corniche_live::{
    DrawingCommand, MapCommand,
    controls::{Button, CameraKey, Input, Modifiers},
};
use glam::DVec2;
use winit::{
    event::{ElementState, KeyEvent, MouseButton, MouseScrollDelta, WindowEvent},
    keyboard::{Key as LogicalKey, ModifiersState, NamedKey, PhysicalKey},
};

use crate::app::App;

/// Scrolling by this much on a touchpad counts as a notch of a wheel.
const POINTS_PER_NOTCH: f64 = 50.0;

/// Modifier keys that are held, and the position of the cursor.
#[derive(Debug, Default)]
pub(crate) struct PointerState {
    modifiers: Modifiers,
    cursor_px: DVec2,
    /// The last position of the cursor and its time, not yet passed to the app. Mice report many
    /// positions per frame, and each one passed on costs a search of the ground.
    moved: Option<(DVec2, f64)>,
}

/// Whether this event is the key that shows and hides the panel. The toolkit must not see the
/// event, because it uses this key itself.
pub(crate) fn is_panel_key(event: &WindowEvent) -> bool {
    matches!(event, WindowEvent::KeyboardInput { event, .. }
        if event.logical_key == LogicalKey::Named(NamedKey::Tab))
}

/// The state of Ctrl Q, which ends the program, even in a window without a frame and its close
/// button.
///
/// If the keys are still held from another window when this window gets the keyboard, they must not
/// end this program: the window library then reports them as synthetic presses, and afterwards
/// reports their repetitions like new presses.
#[derive(Debug, Default)]
pub(crate) struct EndKey {
    is_control_down: bool,
    is_held_from_before: bool,
}

impl EndKey {
    /// Whether this event ends the program.
    pub(crate) fn take(&mut self, event: &WindowEvent) -> bool {
        match event {
            WindowEvent::ModifiersChanged(modifiers) => {
                self.is_control_down = modifiers.state().control_key();
                false
            }
            WindowEvent::KeyboardInput { event, is_synthetic, .. } if is_q(&event.logical_key) => {
                self.press(event.state == ElementState::Pressed, *is_synthetic)
            }
            _ => false,
        }
    }

    fn press(&mut self, is_down: bool, is_synthetic: bool) -> bool {
        self.is_held_from_before = is_down && (self.is_held_from_before || is_synthetic);
        is_down && self.is_control_down && !self.is_held_from_before
    }
}

fn is_q(logical: &LogicalKey) -> bool {
    matches!(logical, LogicalKey::Character(letter) if letter.eq_ignore_ascii_case("q"))
}

impl PointerState {
    /// Passes the last position of the cursor to the app, if it moved. Call this before each frame
    /// and before passing on any other event.
    pub(crate) fn hand_on_move(&mut self, app: &mut App) {
        if let Some((at_px, moved_s)) = self.moved.take() {
            app.desk.input(&Input::Move { at_px }, moved_s);
        }
    }

    /// Passes an event to the app, or keeps it for [`PointerState::hand_on_move`]. Returns whether
    /// a frame is needed.
    pub(crate) fn take(
        &mut self,
        event: &WindowEvent,
        app: &mut App,
        ui: &egui::Context,
        now_s: f64,
    ) -> bool {
        let is_mere_move =
            matches!(event, WindowEvent::CursorMoved { .. } | WindowEvent::AxisMotion { .. });
        if !is_mere_move {
            self.hand_on_move(app);
        }
        match event {
            WindowEvent::ModifiersChanged(modifiers) => {
                self.modifiers = held(modifiers.state());
                app.desk.input(&Input::Modify { modifiers: self.modifiers }, now_s);
                false
            }
            WindowEvent::CursorMoved { position, .. } => {
                self.cursor_px = DVec2::new(position.x, position.y);
                self.moved = Some((self.cursor_px, now_s));
                app.desk.session.cursor_px = Some(self.cursor_px);
                true
            }
            WindowEvent::CursorLeft { .. } => {
                app.desk.session.cursor_px = None;
                true
            }
            WindowEvent::MouseInput { state, button, .. } => {
                self.click(*state, *button, app, ui, now_s)
            }
            WindowEvent::MouseWheel { delta, .. } => self.wheel(*delta, app, ui, now_s),
            WindowEvent::Focused(false) => {
                app.desk.input(&Input::LetGo, now_s);
                true
            }
            WindowEvent::KeyboardInput { event, is_synthetic, .. } => {
                let is_down = event.state == ElementState::Pressed;
                // Text typed into a text field is not meant for the map, but a release counts
                // everywhere. A key that is held when the window gets the keyboard is reported
                // twice, first as synthetic: that report is ignored.
                if is_down && (*is_synthetic || ui.text_edit_focused()) {
                    return false;
                }
                self.key(event, app, now_s)
            }
            _ => false,
        }
    }

    fn wheel(
        &self,
        delta: MouseScrollDelta,
        app: &mut App,
        ui: &egui::Context,
        now_s: f64,
    ) -> bool {
        let steps = match delta {
            MouseScrollDelta::LineDelta(_, lines) => f64::from(lines),
            MouseScrollDelta::PixelDelta(way) => {
                way.y / (POINTS_PER_NOTCH * f64::from(ui.pixels_per_point()))
            }
        };
        let is_maps = app.is_map(ui, self.cursor_px);
        if is_maps {
            app.desk.input(&Input::Wheel { steps, at_px: self.cursor_px }, now_s);
        }
        is_maps
    }

    fn click(
        &mut self,
        state: ElementState,
        button: MouseButton,
        app: &mut App,
        ui: &egui::Context,
        now_s: f64,
    ) -> bool {
        let button = match button {
            MouseButton::Left => Button::Left,
            MouseButton::Middle => Button::Middle,
            MouseButton::Right => Button::Right,
            _ => return false,
        };
        match state {
            ElementState::Pressed if app.is_map(ui, self.cursor_px) => {
                app.desk.press(button, self.cursor_px, self.modifiers, now_s);
            }
            ElementState::Pressed => return false,
            ElementState::Released => app.desk.input(&Input::Release { button }, now_s),
        }
        true
    }

    fn key(&self, event: &KeyEvent, app: &mut App, now_s: f64) -> bool {
        let is_down = event.state == ElementState::Pressed;
        let (sign, code) = names(&event.logical_key, event.physical_key);
        // A release always belongs to the camera: the key may have been pressed before Control was.
        if is_down
            && let Some(command) =
                DrawingCommand::of_key(&sign, self.modifiers, app.desk.drawing.is_on)
        {
            if !(event.repeat && command.is_once()) {
                app.command(MapCommand::Draw(command), now_s);
            }
            return true;
        }
        if let Some(key) = CameraKey::from_sign(&sign, &code) {
            app.desk.input(&Input::Key { key, is_down, modifiers: self.modifiers }, now_s);
            return true;
        }
        if !is_down || event.repeat {
            return false;
        }
        let Some(command) = MapCommand::of_key(&sign, self.modifiers) else { return false };
        app.command(command, now_s);
        true
    }
}

/// The label of a key and its position on the keyboard, as W3C names, which the window library uses
/// too.
fn names(logical: &LogicalKey, physical: PhysicalKey) -> (String, String) {
    let sign = match logical {
        LogicalKey::Character(sign) => sign.to_string(),
        LogicalKey::Named(name) => format!("{name:?}"),
        _ => String::new(),
    };
    let code = match physical {
        PhysicalKey::Code(code) => format!("{code:?}"),
        PhysicalKey::Unidentified(_) => String::new(),
    };
    (sign, code)
}

fn held(state: ModifiersState) -> Modifiers {
    Modifiers {
        shift: state.contains(ModifiersState::SHIFT),
        control: state.contains(ModifiersState::CONTROL),
    }
}

#[cfg(test)]
#[path = "inputs_tests.rs"]
mod tests;
