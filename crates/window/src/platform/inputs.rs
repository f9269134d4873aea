//! Events of the window system, translated into inputs and commands of the app.

use corniche_live::controls::{Button, Input, Key, KeyState, Modifiers};
use glam::DVec2;
use winit::{
    event::{ElementState, MouseButton, MouseScrollDelta, WindowEvent},
    keyboard::{KeyCode, ModifiersState, NamedKey, PhysicalKey},
};

use crate::{
    app::App,
    command::{Command, DrawingCommand, Shot},
};

/// Scrolling by this much on a touchpad counts as a notch of a wheel.
const POINTS_PER_NOTCH: f64 = 50.0;

/// Modifier keys that are held, and the position of the cursor.
#[derive(Debug, Default)]
pub(crate) struct Inputs {
    modifiers: Modifiers,
    cursor_px: DVec2,
    /// The last position of the cursor and its time, not yet handed to the app. Mice report many positions in a frame, and
    /// each that is handed on costs a search of the ground.
    moved: Option<(DVec2, f64)>,
}

/// Whether this event is the key that shows and hides the panel. The panel's toolkit must not see it, for it uses this key
/// itself.
pub(crate) fn is_panel_key(event: &WindowEvent) -> bool {
    matches!(event, WindowEvent::KeyboardInput { event, .. }
        if event.logical_key == winit::keyboard::Key::Named(NamedKey::Tab))
}

/// Ctrl Q ends the program, also where the window has no frame with a button for it.
///
/// If the keys are still held from another window when this window gets the keyboard, they must not end this program: the
/// window library then reports them as synthetic presses, and after that their repetitions as if they were new presses.
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

fn is_q(logical: &winit::keyboard::Key) -> bool {
    use winit::keyboard::Key as Logical;
    matches!(logical, Logical::Character(letter) if letter.eq_ignore_ascii_case("q"))
}

impl Inputs {
    /// Hands the last position of the cursor to the app, if it moved. To be called before each frame and before any other
    /// event is handed on.
    pub(crate) fn hand_on_move(&mut self, app: &mut App) {
        if let Some((at_px, moved_s)) = self.moved.take() {
            app.input(&Input::Move { at_px }, moved_s);
        }
    }

    /// Hands an event to the app, or keeps it for [`Inputs::hand_on_move`]. Returns whether a frame is needed.
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
                app.input(&Input::Modify { modifiers: self.modifiers }, now_s);
                false
            }
            WindowEvent::CursorMoved { position, .. } => {
                self.cursor_px = DVec2::new(position.x, position.y);
                self.moved = Some((self.cursor_px, now_s));
                app.point_at(Some(self.cursor_px));
                true
            }
            WindowEvent::CursorLeft { .. } => {
                app.point_at(None);
                true
            }
            WindowEvent::MouseInput { state, button, .. } => {
                self.click(*state, *button, app, ui, now_s)
            }
            WindowEvent::MouseWheel { delta, .. } => self.wheel(*delta, app, ui, now_s),
            WindowEvent::Focused(false) => {
                app.input(&Input::LetGo, now_s);
                true
            }
            WindowEvent::KeyboardInput { event, is_synthetic, .. } => {
                let is_down = event.state == ElementState::Pressed;
                // What is typed into a text field is not meant for the map, but a release counts everywhere. A key that is
                // held when the window gets the keyboard is reported twice, first as synthetic: that report is ignored.
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
            app.input(&Input::Wheel { steps, at_px: self.cursor_px }, now_s);
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
                app.press(button, self.cursor_px, self.modifiers, now_s);
            }
            ElementState::Pressed => return false,
            ElementState::Released => app.input(&Input::Release { button }, now_s),
        }
        true
    }

    fn key(&self, event: &winit::event::KeyEvent, app: &mut App, now_s: f64) -> bool {
        let state = match event.state {
            ElementState::Pressed => KeyState::Pressed,
            ElementState::Released => KeyState::Released,
        };
        // A release is always the camera's: the key may have been pressed before Control was.
        if state == KeyState::Pressed
            && let Some(command) =
                drawing_command(&event.logical_key, self.modifiers, app.is_drawing())
        {
            let is_once = matches!(
                command,
                DrawingCommand::Toggle
                    | DrawingCommand::Turn
                    | DrawingCommand::Smooth
                    | DrawingCommand::Save
            );
            if !(event.repeat && is_once) {
                app.command(Command::Draw(command), now_s);
            }
            return true;
        }
        if let Some(key) = moving_key(&event.logical_key, event.physical_key) {
            app.input(&Input::Key { key, state, modifiers: self.modifiers }, now_s);
            return true;
        }
        if state == KeyState::Released || event.repeat {
            return false;
        }
        let Some(command) = command(&event.logical_key, self.modifiers) else { return false };
        app.command(command, now_s);
        true
    }
}

fn held(state: ModifiersState) -> Modifiers {
    Modifiers {
        shift: state.contains(ModifiersState::SHIFT),
        control: state.contains(ModifiersState::CONTROL),
    }
}

/// The key that moves the camera. Arrows, + and − are told by what is printed on them, the keys of fly mode by their
/// position on the keyboard.
fn moving_key(logical: &winit::keyboard::Key, physical: PhysicalKey) -> Option<Key> {
    use winit::keyboard::Key as Logical;
    let named = match logical {
        Logical::Named(NamedKey::ArrowLeft) => Some(Key::Left),
        Logical::Named(NamedKey::ArrowRight) => Some(Key::Right),
        Logical::Named(NamedKey::ArrowUp) => Some(Key::Up),
        Logical::Named(NamedKey::ArrowDown) => Some(Key::Down),
        Logical::Character(sign) => match sign.as_str() {
            "+" | "=" => Some(Key::ZoomIn),
            "-" | "_" => Some(Key::ZoomOut),
            _ => None,
        },
        _ => None,
    };
    named.or(match physical {
        PhysicalKey::Code(KeyCode::KeyW) => Some(Key::Ahead),
        PhysicalKey::Code(KeyCode::KeyS) => Some(Key::Back),
        PhysicalKey::Code(KeyCode::KeyA) => Some(Key::StrafeLeft),
        PhysicalKey::Code(KeyCode::KeyD) => Some(Key::StrafeRight),
        PhysicalKey::Code(KeyCode::KeyE) => Some(Key::Rise),
        PhysicalKey::Code(KeyCode::KeyQ) => Some(Key::Sink),
        _ => None,
    })
}

/// The key that does something to drawn lines. With Control, keys of fly mode are these.
fn drawing_command(
    logical: &winit::keyboard::Key,
    modifiers: Modifiers,
    is_drawing: bool,
) -> Option<DrawingCommand> {
    use winit::keyboard::Key as Logical;
    if let Logical::Character(letter) = logical {
        return match (letter.to_lowercase().as_str(), modifiers) {
            ("l", Modifiers { control: false, .. }) => Some(DrawingCommand::Toggle),
            ("z", Modifiers { control: true, shift: false }) => Some(DrawingCommand::Undo),
            ("z" | "y", Modifiers { control: true, .. }) => Some(DrawingCommand::Redo),
            ("s", Modifiers { control: true, .. }) => Some(DrawingCommand::Save),
            ("g", Modifiers { control: false, .. }) if is_drawing => Some(DrawingCommand::Turn),
            ("m", Modifiers { control: false, .. }) if is_drawing => Some(DrawingCommand::Smooth),
            _ => None,
        };
    }
    match logical {
        Logical::Named(NamedKey::Enter) if is_drawing => Some(DrawingCommand::EndLine),
        Logical::Named(NamedKey::Delete | NamedKey::Backspace) if is_drawing => {
            let is_line = modifiers.shift;
            Some(if is_line { DrawingCommand::RemoveLine } else { DrawingCommand::RemovePoint })
        }
        _ => None,
    }
}

fn command(logical: &winit::keyboard::Key, modifiers: Modifiers) -> Option<Command> {
    use winit::keyboard::Key as Logical;
    match logical {
        Logical::Named(NamedKey::Home) => Some(Command::Reset),
        Logical::Named(NamedKey::Tab) => Some(Command::TogglePanel),
        Logical::Named(NamedKey::Escape) => Some(Command::CloseHelp),
        Logical::Character(letter) => match letter.to_lowercase().as_str() {
            "n" => Some(Command::NorthUp),
            "r" => Some(Command::Reset),
            "f" => Some(Command::ToggleFly),
            "t" => Some(Command::ToggleAbove),
            "c" => Some(Command::ToggleRecording),
            "v" => Some(Command::CopyView),
            "?" => Some(Command::ToggleHelp),
            "p" if modifiers.shift => Some(Command::Take(Shot::Window)),
            "p" => Some(Command::Take(Shot::Map)),
            _ => None,
        },
        _ => None,
    }
}

#[cfg(test)]
#[path = "inputs_tests.rs"]
mod tests;
