//! The panel's section for style, heights, areas, lines of files and photos.

use corniche_viewer::BoundaryLines;
use egui::{Color32, ComboBox, Label, Rect, RichText, Slider, Ui, pos2, vec2};

use super::slide::slide;
use crate::{
    Visibility,
    settings::{Settings, range},
    window_content::WindowContent,
};

/// The section for style, heights, areas, lines of files and photos.
pub(crate) fn show(ui: &mut Ui, settings: &mut Settings, content: &WindowContent<'_>) {
    ui.horizontal(|ui| {
        ui.label("Style");
        let chosen = content.style_names.get(settings.style).map_or("", String::as_str);
        ComboBox::from_id_salt("style").width(180.0).truncate().selected_text(chosen).show_ui(
            ui,
            |ui| {
                for (place, name) in content.style_names.iter().enumerate() {
                    ui.selectable_value(&mut settings.style, place, name);
                }
            },
        );
    });
    slide(ui, &mut settings.exaggeration, range::EXAGGERATION, |slider| {
        slider.prefix("× ").max_decimals(2).text("heights")
    });
    if content.has.areas {
        let mut are_shown = settings.areas == Visibility::Shown;
        ui.checkbox(&mut are_shown, "Areas")
            .on_hover_text("Water, forest … as the style draws them");
        settings.areas = if are_shown { Visibility::Shown } else { Visibility::Hidden };
    }
    if content.has.boundaries {
        let mut are_shown = settings.boundaries == Visibility::Shown;
        ui.checkbox(&mut are_shown, "Boundaries").on_hover_text("As the style draws them");
        settings.boundaries = if are_shown { Visibility::Shown } else { Visibility::Hidden };
        if are_shown {
            boundaries(ui, &content.boundary_lines);
        }
    }
    for (number, (name, color)) in content.overlays.iter().zip(&content.overlay_colors).enumerate()
    {
        ui.horizontal(|ui| {
            let mut is_shown = !settings.hidden_overlays.contains(&number);
            let [red, green, blue] = color.map(|channel| (channel * 255.0).round() as u8);
            let mark = RichText::new("■").color(Color32::from_rgb(red, green, blue));
            if ui.checkbox(&mut is_shown, name).on_hover_text("The lines of this file").changed() {
                if is_shown {
                    settings.hidden_overlays.remove(&number);
                } else {
                    settings.hidden_overlays.insert(number);
                }
            }
            ui.label(mark);
        });
    }
    if let Some(of_style) = content.photo {
        let mut strength = settings.photo.unwrap_or(of_style);
        let slider = Slider::new(&mut strength, range::PHOTO).max_decimals(2).text("photo");
        if ui.add(slider).on_hover_text("How strongly the photo is seen").changed() {
            settings.photo = Some(strength);
        }
    }
}

/// The legend of boundaries: how they are drawn, and what they are called.
fn boundaries(ui: &mut Ui, all: &[BoundaryLines]) {
    for BoundaryLines { label, style } in all {
        ui.horizontal(|ui| {
            let (swatch, _) = ui.allocate_exact_size(vec2(36.0, 10.0), egui::Sense::hover());
            let [red, green, blue] = style.color.map(|part| (part * 255.0).round() as u8);
            for column in 0..swatch.width() as u16 {
                let along = f32::from(column) + 0.5;
                let width = style.width_px * style.dash.width_at(along);
                let middle = pos2(swatch.left() + along, swatch.center().y);
                let part = Rect::from_center_size(middle, vec2(1.0, width));
                ui.painter().rect_filled(part, 0, Color32::from_rgb(red, green, blue));
            }
            ui.add(Label::new(label).wrap());
        });
    }
}
