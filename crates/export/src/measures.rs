//! Measures of lines: length, grade and number of vertices.

use crate::{
    join::JoinedLine,
    piece::{Vertex, larger},
    plane::{distance, doubled_area, vector},
};

/// The least length over which a grade is measured. Over shorter lengths, grades reflect single
/// triangles and steps in the heights rather than the road.
pub(crate) const LEAST_GRADE_LENGTH_M: f64 = 20.0;

/// Returns the true length in plan between two places in lattice steps, metres.
pub(crate) type Metric<'a> = dyn Fn([f64; 2], [f64; 2]) -> f64 + 'a;

/// The measures of a feature, over all its lines.
#[derive(Clone, Copy, Default)]
pub(crate) struct Measures {
    /// True length in plan, on the ellipsoid of WGS84.
    pub(crate) length_2d_m: f64,
    /// True length with heights.
    pub(crate) length_3d_m: f64,
    /// Grades over [`LEAST_GRADE_LENGTH_M`] or more of one line.
    pub(crate) grades: ProfileGrades,
    /// Points of the level's lines, before they were draped on the ground.
    pub(crate) vertices_in: u64,
    /// Vertices of the lines on the ground.
    pub(crate) vertices_out: u64,
}

/// The measures of profiles: lines of distances and heights.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct ProfileGrades {
    /// Total ascent in the direction of the lines, metres.
    pub ascent_m: f64,
    /// Total descent in the direction of the lines, metres.
    pub descent_m: f64,
    /// The steepest grade over a least length of one line: rise over run, without sign; `None` if
    /// no line is that long.
    pub steepest: Option<f64>,
}

/// A line with its profile: true distances in plan from its beginning, and heights, of all its
/// vertices.
pub(crate) struct Profiled<'a> {
    pub(crate) line: &'a JoinedLine,
    pub(crate) profile: Vec<[f64; 2]>,
}

impl<'a> Profiled<'a> {
    /// Lines with their profiles. `distance_m` gives the true distance in plan between two places
    /// on the lattice.
    pub(crate) fn from_lines(lines: &'a [JoinedLine], distance_m: &Metric<'_>) -> Vec<Self> {
        let profiled =
            |line: &'a JoinedLine| Self { line, profile: profile_of(&line.vertices, distance_m) };
        lines.iter().map(profiled).collect()
    }
}

/// Returns the profile of a line: true distances in plan from its beginning, and heights.
pub(crate) fn profile_of(vertices: &[Vertex], distance_m: &Metric<'_>) -> Vec<[f64; 2]> {
    let distances_m = distances_m(vertices.iter().map(|vertex| vertex.at), distance_m);
    let places = distances_m.into_iter().zip(vertices);
    places.map(|(along_m, vertex)| [along_m, vertex.z_m]).collect()
}

/// Returns the distance of each place along a line from the first.
pub(crate) fn distances_m(
    places: impl Iterator<Item = [f64; 2]>,
    distance_m: &Metric<'_>,
) -> Vec<f64> {
    let (mut before, mut along_m) = (None, 0.0);
    let next = |at| {
        if let Some(before) = before.replace(at) {
            along_m += distance_m(before, at);
        }
        along_m
    };
    places.map(next).collect()
}

impl Measures {
    /// The measures of some lines.
    pub(crate) fn from_lines(lines: &[Profiled<'_>]) -> Self {
        let profiles = lines.iter().map(|line| &line.profile);
        let grades = ProfileGrades::from_profiles(profiles, LEAST_GRADE_LENGTH_M);
        let mut all = Self { grades, ..Self::default() };
        for Profiled { line, profile } in lines {
            for [from, to] in profile.array_windows::<2>() {
                all.length_3d_m += distance(*from, *to);
            }
            all.length_2d_m += profile.last().map_or(0.0, |last| last[0]);
            all.vertices_in += source_points(line);
            all.vertices_out += line.vertices.len() as u64;
        }
        all
    }
}

impl ProfileGrades {
    /// Returns the grades of some lines, the steepest one over `least_m` or more.
    pub(crate) fn from_profiles<P: AsRef<[[f64; 2]]>>(
        profiles: impl IntoIterator<Item = P>,
        least_m: f64,
    ) -> Self {
        let mut all = Self::default();
        for profile in profiles {
            let profile = profile.as_ref();
            for [from, to] in profile.array_windows::<2>() {
                let rise_m = to[1] - from[1];
                all.ascent_m += rise_m.max(0.0);
                all.descent_m += (-rise_m).max(0.0);
            }
            all.steepest = larger(all.steepest, steepest(profile, least_m));
        }
        all
    }
}

/// Returns the steepest grade, without sign, between two places on a profile that are at least
/// `least_m` apart. The profile has distances along a line, ascending, with heights; heights
/// between are linear.
///
/// ```text
///          ___.-'    Seen from a fixed place a, the grade to b is monotone while b stays on one segment. So the steepest
///   a .-'''    b     is between two vertices, or over exactly the least length with a vertex at one end. Between vertices,
///                    twice the least length is enough: a longer stretch has a part, long enough, that is not less steep.
/// ```
fn steepest(profile: &[[f64; 2]], least_m: f64) -> Option<f64> {
    let [begin_m, _] = *profile.first()?;
    let [last_m, _] = *profile.last()?;
    if last_m - begin_m < least_m {
        return None;
    }
    let mut most = 0.0_f64;
    let mut look = |from: [f64; 2], to: [f64; 2]| {
        let grade = ((to[1] - from[1]) / (to[0] - from[0])).abs();
        if grade.is_finite() {
            most = most.max(grade);
        }
    };
    let mut ahead = 0;
    let mut behind = 0;
    for (index, &here) in profile.iter().enumerate() {
        while ahead + 1 < profile.len() && profile[ahead + 1][0] < here[0] + least_m {
            ahead += 1;
        }
        if here[0] + least_m <= last_m {
            look(here, at(profile, ahead, here[0] + least_m));
        }
        let beyond = profile[(ahead + 1).min(profile.len())..].iter();
        for &there in beyond.take_while(|there| there[0] < here[0] + 2.0 * least_m) {
            look(here, there);
        }
        while behind + 1 < index && profile[behind + 1][0] <= here[0] - least_m {
            behind += 1;
        }
        if here[0] >= begin_m + least_m {
            look(at(profile, behind, here[0] - least_m), here);
        }
    }
    Some(most)
}

/// The place at this distance along a profile, on the segment that begins with vertex `index`.
fn at(profile: &[[f64; 2]], index: usize, along_m: f64) -> [f64; 2] {
    let from = profile[index];
    let to = profile.get(index + 1).copied().unwrap_or(from);
    [along_m, between(from, to, along_m)]
}

/// The height at a distance between two places of a profile.
pub(crate) fn between(from: [f64; 2], to: [f64; 2], along_m: f64) -> f64 {
    let run_m = to[0] - from[0];
    let share = if run_m > 0.0 { ((along_m - from[0]) / run_m).clamp(0.0, 1.0) } else { 1.0 };
    from[1] + share * (to[1] - from[1])
}

/// Counts the points of the line before it was draped on the ground. A border that cuts a straight
/// segment adds none: a place where pieces were joined counts only if the line bends there, by more
/// than the step to which a cut is rounded.
fn source_points(line: &JoinedLine) -> u64 {
    let vertices = &line.vertices;
    let is_source = |&index: &usize| vertices[index].is_source;
    let all = (0..vertices.len()).filter(is_source).count();
    let is_cut = |&&join: &&usize| {
        let before = (0..join).rev().find(is_source).unwrap_or(0);
        let after = (join + 1..vertices.len()).find(is_source).unwrap_or(vertices.len() - 1);
        let [p, q, here] = [before, after, join].map(|index| vertices[index].at);
        let ([along, off], area) = ([q, here].map(|to| vector(p, to)), doubled_area([p, q, here]));
        let share = (off[0] * along[0] + off[1] * along[1]) / (along[0].powi(2) + along[1].powi(2));
        let is_between = (0.0..=1.0).contains(&share);
        is_between && area.abs() <= along[0].hypot(along[1])
    };
    (all - line.joins.iter().filter(is_cut).count()) as u64
}

#[cfg(test)]
#[path = "measures_tests.rs"]
mod tests;
