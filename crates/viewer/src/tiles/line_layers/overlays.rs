//! Lines from users' files, prepared for the tiles of each level.

use std::sync::OnceLock;

use corniche_geom::{GridFrame, LatticeBounds, LatticePoint, Polyline, TileId};
use corniche_roads::{FunctionalRoadClass, simplify};

use super::StyledLine;

/// Simplification tolerance on levels above the finest, in cells of the level, as for roads.
const TOLERANCE_CELLS: f64 = 0.25;
/// Number of segments per run; each run has a bounding box.
const RUN: usize = 64;

/// Lines from users' files, prepared for each level of a package when a tile of the level is first
/// requested.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Overlays {
    /// The lines of the files, without repeated points.
    lines: Vec<SourceLine>,
    levels: Vec<Level>,
    /// The names of the files, by the styles of the lines.
    names: Vec<String>,
}

/// A complete line of a file.
#[derive(Debug, Clone, PartialEq)]
struct SourceLine {
    id: i64,
    style: u8,
    path: Polyline,
}

#[derive(Debug, Clone, PartialEq)]
struct Level {
    /// Simplification tolerance, in steps of the lattice.
    tolerance: f64,
    lines: OnceLock<Vec<LevelLine>>,
}

#[derive(Debug, Clone, PartialEq)]
struct LevelLine {
    line: StyledLine,
    /// The bounding box of each [`RUN`] of segments.
    runs: Vec<LatticeBounds>,
}

impl Overlays {
    /// Creates overlays. Lines with fewer than two different points are skipped.
    #[must_use]
    pub fn new(lines: &[StyledLine], frame: &GridFrame) -> Self {
        let levels = (0..=frame.max_level()).map(|level| {
            let tolerance_m = if level == frame.max_level() {
                0.0
            } else {
                TOLERANCE_CELLS * frame.level_cell(level).shorter_m()
            };
            Level { tolerance: tolerance_m / frame.lattice_step_m(), lines: OnceLock::new() }
        });
        let lines = lines.iter().filter_map(SourceLine::from_layer_line).collect();
        Self { lines, levels: levels.collect(), names: Vec::new() }
    }

    /// Sets the names of the files from which the lines come: one for each style.
    #[must_use]
    pub fn of_files(self, names: Vec<String>) -> Self {
        Self { names, ..self }
    }

    /// The names of the files from which some lines come.
    pub(crate) fn names_of(&self, lines: &[StyledLine]) -> String {
        let has_some = |style: usize| lines.iter().any(|line| usize::from(line.style) == style);
        let named = self.names.iter().enumerate().filter(|(style, _)| has_some(*style));
        named.map(|(_, name)| name.as_str()).collect::<Vec<_>>().join(", ")
    }

    /// Whether there are no lines.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.lines.is_empty()
    }

    /// The parts of lines within a tile and `margin` steps of the lattice around it.
    #[must_use]
    pub fn near(&self, id: TileId, frame: &GridFrame, margin: i64) -> Vec<StyledLine> {
        let around = frame.tile_lattice_bounds(id).expanded(margin.saturating_add(1));
        let level = self.levels.get(usize::from(id.z()));
        let lines = level.map_or(&[][..], |level| self.of_level(level));
        lines.iter().flat_map(|line| line.near(&around)).collect()
    }

    /// The lines of a level, simplified at the first request.
    fn of_level<'a>(&self, Level { tolerance, lines }: &'a Level) -> &'a [LevelLine] {
        let simplified = || self.lines.iter().map(|line| LevelLine::new(line, *tolerance));
        lines.get_or_init(|| simplified().collect())
    }
}

impl SourceLine {
    /// `None` if the line has fewer than two different points, or its style is out of range.
    fn from_layer_line(line: &StyledLine) -> Option<Self> {
        let mut points = line.points.clone();
        points.dedup();
        let (path, class) = (Polyline::new(points).ok()?, FunctionalRoadClass::new(line.style)?);
        Some(Self { id: line.id, style: class.number(), path })
    }
}

impl LevelLine {
    fn new(&SourceLine { id, style, ref path }: &SourceLine, tolerance: f64) -> Self {
        let points = simplify(path, &[], tolerance).into_points();
        let runs = (0..points.len() - 1).step_by(RUN).filter_map(|first| {
            LatticeBounds::around(&points[first..points.len().min(first + RUN + 1)])
        });
        Self { runs: runs.collect(), line: StyledLine { id, style, points } }
    }

    /// The parts with a segment whose bounding box touches these bounds.
    fn near(&self, around: &LatticeBounds) -> Vec<StyledLine> {
        let points = &self.line.points;
        let is_near = |segment: &usize| {
            LatticeBounds::around(&points[*segment..*segment + 2])
                .is_some_and(|bounds| bounds.intersects(around))
        };
        let runs = self.runs.iter().enumerate().filter(|(_, bounds)| bounds.intersects(around));
        let near: Vec<usize> = runs
            .flat_map(|(run, _)| run * RUN..((run + 1) * RUN).min(points.len() - 1))
            .filter(is_near)
            .collect();
        let parts = near.chunk_by(|one, next| one + 1 == *next);
        let part = |part: &[usize]| -> Vec<LatticePoint> {
            points[part[0]..part[part.len() - 1] + 2].to_vec()
        };
        parts.map(|of| StyledLine { points: part(of), ..self.line.clone() }).collect()
    }
}

#[cfg(test)]
#[path = "overlays_tests.rs"]
mod tests;
