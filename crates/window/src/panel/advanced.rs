//! The panel's section for what few people need: details of roads, widths and the fineness of the ground.

use corniche_roads::FunctionalRoadClass;
use corniche_viewer::{CapTest, Caps, Outline, Quads, WidthGrowth};
use egui::{ComboBox, Grid, Ui};

use super::slide::slide;
use crate::{
    settings::{Refinement, Settings, range},
    window_content::WindowContent,
};

/// The section for what few people need: how roads are drawn in detail, widths by class, how finely the ground is drawn.
pub(crate) fn show(ui: &mut Ui, settings: &mut Settings, content: &WindowContent<'_>) {
    road_choices(ui, settings);
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
    ui.checkbox(&mut settings.is_wireframe, "Wireframe");
    let mut is_frozen = settings.refinement == Refinement::Frozen;
    ui.checkbox(&mut is_frozen, "Freeze tiles")
        .on_hover_text("Keep what is drawn now while the camera moves");
    settings.refinement = if is_frozen { Refinement::Frozen } else { Refinement::Live };
    ui.label("Widths of classes");
    widths(ui, settings, content);
}

fn road_choices(ui: &mut Ui, settings: &mut Settings) {
    let roads = &mut settings.roads;
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
            "Quads (GEO)",
            &mut roads.quads,
            &[(Quads::Beds, "beds"), (Quads::Level, "level, the paper's")],
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

/// Factors on the style's widths.
fn widths(ui: &mut Ui, settings: &mut Settings, content: &WindowContent<'_>) {
    Grid::new("widths").num_columns(2).min_col_width(0.0).show(ui, |ui| {
        let rows = FunctionalRoadClass::all().zip(&mut settings.width_factors);
        for ((class, factor), label) in rows.zip(content.class_labels) {
            ui.add_enabled_ui(settings.roads.classes.contains(class), |ui| {
                slide(ui, factor, range::WIDTH_FACTOR, |slider| {
                    slider.prefix("× ").max_decimals(2)
                })
                .on_hover_text(format!("Factor on the style's width of {class}: {label}"));
            });
            ui.add(egui::Label::new(label).truncate());
            ui.end_row();
        }
    });
}
