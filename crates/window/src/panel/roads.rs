//! The panel's sections for the methods of drawing roads and for their classes.

use corniche_roads::FunctionalRoadClass;
use corniche_viewer::RoadMethod;
use egui::{Color32, Grid, Ui, vec2};

use crate::{
    settings::{Compare, Settings},
    window_content::WindowContent,
};

/// The section for the method and the comparison of both methods.
pub(crate) fn show(ui: &mut Ui, settings: &mut Settings) {
    ui.horizontal(|ui| {
        ui.label("Compare");
        let compare = &mut settings.compare;
        ui.selectable_value(compare, Compare::Off, "off");
        ui.selectable_value(compare, Compare::Split, "split")
            .on_hover_text("GEO to the left of the divider, SV to the right; drag it");
        ui.selectable_value(compare, Compare::Difference, "difference")
            .on_hover_text("Where GEO and SV show different classes");
    });
    let roads = &mut settings.roads;
    ui.add_enabled_ui(settings.compare == Compare::Off, |ui| {
        ui.horizontal(|ui| {
            ui.label("Method");
            ui.selectable_value(&mut roads.method, RoadMethod::Geometry, "GEO")
                .on_hover_text("Geometry lying on the ground");
            ui.selectable_value(&mut roads.method, RoadMethod::ShadowVolumes, "SV")
                .on_hover_text("Volumes cut with the ground");
            ui.selectable_value(&mut roads.method, RoadMethod::None, "none");
        });
    });
}

/// The section for the classes that are shown, which is also the legend of the map: colours and names.
pub(crate) fn classes(ui: &mut Ui, settings: &mut Settings, content: &WindowContent<'_>) {
    Grid::new("classes").num_columns(2).min_col_width(0.0).show(ui, |ui| {
        for (class, label) in FunctionalRoadClass::all().zip(content.class_labels) {
            let color = content.road_colors.get(usize::from(class.number()));
            let [red, green, blue] =
                color.copied().unwrap_or_default().map(|part| (part * 255.0).round() as u8);
            let (swatch, _) = ui.allocate_exact_size(vec2(18.0, 10.0), egui::Sense::hover());
            ui.painter().rect_filled(swatch, 2, Color32::from_rgb(red, green, blue));
            let shown = &mut settings.roads.classes;
            let mut is_shown = shown.contains(class);
            ui.checkbox(&mut is_shown, label).on_hover_text(class.to_string());
            *shown = if is_shown { shown.with(class) } else { shown.without(class) };
            ui.end_row();
        }
    });
}
