//! The panel's section that moves the camera.

use egui::{Key, TextEdit, Ui};

use corniche_live::controls::Mode;

use crate::{command::Command, settings::Settings, window_content::WindowContent};

/// The section that moves the camera: buttons, and a place to go to.
pub(crate) fn show(
    ui: &mut Ui,
    settings: &mut Settings,
    content: &WindowContent<'_>,
    commands: &mut Vec<Command>,
) {
    ui.horizontal(|ui| {
        let fly = if content.mode == Mode::Fly { "Back to map (F)" } else { "Fly (F)" };
        for (words, command) in [
            ("North up (N)", Command::NorthUp),
            ("Reset (R)", Command::Reset),
            (fly, Command::ToggleFly),
        ] {
            if ui.button(words).clicked() {
                commands.push(command);
            }
        }
    });
    ui.horizontal(|ui| {
        let field =
            TextEdit::singleline(&mut settings.place).hint_text("lon, lat").desired_width(160.0);
        let response = ui.add(field);
        let is_entered = response.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
        let is_clicked = ui
            .button("Go to")
            .on_hover_text("Longitude and latitude in degrees (WGS84), such as 9.52, 47.14")
            .clicked();
        if is_entered || is_clicked {
            commands.push(Command::GoTo);
        }
    });
    ui.horizontal(|ui| {
        if ui.button("From above (T)").on_hover_text("With parallel rays, and back").clicked() {
            commands.push(Command::ToggleAbove);
        }
        let copy = ui.button("Copy this view (V)");
        if copy.on_hover_text("Puts a command that draws this view on the clipboard").clicked() {
            commands.push(Command::CopyView);
        }
    });
}
