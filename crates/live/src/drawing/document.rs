//! The lines, and what was changed in them.

use std::sync::Arc;

/// How many changes can be taken back.
const MOST_CHANGES: usize = 1000;

/// A point of a line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct DrawnPoint {
    /// Longitude and latitude, as they are saved.
    pub(crate) lon_lat_deg: [f64; 2],
    /// x and y in the working CRS.
    pub(crate) at_m: [f64; 2],
}

/// A line. Lines are never changed: a change makes another line in the same place.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Line {
    /// Which line it is, whatever is changed in it.
    pub(crate) id: u64,
    /// Which feature of the file it comes from; `None` for one that was drawn.
    pub(crate) feature: Option<usize>,
    /// Whether it is the outline of an area: its first point comes after the last one.
    pub(crate) is_area: bool,
    /// Its points; a line that is being begun has only one.
    pub(crate) points: Vec<DrawnPoint>,
}

impl Line {
    /// Whether it has points enough to be saved: an area of two is saved as a line.
    fn is_whole(&self) -> bool {
        self.points.len() >= 2
    }
}

type Lines = Vec<Arc<Line>>;

/// All lines, with what they were before each change.
#[derive(Debug, Default)]
pub(crate) struct Document {
    pub(crate) lines: Lines,
    undone: Vec<Lines>,
    done: Vec<Lines>,
    next_id: u64,
    /// Changes since the beginning, those that were taken back included.
    pub(crate) revision: u64,
    /// The lines as they were saved last.
    saved: Lines,
}

impl Document {
    /// The document of lines that are saved already: which feature of the file each is, whether it is an area, and its points.
    pub(crate) fn of(lines: Vec<(Option<usize>, bool, Vec<DrawnPoint>)>) -> Self {
        let mut document = Self::default();
        for (feature, is_area, points) in lines {
            let id = document.take_id();
            document.lines.push(Arc::new(Line { id, feature, is_area, points }));
        }
        document.saved.clone_from(&document.lines);
        document
    }

    /// All points: their lines, their places in them, and themselves.
    pub(crate) fn points(&self) -> impl Iterator<Item = (u64, usize, &DrawnPoint)> {
        self.lines.iter().flat_map(|line| {
            line.points.iter().enumerate().map(move |(place, point)| (line.id, place, point))
        })
    }

    /// A line by its id.
    pub(crate) fn line(&self, id: u64) -> Option<&Arc<Line>> {
        self.lines.iter().find(|line| line.id == id)
    }

    /// Whether there is something that is not saved.
    pub(crate) fn is_changed(&self) -> bool {
        // One point is no line.
        fn lines(all: &Lines) -> impl Iterator<Item = &Arc<Line>> + Clone {
            all.iter().filter(|line| line.is_whole())
        }
        let (now, saved) = (lines(&self.lines), lines(&self.saved));
        now.clone().count() != saved.clone().count()
            || now.zip(saved).any(|(now, saved)| !Arc::ptr_eq(now, saved))
    }

    /// What there is now is saved.
    pub(crate) fn note_saved(&mut self) {
        self.saved.clone_from(&self.lines);
    }

    /// Whether a change can be taken back, and whether one that was taken back can be made again.
    pub(crate) fn can_step(&self) -> [bool; 2] {
        [!self.done.is_empty(), !self.undone.is_empty()]
    }

    /// Begins a line; returns its id.
    pub(crate) fn begin(&mut self, first: DrawnPoint) -> u64 {
        let id = self.take_id();
        let line = Line { id, feature: None, is_area: false, points: vec![first] };
        self.change(|lines| lines.push(Arc::new(line)));
        id
    }

    /// Puts a point into a line, before the point that has this place now.
    pub(crate) fn insert(&mut self, id: u64, place: usize, point: DrawnPoint) {
        self.change_points(id, |points| points.insert(place.min(points.len()), point));
    }

    /// Moves a point of a line.
    pub(crate) fn shift(&mut self, id: u64, place: usize, to: DrawnPoint) {
        self.change_points(id, |points| {
            if let Some(point) = points.get_mut(place) {
                *point = to;
            }
        });
    }

    /// The last change was the first part of a movement: this one is made instead of it.
    pub(crate) fn shift_on(&mut self, id: u64, place: usize, to: DrawnPoint) {
        let before = self.done.pop();
        self.shift(id, place, to);
        if let Some(before) = before {
            self.done.pop();
            self.done.push(before);
        }
    }

    /// Takes a point out of a line; a line without points is gone.
    pub(crate) fn remove_point(&mut self, id: u64, place: usize) {
        self.change(|lines| {
            for line in lines.iter_mut().filter(|line| line.id == id) {
                let mut points = line.points.clone();
                if place < points.len() {
                    points.remove(place);
                }
                *line = Arc::new(Line { points, ..Line::clone(line) });
            }
            lines.retain(|line| !line.points.is_empty());
        });
    }

    /// Makes a line of an area, or an area of a line. A closed line has its first point only once then.
    pub(crate) fn turn(&mut self, id: u64) {
        self.change_line(id, |line| {
            line.is_area = !line.is_area;
            if line.is_area && line.points.len() > 3 && line.points.first() == line.points.last() {
                line.points.pop();
            }
        });
    }

    /// Gives a line other points.
    pub(crate) fn replace_points(&mut self, id: u64, points: Vec<DrawnPoint>) {
        self.change_line(id, |line| line.points = points);
    }

    /// Takes a line out.
    pub(crate) fn remove_line(&mut self, id: u64) {
        self.change(|lines| lines.retain(|line| line.id != id));
    }

    /// Takes the last change back.
    pub(crate) fn undo(&mut self) {
        if let Some(before) = self.done.pop() {
            self.undone.push(std::mem::replace(&mut self.lines, before));
            self.revision += 1;
        }
    }

    /// Makes the change that was taken back last again.
    pub(crate) fn redo(&mut self) {
        if let Some(after) = self.undone.pop() {
            self.done.push(std::mem::replace(&mut self.lines, after));
            self.revision += 1;
        }
    }

    fn take_id(&mut self) -> u64 {
        self.next_id += 1;
        self.next_id
    }

    fn change_points(&mut self, id: u64, change: impl FnOnce(&mut Vec<DrawnPoint>)) {
        self.change_line(id, |line| change(&mut line.points));
    }

    fn change_line(&mut self, id: u64, change: impl FnOnce(&mut Line)) {
        self.change(|lines| {
            if let Some(line) = lines.iter_mut().find(|line| line.id == id) {
                let mut changed = Line::clone(line);
                change(&mut changed);
                *line = Arc::new(changed);
            }
        });
    }

    fn change(&mut self, change: impl FnOnce(&mut Lines)) {
        self.done.push(self.lines.clone());
        if self.done.len() > MOST_CHANGES {
            self.done.remove(0);
        }
        self.undone.clear();
        change(&mut self.lines);
        self.revision += 1;
    }
}

#[cfg(test)]
#[path = "document_tests.rs"]
mod tests;
