use corniche_roads::FunctionalRoadClass;
use corniche_viewer::{CapTest, Caps, Outline, RoadMethod, WidthGrowth};
use egui::{Color32, ComboBox, Grid, Ui, vec2};

use super::slide::slide;
use crate::{
    settings::{Compare, Settings, range},
    window_content::WindowContent,
};

/// The section for the method, the comparison of both methods, and the options of roads.
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
    Grid::new("roads").num_columns(2).show(ui, |ui| {
        choice(ui, "Caps", &mut roads.caps, &[(Caps::Round, "round"), (Caps::None, "none")]);
        choice(
            ui,
            "Cap test (SV)",
            &mut roads.cap_test,
            &[(CapTest::Distance, "distance"), (CapTest::PaperQuadratic, "paper's quadratic")],
        );
        choice(
            ui,
            "Widths",
            &mut roads.width_growth,
            &[
                (WidthGrowth::ByDistance, "grow with distance"),
                (WidthGrowth::Constant, "times a constant"),
                (WidthGrowth::None, "true"),
            ],
        );
        choice(
            ui,
            "Outline",
            &mut roads.outline,
            &[
                (Outline::OfStyle, "of the style"),
                (Outline::None, "none"),
                (Outline::Kernel3, "3 × 3"),
                (Outline::Kernel5, "5 × 5"),
            ],
        );
    });
}

fn choice<T: Copy + PartialEq>(ui: &mut Ui, name: &str, value: &mut T, all: &[(T, &str)]) {
    ui.label(name);
    let chosen = all.iter().find(|(one, _)| one == value).map_or("", |(_, words)| words);
    ComboBox::from_id_salt(name).width(150.0).selected_text(chosen).show_ui(ui, |ui| {
        for (one, words) in all {
            ui.selectable_value(value, *one, *words);
        }
    });
    ui.end_row();
}

/// The section for the classes that are shown, and their widths.
pub(crate) fn classes(ui: &mut Ui, settings: &mut Settings, content: &WindowContent<'_>) {
    Grid::new("classes").num_columns(3).min_col_width(0.0).show(ui, |ui| {
        for (class, factor) in FunctionalRoadClass::all().zip(&mut settings.width_factors) {
            let color = content.road_colors.get(usize::from(class.number()));
            let [red, green, blue] =
                color.copied().unwrap_or_default().map(|part| (part * 255.0).round() as u8);
            let (swatch, _) = ui.allocate_exact_size(vec2(18.0, 10.0), egui::Sense::hover());
            ui.painter().rect_filled(swatch, 2, Color32::from_rgb(red, green, blue));
            let shown = &mut settings.roads.classes;
            let mut is_shown = shown.contains(class);
            ui.checkbox(&mut is_shown, class.to_string());
            *shown = if is_shown { shown.with(class) } else { shown.without(class) };
            ui.add_enabled_ui(is_shown, |ui| {
                slide(ui, factor, range::WIDTH_FACTOR, |slider| {
                    slider.prefix("× ").max_decimals(2)
                })
                .on_hover_text("Factor on the style's width");
            });
            ui.end_row();
        }
    });
}
