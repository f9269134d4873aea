//! The panel's sections for the look of the map: methods and classes of roads, style, heights,
//! layers, and advanced settings.

use std::ops::RangeInclusive;

use corniche_live::{Compare, MapSettings, range};
use corniche_roads::FunctionalRoadClass;
use corniche_styles::LayerLook;
use corniche_viewer::{CapTest, Caps, LayerRow, Quads, RoadMethod, RoadOutline, WidthGrowth};
use egui::{
    ComboBox, Grid, Label, Rect, Response, RichText, Slider, SliderClamping, Ui, emath::Numeric,
    pos2, vec2,
};

use crate::{overlay::color32, window_content::WindowContent};

/// The section for the method and the comparison of both methods.
pub(crate) fn roads(ui: &mut Ui, settings: &mut MapSettings) {
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
                .on_hover_text("Geometry on the triangles of the ground");
            ui.selectable_value(&mut roads.method, RoadMethod::ShadowVolumes, "SV")
                .on_hover_text("Shadow volumes cut with the ground");
            ui.selectable_value(&mut roads.method, RoadMethod::None, "none");
        });
    });
}

/// The section for the shown classes, which is also the legend of the map: colours and names.
pub(crate) fn classes(ui: &mut Ui, settings: &mut MapSettings, content: &WindowContent<'_>) {
    Grid::new("classes").num_columns(2).min_col_width(0.0).show(ui, |ui| {
        for (class, label) in FunctionalRoadClass::all().zip(content.class_labels) {
            let color = content.road_colors.get(usize::from(class.number()));
            let color = color32(color.copied().unwrap_or_default());
            let (swatch, _) = ui.allocate_exact_size(vec2(18.0, 10.0), egui::Sense::hover());
            ui.painter().rect_filled(swatch, 2, color);
            let shown = &mut settings.roads.classes;
            let mut is_shown = shown.contains(class);
            ui.checkbox(&mut is_shown, label).on_hover_text(class.to_string());
            *shown = if is_shown { shown.with(class) } else { shown.without(class) };
            ui.end_row();
        }
    });
}

/// The section for style, heights, layers, lines of files and photos.
pub(crate) fn map(ui: &mut Ui, settings: &mut MapSettings, content: &WindowContent<'_>) {
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
    for layer in &content.layers {
        let mut is_shown = settings.layers.contains(&layer.id);
        if ui.checkbox(&mut is_shown, &layer.title).on_hover_text(&layer.id).changed() {
            let all = content.layers.iter().map(|layer| layer.id.as_str());
            settings.layers.toggle(&layer.id, all);
        }
        legend(ui, &layer.rows);
    }
    for (number, (name, color)) in content.overlays.iter().zip(&content.overlay_colors).enumerate()
    {
        ui.horizontal(|ui| {
            let mut is_shown = !settings.hidden_overlays.contains(&number);
            let mark = RichText::new("■").color(color32(*color));
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
        if ui.add(slider).on_hover_text("Opacity of the photo").changed() {
            settings.photo = Some(strength);
        }
    }
}

/// The legend of a layer: samples and names of its classes.
fn legend(ui: &mut Ui, rows: &[LayerRow]) {
    for LayerRow { label, look } in rows {
        ui.horizontal(|ui| {
            let (swatch, _) = ui.allocate_exact_size(vec2(36.0, 10.0), egui::Sense::hover());
            let (painter, color) = (ui.painter(), color32(look.color()));
            match look {
                LayerLook::Area(_) => drop(painter.rect_filled(swatch, 0, color)),
                LayerLook::Line(line) => {
                    for column in 0..swatch.width() as u16 {
                        let along = f32::from(column) + 0.5;
                        let width = line.width_px * line.dash.width_at(along);
                        let middle = pos2(swatch.left() + along, swatch.center().y);
                        let part = Rect::from_center_size(middle, vec2(1.0, width));
                        painter.rect_filled(part, 0, color);
                    }
                }
                LayerLook::Point(point) => {
                    let radius = (point.size_px / 2.0).min(swatch.height() / 2.0);
                    painter.circle_filled(swatch.center(), radius, color);
                }
            }
            ui.add(Label::new(label).wrap());
        });
    }
}

/// The section for advanced settings: details of roads, widths by class, the resolution of the
/// ground.
pub(crate) fn advanced(ui: &mut Ui, settings: &mut MapSettings, content: &WindowContent<'_>) {
    road_choices(ui, settings);
    slide(ui, &mut settings.screen_space_error_px, range::SCREEN_SPACE_ERROR_PX, |slider| {
        slider.suffix(" px").max_decimals(1).text("ground error")
    })
    .on_hover_text("A tile is refined while its error looks larger than this");
    ui.horizontal(|ui| {
        ui.label("Samples").on_hover_text("Per pixel, averaged");
        for samples in range::SAMPLES_PER_SIDE {
            let words = format!("{samples} × {samples}");
            ui.selectable_value(&mut settings.samples_per_side, samples, words);
        }
    });
    ui.checkbox(&mut settings.is_wireframe, "Wireframe");
    ui.checkbox(&mut settings.is_frozen, "Freeze tiles")
        .on_hover_text("Keep the drawn tiles while the camera moves");
    ui.label("Widths of classes");
    widths(ui, settings, content);
}

fn road_choices(ui: &mut Ui, settings: &mut MapSettings) {
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
                (RoadOutline::OfStyle, "of the style"),
                (RoadOutline::None, "none"),
                (RoadOutline::Kernel3, "3 × 3"),
                (RoadOutline::Kernel5, "5 × 5"),
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
fn widths(ui: &mut Ui, settings: &mut MapSettings, content: &WindowContent<'_>) {
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

/// A logarithmic slider for a factor or a size. A value of the command line may be outside the
/// slider's range or have more digits than it shows; such a value stays unchanged until the slider
/// is moved.
fn slide<T: Numeric>(
    ui: &mut Ui,
    value: &mut T,
    range: RangeInclusive<T>,
    dressed: impl FnOnce(Slider<'_>) -> Slider<'_>,
) -> Response {
    let mut moved = *value;
    let slider = Slider::new(&mut moved, range).logarithmic(true).clamping(SliderClamping::Edits);
    let response = ui.add(dressed(slider));
    if response.changed() {
        *value = moved;
    }
    response
}
