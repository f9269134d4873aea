use egui::{ComboBox, Slider, Ui};

use super::slide::slide;
use crate::{
    settings::{Refinement, Settings, range},
    window_content::WindowContent,
};

/// The section for style, heights and level of detail.
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
    slide(ui, &mut settings.screen_space_error_px, range::SCREEN_SPACE_ERROR_PX, |slider| {
        slider.suffix(" px").max_decimals(1).text("ground error")
    })
    .on_hover_text("A tile is refined while its error looks larger than this");
    ui.horizontal(|ui| {
        ui.label("Samples").on_hover_text("Per pixel; they are averaged");
        for samples in range::SAMPLES_PER_SIDE {
            let words = format!("{samples} × {samples}");
            ui.selectable_value(&mut settings.samples_per_side, samples, words);
        }
    });
    if let Some(of_style) = content.photo {
        let mut strength = settings.photo.unwrap_or(of_style);
        let slider = Slider::new(&mut strength, range::PHOTO).max_decimals(2).text("photo");
        if ui.add(slider).on_hover_text("How strongly the photo is seen").changed() {
            settings.photo = Some(strength);
        }
    }
    ui.checkbox(&mut settings.is_wireframe, "Wireframe");
    let mut is_frozen = settings.refinement == Refinement::Frozen;
    ui.checkbox(&mut is_frozen, "Freeze tiles")
        .on_hover_text("Keep what is drawn now while the camera moves");
    settings.refinement = if is_frozen { Refinement::Frozen } else { Refinement::Live };
}
