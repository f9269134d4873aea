//! Lines and areas that the user draws on the ground: how mouse and keys change them, and how they
//! are draped on the tiles.
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
    document::{Document, DocumentLine, DrawnPoint},
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

/// Above this number of points, handles are not drawn.
const MOST_HANDLES: usize = 4000;
/// The beginning of the notice about drawn lines that are not shown.
const NOT_LAID: &str =
    "drawn lines that cannot be draped on the ground, and are only partly shown: ";

/// A line that the user draws or has drawn.
#[derive(Debug, Clone, PartialEq)]
pub struct DrawnLine {
    /// The feature of the file that the line comes from; `None` for a line drawn here.
    pub feature: Option<usize>,
    /// Whether the line is the outline of an area: its last point is joined to the first.
    pub is_area: bool,
    /// Longitude and latitude of each point, WGS84.
    pub points_deg: Vec<[f64; 2]>,
}

/// Saves all lines, and returns the path of the file.
pub type SaveDrawing = Box<dyn FnMut(&[DrawnLine]) -> Result<PathBuf, NotSaved>>;

/// Returns the time, in seconds since any moment.
pub type ClockS = Box<dyn Fn() -> f64>;

/// A point of a drawn line on the screen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DrawingHandle {
    /// The position on the screen, in points.
    pub at: [f32; 2],
    /// Whether the point is selected, so that keys act on it.
    pub is_picked: bool,
}

/// The state of the drawing for the panel.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct DrawingContent {
    /// Whether the drawing mode is on.
    pub is_on: bool,
    /// The points of all lines, in drawing mode only.
    pub handles: Vec<DrawingHandle>,
    /// How many lines there are.
    pub lines: usize,
    /// Whether a point is selected.
    pub is_picked: bool,
    /// Whether a change can be undone, and whether one can be redone.
    pub can_step: [bool; 2],
    /// Whether there are unsaved changes.
    pub is_changed: bool,
    /// The number of lines draped on tiles for the last change, and the milliseconds this took.
    pub last: Option<(usize, f64)>,
}

/// The lines that the user draws, and the state of the tool.
pub struct LineDrawing {
    /// Whether the drawing mode is on.
    pub is_on: bool,
    tool: Tool,
    document: Document,
    /// Lines that cannot be transformed to the package's CRS: they are not shown, and are saved
    /// unchanged.
    unplaced: Vec<DrawnLine>,
    laid: LaidLines,
    /// The revision of the document that was draped last.
    laid_revision: u64,
    /// The number of lines that cannot be draped on one of the loaded tiles.
    not_laid: usize,
    last: Option<(usize, f64)>,
    modifiers: Modifiers,
    save: SaveDrawing,
    clock_s: ClockS,
}

impl LineDrawing {
    /// Creates the drawing with the lines of a file. A notice reports the lines that have a point
    /// without a position in the package's CRS: they are not shown.
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
                Some(points) => placed.push(DocumentLine::new(line.feature, line.is_area, points)),
                None => unplaced.push(line.clone()),
            }
        }
        if !unplaced.is_empty() {
            let left_out = unplaced.len();
            notices.warn(format!("{left_out} lines are too far from the package: they are not shown, but stay in the file"));
        }
        Self {
            is_on: false,
            tool: Tool::default(),
            document: Document::from_lines(placed),
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

    /// The revision, which grows with every change of a line.
    #[must_use]
    pub fn revision(&self) -> u64 {
        self.document.revision
    }

    /// Handles a press of the left button while drawing. Returns whether the map must not move.
    pub fn press(&mut self, at_px: DVec2, modifiers: Modifiers, session: &Session) -> bool {
        self.modifiers = modifiers;
        let seen = SeenPoints::from_session(session);
        self.tool.press(at_px / seen.pixels_per_point, &self.document, |point| seen.at(point))
    }

    /// Handles any other input. Returns whether the camera must not get it.
    pub fn input(&mut self, input: &Input, session: &Session) -> bool {
        if !self.is_on {
            return false;
        }
        match *input {
            Input::Modify { modifiers } => self.modifiers = modifiers,
            Input::LetGo => self.tool.let_go(),
            Input::Move { at_px } => {
                let seen = SeenPoints::from_session(session);
                let at = at_px / seen.pixels_per_point;
                self.tool.move_to(at, &mut self.document, || seen.under(at));
                return self.tool.is_dragging();
            }
            Input::Release { button: Button::Left } => {
                let seen = SeenPoints::from_session(session);
                let under = |at: DVec2| seen.under(at);
                let is_shift = self.modifiers.shift;
                self.tool.release(is_shift, &mut self.document, under, |point| seen.at(point));
            }
            _ => {}
        }
        false
    }

    /// Executes a command of a key or the panel for the drawing.
    pub fn command(
        &mut self,
        command: DrawingCommand,
        manifest: &Manifest,
        notices: &mut Notices,
        now_s: f64,
    ) {
        let Self { tool, document, is_on, .. } = self;
        if command != DrawingCommand::Save {
            // The held point may be another one afterwards.
            tool.let_go();
        }
        match command {
            DrawingCommand::Toggle => {
                *is_on = !*is_on;
                tool.end_line();
                let told = if *is_on {
                    "drawing: click on the ground to add points, drag a point to move it; Enter \
                     ends the line, G turns it into an area"
                } else {
                    "drawing ended"
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
                    notices.tell(format!("not turned into an area: {why}"), now_s);
                }
            }
            DrawingCommand::Smooth => {
                let point = |at_m| DrawnPoint::at(at_m, &manifest.coordinates);
                if let Err(why) = tool.smooth(document, point) {
                    notices.tell(format!("corners not rounded: {why}"), now_s);
                }
            }
            DrawingCommand::Undo => document.undo(),
            DrawingCommand::Redo => document.redo(),
            DrawingCommand::Save => match self.save() {
                Some(saved) => notices.tell_saved(saved, now_s),
                None => notices.tell("no unsaved changes".to_owned(), now_s),
            },
        }
    }

    /// The state of the drawing for the panel.
    #[must_use]
    pub fn content(&self, session: &Session) -> DrawingContent {
        let picked = self.tool.picked(&self.document);
        let seen = SeenPoints::from_session(session);
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

    /// Handles evicted and uploaded tiles: drapes changed lines on the loaded tiles; `is_new` means
    /// that some tiles are new. If the number of lines that cannot be draped has changed, a notice
    /// reports it.
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
                "{NOT_LAID}{number}. They have too many points over too much ground, and stay in \
                 the file; simplify them (ogr2ogr -simplify) or split them"
            ));
        }
    }

    /// Handles the loss of all tiles.
    pub fn clear_tiles(&mut self) {
        self.laid.clear();
    }

    /// Saves the lines if they have changed.
    pub fn save(&mut self) -> Option<Result<PathBuf, NotSaved>> {
        if !self.document.is_changed() {
            return None;
        }
        let line = |line: &Arc<DocumentLine>| DrawnLine {
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

/// The mapping between points of lines and positions on the screen.
struct SeenPoints<'a> {
    camera: Camera,
    ground: ShownGround<'a>,
    manifest: &'a Manifest,
    pixels_per_point: f64,
}

impl<'a> SeenPoints<'a> {
    fn from_session(session: &'a Session) -> Self {
        let control = &session.camera;
        Self {
            camera: control.view().camera(control.size_px()),
            ground: session.ground(),
            manifest: session.manifest(),
            pixels_per_point: control.pixels_per_point,
        }
    }

    /// The position of a point on the screen, in points; `None` behind the eye or without ground.
    fn at(&self, point: &DrawnPoint) -> Option<DVec2> {
        let [x, y] = point.at_m;
        let height = self.ground.height(point.at_m)?;
        let (at_px, _) = self.camera.project(DVec3::new(x, y, height))?;
        Some(at_px / self.pixels_per_point)
    }

    /// The point of the ground at a position on the screen, in points.
    fn under(&self, at: DVec2) -> Option<DrawnPoint> {
        let at_px = at * self.pixels_per_point;
        let hit = self.ground.under(&self.camera, at_px)?;
        Some(DrawnPoint::at([hit.x, hit.y], &self.manifest.coordinates))
    }
}
