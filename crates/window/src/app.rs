//! The state of the window, without the window system: a session, what is shown beside its map, and what inputs do to both. What a frame
//! does is in `app/frame.rs`.

mod captures;
mod frame;
mod shown_view;

use std::{path::PathBuf, sync::Arc};

use corniche_live::{
    ClockS, Command, Drawing, DrawingCommand, FramePace, MapSettings, NotSaved, Notices, Session,
    SessionStart, StyleList, TileLoader,
    controls::{Button, Input, Modifiers},
    first_view,
    formatting::with_causes,
};
use corniche_roads::FunctionalRoadClass;
use corniche_viewer::{
    RoadMethod, RoadOptions, SightedGround,
    flight::WorkingCrs,
    gpu::{Gpu, PassTimes},
    tiles::MapPackage,
};
use egui::{Rect, pos2};
use glam::DVec2;

use self::captures::Captures;
pub(crate) use self::frame::FrameInput;
use crate::{
    CommandOf, WindowError, WindowRequest, canvas::Canvas, files::FileWriter, panel, trace::Trace,
};

/// Flights are in perspective.
const NO_FLIGHT_FROM_ABOVE: &str = "flights are recorded in perspective: not from above";

/// The beginning of the notice that a style's file cannot be used.
const STYLE_STAYS: &str = "the style stays as it was: ";
/// The beginning of the notice that the map cannot go where it was asked to.
const NO_PLACE: &str = "go to: ";

/// The window's state.
pub(crate) struct App {
    session: Session,
    pace: FramePace,
    captures: Captures,
    drawing: Drawing,
    notices: Notices,
    trace: Option<Trace>,
    /// Times of the passes of the last frame that the graphics card has finished, picture by picture.
    passes: Vec<(RoadMethod, PassTimes)>,
    class_labels: [String; FunctionalRoadClass::COUNT],
    /// Names of the files of lines.
    overlays: Vec<String>,
    command_of: CommandOf,
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
    /// Ready for the first frame of a package with this ground, which the platform has looked up, because tiles must be waited for.
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
        let scale = request.exaggeration * manifest.point_scale;
        let home = first_view(request.camera, manifest, ground, scale, size_px, covered_px)?;
        let settings = first_settings(&request, gpu.is_software(), panel_width > 0.0);
        let trace = request
            .trace
            .map(|begin| begin().and_then(Trace::begin))
            .transpose()
            .map_err(|source| WindowError::Trace { source })?;
        let mut notices = Notices::default();
        if gpu.is_software() {
            let roads = if settings.roads.method == request.roads.method {
                ""
            } else {
                ", and roads as geometry (GEO), which takes less time"
            };
            notices.warn(format!(
                "no graphics card was found: the processor draws ({}), more coarsely while the camera moves{roads}",
                gpu.adapter_name()
            ));
        }
        let ways = (request.save_drawing, platform.clock_s);
        let drawing = Drawing::new(&request.drawn_lines, ways, manifest, &mut notices);
        Ok(Self {
            session: Session::new(SessionStart {
                package,
                height_range_m: ground.heights_m,
                home,
                settings,
                styles: StyleList::new(request.styles, request.reload),
                loader: platform.loader,
                budget: request.budget,
                size_px,
                pixels_per_point,
                inertia: request.inertia,
            }),
            pace: FramePace::default(),
            captures: Captures::new(platform.files),
            drawing,
            notices,
            trace,
            passes: Vec::new(),
            class_labels: request.class_labels,
            overlays: request.overlays,
            command_of: request.command_of,
            to_copy: None,
            frame: 0,
            occupied: Vec::new(),
        })
    }

    /// Whether the mouse at this pixel of the window is the map's, not the panel's.
    pub(crate) fn is_map(&self, ui: &egui::Context, at_px: DVec2) -> bool {
        let at = at_px / self.session.camera.pixels_per_point();
        let at = pos2(at.x as f32, at.y as f32);
        // Lists that hang from the panel lie in layers of their own.
        let is_in_front =
            ui.layer_id_at(at).is_some_and(|layer| layer.order != egui::Order::Background);
        !is_in_front && !self.occupied.iter().any(|rect| rect.contains(at))
    }

    /// A button of the mouse goes down on the map.
    pub(crate) fn press(&mut self, button: Button, at_px: DVec2, modifiers: Modifiers, now_s: f64) {
        let is_drawn = self.is_drawing() && button == Button::Left && !modifiers.control;
        if !is_drawn {
            self.session.press(button, at_px, modifiers, now_s);
        } else if !self.drawing.press(at_px, modifiers, &self.session) {
            self.session.press_once(button, at_px, modifiers, now_s);
        }
    }

    /// Any other input that moves the camera.
    pub(crate) fn input(&mut self, input: &Input, now_s: f64) {
        if !self.drawing.input(input, &self.session) {
            self.session.input(input, now_s);
        }
    }

    /// The cursor is at this pixel; `None` outside the window.
    pub(crate) fn point_at(&mut self, cursor_px: Option<DVec2>) {
        self.session.cursor_px = cursor_px;
    }

    /// Whether the mouse draws.
    pub(crate) fn is_drawing(&self) -> bool {
        self.drawing.is_on()
    }

    /// Does what a key or the panel asks for.
    pub(crate) fn command(&mut self, command: Command, now_s: f64) {
        let settings = &mut self.session.settings;
        match command {
            Command::NorthUp => self.input(&Input::NorthUp, now_s),
            Command::Reset => self.input(&Input::Reset, now_s),
            Command::ToggleFly => self.input(&Input::ToggleFly, now_s),
            Command::ToggleAbove => {
                let is_done = self.session.toggle_above(now_s);
                self.tell_unless(is_done, now_s);
            }
            Command::GoTo => {
                self.notices.retract(NO_PLACE);
                let place = settings.place.clone();
                if let Err(why) = self.session.go_to(&place, now_s) {
                    self.notices.warn(format!("{NO_PLACE}{why}"));
                }
            }
            Command::CopyView => self.copy_view(now_s),
            Command::TogglePanel => settings.is_panel_open = !settings.is_panel_open,
            Command::ToggleHelp => settings.is_help_open = !settings.is_help_open,
            Command::CloseHelp if settings.is_help_open => settings.is_help_open = false,
            Command::CloseHelp => self.draw_command(DrawingCommand::EndLine, now_s),
            Command::Draw(command) => self.draw_command(command, now_s),
            Command::Take(shot) => self.captures.want(shot),
            Command::ToggleRecording if self.session.flights.recording_s(now_s).is_some() => {
                self.stop_recording(now_s);
            }
            Command::ToggleRecording | Command::StartRecording => {
                let is_done = self.session.start_recording(now_s);
                self.tell_unless(is_done, now_s);
            }
            Command::StopRecording => self.stop_recording(now_s),
            Command::Dismiss(place) => self.notices.dismiss(place),
        }
    }

    /// What would make a flight from above was not done.
    fn tell_unless(&mut self, is_done: bool, now_s: f64) {
        if !is_done {
            self.notices.tell(NO_FLIGHT_FROM_ABOVE.to_owned(), now_s);
        }
    }

    fn draw_command(&mut self, command: DrawingCommand, now_s: f64) {
        self.drawing.command(command, self.session.manifest(), &mut self.notices, now_s);
    }

    /// Puts a command that draws this view on the clipboard, and shows it.
    fn copy_view(&mut self, now_s: f64) {
        match self.shown_view() {
            Some((view, left_out)) => {
                let command = (self.command_of)(&view);
                self.notices.tell(format!("copied: {command}{left_out}"), now_s);
                self.to_copy = Some(command);
            }
            None => self.notices.tell("not copied: the style has no name".to_owned(), now_s),
        }
    }

    fn stop_recording(&mut self, now_s: f64) {
        let lost = self.save_recording(now_s).err();
        self.tell_lost(lost);
    }

    /// Ends the recording, if there is one, and saves it.
    ///
    /// # Errors
    /// When nothing of it can be saved.
    fn save_recording(&mut self, now_s: f64) -> Result<(), NotSaved> {
        let Some(recorded) = self.session.flights.stop_recording(now_s) else { return Ok(()) };
        let text = recorded?.to_text(WorkingCrs::of(self.session.manifest()))?;
        self.captures.files.save_flight(text);
        Ok(())
    }

    /// The graphics device is lost and another one has taken its place: everything is loaded and drawn again.
    pub(crate) fn begin_again(&mut self) {
        self.session.begin_again();
        self.drawing.clear_tiles();
        self.passes.clear();
        let lost = self.captures.lose_device();
        self.tell_lost(lost);
        self.notices.warn("the graphics device was lost; everything was loaded again".to_owned());
    }

    /// The window closes: saves what is still to be saved. Returns what became of it, for there is no panel any more to
    /// show it.
    pub(crate) fn end(&mut self, canvas: &Canvas, now_s: f64) -> Vec<Result<PathBuf, NotSaved>> {
        let mut saved: Vec<_> = self.save_recording(now_s).err().into_iter().map(Err).collect();
        let credits = &self.session.manifest().attribution;
        let divider_share = self.session.settings.divider_share;
        saved.extend(self.captures.end(canvas, divider_share, credits));
        saved.extend(self.drawing.save());
        saved
    }

    /// When [`App::reload`] must be called.
    pub(crate) fn reload_due_s(&self) -> Option<f64> {
        self.session.styles.reload_due_s()
    }

    /// Asks whether the first style has changed, if it is time; tells whether there is something to show.
    pub(crate) fn reload(&mut self, now_s: f64) -> bool {
        let Some(reloaded) = self.session.styles.reload(now_s) else { return false };
        self.notices.retract(STYLE_STAYS);
        match reloaded {
            Ok(()) => self.notices.tell("the style was loaded again".to_owned(), now_s),
            Err(why) => self.notices.warn(format!("{STYLE_STAYS}{why}")),
        }
        true
    }

    /// The graphics device could not do something.
    pub(crate) fn fault(&mut self, what: &str) {
        self.notices.warn(format!("the graphics device could not do its work: {what}"));
    }

    fn tell_lost(&mut self, lost: impl IntoIterator<Item = NotSaved>) {
        self.notices.warn_all(lost.into_iter().map(|lost| with_causes(&lost)));
    }
}

/// The settings with which a window opens. `is_software` says that the processor draws.
fn first_settings(request: &WindowRequest, is_software: bool, is_panel_open: bool) -> MapSettings {
    let method = request.software_method.filter(|_| is_software).unwrap_or(request.roads.method);
    let usual_samples = if is_software { 1 } else { 2 };
    MapSettings {
        photo: request.photo,
        areas: request.areas,
        boundaries: request.boundaries,
        exaggeration: request.exaggeration,
        screen_space_error_px: request.screen_space_error_px,
        cell_px: request.cell_px,
        samples_per_side: request.samples_per_side.unwrap_or(usual_samples),
        is_panel_open,
        ..MapSettings::usual(RoadOptions { method, ..request.roads })
    }
}

#[cfg(test)]
#[path = "app_tests.rs"]
mod tests;
