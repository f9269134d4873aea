//! The drawing tool: the effect of the mouse on the lines.

use std::sync::Arc;

use glam::DVec2;

use super::{
    document::{Document, DocumentLine, DrawnPoint},
    smooth::{Unchanged, smoothed},
};

/// The largest distance between the cursor and a point of a line at which the cursor touches the
/// point, in screen points.
const NEAR_POINTS: f64 = 9.0;
/// A cursor that moves farther than this with the button held drags the map.
const STILL_POINTS: f64 = 3.0;

/// A point of a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Picked {
    /// The line.
    pub(crate) line: u64,
    /// The index of the point in the line.
    pub(crate) place: usize,
}

/// The tool that draws and changes lines.
#[derive(Debug, Default)]
pub(crate) struct Tool {
    /// The selected point, on which keys act; a click on the ground continues from the end of its
    /// line.
    picked: Option<Picked>,
    pressed: Option<Press>,
}

#[derive(Debug, Clone, Copy)]
struct Press {
    at: DVec2,
    /// The dragged point of a line; `None` while the map is dragged.
    point: Option<Picked>,
    /// Whether the cursor has moved since the press.
    is_moved: bool,
    /// Whether the point has been moved since the press.
    is_shifted: bool,
}

impl Tool {
    /// The selected point, as long as it exists.
    pub(crate) fn picked(&self, document: &Document) -> Option<Picked> {
        self.picked
            .filter(|at| document.line(at.line).is_some_and(|line| at.place < line.points.len()))
    }

    /// Handles a press of the button, at a position on the screen in points. `seen_at` returns the
    /// screen position of a point of a line. Returns whether a point was hit, so that the map must
    /// not be dragged.
    pub(crate) fn press(
        &mut self,
        at: DVec2,
        document: &Document,
        seen_at: impl Fn(&DrawnPoint) -> Option<DVec2>,
    ) -> bool {
        let point = nearest(at, document, seen_at);
        if point.is_some() {
            self.picked = point;
        }
        self.pressed = Some(Press { at, point, is_moved: false, is_shifted: false });
        point.is_some()
    }

    /// Handles a movement of the cursor; `ground` is the ground under it. Returns whether a line
    /// was changed.
    pub(crate) fn move_to(
        &mut self,
        at: DVec2,
        document: &mut Document,
        ground: impl FnOnce() -> Option<DrawnPoint>,
    ) -> bool {
        let Some(press) = &mut self.pressed else { return false };
        if !press.is_moved && press.at.distance(at) <= STILL_POINTS {
            return false;
        }
        press.is_moved = true;
        let (Some(Picked { line, place }), Some(to)) =
            (press.point, press.point.and_then(|_| ground()))
        else {
            return false;
        };
        if std::mem::replace(&mut press.is_shifted, true) {
            document.shift_on(line, place, to);
        } else {
            document.shift(line, place, to);
        }
        true
    }

    /// Handles the release of the button. If the cursor has not moved since the press, a point is
    /// added, or, with Shift, inserted between the two nearest points of the selected line.
    /// `ground` is the ground under the cursor. Returns whether a line was changed.
    pub(crate) fn release(
        &mut self,
        is_shift: bool,
        document: &mut Document,
        ground: impl FnOnce(DVec2) -> Option<DrawnPoint>,
        seen_at: impl Fn(&DrawnPoint) -> Option<DVec2>,
    ) -> bool {
        let Some(press) = self.pressed.take() else { return false };
        if press.is_moved || press.point.is_some() {
            return false;
        }
        let Some(point) = ground(press.at) else { return false };
        let picked = self.picked(document);
        let known = picked.and_then(|picked| document.line(picked.line));
        let (line, place) = match known {
            None => (document.begin(point), 0),
            Some(line) => {
                let place = if is_shift {
                    nearest_segment(press.at, line, seen_at).map_or(line.points.len(), |k| k + 1)
                } else if line.is_area {
                    // An area has no end to continue from.
                    picked.map_or(line.points.len(), |picked| picked.place + 1)
                } else if picked.is_some_and(|picked| picked.place == 0) && line.points.len() > 1 {
                    // The line continues from its selected end.
                    0
                } else {
                    line.points.len()
                };
                let id = line.id;
                document.insert(id, place, point);
                (id, place)
            }
        };
        self.picked = Some(Picked { line, place });
        true
    }

    /// Treats the button as released, without any effect.
    pub(crate) fn let_go(&mut self) {
        self.pressed = None;
    }

    /// Whether a point of a line is held.
    pub(crate) fn is_dragging(&self) -> bool {
        self.pressed.is_some_and(|press| press.point.is_some())
    }

    /// The next click begins another line.
    pub(crate) fn end_line(&mut self) {
        self.picked = None;
    }

    /// Removes the selected point, and selects the one before it. Returns whether there was one.
    pub(crate) fn remove_point(&mut self, document: &mut Document) -> bool {
        let Some(Picked { line, place }) = self.picked(document) else { return false };
        document.remove_point(line, place);
        self.picked = Some(Picked { line, place: place.saturating_sub(1) });
        true
    }

    /// Turns the selected line into an area, or the selected area into a line.
    pub(crate) fn turn(&mut self, document: &mut Document) -> Result<(), Unchanged> {
        let line = self.picked_line(document)?;
        if !line.is_area && line.points.len() < 3 {
            return Err(Unchanged::FewPoints);
        }
        let id = line.id;
        document.turn(id);
        Ok(())
    }

    /// Rounds the corners of the selected line; `place` makes a point from a position in the
    /// working CRS.
    pub(crate) fn smooth(
        &mut self,
        document: &mut Document,
        place: impl Fn([f64; 2]) -> DrawnPoint,
    ) -> Result<(), Unchanged> {
        let line = self.picked_line(document)?;
        let (id, points) = (line.id, smoothed(line, place)?);
        document.change_points(id, |known| *known = points);
        self.picked = None;
        Ok(())
    }

    fn picked_line<'a>(&self, document: &'a Document) -> Result<&'a DocumentLine, Unchanged> {
        let picked = self.picked(document).and_then(|picked| document.line(picked.line));
        picked.map(Arc::as_ref).ok_or(Unchanged::NothingPicked)
    }

    /// Removes the selected line. Returns whether there was one.
    pub(crate) fn remove_line(&mut self, document: &mut Document) -> bool {
        let Some(Picked { line, .. }) = self.picked(document) else { return false };
        document.remove_line(line);
        self.picked = None;
        true
    }
}

/// The point of a line nearest to a position on the screen, if it is near.
fn nearest(
    at: DVec2,
    document: &Document,
    seen_at: impl Fn(&DrawnPoint) -> Option<DVec2>,
) -> Option<Picked> {
    document
        .points()
        .filter_map(|(line, place, point)| {
            Some((Picked { line, place }, seen_at(point)?.distance(at)))
        })
        .filter(|(_, away)| *away <= NEAR_POINTS)
        .min_by(|(_, one), (_, other)| one.total_cmp(other))
        .map(|(picked, _)| picked)
}

/// The index of the segment of a line that is nearest to a position on the screen; the last segment
/// of an area closes it.
fn nearest_segment(
    at: DVec2,
    line: &DocumentLine,
    seen_at: impl Fn(&DrawnPoint) -> Option<DVec2>,
) -> Option<usize> {
    let closing = line.points.first().filter(|_| line.is_area);
    let seen: Vec<Option<DVec2>> = line.points.iter().chain(closing).map(seen_at).collect();
    let away = |(place, pair): (usize, &[Option<DVec2>])| {
        let (from, to) = (pair[0]?, pair[1]?);
        let way = to - from;
        let share = ((at - from).dot(way) / way.length_squared().max(1e-9)).clamp(0.0, 1.0);
        Some((place, at.distance(from + share * way)))
    };
    seen.windows(2)
        .enumerate()
        .filter_map(away)
        .min_by(|(_, one), (_, other)| one.total_cmp(other))
        .map(|(place, _)| place)
}

#[cfg(test)]
#[path = "tool_tests.rs"]
mod tests;
