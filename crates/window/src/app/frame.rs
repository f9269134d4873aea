//! What a frame does, up to its painting.
//!
//! In this order: tiles that have arrived, time, choice of tiles, map, panel. A change made in the panel is seen in the next
//! frame, which the panel asks for.

use corniche_live::{Changes, MapScene};
use corniche_styles::Rgb;
use corniche_viewer::{
    BoundaryLines,
    camera::Camera,
    flight::{Pose, WorkingCrs},
    gpu::GpuError,
    lod::{Fineness, Quality},
};
use egui_wgpu::ScreenDescriptor;

use super::{App, frame_pace::Redraw, ground};
use crate::{
    WindowError,
    canvas::{Canvas, Drew, Scene},
    formatting,
    panel::{self, Answer},
    settings::{Refinement, Settings},
    trace::TraceLine,
    window_content::{Has, WindowContent},
};

/// A processor that draws draws coarsely until the camera has been at rest for this time.
const HURRY_S: f64 = 0.15;
/// The times of a frame's passes are asked for this long after it, if no other frame comes before.
const CLOCK_S: f64 = 0.1;
/// Time between two questions whether the pixels of a picture have come back.
const PICTURE_S: f64 = 0.02;
/// The panel's toolkit asks for a repaint after a very long time when it means never; this is the longest that counts.
const LONGEST_WISH_S: f64 = 3600.0;
/// The beginning of the notice that drawn lines are not shown.
const NOT_LAID: &str =
    "drawn lines that cannot be laid on the ground, and are not shown on all of it: ";

/// What a frame is given. Times are seconds of one clock.
pub(crate) struct FrameInput {
    pub(crate) now_s: f64,
    pub(crate) size_px: [u32; 2],
    pub(crate) pixels_per_point: f32,
    pub(crate) ui: egui::RawInput,
}

/// What comes of a frame: what the window system has to do.
pub(crate) struct FrameOutput {
    /// The window's contents, to be painted with [`Canvas::paint`].
    pub(crate) primitives: Vec<egui::ClippedPrimitive>,
    pub(crate) screen: ScreenDescriptor,
    /// The textures that [`Canvas::free_textures`] frees after painting.
    pub(crate) unused_textures: Vec<egui::TextureId>,
    /// What the panel's toolkit wants of the window system, such as a shape of the cursor.
    pub(crate) platform: egui::PlatformOutput,
    pub(crate) redraw: Redraw,
}

impl App {
    /// Does everything of a frame up to its painting.
    ///
    /// # Errors
    /// When the pictures cannot be drawn or the trace cannot be written.
    pub(crate) fn frame(
        &mut self,
        canvas: &mut Canvas,
        ui: &egui::Context,
        input: FrameInput,
    ) -> Result<FrameOutput, WindowError> {
        let FrameInput { now_s, size_px, pixels_per_point, ui: raw } = input;
        self.frame += 1;
        self.take_news(now_s);
        let ground = ground(&self.tiles, &self.settings, &self.package);
        let camera = self.camera.advance(now_s, size_px, pixels_per_point, &ground);
        let is_under_way = self.change_tiles(canvas, &camera, now_s);
        let pose = self.pose();
        self.captures.note(now_s, pose);
        let drew = self.draw(canvas, &camera, now_s)?;
        self.look(&camera, drew.is_new);
        self.notices.warn_all(self.graphics.take_times(canvas)?);

        let before = self.settings.clone();
        let mut output = self.show_panel(canvas, ui, raw, drew, now_s);
        let is_changed = self.settings != before;
        self.follow_exaggeration(&before);

        let screen = ScreenDescriptor { size_in_pixels: size_px, pixels_per_point };
        let to_copy = self.to_copy.take().map(egui::OutputCommand::CopyText);
        output.platform_output.commands.extend(to_copy);
        let unused_textures = canvas.take_textures(std::mem::take(&mut output.textures_delta));
        let primitives = ui.tessellate(std::mem::take(&mut output.shapes), pixels_per_point);
        self.capture(canvas, &primitives, &screen)?;
        self.write_trace(pose, size_px)?;

        let is_busy = self.camera.is_moving() || is_under_way || self.captures.is_wanted();
        let is_one_of_many = drew.is_new && (is_busy || self.camera.is_dragging());
        self.pace.note(now_s, is_one_of_many, is_busy);
        let redraw = self.next_redraw(canvas, now_s, is_busy || is_changed, &output);
        Ok(FrameOutput {
            primitives,
            screen,
            unused_textures,
            platform: output.platform_output,
            redraw,
        })
    }

    /// When the next frame is due; `is_at_once` says that this one left something to do.
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
        let hurry_s = self.is_hurrying(now_s).then_some(HURRY_S);
        // By then the graphics card can tell how long this frame took.
        let clock_s = canvas.is_timing().then_some(CLOCK_S);
        let wish_s = (wish_s <= LONGEST_WISH_S).then_some(wish_s);
        let picture_s = self.captures.is_developing().then_some(PICTURE_S);
        let second_s = self.captures.recording_s(now_s).map(|s| s.floor() + 1.0 - s);
        let notice_s = self.notices.next_end_s().map(|until_s| (until_s - now_s).max(0.0));
        Redraw::after(now_s, [hurry_s, clock_s, picture_s, wish_s, second_s, notice_s])
    }

    fn take_news(&mut self, now_s: f64) {
        self.notices.expire(now_s);
        for defect in self.tiles.take_arrivals() {
            self.notices.warn(format!("{defect}; it is shown without its ground"));
        }
        for saved in self.captures.news() {
            match saved {
                Ok(path) => self.notices.tell(format!("saved {}", path.display()), now_s),
                Err(lost) => self.notices.warn(formatting::with_causes(&lost)),
            }
        }
    }

    /// Chooses tiles and brings them to the graphics card; tells whether the next frame may have more of this to do.
    fn change_tiles(&mut self, canvas: &mut Canvas, camera: &Camera, now_s: f64) -> bool {
        let ahead = self.camera.look_ahead(now_s, camera.size_px());
        let settings = &self.settings;
        let fineness = Fineness {
            screen_space_error_px: settings.screen_space_error_px,
            cell_px: settings.cell_px,
        };
        let (manifest, style) = (self.package.manifest(), self.styles.at(settings.style));
        let quality =
            Quality::of_package(manifest, fineness, style, settings.roads, settings.exaggeration);
        let changes = match self.settings.refinement {
            Refinement::Live => self.tiles.choose(camera, ahead.as_ref(), quality),
            Refinement::Frozen => Changes::default(),
        };
        canvas.change(&changes.evict, &changes.upload);
        let is_new = !changes.upload.is_empty();
        self.tiles.keep_ground(changes.upload);
        self.drawing.evict(&changes.evict);
        let not_laid = self.drawing.lay(canvas, &self.tiles, self.package.manifest(), is_new);
        self.tell_not_laid(not_laid);
        if self.tiles.take_first_time_full() {
            self.notices.warn(
                "the graphics memory allowed is full: this view is drawn more coarsely than asked; allow more with \
                 --gpu-memory"
                    .to_owned(),
            );
        }
        changes.is_under_way
    }

    /// Tells how many drawn lines cannot be laid, when that has changed.
    fn tell_not_laid(&mut self, not_laid: Option<usize>) {
        let Some(number) = not_laid else { return };
        self.notices.retract(NOT_LAID);
        if number > 0 {
            self.notices.warn(format!(
                "{NOT_LAID}{number}. They cross too much ground with too many points, and stay in the file; simplify them (ogr2ogr \
                 -simplify), or divide them"
            ));
        }
    }

    /// Whether the map is drawn coarsely for a moment, because a processor draws and the camera moves.
    fn is_hurrying(&self, now_s: f64) -> bool {
        self.graphics.is_software() && self.camera.at_rest_s(now_s) < HURRY_S && self.frame > 1
    }

    /// Draws the map. Where the picture is too large for the adapter with so many samples, it is drawn with fewer; with
    /// one it always fits, for the window is no larger than that.
    fn draw(
        &mut self,
        canvas: &mut Canvas,
        camera: &Camera,
        now_s: f64,
    ) -> Result<Drew, WindowError> {
        let mut scene = self.scene(camera, now_s);
        let wanted = scene.map.samples_per_side;
        let drew = loop {
            match canvas.draw(&scene) {
                Err(GpuError::TooLarge { .. }) if scene.map.samples_per_side > 1 => {
                    scene.map.samples_per_side -= 1;
                }
                drew => break drew?,
            }
        };
        let drawn = scene.map.samples_per_side;
        if drawn < wanted {
            self.notices.warn(format!(
                "{wanted} × {wanted} samples a pixel are more than the adapter can draw in a window of this size; there \
                 are {drawn} × {drawn} now"
            ));
            self.settings.samples_per_side = drawn;
        }
        Ok(drew)
    }

    fn scene(&self, camera: &Camera, now_s: f64) -> Scene {
        let window_px = camera.size_px();
        // A picture that is to be saved is drawn in full.
        let is_coarse = self.is_hurrying(now_s) && !self.captures.is_wanted();
        let (size_px, samples_per_side) = if is_coarse {
            (window_px.map(|side| side.div_ceil(2)), 1)
        } else {
            (window_px, self.settings.samples_per_side)
        };
        let settings = &self.settings;
        let map = MapScene {
            camera: self.camera.view().camera(size_px),
            style: settings.applied_to(self.styles.at(settings.style)),
            roads: settings.compare.pictures(settings.roads),
            exaggeration: settings.exaggeration,
            point_scale: self.package.manifest().point_scale,
            height_range_m: self.package.height_range_m(),
            cell_px: settings.cell_px,
            latitude_deg: self.package.manifest().wgs84_bounds.center()[1],
            wireframe: settings.wireframe(),
            drawn: self.tiles.drawn().to_vec(),
            samples_per_side,
        };
        let lines_revision = self.drawing.revision();
        Scene { map, window_px, compare: settings.compare, lines_revision }
    }

    fn look(&mut self, camera: &Camera, is_new: bool) {
        let (scale, coordinates) = (self.vertical_scale(), &self.package.manifest().coordinates);
        let ground = ground(&self.tiles, &self.settings, &self.package);
        self.probe.look(camera, self.cursor_px, is_new, &ground, scale, coordinates);
    }

    /// Lays out the window and does what was clicked in it.
    fn show_panel(
        &mut self,
        canvas: &Canvas,
        ui: &egui::Context,
        raw: egui::RawInput,
        drew: Drew,
        now_s: f64,
    ) -> egui::FullOutput {
        let mut answer = Answer::default();
        let mut settings = self.settings.clone();
        let style = self.styles.at(self.settings.style);
        let road_colors: Vec<Rgb> =
            style.roads.iter().map(|road| road.bands.main_color()).collect();
        let content = self.content(canvas, ui, &road_colors, now_s);
        let output = ui.run_ui(raw, |ui| {
            let shown = panel::show(ui, &mut settings, &content, drew.pictures);
            // The toolkit may lay out twice; a click is reported in one of the two.
            answer.commands.extend(shown.commands);
            answer.occupied = shown.occupied;
        });
        self.settings = settings;
        for command in answer.commands {
            self.command(command, now_s);
        }
        self.occupied = answer.occupied;
        output
    }

    /// Colours of the lines of all files, in the style that is shown.
    pub(crate) fn overlay_colors(&self) -> Vec<Rgb> {
        let lines = self.styles.at(self.settings.style).overlays;
        lines.iter().take(self.overlays.len()).map(|line| line.color).collect()
    }

    fn content<'a>(
        &'a self,
        canvas: &Canvas,
        ui: &egui::Context,
        road_colors: &'a [Rgb],
        now_s: f64,
    ) -> WindowContent<'a> {
        let manifest = self.package.manifest();
        let is_over_map = self.cursor_px.is_some_and(|at_px| self.is_map(ui, at_px));
        let counts = canvas.counts();
        let points = self.camera.pixels_per_point() / manifest.point_scale;
        WindowContent {
            adapter: self.graphics.adapter(),
            is_software: self.graphics.is_software(),
            attribution: &manifest.attribution,
            crs: WorkingCrs::of(manifest),
            cursor: self.probe.cursor().filter(|_| is_over_map),
            pose: self.pose(),
            metres_per_point: self.probe.middle_pixel_m().map(|pixel_m| pixel_m * points),
            mode: self.camera.mode(),
            style_names: self.styles.names(),
            has: Has { areas: manifest.areas.is_some(), boundaries: manifest.boundaries.is_some() },
            overlays: &self.overlays,
            overlay_colors: self.overlay_colors(),
            photo: manifest.settings.photo.map(|_| self.styles.at(self.settings.style).photo),
            boundary_lines: BoundaryLines::of(manifest, self.styles.at(self.settings.style)),
            road_colors,
            class_labels: &self.class_labels,
            tiles_drawn: self.tiles.drawn().len(),
            tiles_missing: self.tiles.missing(),
            tiles_loading: self.tiles.loading(),
            is_full: self.tiles.is_full(),
            triangles: counts.triangles,
            segments: counts.segments,
            gpu_bytes: self.tiles.bytes_of_budget(),
            passes: self.graphics.passes(),
            frame_times: self.pace.times(),
            drawing: self.drawing_content(),
            recording_s: self.captures.recording_s(now_s),
            notices: self.notices.all(),
        }
    }

    /// The camera keeps its place over the ground when the exaggeration changes.
    fn follow_exaggeration(&mut self, before: &Settings) {
        let factor = self.settings.exaggeration / before.exaggeration;
        if self.settings.exaggeration.to_bits() != before.exaggeration.to_bits() {
            let ground = ground(&self.tiles, before, &self.package);
            self.camera.rescale_heights(factor, &ground);
        }
    }

    fn capture(
        &mut self,
        canvas: &mut Canvas,
        primitives: &[egui::ClippedPrimitive],
        screen: &ScreenDescriptor,
    ) -> Result<(), WindowError> {
        let (share, manifest) = (self.settings.divider_share, self.package.manifest());
        let mut lost = Vec::new();
        let taken = self.captures.take(canvas, primitives, screen, share, manifest, &mut lost);
        self.tell_lost(lost);
        taken
    }

    fn write_trace(&mut self, pose: Pose, size_px: [u32; 2]) -> Result<(), WindowError> {
        let line = TraceLine {
            frame: self.frame,
            cursor_px: self.cursor_px,
            ground_m: self.probe.cursor().map(|point| point.at_m),
            pixel_m: self.probe.cursor_pixel_m(),
            pose,
            tiles: self.tiles.drawn().len(),
            missing: self.tiles.missing(),
            loading: self.tiles.loading(),
            is_moving: self.camera.is_moving(),
            size_px,
        };
        let Some(trace) = &mut self.trace else { return Ok(()) };
        trace.write(line).map_err(|source| WindowError::Trace { source })
    }
}
