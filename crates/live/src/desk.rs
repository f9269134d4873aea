//! A session with what a person has at hand beside its map: commands, lines to draw, notices.

use corniche_viewer::{
    RoadMethod,
    flight::WorkingCrs,
    gpu::{PassTimes, ReadBackError},
};
use glam::DVec2;

use crate::{
    commands::{Command, DrawingCommand, Shot},
    controls::{Button, Input, Modifiers},
    drawing::Drawing,
    formatting::with_causes,
    frame_pace::{FramePace, Redraw},
    map_canvas::{MapCanvas, MapScene},
    notices::{NotSaved, Notices},
    session::{HURRY_S, Session, SessionStep},
    shown_view::{CommandOf, ShownView},
};

/// The times of a frame's passes are asked for this long after it, if no other frame comes before.
const CLOCK_S: f64 = 0.1;
/// Flights are in perspective.
const NO_FLIGHT_FROM_ABOVE: &str = "flights are recorded in perspective: not from above";
/// The beginning of the notice that a style's file cannot be used.
const STYLE_STAYS: &str = "the style stays as it was: ";
/// The beginning of the notice that the map cannot go where it was asked to.
const NO_PLACE: &str = "go to: ";

/// A session, and what a person sees and does beside its map. Times are seconds of one clock.
pub struct MapDesk {
    /// The map.
    pub session: Session,
    /// The lines that a person draws on it.
    pub drawing: Drawing,
    /// Messages for the person.
    pub notices: Notices,
    /// What people call the files of lines that lie on the map.
    pub overlays: Vec<String>,
    /// Tells the command that draws a view.
    pub command_of: CommandOf,
    /// How long frames take.
    pub pace: FramePace,
    /// Times of the passes of the last frame that the graphics card has finished, picture by picture.
    pub passes: Vec<(RoadMethod, PassTimes)>,
}

/// What whoever shows the map has to do for a command.
#[derive(Debug, PartialEq)]
pub enum Errand {
    /// Save a picture.
    Take(Shot),
    /// Save this text as a flight.
    SaveFlight(String),
    /// Put this text on the clipboard.
    Copy(String),
}

impl MapDesk {
    /// A button of the mouse goes down on the map.
    pub fn press(&mut self, button: Button, at_px: DVec2, modifiers: Modifiers, now_s: f64) {
        let is_drawn = self.drawing.is_on && button == Button::Left && !modifiers.control;
        if !is_drawn {
            self.session.press(button, at_px, modifiers, now_s);
        } else if !self.drawing.press(at_px, modifiers, &self.session) {
            self.session.input(&Input::Press { button, at_px, modifiers }, now_s);
        }
    }

    /// Any other input.
    pub fn input(&mut self, input: &Input, now_s: f64) {
        if !self.drawing.input(input, &self.session) {
            self.session.input(input, now_s);
        }
    }

    /// Does what a key or a button asks for, as far as it can.
    pub fn command(&mut self, command: Command, now_s: f64) -> Option<Errand> {
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
            Command::CopyView => return self.copy_view(now_s).map(Errand::Copy),
            Command::TogglePanel => settings.is_panel_open = !settings.is_panel_open,
            Command::ToggleHelp => settings.is_help_open = !settings.is_help_open,
            Command::CloseHelp if settings.is_help_open => settings.is_help_open = false,
            Command::CloseHelp => self.draw_command(DrawingCommand::EndLine, now_s),
            Command::Draw(command) => self.draw_command(command, now_s),
            Command::Take(shot) => return Some(Errand::Take(shot)),
            Command::ToggleRecording if self.session.flights.recording_s(now_s).is_none() => {
                return self.command(Command::StartRecording, now_s);
            }
            Command::StartRecording => {
                let is_done = self.session.start_recording(now_s);
                self.tell_unless(is_done, now_s);
            }
            Command::ToggleRecording | Command::StopRecording => {
                let recorded = self.stop_recording(now_s)?;
                return recorded
                    .map_err(|lost| self.tell_lost([lost]))
                    .ok()
                    .map(Errand::SaveFlight);
            }
            Command::Dismiss(place) => self.notices.dismiss(place),
        }
        None
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

    /// A command that draws this view, which is shown.
    fn copy_view(&mut self, now_s: f64) -> Option<String> {
        let shown = ShownView::of(&self.session, self.overlays.len());
        let Some((view, left_out)) = shown else {
            self.notices.tell("not copied: the style has no name".to_owned(), now_s);
            return None;
        };
        let command = (self.command_of)(&view);
        self.notices.tell(format!("copied: {command}{left_out}"), now_s);
        Some(command)
    }

    /// Ends the recording; `None` where there is none. The text of the flight.
    pub fn stop_recording(&mut self, now_s: f64) -> Option<Result<String, NotSaved>> {
        let recorded = self.session.flights.stop_recording(now_s)?;
        let crs = WorkingCrs::of(self.session.manifest());
        Some(recorded.and_then(|flight| flight.to_text(crs)).map_err(NotSaved::from))
    }

    /// Files that were not saved.
    pub fn tell_lost(&mut self, lost: impl IntoIterator<Item = NotSaved>) {
        self.notices.warn_all(lost.into_iter().map(|lost| with_causes(&lost)));
    }

    /// Asks whether the first style has changed, if it is time; tells whether there is something to show.
    pub fn reload(&mut self, now_s: f64) -> bool {
        let Some(reloaded) = self.session.styles.reload(now_s) else { return false };
        self.notices.retract(STYLE_STAYS);
        match reloaded {
            Ok(()) => self.notices.tell("the style was loaded again".to_owned(), now_s),
            Err(why) => self.notices.warn(format!("{STYLE_STAYS}{why}")),
        }
        true
    }

    /// The graphics device is lost and another one has taken its place: everything is loaded and drawn again.
    pub fn begin_again(&mut self) {
        self.session.begin_again();
        self.drawing.clear_tiles();
        self.passes.clear();
        self.notices.warn("the graphics device was lost; everything was loaded again".to_owned());
    }

    /// Does the step of a frame, lays drawn lines on the tiles that have come, and tells what went
    /// wrong.
    pub fn step(
        &mut self,
        canvas: &mut MapCanvas,
        size_px: [u32; 2],
        pixels_per_point: f32,
        now_s: f64,
    ) -> SessionStep {
        self.notices.expire(now_s);
        let defects = self.session.tiles.take_arrivals().into_iter();
        let told = defects.map(|defect| format!("{defect}; it is shown without its ground"));
        self.notices.warn_all(told);
        let step = self.session.step(canvas, size_px, pixels_per_point, now_s);
        let changes = (&step.evicted[..], step.has_new_tiles);
        self.drawing.follow_tiles(changes, &self.session, canvas, &mut self.notices);
        if self.session.tiles.take_first_time_full() {
            self.notices.warn(
                "the graphics memory allowed is full: this view is drawn more coarsely than asked; allow more with \
                 --gpu-memory"
                    .to_owned(),
            );
        }
        step
    }

    /// What is drawn in a window of this size. Where the picture is too large for the adapter with
    /// so many samples, there are fewer from now on. `is_in_full` says that it is drawn in full
    /// also where a processor draws and the camera moves.
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
                    "{wanted} × {wanted} samples a pixel are more than the adapter can draw in a window of this size; there \
                     are {drawn} × {drawn} now"
                ));
                self.session.settings.samples_per_side = drawn;
            }
            (window_px, drawn)
        };
        let revision = self.drawing.revision();
        MapScene { shown_px: window_px, revision, ..self.session.scene(size_px, samples) }
    }

    /// Takes the times that the graphics card has finished.
    ///
    /// # Errors
    /// When the device is lost.
    pub fn take_times(&mut self, canvas: &mut MapCanvas) -> Result<(), ReadBackError> {
        match canvas.times() {
            Ok(times) => self.passes = times,
            Err(error) if canvas.gpu.is_lost() => return Err(error),
            Err(error) => {
                self.passes.clear();
                self.notices.warn(format!("no pass was timed: {error}"));
            }
        }
        Ok(())
    }

    /// When the next frame is due that the desk itself asks for, or whoever shows it: after the
    /// shortest of these times.
    #[must_use]
    pub fn next_redraw(
        &self,
        canvas: &MapCanvas,
        wishes_s: [Option<f64>; 2],
        now_s: f64,
    ) -> Redraw {
        let [first_s, second_s] = wishes_s;
        let hurry_s = self.session.is_hurrying(canvas, now_s).then_some(HURRY_S);
        // By then the graphics card can tell how long this frame took.
        let clock_s = canvas.is_timing().then_some(CLOCK_S);
        let recording_s = self.session.flights.recording_s(now_s).map(|s| s.floor() + 1.0 - s);
        let notice_s = self.notices.next_end_s().map(|until_s| (until_s - now_s).max(0.0));
        Redraw::after(now_s, [hurry_s, clock_s, first_s, second_s, recording_s, notice_s])
    }
}
