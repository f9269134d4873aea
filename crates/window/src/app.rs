//! The state of the window, without the window system: what it shows and what inputs do to it. What a frame does is in
//! `app/frame.rs`.

mod adapter;
mod captures;
mod draw_input;
mod drawing;
mod first_settings;
mod frame;
mod frame_pace;
mod shown_package;
mod shown_view;
mod style_list;

pub(crate) use self::{
    frame::FrameInput,
    frame_pace::Redraw,
    shown_package::{ShownPackage, check},
};

use std::path::PathBuf;

use corniche_live::{
    CameraControl, GroundProbe, ShownGround, TileLoader, Tiles,
    controls::{Button, Input, Modifiers, Navigator},
    first_view, limits, place_in_world,
};
use corniche_roads::FunctionalRoadClass;
use corniche_viewer::{
    SightedGround,
    flight::{Pose, WorkingCrs},
};
use egui::{Rect, pos2};
use glam::DVec2;

use self::{
    adapter::AdapterState, captures::Captures, drawing::Drawing, first_settings::first_settings,
    frame_pace::FramePace, style_list::StyleList,
};
use crate::{
    ClockS, CommandOf, NotSaved, WindowError, WindowRequest,
    canvas::Canvas,
    command::{Command, DrawingCommand},
    formatting,
    notices::Notices,
    panel,
    save_files::SaveFiles,
    settings::{Refinement, Settings},
    shots::Shots,
    trace::Trace,
};

/// Flights are in perspective.
const NO_FLIGHT_FROM_ABOVE: &str = "flights are recorded in perspective: not from above";

/// The beginning of the notice that a style's file cannot be used.
const STYLE_STAYS: &str = "the style stays as it was: ";
/// The beginning of the notice that the map cannot go where it was asked to.
const NO_PLACE: &str = "go to: ";

/// The window's state.
pub(crate) struct App {
    package: ShownPackage,
    tiles: Tiles,
    camera: CameraControl,
    settings: Settings,
    styles: StyleList,
    graphics: AdapterState,
    pace: FramePace,
    captures: Captures,
    drawing: Drawing,
    notices: Notices,
    trace: Option<Trace>,
    probe: GroundProbe,
    class_labels: [String; FunctionalRoadClass::COUNT],
    /// Names of the files of lines.
    overlays: Vec<String>,
    command_of: CommandOf,
    /// What the next frame puts on the clipboard.
    to_copy: Option<String>,
    /// Number of the frame, 1 first.
    frame: u64,
    cursor_px: Option<DVec2>,
    /// Where the mouse is the panel's, points.
    occupied: Vec<Rect>,
}

/// What the platform does for the app while it draws.
pub(crate) struct AppPlatform {
    /// Loads tiles.
    pub(crate) loader: Box<dyn TileLoader>,
    /// Saves files.
    pub(crate) files: Box<dyn SaveFiles>,
    /// Tells the time.
    pub(crate) clock_s: ClockS,
}

impl App {
    /// Ready for the first frame. `place_height_m` is the true height of the ground at the place to look at first; the
    /// platform has looked it up, because tiles must be waited for.
    ///
    /// # Errors
    /// When the place to look at has no ground, or the trace cannot be written.
    pub(crate) fn new(
        request: WindowRequest,
        package: ShownPackage,
        place_height_m: Option<f64>,
        canvas: &Canvas,
        platform: AppPlatform,
        size_px: [u32; 2],
        pixels_per_point: f32,
    ) -> Result<Self, WindowError> {
        let exaggeration = request.exaggeration;
        let panel_px = panel::first_width(size_px[0] as f32 / pixels_per_point) * pixels_per_point;
        let sighted = SightedGround {
            extent: package.extent(),
            heights_m: package.height_range_m(),
            at_place_m: place_height_m,
        };
        let home = first_view(
            request.camera,
            package.manifest(),
            sighted,
            package.vertical_scale(exaggeration),
            size_px,
            panel_px as u32,
        )?;
        let limits = limits(package.manifest());
        let graphics = AdapterState::of(canvas);
        let width_points = size_px[0] as f32 / pixels_per_point;
        let settings = first_settings(&request, graphics.is_software(), width_points);
        let trace = request
            .trace
            .map(|begin| begin().and_then(Trace::begin))
            .transpose()
            .map_err(|source| WindowError::Trace { source })?;
        let navigator = Navigator::new(home, limits, size_px, request.inertia);
        let quantum_m = package.manifest().vertical.quantum_m;
        let mut notices = Notices::default();
        if graphics.is_software() {
            let roads = if settings.roads.method == request.roads.method {
                ""
            } else {
                ", and roads as geometry (GEO), which takes less time"
            };
            notices.warn(format!(
                "no graphics card was found: the processor draws ({}), more coarsely while the camera moves{roads}",
                graphics.adapter()
            ));
        }
        let (lines, ways) = (&request.drawn_lines, (request.save_drawing, platform.clock_s));
        let (drawing, left_out) = Drawing::new(lines, ways, package.manifest());
        if left_out > 0 {
            notices.warn(format!("{left_out} lines lie too far away from the package: they are not shown, and stay in the file"));
        }
        Ok(Self {
            tiles: Tiles::new(package.catalog(), quantum_m, platform.loader, request.budget),
            package,
            camera: CameraControl::new(navigator, pixels_per_point),
            settings,
            styles: StyleList::new(request.styles, request.reload),
            graphics,
            pace: FramePace::default(),
            captures: Captures::new(Shots::new(platform.files)),
            drawing,
            notices,
            trace,
            probe: GroundProbe::default(),
            class_labels: request.class_labels,
            overlays: request.overlays,
            command_of: request.command_of,
            to_copy: None,
            frame: 0,
            cursor_px: None,
            occupied: Vec::new(),
        })
    }

    /// Whether the mouse at this pixel of the window is the map's, not the panel's.
    pub(crate) fn is_map(&self, ui: &egui::Context, at_px: DVec2) -> bool {
        let at = at_px / self.camera.pixels_per_point();
        let at = pos2(at.x as f32, at.y as f32);
        // Lists that hang from the panel lie in layers of their own.
        let is_in_front =
            ui.layer_id_at(at).is_some_and(|layer| layer.order != egui::Order::Background);
        !is_in_front && !self.occupied.iter().any(|rect| rect.contains(at))
    }

    /// A button of the mouse goes down on the map.
    pub(crate) fn press(&mut self, button: Button, at_px: DVec2, modifiers: Modifiers, now_s: f64) {
        let is_drawn = self.is_drawing() && button == Button::Left && !modifiers.control;
        if is_drawn && self.press_drawing(at_px, modifiers) {
            return;
        }
        let ground = ground(&self.tiles, &self.settings, &self.package);
        if is_drawn {
            self.camera.press_once(button, at_px, modifiers, now_s, &ground);
        } else {
            self.camera.press(button, at_px, modifiers, now_s, &ground);
        }
    }

    /// Any other input that moves the camera.
    pub(crate) fn input(&mut self, input: &Input, now_s: f64) {
        if self.is_drawing() && self.input_drawing(input) {
            return;
        }
        let ground = ground(&self.tiles, &self.settings, &self.package);
        self.camera.input(input, now_s, &ground);
    }

    /// The cursor is at this pixel; `None` outside the window.
    pub(crate) fn point_at(&mut self, cursor_px: Option<DVec2>) {
        self.cursor_px = cursor_px;
    }

    /// Does what a key or the panel asks for.
    pub(crate) fn command(&mut self, command: Command, now_s: f64) {
        match command {
            Command::NorthUp => self.input(&Input::NorthUp, now_s),
            Command::Reset => self.input(&Input::Reset, now_s),
            Command::ToggleFly => self.input(&Input::ToggleFly, now_s),
            Command::ToggleAbove if self.captures.is_recording() => {
                self.notices.tell(NO_FLIGHT_FROM_ABOVE.to_owned(), now_s);
            }
            Command::ToggleAbove => self.input(&Input::ToggleAbove, now_s),
            Command::GoTo => self.go_to(now_s),
            Command::CopyView => self.copy_view(now_s),
            Command::TogglePanel => self.settings.is_panel_open = !self.settings.is_panel_open,
            Command::ToggleHelp => self.settings.is_help_open = !self.settings.is_help_open,
            Command::CloseHelp if self.settings.is_help_open => self.settings.is_help_open = false,
            Command::CloseHelp => self.draw_command(DrawingCommand::EndLine, now_s),
            Command::Draw(command) => self.draw_command(command, now_s),
            Command::Take(shot) => self.captures.want(shot),
            Command::ToggleRecording if self.captures.is_recording() => self.stop_recording(now_s),
            Command::ToggleRecording | Command::StartRecording
                if self.camera.view().from_above.is_some() =>
            {
                self.notices.tell(NO_FLIGHT_FROM_ABOVE.to_owned(), now_s);
            }
            Command::ToggleRecording | Command::StartRecording => {
                self.captures.start_recording(now_s, self.pose());
            }
            Command::StopRecording => self.stop_recording(now_s),
            Command::Dismiss(place) => self.notices.dismiss(place),
        }
    }

    /// Looks at the place that is typed in the panel, or says why it cannot.
    fn go_to(&mut self, now_s: f64) {
        self.notices.retract(NO_PLACE);
        let ground = ground(&self.tiles, &self.settings, &self.package);
        match place_in_world(&self.settings.place, self.package.manifest(), &ground) {
            Ok(target_in_world) => self.input(&Input::GoTo { target_in_world }, now_s),
            Err(why) => self.notices.warn(format!("{NO_PLACE}{why}")),
        }
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
        let crs = WorkingCrs::of(self.package.manifest());
        let lost = self.captures.stop_recording(now_s, crs).err();
        self.tell_lost(lost);
    }

    /// The graphics device is lost and another one has taken its place: everything is loaded and drawn again.
    pub(crate) fn begin_again(&mut self, canvas: &Canvas) {
        self.tiles.begin_again();
        self.drawing.clear_tiles();
        // A frozen choice of tiles would stay empty.
        self.settings.refinement = Refinement::Live;
        self.graphics = AdapterState::of(canvas);
        let lost = self.captures.lose_device();
        self.tell_lost(lost);
        self.notices.warn("the graphics device was lost; everything was loaded again".to_owned());
    }

    /// The window closes: saves what is still to be saved. Returns what became of it, for there is no panel any more to
    /// show it.
    pub(crate) fn end(&mut self, canvas: &Canvas, now_s: f64) -> Vec<Result<PathBuf, NotSaved>> {
        let manifest = self.package.manifest();
        let mut saved = self.captures.end(canvas, now_s, self.settings.divider_share, manifest);
        saved.extend(self.drawing.save());
        saved
    }

    /// When [`App::reload`] must be called.
    pub(crate) fn reload_due_s(&self) -> Option<f64> {
        self.styles.reload_due_s()
    }

    /// Asks whether the first style has changed, if it is time; tells whether there is something to show.
    pub(crate) fn reload(&mut self, now_s: f64) -> bool {
        let Some(reloaded) = self.styles.reload(now_s) else { return false };
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
        for lost in lost {
            self.notices.warn(formatting::with_causes(&lost));
        }
    }

    fn vertical_scale(&self) -> f64 {
        self.package.vertical_scale(self.settings.exaggeration)
    }

    /// The camera as flights have it.
    fn pose(&self) -> Pose {
        self.camera.pose(self.vertical_scale())
    }
}

/// The ground as the camera's controls see it.
fn ground<'a>(tiles: &'a Tiles, settings: &Settings, package: &ShownPackage) -> ShownGround<'a> {
    let vertical_scale = package.vertical_scale(settings.exaggeration);
    tiles.ground(vertical_scale, package.height_range_m())
}

#[cfg(test)]
#[path = "app_tests.rs"]
mod tests;
