//! Lines and areas that a person draws on the ground: what mouse and keys do to them, and how they
//! come onto the tiles.
//!
//! ```text
//!  mouse, keys ──► Tool ──► Document (lines, undo, redo) ──► LaidLines ──► layers of the tiles that are shown
//!                              ▲            │
//!                       file ──┘            └──► file
//! ```

mod document;
mod laid;
mod smooth;
mod tool;

use std::{path::PathBuf, sync::Arc};

use corniche_geom::TileId;
use corniche_tileset::Manifest;
use corniche_viewer::camera::Camera;
use glam::{DVec2, DVec3};

use self::{
    document::{Document, DrawnPoint, Line},
    laid::LaidLines,
    tool::Tool,
};
use crate::{
    commands::DrawingCommand,
    controls::{Button, Input, KnownGround as _, Modifiers},
    map_canvas::MapCanvas,
    notices::{NotSaved, Notices},
    session::Session,
    tiles::ShownGround,
};

/// More points than these have no handles that can be seen.
const MOST_HANDLES: usize = 4000;
/// The beginning of the notice that drawn lines are not shown.
const NOT_LAID: &str =
    "drawn lines that cannot be laid on the ground, and are not shown on all of it: ";

/// A line that a person draws or has drawn.
#[derive(Debug, Clone, PartialEq)]
pub struct DrawnLine {
    /// Which feature of the file it comes from; `None` for one that was drawn here.
    pub feature: Option<usize>,
    /// Whether it is the outline of an area: its first point comes after the last one.
    pub is_area: bool,
    /// Longitude and latitude of each point, WGS84.
    pub points_deg: Vec<[f64; 2]>,
}

/// Saves all lines, and tells where.
pub type SaveDrawing = Box<dyn FnMut(&[DrawnLine]) -> Result<PathBuf, NotSaved>>;

/// Tells the time, seconds since any moment.
pub type ClockS = Box<dyn Fn() -> f64>;

/// A point of a drawn line as it is shown.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DrawingHandle {
    /// The place on the screen, points.
    pub at: [f32; 2],
    /// Whether keys act on it.
    pub is_picked: bool,
}

/// What is told of the lines that a person draws.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct DrawingContent {
    /// Whether the mouse draws.
    pub is_on: bool,
    /// The points of all lines, while it does.
    pub handles: Vec<DrawingHandle>,
    /// How many lines there are.
    pub lines: usize,
    /// Whether a point is picked.
    pub is_picked: bool,
    /// Whether a change can be taken back, and whether one can be made again.
    pub can_step: [bool; 2],
    /// Whether something is not saved.
    pub is_changed: bool,
    /// How often a line was laid on a tile for the last change, and how many milliseconds that took.
    pub last: Option<(usize, f64)>,
}

/// The lines that a person draws, and the state of the tool.
pub struct Drawing {
    /// Whether the mouse draws.
    pub is_on: bool,
    tool: Tool,
    document: Document,
    /// Lines that have no place in the package's CRS: they cannot be shown, and are saved as they are.
    unplaced: Vec<DrawnLine>,
    laid: LaidLines,
    /// The state of the document that was laid last.
    laid_revision: u64,
    /// How many lines cannot be laid on one of the tiles that are there.
    not_laid: usize,
    last: Option<(usize, f64)>,
    modifiers: Modifiers,
    save: SaveDrawing,
    clock_s: ClockS,
}

impl Drawing {
    /// The drawing with the lines of a file. A notice tells how many have a point without a place
    /// in the package's CRS: they are not shown.
    pub fn new(
        lines: &[DrawnLine],
        (save, clock_s): (SaveDrawing, ClockS),
        manifest: &Manifest,
        notices: &mut Notices,
    ) -> Self {
        let point = |&lon_lat_deg: &[f64; 2]| {
            let at_m = manifest.coordinates.working_from_wgs84(lon_lat_deg)?;
            Some(DrawnPoint { lon_lat_deg, at_m })
        };
        let (mut placed, mut unplaced) = (Vec::new(), Vec::new());
        for line in lines {
            let points: Option<Vec<DrawnPoint>> = line.points_deg.iter().map(point).collect();
            match points {
                Some(points) => placed.push((line.feature, line.is_area, points)),
                None => unplaced.push(line.clone()),
            }
        }
        if !unplaced.is_empty() {
            let left_out = unplaced.len();
            notices.warn(format!("{left_out} lines lie too far away from the package: they are not shown, and stay in the file"));
        }
        Self {
            is_on: false,
            tool: Tool::default(),
            document: Document::of(placed),
            unplaced,
            laid: LaidLines::default(),
            laid_revision: 0,
            not_laid: 0,
            last: None,
            modifiers: Modifiers::default(),
            save,
            clock_s,
        }
    }

    /// Grows with every change of a line.
    #[must_use]
    pub fn revision(&self) -> u64 {
        self.document.revision
    }

    /// The left button goes down while drawing. Whether the map stays where it is.
    pub fn press(&mut self, at_px: DVec2, modifiers: Modifiers, session: &Session) -> bool {
        self.modifiers = modifiers;
        let seen = SeenPoints::of(session);
        self.tool.press(at_px / seen.pixels_per_point, &self.document, |point| seen.at(point))
    }

    /// Any other input. Whether the camera does not get it.
    pub fn input(&mut self, input: &Input, session: &Session) -> bool {
        if !self.is_on {
            return false;
        }
        match *input {
            Input::Modify { modifiers } => self.modifiers = modifiers,
            Input::LetGo => self.tool.let_go(),
            Input::Move { at_px } => {
                let seen = SeenPoints::of(session);
                let at = at_px / seen.pixels_per_point;
                self.tool.move_to(at, &mut self.document, || seen.under(at));
                return self.tool.is_dragging();
            }
            Input::Release { button: Button::Left } => {
                let seen = SeenPoints::of(session);
                let under = |at: DVec2| seen.under(at);
                let is_shift = self.modifiers.shift;
                self.tool.release(is_shift, &mut self.document, under, |point| seen.at(point));
            }
            _ => {}
        }
        false
    }

    /// Does what a key or the panel asks of the drawing.
    pub fn command(
        &mut self,
        command: DrawingCommand,
        manifest: &Manifest,
        notices: &mut Notices,
        now_s: f64,
    ) {
        let Self { tool, document, is_on, .. } = self;
        if command != DrawingCommand::Save {
            // What is held may be another point afterwards.
            tool.let_go();
        }
        match command {
            DrawingCommand::Toggle => {
                *is_on = !*is_on;
                tool.end_line();
                let told = if *is_on {
                    "drawing: click on the ground to add points, drag a point to move it, Enter ends the line, G makes it an area"
                } else {
                    "drawing is over"
                };
                notices.tell(told.to_owned(), now_s);
            }
            DrawingCommand::EndLine => tool.end_line(),
            DrawingCommand::RemovePoint => {
                tool.remove_point(document);
            }
            DrawingCommand::RemoveLine => {
                tool.remove_line(document);
            }
            DrawingCommand::Turn => {
                if let Err(why) = tool.turn(document) {
                    notices.tell(format!("no area: {why}"), now_s);
                }
            }
            DrawingCommand::Smooth => {
                let coordinates = &manifest.coordinates;
                let point =
                    |at_m| DrawnPoint { lon_lat_deg: coordinates.wgs84_from_working(at_m), at_m };
                if let Err(why) = tool.smooth(document, point) {
                    notices.tell(format!("no corners rounded: {why}"), now_s);
                }
            }
            DrawingCommand::Undo => document.undo(),
            DrawingCommand::Redo => document.redo(),
            DrawingCommand::Save => match self.save() {
                Some(saved) => notices.tell_saved(saved, now_s),
                None => notices.tell("no line has changed".to_owned(), now_s),
            },
        }
    }

    /// What is shown of the drawing.
    #[must_use]
    pub fn content(&self, session: &Session) -> DrawingContent {
        let picked = self.tool.picked(&self.document);
        let seen = SeenPoints::of(session);
        let handle = |(line, place, point): (u64, usize, &DrawnPoint)| {
            let is_picked = picked.is_some_and(|at| (at.line, at.place) == (line, place));
            let at = seen.at(point)?.to_array().map(|value| value as f32);
            Some(DrawingHandle { at, is_picked })
        };
        let handles = if self.is_on {
            self.document.points().filter_map(handle).take(MOST_HANDLES).collect()
        } else {
            Vec::new()
        };
        DrawingContent {
            is_on: self.is_on,
            handles,
            lines: self.document.lines.len(),
            is_picked: picked.is_some(),
            can_step: self.document.can_step(),
            is_changed: self.document.is_changed(),
            last: self.last,
        }
    }

    /// Tiles were evicted and uploaded: lays what has changed on those that are there now; `is_new`
    /// says that some of them were not there before. A notice tells how many lines cannot be laid,
    /// when that has changed.
    pub fn follow_tiles(
        &mut self,
        (evicted, is_new): (&[TileId], bool),
        session: &Session,
        canvas: &mut MapCanvas,
        notices: &mut Notices,
    ) {
        self.laid.evict(evicted);
        let is_changed = self.laid_revision != self.document.revision;
        if !is_changed && !is_new {
            return;
        }
        self.laid_revision = self.document.revision;
        let begun_s = (self.clock_s)();
        let tiles = session.tiles.resident();
        let relaid = self.laid.update(&self.document, tiles, session.manifest());
        for (id, lines, areas) in &relaid.changed {
            canvas.replace_drawn(*id, lines, areas);
        }
        if is_changed {
            self.last = Some((relaid.laid, ((self.clock_s)() - begun_s) * 1e3));
        }
        let number = relaid.not_laid.len();
        if std::mem::replace(&mut self.not_laid, number) == number {
            return;
        }
        notices.retract(NOT_LAID);
        if number > 0 {
            notices.warn(format!(
                "{NOT_LAID}{number}. They cross too much ground with too many points, and stay in the file; simplify them (ogr2ogr \
                 -simplify), or divide them"
            ));
        }
    }

    /// All tiles are gone.
    pub fn clear_tiles(&mut self) {
        self.laid.clear();
    }

    /// Saves the lines if they have changed.
    pub fn save(&mut self) -> Option<Result<PathBuf, NotSaved>> {
        if !self.document.is_changed() {
            return None;
        }
        let line = |line: &Arc<Line>| DrawnLine {
            feature: line.feature,
            is_area: line.is_area,
            points_deg: line.points.iter().map(|point| point.lon_lat_deg).collect(),
        };
        let drawn = self.document.lines.iter().map(line);
        let lines: Vec<DrawnLine> = drawn.chain(self.unplaced.iter().cloned()).collect();
        let saved = (self.save)(&lines);
        if saved.is_ok() {
            self.document.note_saved();
        }
        Some(saved)
    }
}

/// Where points of lines are seen, and which points are.
struct SeenPoints<'a> {
    camera: Camera,
    ground: ShownGround<'a>,
    manifest: &'a Manifest,
    pixels_per_point: f64,
}

impl<'a> SeenPoints<'a> {
    fn of(session: &'a Session) -> Self {
        let control = &session.camera;
        Self {
            camera: control.view().camera(control.size_px()),
            ground: session.ground(),
            manifest: session.manifest(),
            pixels_per_point: control.pixels_per_point,
        }
    }

    /// The place on the screen, in points; `None` behind the eye or where there is no ground.
    fn at(&self, point: &DrawnPoint) -> Option<DVec2> {
        let [x, y] = point.at_m;
        let height = self.ground.height(point.at_m)?;
        let (at_px, _) = self.camera.project(DVec3::new(x, y, height))?;
        Some(at_px / self.pixels_per_point)
    }

    /// The point of the ground that is seen there, in points of the screen.
    fn under(&self, at: DVec2) -> Option<DrawnPoint> {
        let at_px = at * self.pixels_per_point;
        let (start, ray) = (self.camera.ray_start_in_world(at_px), self.camera.ray_in_world(at_px));
        let hit = self.ground.hit(start, ray)?;
        let at_m = [hit.x, hit.y];
        Some(DrawnPoint { lon_lat_deg: self.manifest.coordinates.wgs84_from_working(at_m), at_m })
    }
}
