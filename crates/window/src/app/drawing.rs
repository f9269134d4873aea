//! The lines that a person draws in the window.

use std::{path::PathBuf, sync::Arc};

use corniche_geom::TileId;
use corniche_live::{Tiles, controls::Modifiers};
use corniche_tileset::Manifest;

use crate::{
    ClockS, DrawnLine, NotSaved, SaveDrawing,
    canvas::Canvas,
    drawing::{Document, LaidLines, Line, Point, Tool},
};

/// The drawing of the window.
pub(crate) struct Drawing {
    pub(crate) is_on: bool,
    pub(crate) tool: Tool,
    pub(crate) document: Document,
    /// Lines that have no place in the package's CRS: they cannot be shown, and are saved as they are.
    unplaced: Vec<DrawnLine>,
    laid: LaidLines,
    /// The state of the document that was laid last.
    laid_revision: u64,
    /// How many lines cannot be laid on one of the tiles that are there.
    not_laid: usize,
    /// How often a line was laid on a tile for the last change, and how long that took.
    pub(crate) last: Option<(usize, f64)>,
    pub(crate) modifiers: Modifiers,
    save: SaveDrawing,
    clock_s: ClockS,
}

impl Drawing {
    /// The drawing with the lines of a file. Those with a point that has no place in the package's CRS are not shown; tells how many these are.
    pub(crate) fn new(
        lines: &[DrawnLine],
        (save, clock_s): (SaveDrawing, ClockS),
        manifest: &Manifest,
    ) -> (Self, usize) {
        let point = |&lon_lat_deg: &[f64; 2]| {
            let at_m = manifest.coordinates.working_from_wgs84(lon_lat_deg)?;
            Some(Point { lon_lat_deg, at_m })
        };
        let (mut placed, mut unplaced) = (Vec::new(), Vec::new());
        for line in lines {
            let points: Option<Vec<Point>> = line.points_deg.iter().map(point).collect();
            match points {
                Some(points) => placed.push((line.feature, line.is_area, points)),
                None => unplaced.push(line.clone()),
            }
        }
        let left_out = unplaced.len();
        let drawing = Self {
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
        };
        (drawing, left_out)
    }

    /// Grows with every change of a line.
    pub(crate) fn revision(&self) -> u64 {
        self.document.revision()
    }

    /// Lays what has changed on the tiles that are there; `is_new` says that some of them were not there before. Tells how many lines and
    /// outlines cannot be laid on one of them, when that has changed.
    pub(crate) fn lay(
        &mut self,
        canvas: &mut Canvas,
        tiles: &Tiles,
        manifest: &Manifest,
        is_new: bool,
    ) -> Option<usize> {
        let is_changed = self.laid_revision != self.document.revision();
        if !is_changed && !is_new {
            return None;
        }
        self.laid_revision = self.document.revision();
        let begun_s = (self.clock_s)();
        let relaid = self.laid.update(&self.document, tiles.resident(), manifest);
        for (id, lines, areas) in &relaid.changed {
            canvas.replace_drawn(*id, lines, areas);
        }
        if is_changed {
            self.last = Some((relaid.laid, ((self.clock_s)() - begun_s) * 1e3));
        }
        let not_laid = relaid.not_laid.len();
        (std::mem::replace(&mut self.not_laid, not_laid) != not_laid).then_some(not_laid)
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
            is_area: line.is_area,
            points_deg: line.points.iter().map(|point| point.lon_lat_deg).collect(),
        };
        let drawn = self.document.lines().iter().map(line);
        let lines: Vec<DrawnLine> = drawn.chain(self.unplaced.iter().cloned()).collect();
        let saved = (self.save)(&lines);
        if saved.is_ok() {
            self.document.note_saved();
        }
        Some(saved)
    }
}
