//! The panel's section that saves pictures and records flights.

use egui::Ui;

use crate::{
    command::{Command, Shot},
    window_content::WindowContent,
};

/// The section that saves pictures and records flights.
pub(crate) fn show(ui: &mut Ui, content: &WindowContent<'_>, commands: &mut Vec<Command>) {
    ui.horizontal(|ui| {
        for (words, shot) in [("Map (P)", Shot::Map), ("Window (Shift P)", Shot::Window)] {
            if ui.button(words).on_hover_text("Saves a picture").clicked() {
                commands.push(Command::Take(shot));
            }
        }
    });
    ui.horizontal(|ui| match content.recording_s {
        None => {
            let start = ui.button("Record the camera's way");
            if start.on_hover_text("For corniche fly --path (key C)").clicked() {
                commands.push(Command::StartRecording);
            }
        }
        Some(recording_s) => {
            if ui.button("Stop and save").clicked() {
                commands.push(Command::StopRecording);
            }
            ui.label(format!("recording, {recording_s:.0} s"));
        }
    });
}
