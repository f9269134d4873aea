//! Heights and grades along ways and other lines.

mod legs;

use std::{
    collections::{BTreeMap, BTreeSet},
    ops::Range,
};

use corniche_geom::LatticePoint;
use corniche_roads::{FunctionalRoadClass, RoadAttributes, Structure};
use corniche_tileset::FilePackage;
use corniche_work::{Observer, Stage, workers::one_by_one};

use crate::{
    deck_lines::{Carrier, lay_on_deck},
    dem_ground::{DemLine, DemNodes},
    error::{ElevationError, ProfileError, SelectionError},
    feature::{HeightKind, HeightSource},
    grades::{MeasuredChains, SmoothLine, Smoothing, grades_of, most_steps, stretch_of_way},
    heights::{Elevation, sample_bound_m},
    join::{Line, lines},
    laid_lines::laid_lines,
    measures::{LEAST_GRADE_LENGTH_M, ProfileGrades, profile_of},
    piece::{Piece, Vertex},
    places::{Coordinates, Places},
    read,
    roads::RoadHeights,
};

use self::legs::joined_runs;
pub use self::legs::{Course, CourseLeg, ProfileLeg};

/// A place at both ends of the map comes out at the same longitude and latitude to this, as tables of coordinates have them to a centimetre.
const SAME_PLACE_M: f64 = 0.02;
/// Such places are at one end of the map within this, working metres.
const NEAR_ON_MAP_M: f64 = 1000.0;

/// The profile of some ways, one after the other.
#[derive(Debug, Clone, PartialEq)]
pub struct Profile {
    /// The level whose roads were taken.
    pub level: u8,
    /// What heights are, in words.
    pub heights: String,
    /// How far heights are from the elevation files at most, metres.
    pub height_tolerance_m: f64,
    /// Parts without gaps, in order.
    pub parts: Vec<ProfilePart>,
    /// What is followed, in order. A way that is followed twice, or has a gap, is there several times.
    pub legs: Vec<ProfileLeg>,
    /// True length in plan of all parts, metres.
    pub length_2d_m: f64,
    /// True length with heights, metres.
    pub length_3d_m: f64,
    /// What bridges and tunnels without known decks have of the length in plan: what follows is told without them.
    pub on_structures_m: f64,
    /// The ups and downs of the line itself.
    pub grades: ProfileGrades,
    /// With heights of the elevation files: those of a smooth line, and the largest distance of it from the line, metres.
    pub smooth: Option<(ProfileGrades, f64)>,
}

/// A part of a profile without gaps.
#[derive(Debug, Clone, PartialEq)]
pub struct ProfilePart {
    /// Its points; at least two.
    pub points: Vec<ProfilePoint>,
}

/// A vertex of a road on the ground.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ProfilePoint {
    /// The way that it belongs to; of two ways that meet, the first. Of lines that are no ways their numbers, from 1.
    pub way_id: i64,
    /// True distance in plan from the beginning of the profile, metres. Gaps count nothing.
    pub distance_m: f64,
    /// Height of the line.
    pub height_m: f64,
    /// Rise over run, over 20 m around the point, or as many as the part has; upwards is positive.
    pub grade: f64,
    /// Longitude and latitude, degrees.
    pub position_deg: [f64; 2],
    /// Where the height is from, as in exported roads.
    pub height_source: HeightKind,
    /// Height of the smooth line, and its rise over run over 50 m around the point; `None` on bridges and in tunnels whose decks are not
    /// known, and without elevation files.
    pub smooth: Option<[f64; 2]>,
}

/// Follows ways over the ground of a level, in the order in which they are named. Each is turned so that it goes on where the one before
/// it ends, if it has an end there; the first so that it ends at the second. With elevation files, heights are theirs.
///
/// # Errors
/// When the package has no such way or level, or is damaged.
pub fn profile(
    package: &FilePackage,
    way_ids: &[i64],
    level: Option<u8>,
    heights: RoadHeights<'_>,
    observer: &dyn Observer,
) -> Result<Profile, ProfileError> {
    let manifest = package.manifest();
    SelectionError::check_roads(package)?;
    let level = read::level(package, level)?;
    let places = Places::new(manifest, Coordinates::Package)?;
    let mut of_ways: Vec<Vec<Line>> = Vec::with_capacity(way_ids.len());
    let pieces = pieces(package, way_ids, level, observer)?;
    let mut ways = BTreeMap::new();
    for &way_id in way_ids {
        let own: Vec<Piece> =
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

/// Follows lines over the ground of a level, one after the other. With elevation files, heights are theirs.
///
/// # Errors
/// When the package has no such level, no line lies on its ground, or it is damaged.
pub fn profile_of_course(
    package: &FilePackage,
    course: &Course,
    level: Option<u8>,
    heights: RoadHeights<'_>,
    observer: &dyn Observer,
) -> Result<Profile, ProfileError> {
    let level = read::level(package, level)?;
    let manifest = package.manifest();
    let places = Places::new(manifest, Coordinates::Package)?;
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
    // Lines go on at the other end of the map only once they were laid: between its ends there is nothing.
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

/// What a profile is told from.
struct Telling<'a> {
    level: u8,
    places: Places<'a>,
    legs: Vec<Leg>,
    /// What is known of each way.
    ways: BTreeMap<i64, RoadAttributes>,
    elevation: Option<Elevation<'a>>,
    /// Legs over bridges and through tunnels whose decks are known.
    on_deck: BTreeSet<usize>,
    /// The smooth line of each way, where those of chains are known.
    smooth_ways: BTreeMap<i64, Vec<SmoothLine>>,
    /// How far the ground is from the elevation files at most, metres.
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

    /// Measures the parts; those of elevation files are smoothed.
    fn tell(self, parts: &[ProfileLine]) -> Profile {
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
            let lengths_m =
                profile.array_windows().map(|[from, to]| (to[0] - from[0]).hypot(to[1] - from[1]));
            length_3d_m += lengths_m.sum::<f64>();
            let runs = self.runs_on_ground(part);
            let lengths_m = runs.iter().map(|run| profile[run.end - 1][0] - profile[run.start][0]);
            on_structures_m += own_m - lengths_m.sum::<f64>();
            let smooth_of_runs: Vec<SmoothLine> = match smoothing {
                Some(smoothing) => {
                    let of = |run: &Range<usize>| {
                        let own = &profile[run.clone()];
                        // A deck is smooth by itself, and on the ground where that is in its way.
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
        Profile {
            level: self.level,
            heights: self.places.heights.clone(),
            height_tolerance_m: self.tolerance_m,
            parts: told,
            legs: legs.into_iter().map(|(_, leg)| leg).collect(),
            length_2d_m: begin_m,
            length_3d_m,
            on_structures_m,
            grades: ProfileGrades::of(on_ground, LEAST_GRADE_LENGTH_M),
            smooth,
        }
    }

    /// Adds what a leg follows; parts of a way in a row are one.
    fn add_leg(&self, legs: &mut Vec<(Leg, ProfileLeg)>, leg: Leg, range_m: [f64; 2]) {
        match legs.last_mut() {
            Some((before, told)) if *before == leg && told.range_m[1] >= range_m[0] => {
                told.range_m[1] = range_m[1];
            }
            _ => legs.push((leg, ProfileLeg::new(leg.way_id, range_m, self.ways.get(&leg.way_id)))),
        }
    }

    /// The parts as they are, or on the ground of the elevation files and on decks.
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
                    let begin = vertices.first().map(|vertex| vertex.at);
                    let goes_on = |before: &&mut ProfileLine| {
                        before.last().map(|(_, vertex)| vertex.at) == begin
                    };
                    let vertices = vertices.into_iter().map(|vertex| (leg, vertex));
                    match laid_parts.last_mut().filter(goes_on) {
                        Some(before) => before.extend(vertices.skip(1)),
                        None => laid_parts.push(vertices.collect()),
                    }
                }
                first += own;
            }
        }
        Ok(laid_parts)
    }

    /// Whether heights along a leg are its own.
    fn is_measured(&self, leg: usize) -> bool {
        self.structure(leg) == Structure::Ground || self.on_deck.contains(&leg)
    }

    fn structure(&self, leg: usize) -> Structure {
        let way = self.ways.get(&self.legs[leg].way_id);
        way.map(|way| way.structure).unwrap_or_default()
    }

    /// The smooth line of some vertices of a leg, where those of chains are known.
    fn of_chains(&self, run: &[(usize, Vertex)], profile: &[[f64; 2]]) -> Option<SmoothLine> {
        let Leg { way_id, is_turned } = self.legs[run.last()?.0];
        let way = self.smooth_ways.get(&way_id)?;
        let [begin_m, end_m] = [profile.first()?[0], profile.last()?[0]];
        let most_steps = most_steps(self.places.manifest, self.level);
        let vertices = along_way(run.iter().map(|(_, vertex)| *vertex), is_turned);
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

    /// The vertices between which the heights of a part are its own, not those beneath a bridge or above a tunnel; leg by leg where smooth lines are those of ways. A segment
    /// belongs to the leg of its second vertex.
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

/// What the tiles of a level hold of some ways, in the package's order.
fn pieces(
    package: &FilePackage,
    way_ids: &[i64],
    level: u8,
    observer: &dyn Observer,
) -> Result<Vec<Piece>, ProfileError> {
    let classes: Vec<FunctionalRoadClass> = FunctionalRoadClass::all().collect();
    let tiles = read::tiles(package, level, None)?;
    let mut pieces = Vec::new();
    one_by_one((observer, Stage::ExportTiles), &tiles, |&id| {
        let own = read::pieces(package, id, &classes)?;
        pieces.extend(own.into_iter().filter(|piece| way_ids.contains(&piece.key.way_id)));
        Ok::<(), ProfileError>(())
    })?;
    Ok(pieces)
}

/// A way as it is followed once, or a line of a file. A way may be followed again, also back at once.
#[derive(Clone, Copy, PartialEq, Eq)]
struct Leg {
    way_id: i64,
    /// Whether it is followed against its direction.
    is_turned: bool,
}

/// Vertices, each with the number of its leg.
type ProfileLine = Vec<(usize, Vertex)>;

/// Vertices of a leg in the direction of its way; or those of a way in the direction of its leg.
fn along_way(vertices: impl DoubleEndedIterator<Item = Vertex>, is_turned: bool) -> Vec<Vertex> {
    if is_turned { vertices.rev().collect() } else { vertices.collect() }
}

/// The lines of all ways in a row, turned so that they go on; those that meet become one part.
fn in_a_row(way_ids: &[i64], of_ways: Vec<Vec<Line>>) -> (Vec<Leg>, Vec<ProfileLine>) {
    let ends = |lines: &[Line]| -> [Option<[f64; 2]>; 2] {
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
            // The first way: its beginning is where the second one goes on.
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
            let begin = line.vertices.first().map(|vertex| vertex.at);
            let goes_on = end.is_some() && begin == end;
            let vertices = line.vertices.into_iter().map(|vertex| (index, vertex));
            match parts.last_mut().filter(|_| goes_on) {
                Some(part) => part.extend(vertices.skip(1)),
                None => parts.push(vertices.collect()),
            }
            end = parts.last().and_then(|part| part.last()).map(|(_, vertex)| vertex.at);
        }
    }
    (legs, parts)
}

/// Lines of which each begins where the one before ends are one part: also where a line ends at the end of the map and goes on at its other end.
fn joined(lines: impl Iterator<Item = ProfileLine>, places: &Places<'_>) -> Vec<ProfileLine> {
    let mut parts: Vec<ProfileLine> = Vec::new();
    let near_steps = NEAR_ON_MAP_M / places.manifest.frame.lattice_step_m();
    for line in lines {
        let goes_on = |before: &&mut ProfileLine| match (before.last(), line.first()) {
            (Some((_, end)), Some((_, begin))) => {
                places.distance_m(end.at, begin.at) <= SAME_PLACE_M
            }
            _ => false,
        };
        match parts.last_mut().filter(goes_on) {
            Some(before) => {
                // At the other end of the map the line begins at a place of its own: from the one before, the next would be a map away.
                let is_there = |end: &(usize, Vertex), begin: &(usize, Vertex)| {
                    (0..2).all(|axis| (end.1.at[axis] - begin.1.at[axis]).abs() <= near_steps)
                };
                let is_same = before.last().zip(line.first()).is_some_and(|(a, b)| is_there(a, b));
                before.extend(line.into_iter().skip(usize::from(is_same)));
            }
            None => parts.push(line),
        }
    }
    parts
}

/// The grade at each point of a profile, whose distances ascend.
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
        // Near an end the stretch lies to one side.
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
