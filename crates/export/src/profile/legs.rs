//! The legs of a profile: the ways, parts of ways, or lines of a file that are followed one after
//! the other.

use std::{collections::BTreeMap, ops::Range};

use corniche_geom::LatticePoint;
use corniche_roads::{RoadAttributes, Structure};

use crate::grades::SmoothLine;

/// Smooth lines of two legs are fixed at the node between them: they have the same height there,
/// apart from rounding, unless one of them only touches a deck.
const SAME_HEIGHT_M: f64 = 0.01;

/// Lines that are followed one after the other, on any ground.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Course {
    /// The lines.
    pub legs: Vec<CourseLeg>,
    /// The attributes of the ways to which the lines belong, by id.
    pub ways: BTreeMap<i64, RoadAttributes>,
    /// Whether the lines are parts of ways, whose bridges and tunnels are known.
    pub is_of_ways: bool,
    /// The longitude and latitude in the file of the first point, reported in case the user swapped
    /// them.
    pub begins_deg: Option<[f64; 2]>,
}

/// A line to follow.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CourseLeg {
    /// The way to which the line belongs, or the line's number.
    pub way_id: i64,
    /// Whether the line goes against its way.
    pub is_against: bool,
    /// Its points on the lattice of the package.
    pub points: Vec<LatticePoint>,
}

impl Course {
    /// Returns a course of lines that are not ways, with the numbers under which they are reported
    /// and their names, if any.
    pub fn of_lines(
        lines: impl IntoIterator<Item = (i64, Option<String>, Vec<LatticePoint>)>,
    ) -> Self {
        let mut course = Self::default();
        for (way_id, name, points) in lines {
            let name = name.unwrap_or_default();
            course
                .ways
                .entry(way_id)
                .or_insert_with(|| RoadAttributes { name, ..RoadAttributes::default() });
            course.legs.push(CourseLeg { way_id, is_against: false, points });
        }
        course
    }
}

/// A leg of a profile.
#[derive(Debug, Clone, PartialEq)]
pub struct ProfileLeg {
    /// The way, or the number of the line.
    pub way_id: i64,
    /// The beginning and the end of the leg, true distances in plan from the beginning of the
    /// profile, metres.
    pub range_m: [f64; 2],
    /// OSM's `name`, or the name of the line; empty without.
    pub name: String,
    /// OSM's `ref`; empty without.
    pub reference: String,
    /// OSM's `highway`; empty for lines of a file.
    pub highway: String,
    /// The structure that carries it.
    pub structure: Structure,
}

impl ProfileLeg {
    /// Returns a leg with the attributes of its way.
    pub(crate) fn new(way_id: i64, range_m: [f64; 2], way: Option<&RoadAttributes>) -> Self {
        let way = way.cloned().unwrap_or_default();
        let RoadAttributes { name, reference, highway, structure, .. } = way;
        Self { way_id, range_m, name, reference, highway, structure }
    }
}

/// Joins runs with their smooth lines: one that begins where the previous one ends, at the same
/// height, continues it. Grades are therefore measured over the whole profile, not leg by leg.
pub(crate) fn joined_runs(
    runs: Vec<Range<usize>>,
    smooth: Vec<SmoothLine>,
) -> (Vec<Range<usize>>, Vec<SmoothLine>) {
    if smooth.is_empty() {
        return (runs, smooth);
    }
    let mut joined: (Vec<Range<usize>>, Vec<SmoothLine>) = (Vec::new(), Vec::new());
    for (run, line) in runs.into_iter().zip(smooth) {
        if let (Some(before), Some(whole)) = (joined.0.last_mut(), joined.1.last_mut())
            && before.end == run.start + 1
            && let (Some(end), Some(begin)) = (whole.stations.last(), line.stations.first())
            && (end.height_m - begin.height_m).abs() <= SAME_HEIGHT_M
        {
            before.end = run.end;
            let end_m = end.along_m;
            whole.stations.extend(line.stations.into_iter().filter(|at| at.along_m > end_m));
        } else {
            joined.0.push(run);
            joined.1.push(line);
        }
    }
    joined
}
