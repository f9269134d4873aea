//! A smooth line, and the measures of a part of it.

use super::smoothing::{MOST_SPACING_M, Smoothing};
use crate::{
    measures::{ProfileGrades, between},
    plane::{along, mix},
};

/// The steepest grade of a smooth line is measured over this length, metres.
pub(crate) const GRADE_LENGTH_M: f64 = 50.0;

/// A place of a smooth line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Station {
    /// Steps of the lattice east and north.
    pub(crate) at: [f64; 2],
    /// True distance in plan from the beginning of the way, metres.
    pub(crate) along_m: f64,
    /// Height of the smooth line.
    pub(crate) height_m: f64,
    /// Height of the ground.
    pub(crate) ground_m: f64,
}

/// A smooth line without a gap: stations in order of their distances, connected by straight
/// segments.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct SmoothLine {
    pub(crate) stations: Vec<Station>,
}

impl SmoothLine {
    /// Returns the smooth line through a profile of distances and heights, fixed at its ends. Its
    /// stations have no position in plan.
    pub(crate) fn of_profile(profile: &[[f64; 2]], smoothing: Smoothing) -> Self {
        let (Some(first), Some(last)) = (profile.first(), profile.last()) else {
            return Self::default();
        };
        let count = stations(last[0] - first[0]);
        let spacing_m = (last[0] - first[0]) / (count - 1) as f64;
        let mut after = 0;
        let heights_m: Vec<f64> = (0..count)
            .map(|k| {
                let along_m =
                    if k + 1 == count { last[0] } else { first[0] + k as f64 * spacing_m };
                while after + 1 < profile.len() && profile[after][0] < along_m {
                    after += 1;
                }
                between(profile[after.saturating_sub(1)], profile[after], along_m)
            })
            .collect();
        let smooth_m = smoothing.solve(spacing_m, &heights_m, [Some(first[1]), Some(last[1])]);
        let station = |(k, (&ground_m, height_m)): (usize, (&f64, f64))| Station {
            at: [f64::NAN; 2],
            along_m: first[0] + k as f64 * spacing_m,
            height_m,
            ground_m,
        };
        Self { stations: heights_m.iter().zip(smooth_m).enumerate().map(station).collect() }
    }

    /// Returns a line that needs no smoothing: a deck. Its stations have no position in plan.
    pub(crate) fn itself(profile: &[[f64; 2]]) -> Self {
        let station = |&[along_m, height_m]: &[f64; 2]| Station {
            at: [f64::NAN; 2],
            along_m,
            height_m,
            ground_m: height_m,
        };
        Self { stations: profile.iter().map(station).collect() }
    }

    /// Returns the largest vertical distance from a line with the same distances, metres, at all
    /// stations and vertices of both.
    pub(crate) fn most_off_m(&self, profile: &[[f64; 2]]) -> f64 {
        let Some([begin_m, end_m]) = self.ends_m() else { return 0.0 };
        let is_along = |[along_m, _]: &&[f64; 2]| *along_m >= begin_m && *along_m <= end_m;
        let at_vertices = profile.iter().filter(is_along);
        let at_vertices = at_vertices.map(|&[along_m, height_m]| self.height_m(along_m) - height_m);
        let mut after = 1;
        let at_stations = self.stations.iter().filter_map(|station| {
            while profile.get(after)?[0] < station.along_m {
                after += 1;
            }
            let [from, to] = [profile[after - 1], profile[after]];
            (from[0] <= station.along_m)
                .then(|| station.height_m - between(from, to, station.along_m))
        });
        at_vertices.chain(at_stations).fold(0.0, |most_m, off_m| most_m.max(off_m.abs()))
    }

    /// Returns the part between two distances; empty if there is none.
    pub(crate) fn part(&self, [from_m, to_m]: [f64; 2]) -> Self {
        let mut part = Self::default();
        let mut push = |station: Station| {
            let is_new = part.stations.last().is_none_or(|last| last.along_m < station.along_m);
            if is_new {
                part.stations.push(station);
            }
        };
        for pair in self.stations.array_windows::<2>() {
            let [from, to] = *pair;
            if to.along_m <= from_m || from.along_m >= to_m {
                continue;
            }
            push(from.towards(to, from_m.max(from.along_m)));
            push(from.towards(to, to_m.min(to.along_m)));
        }
        part
    }

    /// The distances at which it begins and ends.
    fn ends_m(&self) -> Option<[f64; 2]> {
        Some([self.stations.first()?.along_m, self.stations.last()?.along_m])
    }

    /// Its distances and heights.
    fn profile(&self) -> Vec<[f64; 2]> {
        self.stations.iter().map(|station| [station.along_m, station.height_m]).collect()
    }

    /// The height at a distance; beyond the ends, that of the nearest end. NaN for an empty line.
    pub(crate) fn height_m(&self, along_m: f64) -> f64 {
        self.at(along_m).map_or(f64::NAN, |station| station.height_m)
    }

    /// Whether the line covers a whole stretch of its way.
    pub(crate) fn reaches(&self, [from_m, to_m]: [f64; 2]) -> bool {
        self.ends_m().is_some_and(|[begin_m, end_m]| begin_m <= from_m && to_m <= end_m)
    }

    /// The place at a distance; beyond the ends, the nearest end. `None` for an empty line.
    pub(crate) fn at(&self, along_m: f64) -> Option<Station> {
        let after = self.stations.partition_point(|station| station.along_m < along_m);
        let [from, to] = [after.saturating_sub(1), after.min(self.stations.len().max(1) - 1)];
        let (from, to) = (self.stations.get(from)?, self.stations.get(to)?);
        Some(from.towards(*to, along_m.clamp(from.along_m, to.along_m)))
    }

    /// Rise over run of 50 m around a distance, or of the part of them that the line has.
    pub(crate) fn grade(&self, along_m: f64) -> f64 {
        let Some([begin_m, end_m]) = self.ends_m() else { return f64::NAN };
        let half_m = GRADE_LENGTH_M / 2.0;
        let middle_m = along_m.min(end_m - half_m).max(begin_m + half_m);
        let [from_m, to_m] =
            [middle_m - half_m, middle_m + half_m].map(|at_m| at_m.clamp(begin_m, end_m));
        let rise_m = self.height_m(to_m) - self.height_m(from_m);
        if to_m > from_m { rise_m / (to_m - from_m) } else { 0.0 }
    }
}

/// Returns the grades of smooth lines, each measured over [`GRADE_LENGTH_M`] or more.
pub(crate) fn grades_of(lines: &[SmoothLine]) -> ProfileGrades {
    ProfileGrades::from_profiles(lines.iter().map(SmoothLine::profile), GRADE_LENGTH_M)
}

impl Station {
    /// The place at a distance on the way to another station.
    fn towards(self, to: Self, along_m: f64) -> Self {
        let run_m = to.along_m - self.along_m;
        let share = if run_m > 0.0 { (along_m - self.along_m) / run_m } else { 0.0 };
        match share {
            ..=0.0 => self,
            1.0.. => to,
            _ => Self {
                at: along(self.at, to.at, share),
                along_m,
                height_m: mix(self.height_m, to.height_m, share),
                ground_m: mix(self.ground_m, to.ground_m, share),
            },
        }
    }
}

/// The number of stations of a line of this length: at least two.
pub(crate) fn stations(length_m: f64) -> usize {
    (length_m / MOST_SPACING_M).ceil().max(1.0) as usize + 1
}

#[cfg(test)]
#[path = "smooth_line_tests.rs"]
mod tests;
