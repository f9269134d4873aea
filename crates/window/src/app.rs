//! The state of the window, without the window system: a desk of `corniche-live`, images and files.
//! `app/frame.rs` executes a frame.

mod captures;
mod frame;

use std::{path::PathBuf, sync::Arc};

use corniche_live::{
    ClockS, Errand, FramePace, LineDrawing, MapCommand, MapDesk, MapSettings, NotSaved, Notices,
    Session, SessionStart, StyleList, TileLoader, Trace, first_view,
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
    /// The text that the next frame copies to the clipboard.
    to_copy: Option<String>,
    /// The number of the frame, from 1.
    frame: u64,
    /// The areas where the mouse belongs to the panel, in points.
    occupied: Vec<Rect>,
}

/// Services of the platform that the app uses while it draws.
pub(crate) struct AppPlatform {
    /// Loads tiles.
    pub(crate) loader: Box<dyn TileLoader>,
    /// Saves files.
    pub(crate) files: FileWriter,
    /// Returns the time.
    pub(crate) clock_s: ClockS,
}

impl App {
    /// Creates the app, ready for the first frame, of a package with this ground. The platform has
    /// looked up the ground, because doing so waits for tiles.
    ///
    /// # Errors
    /// When there is no ground at the place to look at, or the trace cannot be written.
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
        let drawing = LineDrawing::new(&request.drawn_lines, ways, manifest, &mut notices);
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

    /// Whether the mouse at this pixel of the window belongs to the map and not to the panel.
    pub(crate) fn is_map(&self, ui: &egui::Context, at_px: DVec2) -> bool {
        let at = at_px / self.desk.session.camera.pixels_per_point;
        let at = pos2(at.x as f32, at.y as f32);
        // Lists that drop down from the panel are in layers of their own.
        let is_in_front =
            ui.layer_id_at(at).is_some_and(|layer| layer.order != egui::Order::Background);
        !is_in_front && !self.occupied.iter().any(|rect| rect.contains(at))
    }

    /// Executes a command of a key or the panel.
    pub(crate) fn command(&mut self, command: MapCommand, now_s: f64) {
        match self.desk.command(command, now_s) {
            Some(Errand::Take(shot)) => self.captures.wanted.push(shot),
            Some(Errand::SaveFlight(text)) => self.captures.files.save_flight(text),
            Some(Errand::Copy(text)) => self.to_copy = Some(text),
            None => {}
        }
    }

    /// Starts over with a new graphics device after the old one was lost: everything is loaded and
    /// drawn again.
    pub(crate) fn begin_again(&mut self) {
        self.desk.tell_lost(self.captures.lose_device());
        self.desk.begin_again();
    }

    /// Closes the window: saves pending files. Returns the results, because no panel can show them
    /// any more.
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

/// The initial settings of the window. `is_software` means that the CPU draws.
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
