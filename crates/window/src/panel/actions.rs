//! The panel's sections of buttons: they move the camera, change drawn lines, and save images and
//! flights.

use corniche_live::{
    DrawingCommand, DrawingContent, MapCommand, MapSettings, Shot, controls::Mode,
};
use egui::{Key, TextEdit, Ui};

use crate::window_content::WindowContent;

/// A button; its command is added to `commands`. An empty `hover` is not shown.
fn button(
    ui: &mut Ui,
    words: &str,
    hover: &str,
    command: MapCommand,
    commands: &mut Vec<MapCommand>,
) {
    let mut response = ui.button(words);
    if !hover.is_empty() {
        response = response.on_hover_text(hover);
    }
    if response.clicked() {
        commands.push(command);
    }
}

/// The section that moves the camera: buttons, and a place to go to.
pub(crate) fn camera(
    ui: &mut Ui,
    settings: &mut MapSettings,
    content: &WindowContent<'_>,
    commands: &mut Vec<MapCommand>,
) {
    ui.horizontal(|ui| {
        let fly = if content.mode == Mode::Fly { "Back to map (F)" } else { "Fly (F)" };
        button(ui, "North up (N)", "", MapCommand::NorthUp, commands);
        button(ui, "Reset (R)", "", MapCommand::Reset, commands);
        button(ui, fly, "", MapCommand::ToggleFly, commands);
    });
    ui.horizontal(|ui| {
        let field =
            TextEdit::singleline(&mut settings.place).hint_text("lon, lat").desired_width(160.0);
        let response = ui.add(field);
        let is_entered = response.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
        if is_entered {
            commands.push(MapCommand::GoTo);
        }
        let hover = "Longitude and latitude in degrees (WGS84), such as 9.52, 47.14";
        button(ui, "Go to", hover, MapCommand::GoTo, commands);
    });
    ui.horizontal(|ui| {
        let hover = "Switch between parallel rays and perspective";
        button(ui, "From above (T)", hover, MapCommand::ToggleAbove, commands);
        let hover = "Copies a command that draws this view to the clipboard";
        button(ui, "Copy this view (V)", hover, MapCommand::CopyView, commands);
    });
}

/// The section for lines that the user draws.
pub(crate) fn lines(ui: &mut Ui, content: &WindowContent<'_>, commands: &mut Vec<MapCommand>) {
    let DrawingContent { is_on, lines, is_picked, can_step, is_changed, last, .. } =
        &content.drawing;
    let mut button = |ui: &mut Ui, is_enabled: bool, words: &str, command: DrawingCommand| {
        if ui.add_enabled(is_enabled, egui::Button::new(words)).clicked() {
            commands.push(MapCommand::Draw(command));
        }
    };
    ui.horizontal(|ui| {
        let words = if *is_on { "Stop drawing (L)" } else { "Draw lines (L)" };
        button(ui, true, words, DrawingCommand::Toggle);
        button(ui, *is_changed, "Save (Ctrl S)", DrawingCommand::Save);
    });
    if *is_on {
        ui.horizontal(|ui| {
            button(ui, *is_picked, "End (Enter)", DrawingCommand::EndLine);
            button(ui, *is_picked, "- point (Del)", DrawingCommand::RemovePoint);
            button(ui, *is_picked, "- line", DrawingCommand::RemoveLine);
        });
        ui.horizontal(|ui| {
            button(ui, *is_picked, "Line or area (G)", DrawingCommand::Turn);
            button(ui, *is_picked, "Round corners (M)", DrawingCommand::Smooth);
        });
    }
    ui.horizontal(|ui| {
        button(ui, can_step[0], "Undo", DrawingCommand::Undo);
        button(ui, can_step[1], "Redo", DrawingCommand::Redo);
        let unsaved = if *is_changed { ", not saved" } else { "" };
        ui.label(format!("{lines} lines{unsaved}"));
    });
    if let Some((laid, ms)) = last {
        ui.label(format!("last change: {laid} tiles in {ms:.1} ms"));
    }
}

/// The section that saves images and records flights.
pub(crate) fn record(ui: &mut Ui, content: &WindowContent<'_>, commands: &mut Vec<MapCommand>) {
    ui.horizontal(|ui| {
        button(ui, "Map (P)", "Saves an image", MapCommand::Take(Shot::Map), commands);
        button(ui, "Window (Shift P)", "Saves an image", MapCommand::Take(Shot::Window), commands);
    });
    ui.horizontal(|ui| match content.recording_s {
        None => {
            let hover = "For corniche fly --path (key C)";
            button(ui, "Record flight", hover, MapCommand::StartRecording, commands);
        }
        Some(recording_s) => {
            button(ui, "Stop and save", "", MapCommand::StopRecording, commands);
            ui.label(format!("recording, {recording_s:.0} s"));
        }
    });
}
