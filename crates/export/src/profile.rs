//! Heights and grades along ways.

use corniche_geom::LatticePoint;
use corniche_roads::FunctionalRoadClass;
use corniche_tileset::FilePackage;
use corniche_work::{Observer, Stage, workers::one_by_one};

use crate::{
    error::ExportError,
    feature_request::Coordinates,
    join::{Line, lines},
    laid_lines::laid_lines,
    measures::{LEAST_GRADE_LENGTH_M, Measures},
    piece::{Piece, Vertex},
    places::Places,
    read,
};

/// A place at both ends of the map comes out at the same longitude and latitude to this, as tables of coordinates have them to a centimetre.
const SAME_PLACE_M: f64 = 0.02;

/// The profile of some ways, one after the other.
#[derive(Debug, Clone, PartialEq)]
pub struct Profile {
    /// The level whose roads were taken.
    pub level: u8,
    /// What heights are, in words.
    pub heights: String,
    /// Parts without gaps, in order.
    pub parts: Vec<ProfilePart>,
    /// True length in plan of all parts, metres.
    pub length_2d_m: f64,
    /// True length with heights, metres.
    pub length_3d_m: f64,
    /// Metres upwards, all of them together.
    pub ascent_m: f64,
    /// The same downwards.
    pub descent_m: f64,
    /// Steepest grade over at least 20 m, rise over run without sign; `None` where no part is as long.
    pub steepest: Option<f64>,
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
    /// Height of the ground.
    pub height_m: f64,
    /// Rise over run, over 20 m around the point, or as many as the part has; upwards is positive.
    pub grade: f64,
    /// Longitude and latitude, degrees.
    pub position_deg: [f64; 2],
}

/// Follows ways over the ground of a level, in the order in which they are named. Each is turned so that it goes on where the one before
/// it ends, if it has an end there; the first so that it ends at the second.
///
/// # Errors
/// When the package has no such way or level, or is damaged.
pub fn profile(
    package: &FilePackage,
    way_ids: &[i64],
    level: Option<u8>,
    observer: &dyn Observer,
) -> Result<Profile, ExportError> {
    let manifest = package.manifest();
    if manifest.inputs.iter().all(|input| input.kind != "osm") {
        return Err(ExportError::NoRoads { package: package.path().to_path_buf() });
    }
    let level = read::level(package, level)?;
    let places = Places::new(manifest, Coordinates::Package)?;
    let mut of_ways: Vec<Vec<Line>> = Vec::with_capacity(way_ids.len());
    let pieces = pieces(package, way_ids, level, observer)?;
    for &way_id in way_ids {
        let own: Vec<Piece> =
            pieces.iter().filter(|piece| piece.key.way_id == way_id).cloned().collect();
        if own.is_empty() {
            let package = package.path().to_path_buf();
            return Err(ExportError::NoWay { package, way_id, level });
        }
        of_ways.push(lines(&own));
    }
    Ok(told(&in_a_row(way_ids, of_ways), level, &places))
}

/// Follows lines that are no ways of the package over the ground of a level, one after the other. Parts of the line with index 0 have the
/// `way_id` 1, and so on.
///
/// # Errors
/// When the package has no such level, no line lies on its ground, or it is damaged.
pub fn profile_of_lines(
    package: &FilePackage,
    lines: &[Vec<LatticePoint>],
    level: Option<u8>,
    observer: &dyn Observer,
) -> Result<Profile, ExportError> {
    let level = read::level(package, level)?;
    let places = Places::new(package.manifest(), Coordinates::Package)?;
    let laid = laid_lines(package, lines, level, observer)?;
    let numbered = (1..).zip(laid).flat_map(|(number, parts)| {
        let of_line = move |part: Vec<Vertex>| -> ProfileLine {
            part.into_iter().map(|vertex| (number, vertex)).collect()
        };
        parts.into_iter().map(of_line)
    });
    let parts = joined(numbered, &places);
    if parts.is_empty() {
        return Err(ExportError::NoLineOnGround { package: package.path().to_path_buf() });
    }
    Ok(told(&parts, level, &places))
}

fn told(parts: &[ProfileLine], level: u8, places: &Places<'_>) -> Profile {
    let distance_m = |from: [f64; 2], to: [f64; 2]| places.distance_m(from, to);
    let all: Vec<Line> = parts
        .iter()
        .map(|part| Line { vertices: part.iter().map(|(_, at)| *at).collect(), joins: Vec::new() })
        .collect();
    let measures = Measures::of(&all, &distance_m);
    let mut begin_m = 0.0;
    let mut told = Vec::with_capacity(parts.len());
    for part in parts {
        let points = points(part, begin_m, places);
        begin_m = points.last().map_or(begin_m, |last| last.distance_m);
        told.push(ProfilePart { points });
    }
    Profile {
        level,
        heights: places.heights().to_owned(),
        parts: told,
        length_2d_m: measures.length_2d_m,
        length_3d_m: measures.length_3d_m,
        ascent_m: measures.ascent_m,
        descent_m: measures.descent_m,
        steepest: measures.steepest,
    }
}

/// What the tiles of a level hold of some ways, in the package's order.
fn pieces(
    package: &FilePackage,
    way_ids: &[i64],
    level: u8,
    observer: &dyn Observer,
) -> Result<Vec<Piece>, ExportError> {
    let classes: Vec<FunctionalRoadClass> = FunctionalRoadClass::all().collect();
    let tiles = read::tiles(package, level, None)?;
    let mut pieces = Vec::new();
    one_by_one((observer, Stage::ExportTiles), &tiles, |&id| {
        let own = read::pieces(package, id, &classes)?;
        pieces.extend(own.into_iter().filter(|piece| way_ids.contains(&piece.key.way_id)));
        Ok::<(), ExportError>(())
    })?;
    Ok(pieces)
}

type ProfileLine = Vec<(i64, Vertex)>;

/// The lines of all ways in a row, turned so that they go on; those that meet become one part.
fn in_a_row(way_ids: &[i64], of_ways: Vec<Vec<Line>>) -> Vec<ProfileLine> {
    let ends = |lines: &[Line]| -> [Option<[f64; 2]>; 2] {
        let first = lines.first().and_then(|line| line.vertices.first());
        let last = lines.last().and_then(|line| line.vertices.last());
        [first, last].map(|vertex| vertex.map(|vertex| vertex.at))
    };
    let all_ends: Vec<_> = of_ways.iter().map(|lines| ends(lines)).collect();
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
        if is_turned {
            lines.reverse();
            for line in &mut lines {
                line.vertices.reverse();
            }
        }
        for line in lines {
            let begin = line.vertices.first().map(|vertex| vertex.at);
            let goes_on = end.is_some() && begin == end;
            let vertices = line.vertices.into_iter().map(|vertex| (way_id, vertex));
            match parts.last_mut().filter(|_| goes_on) {
                Some(part) => part.extend(vertices.skip(1)),
                None => parts.push(vertices.collect()),
            }
            end = parts.last().and_then(|part| part.last()).map(|(_, vertex)| vertex.at);
        }
    }
    parts
}

/// Lines of which each begins where the one before ends are one part: also where a line ends at the end of the map and goes on at its other end.
fn joined(lines: impl Iterator<Item = ProfileLine>, places: &Places<'_>) -> Vec<ProfileLine> {
    let mut parts: Vec<ProfileLine> = Vec::new();
    for line in lines {
        let goes_on = |before: &&mut ProfileLine| match (before.last(), line.first()) {
            (Some((_, end)), Some((_, begin))) => {
                places.distance_m(end.at, begin.at) <= SAME_PLACE_M
            }
            _ => false,
        };
        match parts.last_mut().filter(goes_on) {
            Some(before) => before.extend(line.into_iter().skip(1)),
            None => parts.push(line),
        }
    }
    parts
}

fn points(part: &ProfileLine, begin_m: f64, places: &Places<'_>) -> Vec<ProfilePoint> {
    let mut along_m = begin_m;
    let mut profile = Vec::with_capacity(part.len());
    for (index, (_, vertex)) in part.iter().enumerate() {
        if let Some((_, before)) = index.checked_sub(1).map(|before| part[before]) {
            along_m += places.distance_m(before.at, vertex.at);
        }
        profile.push([along_m, vertex.z_m]);
    }
    let grades = grades(&profile);
    part.iter()
        .zip(&profile)
        .zip(grades)
        .map(|(((way_id, vertex), [distance_m, height_m]), grade)| ProfilePoint {
            way_id: *way_id,
            distance_m: *distance_m,
            height_m: *height_m,
            grade,
            position_deg: places.wgs84(vertex.at),
        })
        .collect()
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
