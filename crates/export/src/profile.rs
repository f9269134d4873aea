//! Heights and grades along ways and other lines.

mod legs;

use std::{
    collections::{BTreeMap, BTreeSet},
    ops::Range,
};

use corniche_geom::LatticePoint;
use corniche_roads::{RoadAttributes, Structure};
use corniche_tileset::FilePackage;
use corniche_work::{Observer, Stage, workers::one_by_one};

use crate::{
    deck_lines::{Carrier, along_way, lay_on_deck},
    dem_ground::{DemLine, DemNodes},
    error::{ElevationError, ProfileError, SelectionError},
    feature::{HeightKind, HeightSource},
    grades::{MeasuredChains, SmoothLine, Smoothing, grades_of, most_steps, stretch_of_way},
    heights::{Elevation, sample_bound_m},
    join::{JoinedLine, lines},
    laid_lines::laid_lines,
    measures::{LEAST_GRADE_LENGTH_M, ProfileGrades, profile_of},
    piece::{Vertex, WayPiece},
    places::{FeatureCoordinates, Places},
    plane::distance,
    read,
    roads::RoadHeights,
};

use self::legs::joined_runs;
pub use self::legs::{Course, CourseLeg, ProfileLeg};

/// Positions at both ends of the map are the same place if their longitudes and latitudes agree to
/// this, metres: coordinate tables are accurate to a centimetre.
const SAME_PLACE_M: f64 = 0.02;
/// The largest distance of such places on the map if they are at the same end of it, working
/// metres.
const NEAR_ON_MAP_M: f64 = 1000.0;

/// The profile of some ways, one after the other.
#[derive(Debug, Clone, PartialEq)]
pub struct RoadProfile {
    /// The level whose roads were used.
    pub level: u8,
    /// What heights refer to, in words.
    pub heights: String,
    /// The largest distance of heights from the elevation files, metres.
    pub height_tolerance_m: f64,
    /// Parts without gaps, in order.
    pub parts: Vec<ProfilePart>,
    /// The ways or lines that are followed, in order. A way that is followed twice, or has a gap,
    /// occurs several times.
    pub legs: Vec<ProfileLeg>,
    /// True length in plan of all parts, metres.
    pub length_2d_m: f64,
    /// True length with heights, metres.
    pub length_3d_m: f64,
    /// The length in plan of bridges and tunnels without known decks, metres. The following
    /// measures exclude it.
    pub on_structures_m: f64,
    /// Ascent, descent and grade of the line itself.
    pub grades: ProfileGrades,
    /// With heights of the elevation files: the measures of a smooth line, and its largest distance
    /// from the line, metres.
    pub smooth: Option<(ProfileGrades, f64)>,
}

/// A part of a profile without gaps.
#[derive(Debug, Clone, PartialEq)]
pub struct ProfilePart {
    /// The points; at least two.
    pub points: Vec<ProfilePoint>,
}

/// A vertex of a road on the ground.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ProfilePoint {
    /// The way to which the point belongs; where two ways meet, the first. Lines that are not ways
    /// have numbers from 1.
    pub way_id: i64,
    /// True distance in plan from the beginning of the profile, metres. Gaps have no length.
    pub distance_m: f64,
    /// Height of the line.
    pub height_m: f64,
    /// Rise over run, over 20 m around the point, or over the whole part if it is shorter; upwards
    /// is positive.
    pub grade: f64,
    /// Longitude and latitude, degrees.
    pub position_deg: [f64; 2],
    /// The source of the height, as in exported roads.
    pub height_source: HeightKind,
    /// Height of the smooth line, and its rise over run over 50 m around the point; `None` on
    /// bridges and in tunnels whose decks are unknown, and without elevation files.
    pub smooth: Option<[f64; 2]>,
}

/// Follows ways over the ground of a level, in the given order. Each way is turned to continue
/// where the previous one ends, if it has an end there; the first way is turned to end at the
/// second. With elevation files, heights come from them.
///
/// # Errors
/// When the package has no such way or level, or is corrupt.
pub fn profile(
    package: &FilePackage,
    way_ids: &[i64],
    level: Option<u8>,
    heights: RoadHeights<'_>,
    observer: &dyn Observer,
) -> Result<RoadProfile, ProfileError> {
    let manifest = package.manifest();
    SelectionError::check_roads(package)?;
    let level = read::level(package, level)?;
    let places = Places::new(manifest, FeatureCoordinates::Package)?;
    let mut of_ways: Vec<Vec<JoinedLine>> = Vec::with_capacity(way_ids.len());
    let pieces = pieces(package, way_ids, level, observer)?;
    let mut ways = BTreeMap::new();
    for &way_id in way_ids {
        let own: Vec<WayPiece> =
            pieces.iter().filter(|piece| piece.key.way_id == way_id).cloned().collect();
        let Some(first) = own.first() else {
            let package = package.path().to_path_buf();
            return Err(ProfileError::NoWay { package, way_id, level });
        };
        ways.insert(way_id, first.attributes.clone());
        of_ways.push(lines(&own));
    }
    let (legs, parts) = in_a_row(way_ids, of_ways);
    let mut telling = Telling::new((places, level), (legs, ways), heights, observer)?;
    let parts = telling.on_ground(parts)?;
    Ok(telling.tell(&parts))
}

/// Follows lines over the ground of a level, one after the other. With elevation files, heights
/// come from them.
///
/// # Errors
/// When the package has no such level, no line is on its ground, or it is corrupt.
pub fn profile_of_course(
    package: &FilePackage,
    course: &Course,
    level: Option<u8>,
    heights: RoadHeights<'_>,
    observer: &dyn Observer,
) -> Result<RoadProfile, ProfileError> {
    let level = read::level(package, level)?;
    let manifest = package.manifest();
    let places = Places::new(manifest, FeatureCoordinates::Package)?;
    let lines: Vec<&[LatticePoint]> = course.legs.iter().map(|leg| leg.points.as_slice()).collect();
    let laid = laid_lines(package, &lines, level, observer)?;
    let numbered = laid.into_iter().enumerate().flat_map(|(leg, parts)| {
        let of_line = move |part: Vec<Vertex>| -> ProfileLine {
            part.into_iter().map(|vertex| (leg, vertex)).collect()
        };
        parts.into_iter().map(of_line)
    });
    let parts: Vec<ProfileLine> = numbered.collect();
    let of_legs = course.legs.iter();
    let legs = of_legs.map(|leg| Leg { way_id: leg.way_id, is_turned: leg.is_against }).collect();
    let heights = RoadHeights { network: heights.network.filter(|_| course.is_of_ways), ..heights };
    let about = (legs, course.ways.clone());
    let mut telling = Telling::new((places, level), about, heights, observer)?;
    let parts = telling.on_ground(parts)?;
    // Lines continue at the other end of the map only after they were draped: between the ends
    // there is nothing.
    let parts = joined(parts.into_iter(), &telling.places);
    if parts.is_empty() {
        let package = package.path().to_path_buf();
        let begins =
            course.begins_deg.map(|[lon, lat]| format!("; the first begins at {lon},{lat}"));
        let begins = begins.unwrap_or_default();
        let covered = manifest.covered_text(course.begins_deg.unwrap_or([f64::NAN; 2]));
        return Err(ProfileError::NoLineOnGround { package, begins, covered });
    }
    Ok(telling.tell(&parts))
}

/// The inputs of a profile.
struct Telling<'a> {
    level: u8,
    places: Places<'a>,
    legs: Vec<Leg>,
    /// The attributes of each way.
    ways: BTreeMap<i64, RoadAttributes>,
    elevation: Option<Elevation<'a>>,
    /// Legs over bridges and through tunnels whose decks are known.
    on_deck: BTreeSet<usize>,
    /// The smooth lines of each way for which those of chains are known.
    smooth_ways: BTreeMap<i64, Vec<SmoothLine>>,
    /// The largest distance of the ground from the elevation files, metres.
    tolerance_m: f64,
}

impl<'a> Telling<'a> {
    fn new(
        (places, level): (Places<'a>, u8),
        (legs, ways): (Vec<Leg>, BTreeMap<i64, RoadAttributes>),
        RoadHeights { elevation, network }: RoadHeights<'a>,
        observer: &dyn Observer,
    ) -> Result<Self, ElevationError> {
        let mut smooth_ways = BTreeMap::new();
        if let (Some(elevation), Some(network), false) = (elevation, network, legs.is_empty()) {
            let chains = MeasuredChains::measure(network, &places, elevation, observer)?;
            let way_ids: BTreeSet<i64> = legs.iter().map(|leg| leg.way_id).collect();
            let of_way = |way_id| (way_id, chains.of_way(way_id));
            smooth_ways = way_ids.into_iter().map(of_way).collect();
        }
        let tolerance_m = sample_bound_m(places.manifest, level);
        let on_deck = BTreeSet::new();
        Ok(Self { level, places, legs, ways, elevation, on_deck, smooth_ways, tolerance_m })
    }

    /// Measures the parts; those with heights of the elevation files are smoothed.
    fn tell(self, parts: &[ProfileLine]) -> RoadProfile {
        let frame = &self.places.manifest.frame;
        let smoothing = self.elevation.map(|_| Smoothing::of_frame(frame));
        let distance_m = self.places.metric();
        let mut length_3d_m = 0.0;
        let mut on_ground = Vec::new();
        let mut smooth = Vec::new();
        let mut most_off_m = 0.0_f64;
        let mut told = Vec::with_capacity(parts.len());
        let mut legs = Vec::new();
        let mut on_structures_m = 0.0;
        let mut begin_m = 0.0;
        for part in parts {
            let vertices: Vec<Vertex> = part.iter().map(|(_, vertex)| *vertex).collect();
            let profile = profile_of(&vertices, &distance_m);
            let own_m = profile.last().map_or(0.0, |last| last[0]);
            let lengths_m = profile.array_windows().map(|[from, to]| distance(*from, *to));
            length_3d_m += lengths_m.sum::<f64>();
            let runs = self.runs_on_ground(part);
            let lengths_m = runs.iter().map(|run| profile[run.end - 1][0] - profile[run.start][0]);
            on_structures_m += own_m - lengths_m.sum::<f64>();
            let smooth_of_runs: Vec<SmoothLine> = match smoothing {
                Some(smoothing) => {
                    let of = |run: &Range<usize>| {
                        let own = &profile[run.clone()];
                        // A deck is smooth by itself, and on the ground where the ground obstructs
                        // it.
                        if self.on_deck.contains(&part[run.end - 1].0) {
                            return SmoothLine::itself(own);
                        }
                        let of_chains = self.of_chains(&part[run.clone()], own);
                        of_chains.unwrap_or_else(|| SmoothLine::of_profile(own, smoothing))
                    };
                    runs.iter().map(of).collect()
                }
                None => Vec::new(),
            };
            let (runs, smooth_of_runs) = joined_runs(runs, smooth_of_runs);
            let points = self.points(part, (&profile, begin_m), (&runs, &smooth_of_runs));
            for ([from, to], &(leg, _)) in points.array_windows().zip(part.iter().skip(1)) {
                self.add_leg(&mut legs, self.legs[leg], [from.distance_m, to.distance_m]);
            }
            told.push(ProfilePart { points });
            begin_m += own_m;
            for (run, line) in runs.iter().zip(&smooth_of_runs) {
                most_off_m = most_off_m.max(line.most_off_m(&profile[run.clone()]));
            }
            smooth.extend(smooth_of_runs);
            on_ground.extend(runs.into_iter().map(|run| profile_of(&vertices[run], &distance_m)));
        }
        let smooth = smoothing.map(|_| (grades_of(&smooth), most_off_m));
        RoadProfile {
            level: self.level,
            heights: self.places.heights.clone(),
            height_tolerance_m: self.tolerance_m,
            parts: told,
            legs: legs.into_iter().map(|(_, leg)| leg).collect(),
            length_2d_m: begin_m,
            length_3d_m,
            on_structures_m,
            grades: ProfileGrades::from_profiles(on_ground, LEAST_GRADE_LENGTH_M),
            smooth,
        }
    }

    /// Adds the leg of this range; consecutive parts of a way are one leg.
    fn add_leg(&self, legs: &mut Vec<(Leg, ProfileLeg)>, leg: Leg, range_m: [f64; 2]) {
        match legs.last_mut() {
            Some((before, told)) if *before == leg && told.range_m[1] >= range_m[0] => {
                told.range_m[1] = range_m[1];
            }
            _ => legs.push((leg, ProfileLeg::new(leg.way_id, range_m, self.ways.get(&leg.way_id)))),
        }
    }

    /// Returns the parts unchanged, or on the ground of the elevation files and on decks.
    fn on_ground(&mut self, parts: Vec<ProfileLine>) -> Result<Vec<ProfileLine>, ElevationError> {
        let Some(elevation) = self.elevation else { return Ok(parts) };
        let nodes = &mut DemNodes::new(elevation, &self.places.manifest.frame);
        self.tolerance_m = 0.0;
        let mut laid_parts: Vec<ProfileLine> = Vec::new();
        for part in parts {
            let mut first = 0;
            while first + 1 < part.len() {
                let leg = part[first + 1].0;
                let own = part[first + 1..].iter().take_while(|(of, _)| *of == leg).count();
                let run: Vec<Vertex> =
                    part[first..=first + own].iter().map(|(_, vertex)| *vertex).collect();
                let Leg { way_id, is_turned } = self.legs[leg];
                let carrier = Carrier {
                    structure: self.structure(leg),
                    way: self.smooth_ways.get(&way_id).map_or(&[], Vec::as_slice),
                    most_steps: most_steps(self.places.manifest, self.level),
                    is_turned,
                };
                let laid = lay_on_deck(nodes, &run, &carrier, &self.places.metric())?;
                for DemLine { vertices, tolerance_m, on_deck, .. } in laid {
                    self.tolerance_m = self.tolerance_m.max(tolerance_m.unwrap_or(0.0));
                    if on_deck {
                        self.on_deck.insert(leg);
                    }
                    add_line(&mut laid_parts, leg, vertices);
                }
                first += own;
            }
        }
        Ok(laid_parts)
    }

    /// Whether the heights along a leg are the road's own.
    fn is_measured(&self, leg: usize) -> bool {
        self.structure(leg) == Structure::Ground || self.on_deck.contains(&leg)
    }

    fn structure(&self, leg: usize) -> Structure {
        let way = self.ways.get(&self.legs[leg].way_id);
        way.map(|way| way.structure).unwrap_or_default()
    }

    /// Returns the smooth line of some vertices of a leg, if those of chains are known.
    fn of_chains(&self, run: &[(usize, Vertex)], profile: &[[f64; 2]]) -> Option<SmoothLine> {
        let Leg { way_id, is_turned } = self.legs[run.last()?.0];
        let way = self.smooth_ways.get(&way_id)?;
        let [begin_m, end_m] = [profile.first()?[0], profile.last()?[0]];
        let most_steps = most_steps(self.places.manifest, self.level);
        let vertices = along_way(run.iter().map(|(_, vertex)| *vertex).collect(), is_turned);
        let stretch = stretch_of_way(way, &vertices, end_m - begin_m, most_steps)?;
        let parts = way.iter().map(|line| line.part(stretch));
        let mut line = parts.max_by_key(|part| part.stations.len())?;
        if is_turned {
            line.stations.reverse();
        }
        for station in &mut line.stations {
            let [from_m, to_m] = stretch;
            let along_m = station.along_m;
            station.along_m = begin_m + if is_turned { to_m - along_m } else { along_m - from_m };
        }
        Some(line)
    }

    /// Returns the ranges of vertices between which the heights of a part are the road's own,
    /// rather than those beneath a bridge or above a tunnel; leg by leg if smooth lines follow
    /// ways. A segment belongs to the leg of its second vertex.
    fn runs_on_ground(&self, part: &ProfileLine) -> Vec<Range<usize>> {
        let mut runs: Vec<Range<usize>> = Vec::new();
        for end in 1..part.len() {
            if !self.is_measured(part[end].0) {
                continue;
            }
            let is_of_same_leg =
                self.smooth_ways.is_empty() || end < 2 || part[end - 1].0 == part[end].0;
            match runs.last_mut() {
                Some(run) if run.end == end && is_of_same_leg => run.end = end + 1,
                _ => runs.push(end - 1..end + 1),
            }
        }
        runs
    }

    fn points(
        &self,
        part: &ProfileLine,
        (profile, begin_m): (&[[f64; 2]], f64),
        (runs, smooth): (&[Range<usize>], &[SmoothLine]),
    ) -> Vec<ProfilePoint> {
        let from = if smooth.is_empty() { HeightSource::Ground } else { HeightSource::Dem };
        let smooth_at = |index: usize, along_m: f64| {
            let run = runs.iter().position(|run| run.contains(&index))?;
            let line = smooth.get(run)?;
            Some([line.height_m(along_m), line.grade(along_m)])
        };
        let measured = part.iter().zip(profile).zip(grades(profile)).enumerate();
        measured
            .map(|(index, ((&(leg, vertex), &[along_m, height_m]), grade))| ProfilePoint {
                way_id: self.legs[leg].way_id,
                distance_m: begin_m + along_m,
                height_m,
                grade,
                position_deg: self.places.wgs84(vertex.at),
                height_source: from.kind(self.structure(leg), self.on_deck.contains(&leg)),
                smooth: smooth_at(index, along_m),
            })
            .collect()
    }
}

/// Returns the pieces of some ways in the tiles of a level, in the package's order.
fn pieces(
    package: &FilePackage,
    way_ids: &[i64],
    level: u8,
    observer: &dyn Observer,
) -> Result<Vec<WayPiece>, ProfileError> {
    let tiles = read::tiles(package, level, None)?;
    let mut pieces = Vec::new();
    one_by_one((observer, Stage::ExportTiles), &tiles, |&id| {
        let own = read::all_pieces(package, id)?;
        pieces.extend(own.into_iter().filter(|piece| way_ids.contains(&piece.key.way_id)));
        Ok::<(), ProfileError>(())
    })?;
    Ok(pieces)
}

/// A way that is followed once, or a line of a file. A way may be followed again, also back at
/// once.
#[derive(Clone, Copy, PartialEq, Eq)]
struct Leg {
    way_id: i64,
    /// Whether it is followed against its direction.
    is_turned: bool,
}

/// Vertices, each with the number of its leg.
type ProfileLine = Vec<(usize, Vertex)>;

/// Appends a line of a leg to the last part if it continues there; otherwise it becomes a new part.
fn add_line(parts: &mut Vec<ProfileLine>, leg: usize, vertices: Vec<Vertex>) {
    let begin = vertices.first().map(|vertex| vertex.at);
    let goes_on = |part: &&mut ProfileLine| part.last().map(|(_, vertex)| vertex.at) == begin;
    let vertices = vertices.into_iter().map(|vertex| (leg, vertex));
    match parts.last_mut().filter(goes_on) {
        Some(part) => part.extend(vertices.skip(1)),
        None => parts.push(vertices.collect()),
    }
}

/// Returns the lines of consecutive ways, turned so that each continues the previous one; lines
/// that meet become one part.
fn in_a_row(way_ids: &[i64], of_ways: Vec<Vec<JoinedLine>>) -> (Vec<Leg>, Vec<ProfileLine>) {
    let ends = |lines: &[JoinedLine]| -> [Option<[f64; 2]>; 2] {
        let first = lines.first().and_then(|line| line.vertices.first());
        let last = lines.last().and_then(|line| line.vertices.last());
        [first, last].map(|vertex| vertex.map(|vertex| vertex.at))
    };
    let all_ends: Vec<_> = of_ways.iter().map(|lines| ends(lines)).collect();
    let mut legs = Vec::with_capacity(way_ids.len());
    let mut parts: Vec<ProfileLine> = Vec::new();
    let mut end: Option<[f64; 2]> = None;
    for (index, (&way_id, mut lines)) in way_ids.iter().zip(of_ways).enumerate() {
        let [first, last] = ends(&lines);
        let next = all_ends.get(index + 1).copied().unwrap_or_default();
        let is_turned = match end {
            Some(_) => first != end && last == end,
            // The first way ends where the second one continues.
            None => next.contains(&first) && !next.contains(&last) && first.is_some(),
        };
        legs.push(Leg { way_id, is_turned });
        if is_turned {
            lines.reverse();
            for line in &mut lines {
                line.vertices.reverse();
            }
        }
        for line in lines {
            add_line(&mut parts, index, line.vertices);
            end = parts.last().and_then(|part| part.last()).map(|(_, vertex)| vertex.at);
        }
    }
    (legs, parts)
}

/// Joins lines that begin where the previous one ends into one part, also across the ends of the
/// map, where a line continues at the other end.
fn joined(lines: impl Iterator<Item = ProfileLine>, places: &Places<'_>) -> Vec<ProfileLine> {
    let mut parts: Vec<ProfileLine> = Vec::new();
    let near_steps = NEAR_ON_MAP_M / places.manifest.frame.lattice_step_m();
    for line in lines {
        let (before, begin) = (parts.last_mut(), line[0].1.at);
        let before = before.and_then(|part| Some((part.last()?.1.at, part)));
        match before.filter(|(end, _)| places.distance_m(*end, begin) <= SAME_PLACE_M) {
            Some((end, part)) => {
                // At the other end of the map the line begins at a separate place: the distance
                // from the previous one would be as wide as the map.
                let is_same = (0..2).all(|axis| (end[axis] - begin[axis]).abs() <= near_steps);
                part.extend(line.into_iter().skip(usize::from(is_same)));
            }
            None => parts.push(line),
        }
    }
    parts
}

/// The grade at each point of a profile; distances must ascend.
fn grades(profile: &[[f64; 2]]) -> Vec<f64> {
    let half_m = LEAST_GRADE_LENGTH_M / 2.0;
    let height_at = |along_m: f64| -> [f64; 2] {
        let after = profile.partition_point(|point| point[0] < along_m).min(profile.len() - 1);
        let [from, to] = [profile[after.saturating_sub(1)], profile[after]];
        let run_m = to[0] - from[0];
        let share = if run_m > 0.0 { ((along_m - from[0]) / run_m).clamp(0.0, 1.0) } else { 1.0 };
        [from[0] + share * run_m, from[1] + share * (to[1] - from[1])]
    };
    let [begin_m, end_m] =
        [profile.first(), profile.last()].map(|end| end.map_or(0.0, |end| end[0]));
    let grade = |point: &[f64; 2]| {
        // Near an end, the stretch is on one side only.
        let middle_m = point[0].min(end_m - half_m).max(begin_m + half_m);
        let [before, after] = [middle_m - half_m, middle_m + half_m].map(height_at);
        let run_m = after[0] - before[0];
        if run_m > 0.0 { (after[1] - before[1]) / run_m } else { 0.0 }
    };
    profile.iter().map(grade).collect()
}

#[cfg(test)]
#[path = "profile_tests.rs"]
mod tests;
