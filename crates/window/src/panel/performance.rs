//! The panel's section for the times, counts and memory of a frame.

use corniche_live::{FrameTimes, formatting};
use corniche_viewer::gpu::PassTimes;
use egui::{Color32, Grid, Pos2, Sense, Shape, Stroke, Ui, pos2, vec2};

use crate::window_content::WindowContent;

/// The upper end of the graph, unless a frame took longer.
const GRAPH_MS: f64 = 33.3;

/// Shows the times, counts and memory of a frame.
pub(crate) fn show(ui: &mut Ui, content: &WindowContent<'_>) {
    let times = content.frame_times;
    let ms = |value: Option<f64>| value.map_or("–".to_owned(), |ms| format!("{ms:.1}"));
    ui.label(format!(
        "frame {} ms, p50 {} ms, p95 {} ms",
        ms(times.last_ms()),
        ms(times.quantile_ms(0.5)),
        ms(times.quantile_ms(0.95))
    ));
    graph(ui, times);
    if content.passes.is_empty() {
        ui.label("no pass was timed yet");
    } else {
        passes(ui, content);
    }
    Grid::new("counts").num_columns(2).spacing(vec2(16.0, 2.0)).show(ui, |ui| {
        let tiles = format!(
            "{} drawn, {} missing, {} loading",
            content.tiles_drawn, content.tiles_missing, content.tiles_loading
        );
        let [used, allowed] = content.gpu_bytes;
        for (name, value) in [
            ("tiles", tiles),
            ("triangles", corniche_viewer::grouped(content.triangles)),
            ("segments", corniche_viewer::grouped(content.segments)),
            (
                "GPU memory",
                format!("{} of {}", formatting::mebibytes(used), formatting::mebibytes(allowed)),
            ),
        ] {
            ui.label(name);
            ui.label(value);
            ui.end_row();
        }
    });
    let words = format!("drawn by {}", content.adapter);
    ui.add(egui::Label::new(egui::RichText::new(words).small()).wrap());
}

fn passes(ui: &mut Ui, content: &WindowContent<'_>) {
    Grid::new("passes").num_columns(7).min_col_width(34.0).spacing(vec2(8.0, 2.0)).show(ui, |ui| {
        for heading in ["GPU ms", "terrain", "areas", "roads", "bridges", "composite", "sum"] {
            ui.small(heading);
        }
        ui.end_row();
        for (method, times) in content.passes {
            ui.label(formatting::method(*method));
            let PassTimes { terrain_ms, areas_ms, roads_ms, decks_ms, composite_ms } = *times;
            for ms in [terrain_ms, areas_ms, roads_ms, decks_ms, composite_ms, times.total_ms()] {
                let digits = if ms < 100.0 { 2 } else { 0 };
                ui.monospace(format!("{ms:.digits$}"));
            }
            ui.end_row();
        }
    });
}

fn graph(ui: &mut Ui, times: &FrameTimes) {
    let size = vec2(ui.available_width(), 44.0);
    let (area, response) = ui.allocate_exact_size(size, Sense::hover());
    response.on_hover_text(
        "Times of the last consecutive frames; the lines are 60 and 30 frames per second",
    );
    let painter = ui.painter();
    painter.rect_filled(area, 2, ui.visuals().extreme_bg_color);
    let top_ms = times.iter().fold(GRAPH_MS, f64::max);
    let y = |ms: f64| area.bottom() - (ms / top_ms) as f32 * (area.height() - 2.0);
    for (ms, color) in [
        (1000.0 / 60.0, Color32::from_rgb(60, 110, 70)),
        (1000.0 / 30.0, Color32::from_rgb(120, 100, 50)),
    ] {
        let ends = [pos2(area.left(), y(ms)), pos2(area.right(), y(ms))];
        painter.line_segment(ends, Stroke::new(1.0, color));
    }
    let step = area.width() / (times.iter().len().max(2) - 1) as f32;
    let line: Vec<Pos2> = times
        .iter()
        .enumerate()
        .map(|(place, ms)| pos2(area.left() + place as f32 * step, y(ms)))
        .collect();
    if line.len() > 1 {
        painter.add(Shape::line(line, Stroke::new(1.2, Color32::from_rgb(120, 190, 240))));
    }
}
