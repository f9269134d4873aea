//! A session together with the user's tools around its map: commands, lines to draw, notices.

use corniche_viewer::{
    RoadMethod,
    flight::WorkingCrs,
    gpu::{PassTimes, ReadBackError},
};
use glam::DVec2;

use crate::{
    commands::{DrawingCommand, MapCommand, Shot},
    controls::{Button, Input, Modifiers},
    drawing::LineDrawing,
    formatting::with_causes,
    frame_pace::{FramePace, Redraw},
    map_canvas::{MapCanvas, MapScene},
    notices::{NotSaved, Notices},
    session::{HURRY_S, Session, SessionStep},
    shown_view::{CommandOf, ShownView},
};

/// The times of a frame's passes are read this long after the frame, if no other frame comes
/// before.
const CLOCK_S: f64 = 0.1;
/// The notice that flights are recorded in perspective only.
const NO_FLIGHT_FROM_ABOVE: &str = "flights are recorded in perspective; leave the view from above \
    first";
/// The beginning of the notice about an invalid style file.
const STYLE_STAYS: &str = "the previous style is kept: ";
/// The beginning of the notice about a place that the map cannot go to.
const NO_PLACE: &str = "cannot go there: ";

/// A session, and the state of the tools around its map. Times are seconds of one clock.
pub struct MapDesk {
    /// The map.
    pub session: Session,
    /// The lines that the user draws on the map.
    pub drawing: LineDrawing,
    /// Messages for the user.
    pub notices: Notices,
    /// The names of the line files drawn on the map.
    pub overlays: Vec<String>,
    /// Returns the command that draws a view.
    pub command_of: CommandOf,
    /// The durations of frames.
    pub pace: FramePace,
    /// Times of the passes of the last frame that the GPU has finished, image by image.
    pub passes: Vec<(RoadMethod, PassTimes)>,
}

/// The task that a command leaves to the window or page.
#[derive(Debug, PartialEq)]
pub enum Errand {
    /// Save an image.
    Take(Shot),
    /// Save this text as a flight.
    SaveFlight(String),
    /// Copy this text to the clipboard.
    Copy(String),
}

impl MapDesk {
    /// Handles a press of a mouse button on the map.
    pub fn press(&mut self, button: Button, at_px: DVec2, modifiers: Modifiers, now_s: f64) {
        let is_drawn = self.drawing.is_on && button == Button::Left && !modifiers.control;
        if !is_drawn {
            self.session.press(button, at_px, modifiers, now_s);
        } else if !self.drawing.press(at_px, modifiers, &self.session) {
            self.session.input(&Input::Press { button, at_px, modifiers }, now_s);
        }
    }

    /// Handles any other input.
    pub fn input(&mut self, input: &Input, now_s: f64) {
        if !self.drawing.input(input, &self.session) {
            self.session.input(input, now_s);
        }
    }

    /// Executes the command of a key or a button, as far as the desk can.
    pub fn command(&mut self, command: MapCommand, now_s: f64) -> Option<Errand> {
        let settings = &mut self.session.settings;
        match command {
            MapCommand::NorthUp => self.input(&Input::NorthUp, now_s),
            MapCommand::Reset => self.input(&Input::Reset, now_s),
            MapCommand::ToggleFly => self.input(&Input::ToggleFly, now_s),
            MapCommand::ToggleAbove => {
                let is_done = self.session.toggle_above(now_s);
                self.tell_unless(is_done, now_s);
            }
            MapCommand::GoTo => {
                self.notices.retract(NO_PLACE);
                let place = settings.place.clone();
                if let Err(why) = self.session.go_to(&place, now_s) {
                    self.notices.warn(format!("{NO_PLACE}{why}"));
                }
            }
            MapCommand::CopyView => return self.copy_view(now_s).map(Errand::Copy),
            MapCommand::TogglePanel => settings.is_panel_open = !settings.is_panel_open,
            MapCommand::ToggleHelp => settings.is_help_open = !settings.is_help_open,
            MapCommand::CloseHelp if settings.is_help_open => settings.is_help_open = false,
            MapCommand::CloseHelp => self.draw_command(DrawingCommand::EndLine, now_s),
            MapCommand::Draw(command) => self.draw_command(command, now_s),
            MapCommand::Take(shot) => return Some(Errand::Take(shot)),
            MapCommand::ToggleRecording if self.session.flights.recording_s(now_s).is_none() => {
                return self.command(MapCommand::StartRecording, now_s);
            }
            MapCommand::StartRecording => {
                let is_done = self.session.start_recording(now_s);
                self.tell_unless(is_done, now_s);
            }
            MapCommand::ToggleRecording | MapCommand::StopRecording => {
                let recorded = self.stop_recording(now_s)?;
                return recorded
                    .map_err(|lost| self.tell_lost([lost]))
                    .ok()
                    .map(Errand::SaveFlight);
            }
            MapCommand::Dismiss(place) => self.notices.dismiss(place),
        }
        None
    }

    /// Warns that something was not done because it would record a flight from above.
    fn tell_unless(&mut self, is_done: bool, now_s: f64) {
        if !is_done {
            self.notices.tell(NO_FLIGHT_FROM_ABOVE.to_owned(), now_s);
        }
    }

    fn draw_command(&mut self, command: DrawingCommand, now_s: f64) {
        self.drawing.command(command, self.session.manifest(), &mut self.notices, now_s);
    }

    /// Returns a command that draws the current view.
    fn copy_view(&mut self, now_s: f64) -> Option<String> {
        let shown = ShownView::from_session(&self.session, self.overlays.len());
        let Some((view, left_out)) = shown else {
            self.notices.tell("not copied: the style has no name".to_owned(), now_s);
            return None;
        };
        let command = (self.command_of)(&view);
        self.notices.tell(format!("copied: {command}{left_out}"), now_s);
        Some(command)
    }

    /// Stops recording and returns the text of the flight; `None` if none is being recorded.
    pub fn stop_recording(&mut self, now_s: f64) -> Option<Result<String, NotSaved>> {
        let recorded = self.session.flights.stop_recording(now_s)?;
        let crs = WorkingCrs::from_manifest(self.session.manifest());
        Some(recorded.and_then(|flight| flight.to_text(crs)).map_err(NotSaved::from))
    }

    /// Reports files that were not saved.
    pub fn tell_lost(&mut self, lost: impl IntoIterator<Item = NotSaved>) {
        self.notices.warn_all(lost.into_iter().map(|lost| with_causes(&lost)));
    }

    /// Checks whether the first style has changed, if it is time. Returns whether there is
    /// something new to show.
    pub fn reload(&mut self, now_s: f64) -> bool {
        let Some(reloaded) = self.session.styles.reload(now_s) else { return false };
        self.notices.retract(STYLE_STAYS);
        match reloaded {
            Ok(()) => self.notices.tell("the style was reloaded".to_owned(), now_s),
            Err(why) => self.notices.warn(format!("{STYLE_STAYS}{why}")),
        }
        true
    }

    /// Starts over with a new graphics device after the old one was lost: everything is loaded and
    /// drawn again.
    pub fn begin_again(&mut self) {
        self.session.begin_again();
        self.drawing.clear_tiles();
        self.passes.clear();
        self.notices.warn("the graphics device was lost; everything was reloaded".to_owned());
    }

    /// Executes the step of a frame, drapes drawn lines on new tiles, and reports problems.
    pub fn step(
        &mut self,
        canvas: &mut MapCanvas,
        size_px: [u32; 2],
        pixels_per_point: f32,
        now_s: f64,
    ) -> SessionStep {
        self.notices.expire(now_s);
        let defects = self.session.tiles.take_arrivals().into_iter();
        let told = defects.map(|defect| format!("{defect}; the tile is shown without its ground"));
        self.notices.warn_all(told);
        let step = self.session.step(canvas, size_px, pixels_per_point, now_s);
        let changes = (&step.evicted[..], step.has_new_tiles);
        self.drawing.follow_tiles(changes, &self.session, canvas, &mut self.notices);
        if self.session.tiles.take_first_time_full() {
            self.notices.warn(
                "graphics memory limit reached: this view is coarser than requested; raise the \
                 limit with --gpu-memory"
                    .to_owned(),
            );
        }
        step
    }

    /// The scene in a window of this size. If the image is too large for the adapter with this many
    /// samples, the samples are reduced from now on. `is_in_full` requests full resolution even if
    /// the CPU draws and the camera moves.
    pub fn scene(
        &mut self,
        canvas: &MapCanvas,
        window_px: [u32; 2],
        is_in_full: bool,
        now_s: f64,
    ) -> MapScene {
        let (size_px, samples) = if self.session.is_hurrying(canvas, now_s) && !is_in_full {
            (window_px.map(|side| side.div_ceil(2)), 1)
        } else {
            let wanted = self.session.settings.samples_per_side;
            let drawn = wanted.min(canvas.most_samples(window_px));
            if drawn < wanted {
                self.notices.warn(format!(
                    "{wanted} × {wanted} samples per pixel exceed what the adapter can draw in a \
                     window of this size; reduced to {drawn} × {drawn}"
                ));
                self.session.settings.samples_per_side = drawn;
            }
            (window_px, drawn)
        };
        let revision = self.drawing.revision();
        MapScene { shown_px: window_px, revision, ..self.session.scene(size_px, samples) }
    }

    /// Reads the times that the GPU has finished.
    ///
    /// # Errors
    /// When the device is lost.
    pub fn take_times(&mut self, canvas: &mut MapCanvas) -> Result<(), ReadBackError> {
        match canvas.times() {
            Ok(times) => self.passes = times,
            Err(error) if canvas.gpu.is_lost() => return Err(error),
            Err(error) => {
                self.passes.clear();
                self.notices.warn(format!("no GPU pass was timed: {error}"));
            }
        }
        Ok(())
    }

    /// The time of the next frame that the desk or its host needs: the shortest of these times.
    #[must_use]
    pub fn next_redraw(
        &self,
        canvas: &MapCanvas,
        wishes_s: [Option<f64>; 2],
        now_s: f64,
    ) -> Redraw {
        let [first_s, second_s] = wishes_s;
        let hurry_s = self.session.is_hurrying(canvas, now_s).then_some(HURRY_S);
        // By then the GPU can report how long this frame took.
        let clock_s = canvas.is_timing().then_some(CLOCK_S);
        let recording_s = self.session.flights.recording_s(now_s).map(|s| s.floor() + 1.0 - s);
        let notice_s = self.notices.next_end_s().map(|until_s| (until_s - now_s).max(0.0));
        Redraw::after(now_s, [hurry_s, clock_s, first_s, second_s, recording_s, notice_s])
    }
}
