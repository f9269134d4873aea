//! What mouse and keys mean for the lines that a person draws, and what the panel is told of them.

use corniche_live::{
    CameraControl, ShownGround, Tiles,
    controls::{Button, Input, KnownGround as _, Modifiers},
};
use corniche_tileset::Manifest;
use corniche_viewer::camera::Camera;
use glam::{DVec2, DVec3};

use super::{App, Drawing, ShownPackage, ground};
use crate::{
    command::DrawingCommand,
    drawing::Point,
    formatting,
    settings::Settings,
    window_content::{DrawingContent, Handle},
};

/// More points than these have no handles that can be seen.
const MOST_HANDLES: usize = 4000;

impl App {
    /// Whether the mouse draws.
    pub(crate) fn is_drawing(&self) -> bool {
        self.drawing.is_on
    }

    /// The left button goes down while drawing. Whether the map stays where it is.
    pub(crate) fn press_drawing(&mut self, at_px: DVec2, modifiers: Modifiers) -> bool {
        self.drawing.modifiers = modifiers;
        let seen = Seen::of(&self.camera, &self.tiles, &self.settings, &self.package);
        let at = at_px / seen.pixels_per_point;
        let Drawing { tool, document, .. } = &mut self.drawing;
        tool.press(at, document, |point| seen.at(point))
    }

    /// Any other input while drawing. Whether the camera does not get it.
    pub(crate) fn input_drawing(&mut self, input: &Input) -> bool {
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
    pub(crate) fn draw_command(&mut self, command: DrawingCommand, now_s: f64) {
        let Drawing { tool, document, is_on, .. } = &mut self.drawing;
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
                self.notices.tell(told.to_owned(), now_s);
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
                    self.notices.tell(format!("no area: {why}"), now_s);
                }
            }
            DrawingCommand::Smooth => {
                let coordinates = &self.package.manifest().coordinates;
                let point =
                    |at_m| Point { lon_lat_deg: coordinates.wgs84_from_working(at_m), at_m };
                if let Err(why) = tool.smooth(document, point) {
                    self.notices.tell(format!("no corners rounded: {why}"), now_s);
                }
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
    pub(crate) fn drawing_content(&self) -> DrawingContent {
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
            points.filter_map(handle).take(MOST_HANDLES).collect()
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

    /// The place on the screen, in points; `None` behind the eye or where there is no ground.
    fn at(&self, point: &Point) -> Option<DVec2> {
        let [x, y] = point.at_m;
        let height = self.ground.height(point.at_m)?;
        let (at_px, _) = self.camera.project(DVec3::new(x, y, height))?;
        Some(at_px / self.pixels_per_point)
    }

    /// The point of the ground that is seen there, in points of the screen.
    fn under(&self, at: DVec2) -> Option<Point> {
        let at_px = at * self.pixels_per_point;
        let (start, ray) = (self.camera.ray_start_in_world(at_px), self.camera.ray_in_world(at_px));
        let hit = self.ground.hit(start, ray)?;
        let at_m = [hit.x, hit.y];
        Some(Point { lon_lat_deg: self.manifest.coordinates.wgs84_from_working(at_m), at_m })
    }
}
