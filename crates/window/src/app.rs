//! The state of the window, without the window system: a desk of `corniche-live`, and pictures and
//! files. What a frame does is in `app/frame.rs`.

mod captures;
mod frame;

use std::{path::PathBuf, sync::Arc};

use corniche_live::{
    ClockS, Command, Drawing, Errand, FramePace, MapDesk, MapSettings, NotSaved, Notices, Session,
    SessionStart, StyleList, TileLoader, Trace, first_view,
};
use corniche_roads::FunctionalRoadClass;
use corniche_viewer::{RoadOptions, SightedGround, gpu::Gpu, tiles::MapPackage};
use egui::{Rect, pos2};
use glam::DVec2;

use self::captures::Captures;
pub(crate) use self::frame::FrameInput;
use crate::{WindowError, WindowRequest, canvas::Canvas, files::FileWriter, panel};

/// The window's state.
pub(crate) struct App {
    pub(crate) desk: MapDesk,
    captures: Captures,
    trace: Option<Trace>,
    class_labels: [String; FunctionalRoadClass::COUNT],
    /// What the next frame puts on the clipboard.
    to_copy: Option<String>,
    /// Number of the frame, 1 first.
    frame: u64,
    /// Where the mouse is the panel's, points.
    occupied: Vec<Rect>,
}

/// What the platform does for the app while it draws.
pub(crate) struct AppPlatform {
    /// Loads tiles.
    pub(crate) loader: Box<dyn TileLoader>,
    /// Saves files.
    pub(crate) files: FileWriter,
    /// Tells the time.
    pub(crate) clock_s: ClockS,
}

impl App {
    /// Ready for the first frame of a package with this ground, which the platform has looked up,
    /// because tiles must be waited for.
    ///
    /// # Errors
    /// When the place to look at has no ground, or the trace cannot be written.
    pub(crate) fn new(
        request: WindowRequest,
        package: Arc<dyn MapPackage>,
        ground: SightedGround,
        gpu: &Gpu,
        platform: AppPlatform,
        (size_px, pixels_per_point): ([u32; 2], f32),
    ) -> Result<Self, WindowError> {
        let manifest = package.manifest();
        let panel_width = panel::first_width(size_px[0] as f32 / pixels_per_point);
        let covered_px = (panel_width * pixels_per_point) as u32;
        let scale = request.settings.exaggeration * manifest.point_scale;
        let home = first_view(request.camera, manifest, ground, scale, size_px, covered_px)?;
        let settings = first_settings(&request, gpu.is_software(), panel_width > 0.0);
        let trace = request
            .trace
            .map(|begin| begin().and_then(Trace::begin))
            .transpose()
            .map_err(|source| WindowError::Trace { source })?;
        let mut notices = Notices::default();
        notices.warn_of_software(gpu, settings.roads.method, request.settings.roads.method);
        let ways = (request.save_drawing, platform.clock_s);
        let drawing = Drawing::new(&request.drawn_lines, ways, manifest, &mut notices);
        let session = Session::new(SessionStart {
            package,
            height_range_m: ground.heights_m,
            home,
            settings,
            styles: StyleList::new(request.styles, request.reload),
            loader: platform.loader,
            budget: request.budget,
            size_px,
            pixels_per_point,
            has_inertia: request.has_inertia,
        });
        let desk = MapDesk {
            session,
            drawing,
            notices,
            overlays: request.overlays,
            command_of: request.command_of,
            pace: FramePace::default(),
            passes: Vec::new(),
        };
        Ok(Self {
            desk,
            captures: Captures::new(platform.files),
            trace,
            class_labels: request.class_labels,
            to_copy: None,
            frame: 0,
            occupied: Vec::new(),
        })
    }

    /// Whether the mouse at this pixel of the window is the map's, not the panel's.
    pub(crate) fn is_map(&self, ui: &egui::Context, at_px: DVec2) -> bool {
        let at = at_px / self.desk.session.camera.pixels_per_point;
        let at = pos2(at.x as f32, at.y as f32);
        // Lists that hang from the panel lie in layers of their own.
        let is_in_front =
            ui.layer_id_at(at).is_some_and(|layer| layer.order != egui::Order::Background);
        !is_in_front && !self.occupied.iter().any(|rect| rect.contains(at))
    }

    /// Does what a key or the panel asks for.
    pub(crate) fn command(&mut self, command: Command, now_s: f64) {
        match self.desk.command(command, now_s) {
            Some(Errand::Take(shot)) => self.captures.wanted.push(shot),
            Some(Errand::SaveFlight(text)) => self.captures.files.save_flight(text),
            Some(Errand::Copy(text)) => self.to_copy = Some(text),
            None => {}
        }
    }

    /// The graphics device is lost and another one has taken its place: everything is loaded and drawn again.
    pub(crate) fn begin_again(&mut self) {
        self.desk.tell_lost(self.captures.lose_device());
        self.desk.begin_again();
    }

    /// The window closes: saves what is still to be saved. Returns what became of it, for there is no panel any more to
    /// show it.
    pub(crate) fn end(&mut self, canvas: &Canvas, now_s: f64) -> Vec<Result<PathBuf, NotSaved>> {
        let mut saved = Vec::new();
        match self.desk.stop_recording(now_s) {
            Some(Ok(text)) => self.captures.files.save_flight(text),
            Some(Err(lost)) => saved.push(Err(lost)),
            None => {}
        }
        let session = &self.desk.session;
        let credits = &session.manifest().attribution;
        saved.extend(self.captures.end(canvas, session.settings.divider_share, credits));
        saved.extend(self.desk.drawing.save());
        saved
    }
}

/// The settings with which a window opens. `is_software` says that the processor draws.
fn first_settings(request: &WindowRequest, is_software: bool, is_panel_open: bool) -> MapSettings {
    let MapSettings { roads, .. } = request.settings;
    let method = request.software_method.filter(|_| is_software).unwrap_or(roads.method);
    let usual_samples = if is_software { 1 } else { 2 };
    MapSettings {
        roads: RoadOptions { method, ..roads },
        samples_per_side: request.samples_per_side.unwrap_or(usual_samples),
        is_panel_open,
        ..request.settings.clone()
    }
}

#[cfg(test)]
#[path = "app_tests.rs"]
mod tests;
