//! The panel's section for lines that a person draws.

use egui::Ui;

use crate::{
    command::{Command, DrawingCommand},
    window_content::{DrawingContent, WindowContent},
};

/// The section for lines that a person draws.
pub(crate) fn show(ui: &mut Ui, content: &WindowContent<'_>, commands: &mut Vec<Command>) {
    let DrawingContent { is_on, lines, is_picked, can_step, is_changed, last, .. } =
        &content.drawing;
    let mut button = |ui: &mut Ui, is_enabled: bool, words: &str, command: DrawingCommand| {
        if ui.add_enabled(is_enabled, egui::Button::new(words)).clicked() {
            commands.push(Command::Draw(command));
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
