//! Drawing of lines: what mouse and keys mean for it, and what the panel is told.

use std::{path::PathBuf, sync::Arc};

use corniche_geom::TileId;
use corniche_tileset::Manifest;
use corniche_viewer::camera::Camera;
use glam::{DVec2, DVec3};

use super::{App, CameraControl, ShownPackage, ground};
use crate::{
    ClockS, DrawnLine, NotSaved, SaveDrawing,
    canvas::Canvas,
    command::DrawingCommand,
    controls::{Button, Input, KnownGround as _, Modifiers},
    drawing::{Document, LaidLines, Line, Point, Tool},
    formatting,
    settings::Settings,
    tiles::{ShownGround, Tiles},
    window_content::{DrawingContent, Handle},
};

/// More points than these have no handles that can be seen.
const MOST_HANDLES: usize = 4000;

/// The drawing of the window.
pub(crate) struct Drawing {
    is_on: bool,
    tool: Tool,
    document: Document,
    laid: LaidLines,
    /// The state of the document that was laid last.
    laid_revision: u64,
    /// How often a line was laid on a tile for the last change, and how long that took.
    last: Option<(usize, f64)>,
    modifiers: Modifiers,
    save: SaveDrawing,
    clock_s: ClockS,
}

impl Drawing {
    /// With the lines of a file. Those with a point that has no place in the package's CRS are left out, and counted.
    pub(crate) fn new(
        lines: &[DrawnLine],
        (save, clock_s): (SaveDrawing, ClockS),
        manifest: &Manifest,
    ) -> (Self, usize) {
        let point = |&lon_lat_deg: &[f64; 2]| {
            let at_m = manifest.coordinates.working_from_wgs84(lon_lat_deg)?;
            Some(Point { lon_lat_deg, at_m })
        };
        let placed: Vec<_> = lines
            .iter()
            .filter_map(|line| {
                let points: Option<Vec<Point>> = line.points_deg.iter().map(point).collect();
                Some((line.feature, points?))
            })
            .collect();
        let left_out = lines.len() - placed.len();
        let drawing = Self {
            is_on: false,
            tool: Tool::default(),
            document: Document::of(placed),
            laid: LaidLines::default(),
            laid_revision: 0,
            last: None,
            modifiers: Modifiers::default(),
            save,
            clock_s,
        };
        (drawing, left_out)
    }

    /// Grows with every change of a line.
    pub(crate) fn revision(&self) -> u64 {
        self.document.revision()
    }

    /// Lays what has changed on the tiles that are there; `is_new` says that some of them were not there before.
    pub(crate) fn lay(
        &mut self,
        canvas: &mut Canvas,
        tiles: &Tiles,
        manifest: &Manifest,
        is_new: bool,
    ) {
        let is_changed = self.laid_revision != self.document.revision();
        if !is_changed && !is_new {
            return;
        }
        self.laid_revision = self.document.revision();
        let begun_s = (self.clock_s)();
        let relaid = self.laid.update(&self.document, tiles.resident(), manifest);
        for (id, lines) in &relaid.changed {
            canvas.replace_drawn_lines(*id, lines);
        }
        if is_changed {
            self.last = Some((relaid.laid, ((self.clock_s)() - begun_s) * 1e3));
        }
    }

    /// Tiles are gone.
    pub(crate) fn evict(&mut self, ids: &[TileId]) {
        self.laid.evict(ids);
    }

    /// All tiles are gone.
    pub(crate) fn clear_tiles(&mut self) {
        self.laid.clear();
    }

    /// Saves the lines if they have changed.
    pub(crate) fn save(&mut self) -> Option<Result<PathBuf, NotSaved>> {
        if !self.document.is_changed() {
            return None;
        }
        let line = |line: &Arc<Line>| DrawnLine {
            feature: line.feature,
            points_deg: line.points.iter().map(|point| point.lon_lat_deg).collect(),
        };
        let lines: Vec<DrawnLine> = self.document.lines().iter().map(line).collect();
        let saved = (self.save)(&lines);
        if saved.is_ok() {
            self.document.note_saved();
        }
        Some(saved)
    }
}

impl App {
    /// Whether the mouse draws.
    pub(crate) fn is_drawing(&self) -> bool {
        self.drawing.is_on
    }

    /// The left button goes down while drawing. Whether the map stays where it is.
    pub(super) fn press_drawing(&mut self, at_px: DVec2, modifiers: Modifiers) -> bool {
        self.drawing.modifiers = modifiers;
        let seen = Seen::of(&self.camera, &self.tiles, &self.settings, &self.package);
        let at = at_px / seen.pixels_per_point;
        let Drawing { tool, document, .. } = &mut self.drawing;
        tool.press(at, document, |point| seen.at(point))
    }

    /// Any other input while drawing. Whether the camera does not get it.
    pub(super) fn input_drawing(&mut self, input: &Input) -> bool {
        match *input {
            Input::Modify { modifiers } => self.drawing.modifiers = modifiers,
            Input::LetGo => self.drawing.tool.let_go(),
            Input::Move { at_px } => {
                let seen = Seen::of(&self.camera, &self.tiles, &self.settings, &self.package);
                let at = at_px / seen.pixels_per_point;
                let Drawing { tool, document, .. } = &mut self.drawing;
                tool.move_to(at, document, || seen.under(at));
                return tool.is_dragging();
            }
            Input::Release { button: Button::Left } => {
                let seen = Seen::of(&self.camera, &self.tiles, &self.settings, &self.package);
                let Drawing { tool, document, modifiers, .. } = &mut self.drawing;
                let under = |at: DVec2| seen.under(at);
                tool.release(modifiers.shift, document, under, |point| seen.at(point));
            }
            _ => {}
        }
        false
    }

    /// Does what a key or the panel asks of the drawing.
    pub(super) fn draw_command(&mut self, command: DrawingCommand, now_s: f64) {
        let Drawing { tool, document, is_on, .. } = &mut self.drawing;
        match command {
            DrawingCommand::Toggle => {
                *is_on = !*is_on;
                tool.let_go();
                tool.end_line();
                let told = if *is_on {
                    "drawing: click on the ground to add points, drag a point to move it, Enter ends the line"
                } else {
                    "drawing is over"
                };
                self.notices.tell(told.to_owned(), now_s);
            }
            DrawingCommand::EndLine => tool.end_line(),
            DrawingCommand::RemovePoint => {
                tool.remove_point(document);
            }
            DrawingCommand::RemoveLine => {
                tool.remove_line(document);
            }
            DrawingCommand::Undo => document.undo(),
            DrawingCommand::Redo => document.redo(),
            DrawingCommand::Save => match self.drawing.save() {
                Some(Ok(path)) => self.notices.tell(format!("saved {}", path.display()), now_s),
                Some(Err(lost)) => self.notices.warn(formatting::with_causes(&lost)),
                None => self.notices.tell("no line has changed".to_owned(), now_s),
            },
        }
    }

    /// What the panel and the overlay show of the drawing.
    pub(super) fn drawing_content(&self) -> DrawingContent {
        let drawing = &self.drawing;
        let picked = drawing.tool.picked(&drawing.document);
        let seen = Seen::of(&self.camera, &self.tiles, &self.settings, &self.package);
        let lines = drawing.document.lines();
        let points = lines.iter().flat_map(|line| {
            line.points.iter().enumerate().map(move |(place, point)| (line.id, place, point))
        });
        let handle = |(line, place, point): (u64, usize, &Point)| {
            let is_picked = picked.is_some_and(|at| (at.line, at.place) == (line, place));
            Some(Handle { at: seen.at(point)?.to_array().map(|value| value as f32), is_picked })
        };
        let handles = if drawing.is_on {
            points.take(MOST_HANDLES).filter_map(handle).collect()
        } else {
            Vec::new()
        };
        DrawingContent {
            is_on: drawing.is_on,
            handles,
            lines: lines.len(),
            is_picked: picked.is_some(),
            can_step: drawing.document.can_step(),
            is_changed: drawing.document.is_changed(),
            last: drawing.last,
        }
    }
}

/// Where points of lines are seen, and which points are.
struct Seen<'a> {
    camera: Camera,
    ground: ShownGround<'a>,
    manifest: &'a Manifest,
    pixels_per_point: f64,
}

impl<'a> Seen<'a> {
    fn of(
        control: &CameraControl,
        tiles: &'a Tiles,
        settings: &Settings,
        package: &'a ShownPackage,
    ) -> Self {
        Self {
            camera: control.view().camera(control.size_px()),
            ground: ground(tiles, settings, package),
            manifest: package.manifest(),
            pixels_per_point: control.pixels_per_point(),
        }
    }

    /// On the screen, in points; `None` behind the eye or where there is no ground.
    fn at(&self, point: &Point) -> Option<DVec2> {
        let [x, y] = point.at_m;
        let height = self.ground.height(point.at_m)?;
        let (at_px, _) = self.camera.project(DVec3::new(x, y, height))?;
        Some(at_px / self.pixels_per_point)
    }

    /// The point of the ground that is seen there, in points of the screen.
    fn under(&self, at: DVec2) -> Option<Point> {
        let ray = self.camera.ray_in_world(at * self.pixels_per_point);
        let hit = self.ground.hit(self.camera.eye_in_world(), ray)?;
        let at_m = [hit.x, hit.y];
        Some(Point { lon_lat_deg: self.manifest.coordinates.wgs84_from_working(at_m), at_m })
    }
}
