//! The work of a frame, up to its painting.
//!
//! The order is: arrived tiles, time, selection of tiles, map, panel. A change in the panel takes
//! effect in the next frame, which the panel requests.

use corniche_live::{MapSettings, Redraw, TraceLine};
use corniche_styles::Rgb;
use corniche_viewer::{LayerLegend, flight::WorkingCrs};
use egui_wgpu::ScreenDescriptor;

use super::App;
use crate::{
    WindowError,
    canvas::Canvas,
    panel::{self, PanelActions},
    window_content::WindowContent,
};

/// The interval between checks whether the pixels of an image have arrived.
const PICTURE_S: f64 = 0.02;
/// The toolkit of the panel requests a repaint after a very long time when it means never; longer
/// times than this count as never.
const LONGEST_WISH_S: f64 = 3600.0;

/// The input of a frame. Times are seconds of one clock.
pub(crate) struct FrameInput {
    pub(crate) now_s: f64,
    pub(crate) size_px: [u32; 2],
    pub(crate) pixels_per_point: f32,
    pub(crate) ui: egui::RawInput,
}

/// The output of a frame: the work of the window system.
pub(crate) struct FrameOutput {
    /// The window's contents, to be painted with [`Canvas::paint`].
    pub(crate) primitives: Vec<egui::ClippedPrimitive>,
    pub(crate) screen: ScreenDescriptor,
    /// The textures that [`Canvas::free_textures`] frees after painting.
    pub(crate) unused_textures: Vec<egui::TextureId>,
    /// Requests of the toolkit to the window system, such as a shape of the cursor.
    pub(crate) platform: egui::PlatformOutput,
    pub(crate) redraw: Redraw,
}

impl App {
    /// Executes a frame up to its painting.
    ///
    /// # Errors
    /// When the images cannot be drawn or the trace cannot be written.
    pub(crate) fn frame(
        &mut self,
        canvas: &mut Canvas,
        ui: &egui::Context,
        input: FrameInput,
    ) -> Result<FrameOutput, WindowError> {
        let FrameInput { now_s, size_px, pixels_per_point, ui: raw } = input;
        self.frame += 1;
        let desk = &mut self.desk;
        for saved in self.captures.files.news() {
            desk.notices.tell_saved(saved, now_s);
        }
        let step = desk.step(&mut canvas.map, size_px, pixels_per_point, now_s);
        // An image to be saved is drawn in full resolution.
        let is_wanted = !self.captures.wanted.is_empty();
        let scene = desk.scene(&canvas.map, size_px, is_wanted, now_s);
        let is_new = canvas.draw(&scene)?;
        desk.session.look_at_ground(&step.camera, is_new);
        desk.take_times(&mut canvas.map)?;
        let line = self
            .trace
            .as_ref()
            .map(|_| TraceLine::from_session(&desk.session, self.frame, size_px));

        let before = self.desk.session.settings.clone();
        let mut output = self.show_panel(canvas, ui, raw, now_s);
        let is_changed = self.desk.session.settings != before;

        let screen = ScreenDescriptor { size_in_pixels: size_px, pixels_per_point };
        let to_copy = self.to_copy.take().map(egui::OutputCommand::CopyText);
        output.platform_output.commands.extend(to_copy);
        let unused_textures = canvas.take_textures(std::mem::take(&mut output.textures_delta));
        let primitives = ui.tessellate(std::mem::take(&mut output.shapes), pixels_per_point);
        self.capture(canvas, &primitives, &screen)?;
        if let (Some(trace), Some(mut line)) = (&mut self.trace, line) {
            // The commands of the panel begin with this frame.
            line.is_moving = self.desk.session.camera.navigator.is_moving();
            trace.write(line).map_err(|source| WindowError::Trace { source })?;
        }

        let camera = &self.desk.session.camera;
        let is_wanted = !self.captures.wanted.is_empty();
        let is_busy = camera.navigator.is_moving() || step.is_under_way || is_wanted;
        let is_one_of_many = is_new && (is_busy || camera.is_dragging);
        self.desk.pace.note(now_s, is_one_of_many, is_busy);
        let redraw = self.next_redraw(canvas, now_s, is_busy || is_changed, &output);
        Ok(FrameOutput {
            primitives,
            screen,
            unused_textures,
            platform: output.platform_output,
            redraw,
        })
    }

    /// The time of the next frame; `is_at_once` means that this frame left something to do.
    fn next_redraw(
        &self,
        canvas: &Canvas,
        now_s: f64,
        is_at_once: bool,
        output: &egui::FullOutput,
    ) -> Redraw {
        let wishes = output.viewport_output.values().map(|viewport| viewport.repaint_delay);
        let wish_s = wishes.map(|delay| delay.as_secs_f64()).fold(f64::INFINITY, f64::min);
        if is_at_once || wish_s <= 0.0 {
            return Redraw::Now;
        }
        let wish_s = (wish_s <= LONGEST_WISH_S).then_some(wish_s);
        let picture_s = (!self.captures.developing.is_empty()).then_some(PICTURE_S);
        self.desk.next_redraw(&canvas.map, [picture_s, wish_s], now_s)
    }

    /// Lays out the window and executes what the user clicked.
    fn show_panel(
        &mut self,
        canvas: &Canvas,
        ui: &egui::Context,
        raw: egui::RawInput,
        now_s: f64,
    ) -> egui::FullOutput {
        let mut answer = PanelActions::default();
        let mut settings: MapSettings = self.desk.session.settings.clone();
        let roads = self.desk.session.style().roads.iter();
        let road_colors: Vec<Rgb> = roads.map(|road| road.bands.main_color()).collect();
        let content = self.content(canvas, ui, &road_colors, now_s);
        let output = ui.run_ui(raw, |ui| {
            let shown = panel::show(ui, &mut settings, &content, &canvas.pictures());
            // The toolkit may lay out twice; one of the two reports a click.
            answer.commands.extend(shown.commands);
            answer.occupied = shown.occupied;
        });
        self.desk.session.change(settings);
        for command in answer.commands {
            self.command(command, now_s);
        }
        self.occupied = answer.occupied;
        output
    }

    fn content<'a>(
        &'a self,
        canvas: &'a Canvas,
        ui: &egui::Context,
        road_colors: &'a [Rgb],
        now_s: f64,
    ) -> WindowContent<'a> {
        let session = &self.desk.session;
        let (manifest, style, tiles) = (session.manifest(), session.style(), &session.tiles);
        let is_over_map = session.cursor_px.is_some_and(|at_px| self.is_map(ui, at_px));
        let counts = canvas.map.counts;
        let points = session.camera.pixels_per_point / manifest.point_scale;
        WindowContent {
            adapter: &canvas.gpu().adapter_name,
            is_software: canvas.gpu().is_software(),
            attribution: &manifest.attribution,
            crs: WorkingCrs::from_manifest(manifest),
            cursor: session.probe.cursor().filter(|_| is_over_map),
            pose: session.pose(),
            metres_per_point: session.probe.middle_pixel_m.map(|pixel_m| pixel_m * points),
            mode: session.camera.navigator.mode,
            style_names: &session.styles.names,
            overlays: &self.desk.overlays,
            overlay_colors: session.overlay_colors(self.desk.overlays.len()),
            photo: manifest.settings.photo.map(|_| style.photo),
            layers: LayerLegend::from_manifest(manifest, &session.layer_looks()),
            road_colors,
            class_labels: &self.class_labels,
            tiles_drawn: tiles.drawn.len(),
            tiles_missing: tiles.missing,
            tiles_loading: tiles.loading(),
            is_full: tiles.is_full,
            triangles: counts.triangles,
            segments: counts.segments,
            gpu_bytes: tiles.bytes_of_budget(),
            passes: &self.desk.passes,
            frame_times: &self.desk.pace.times,
            drawing: self.desk.drawing.content(session),
            recording_s: session.flights.recording_s(now_s),
            notices: self.desk.notices.all(),
        }
    }

    fn capture(
        &mut self,
        canvas: &mut Canvas,
        primitives: &[egui::ClippedPrimitive],
        screen: &ScreenDescriptor,
    ) -> Result<(), WindowError> {
        let share = self.desk.session.settings.divider_share;
        let credits = &self.desk.session.manifest().attribution;
        let mut lost = Vec::new();
        let taken = self.captures.take(canvas, (primitives, screen), share, credits, &mut lost);
        self.desk.tell_lost(lost);
        taken
    }
}
