//! The drawn lines and the history of their changes.

use std::sync::Arc;

use corniche_geom::CoordinateTable;

/// The number of changes that can be undone.
const MOST_CHANGES: usize = 1000;

/// A point of a line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct DrawnPoint {
    /// Longitude and latitude, as in the file.
    pub(crate) lon_lat_deg: [f64; 2],
    /// x and y in the working CRS.
    pub(crate) at_m: [f64; 2],
}

impl DrawnPoint {
    /// Creates the point at a position in the working CRS.
    pub(crate) fn at(at_m: [f64; 2], coordinates: &CoordinateTable) -> Self {
        Self { lon_lat_deg: coordinates.wgs84_from_working(at_m), at_m }
    }
}

/// A line. Lines are immutable: a change replaces a line with a new one.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct DocumentLine {
    /// The id of the line, which changes keep.
    pub(crate) id: u64,
    /// The feature of the file that the line comes from; `None` for a line drawn here.
    pub(crate) feature: Option<usize>,
    /// Whether the line is the outline of an area: its last point is joined to the first.
    pub(crate) is_area: bool,
    /// The points of the line; a line that was just started has only one.
    pub(crate) points: Vec<DrawnPoint>,
}

impl DocumentLine {
    /// A line without an id, of a `feature` of the file or of none.
    pub(crate) fn new(feature: Option<usize>, is_area: bool, points: Vec<DrawnPoint>) -> Self {
        Self { id: 0, feature, is_area, points }
    }

    /// Whether the line has enough points to be saved: an area of two points is saved as a line.
    fn is_whole(&self) -> bool {
        self.points.len() >= 2
    }
}

type Lines = Vec<Arc<DocumentLine>>;

/// All lines, with their states before each change.
#[derive(Debug, Default)]
pub(crate) struct Document {
    pub(crate) lines: Lines,
    undone: Vec<Lines>,
    done: Vec<Lines>,
    next_id: u64,
    /// The number of changes since the beginning, including those that were undone.
    pub(crate) revision: u64,
    /// The lines as saved last.
    saved: Lines,
}

impl Document {
    /// Creates the document of saved lines, and gives them ids.
    pub(crate) fn from_lines(lines: Vec<DocumentLine>) -> Self {
        let mut document = Self::default();
        for line in lines {
            let id = document.take_id();
            document.lines.push(Arc::new(DocumentLine { id, ..line }));
        }
        document.saved.clone_from(&document.lines);
        document
    }

    /// All points: the id of the line, the index of the point, and the point.
    pub(crate) fn points(&self) -> impl Iterator<Item = (u64, usize, &DrawnPoint)> {
        self.lines.iter().flat_map(|line| {
            line.points.iter().enumerate().map(move |(place, point)| (line.id, place, point))
        })
    }

    /// A line by its id.
    pub(crate) fn line(&self, id: u64) -> Option<&Arc<DocumentLine>> {
        self.lines.iter().find(|line| line.id == id)
    }

    /// Whether there are unsaved changes.
    pub(crate) fn is_changed(&self) -> bool {
        // A single point is not a line.
        fn lines(all: &Lines) -> impl Iterator<Item = &Arc<DocumentLine>> + Clone {
            all.iter().filter(|line| line.is_whole())
        }
        let (now, saved) = (lines(&self.lines), lines(&self.saved));
        now.clone().count() != saved.clone().count()
            || now.zip(saved).any(|(now, saved)| !Arc::ptr_eq(now, saved))
    }

    /// Notes that the current state is saved.
    pub(crate) fn note_saved(&mut self) {
        self.saved.clone_from(&self.lines);
    }

    /// Whether a change can be undone, and whether one can be redone.
    pub(crate) fn can_step(&self) -> [bool; 2] {
        [!self.done.is_empty(), !self.undone.is_empty()]
    }

    /// Starts a line and returns its id.
    pub(crate) fn begin(&mut self, first: DrawnPoint) -> u64 {
        let id = self.take_id();
        let line = DocumentLine { id, ..DocumentLine::new(None, false, vec![first]) };
        self.change(|lines| lines.push(Arc::new(line)));
        id
    }

    /// Inserts a point into a line, before the point with this index.
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

    /// Replaces the last change, which was the first part of a movement, with this one.
    pub(crate) fn shift_on(&mut self, id: u64, place: usize, to: DrawnPoint) {
        let before = self.done.pop();
        self.shift(id, place, to);
        if let Some(before) = before {
            self.done.pop();
            self.done.push(before);
        }
    }

    /// Removes a point from a line; a line without points is removed.
    pub(crate) fn remove_point(&mut self, id: u64, place: usize) {
        self.change(|lines| {
            for line in lines.iter_mut().filter(|line| line.id == id && place < line.points.len()) {
                Arc::make_mut(line).points.remove(place);
            }
            lines.retain(|line| !line.points.is_empty());
        });
    }

    /// Turns an area into a line, or a line into an area. A closed line then has its first point
    /// only once.
    pub(crate) fn turn(&mut self, id: u64) {
        self.change_line(id, |line| {
            line.is_area = !line.is_area;
            if line.is_area && line.points.len() > 3 && line.points.first() == line.points.last() {
                line.points.pop();
            }
        });
    }

    /// Removes a line.
    pub(crate) fn remove_line(&mut self, id: u64) {
        self.change(|lines| lines.retain(|line| line.id != id));
    }

    /// Undoes the last change.
    pub(crate) fn undo(&mut self) {
        if let Some(before) = self.done.pop() {
            self.undone.push(std::mem::replace(&mut self.lines, before));
            self.revision += 1;
        }
    }

    /// Redoes the change that was undone last.
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

    /// Changes the points of a line.
    pub(crate) fn change_points(&mut self, id: u64, change: impl FnOnce(&mut Vec<DrawnPoint>)) {
        self.change_line(id, |line| change(&mut line.points));
    }

    fn change_line(&mut self, id: u64, change: impl FnOnce(&mut DocumentLine)) {
        self.change(|lines| {
            if let Some(line) = lines.iter_mut().find(|line| line.id == id) {
                // The list of changes has the line, too, so this makes another one.
                change(Arc::make_mut(line));
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
