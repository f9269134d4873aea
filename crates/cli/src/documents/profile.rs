//! The JSON document of `corniche profile`.

use corniche_export::{Profile, ProfileGrades, ProfilePoint};
use serde::Serialize;

/// Heights and grades along ways or lines.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct ProfileDocument<'a> {
    /// What it is called: roads by their names, or a file.
    title: &'a str,
    /// The level on whose ground it lies.
    level: u8,
    /// What heights are, in words.
    heights: &'a str,
    /// How far heights are from the elevation files at most, metres; null without them.
    height_tolerance_m: Option<f64>,
    /// How far heights are from the elevation data at the samples of these, at most, metres; null with elevation files.
    sample_tolerance_m: Option<f64>,
    /// True length in plan, metres.
    length_2d_m: f64,
    /// True length with heights, metres.
    length_3d_m: f64,
    /// What bridges and tunnels without known decks have of the length in plan: ups and downs are without them.
    on_structures_m: f64,
    /// The ups and downs of the line itself; its steepest grade is over 20 m.
    line: GradesDocument,
    /// Those of a smooth line, whose steepest grade is over 50 m; null without elevation files.
    smooth: Option<GradesDocument>,
    /// The largest distance of the smooth line from the line, metres; null without elevation files.
    smoothing_max_m: Option<f64>,
    /// What is followed, in order.
    legs: Vec<LegDocument<'a>>,
    /// Parts without gaps, in order.
    parts: Vec<PartDocument>,
    /// To be shown with it.
    attribution: &'a [String],
}

/// Ups and downs.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct GradesDocument {
    /// Metres upwards, all of them together.
    ascent_m: f64,
    /// The same downwards.
    descent_m: f64,
    /// Steepest grade, up or down; null where no part is long enough.
    steepest_pct: Option<f64>,
}

/// What a stretch follows.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct LegDocument<'a> {
    /// The way; with `--line` the number of the line in the file, from 1.
    way_id: i64,
    /// Where it begins and ends, true distances in plan from the beginning, metres.
    range_m: [f64; 2],
    /// OSM's `name`, or that of the line; null without.
    name: Option<&'a str>,
    /// OSM's `ref`; null without.
    r#ref: Option<&'a str>,
    /// OSM's `highway`; null for lines of a file.
    highway: Option<&'a str>,
    /// "ground", "bridge" or "tunnel".
    structure: &'static str,
}

/// A part without gaps.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct PartDocument {
    /// Its vertices.
    points: Vec<PointDocument>,
}

/// A vertex.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct PointDocument {
    /// The way of the vertex; where two meet, the first. With `--line` the number of the line.
    way_id: i64,
    /// True distance in plan from the beginning, metres.
    distance_m: f64,
    /// Height of the line, metres.
    height_m: f64,
    /// Rise over run of 20 m around the vertex, or of what the part has of them; upwards is positive.
    grade_pct: f64,
    /// Longitude and latitude of WGS84, degrees.
    position_deg: [f64; 2],
    /// As in exported roads.
    height_source: &'static str,
    /// Height of the smooth line, metres; null where there is none.
    smooth_m: Option<f64>,
    /// Its rise over run of 50 m around the vertex; null where there is none.
    smooth_grade_pct: Option<f64>,
}

/// As many digits as tell something: micrometres, and 1e-9 degrees.
fn rounded(value: f64) -> f64 {
    (value * 1e6).round() / 1e6
}

impl GradesDocument {
    fn of(grades: &ProfileGrades) -> Self {
        Self {
            ascent_m: rounded(grades.ascent_m),
            descent_m: rounded(grades.descent_m),
            steepest_pct: grades.steepest.map(|grade| rounded(100.0 * grade)),
        }
    }
}

impl PointDocument {
    fn of(point: &ProfilePoint) -> Self {
        Self {
            way_id: point.way_id,
            distance_m: rounded(point.distance_m),
            height_m: rounded(point.height_m),
            grade_pct: rounded(100.0 * point.grade),
            position_deg: point.position_deg.map(|degrees| (degrees * 1e9).round() / 1e9),
            height_source: point.height_source.name(),
            smooth_m: point.smooth.map(|[height_m, _]| rounded(height_m)),
            smooth_grade_pct: point.smooth.map(|[_, grade]| rounded(100.0 * grade)),
        }
    }
}

impl<'a> ProfileDocument<'a> {
    /// A profile with its title and the attribution of its package.
    pub(crate) fn of(found: &'a Profile, title: &'a str, attribution: &'a [String]) -> Self {
        let text = |text: &'a String| Some(text.as_str()).filter(|text| !text.is_empty());
        let legs = found.legs.iter().map(|leg| LegDocument {
            way_id: leg.way_id,
            range_m: leg.range_m.map(rounded),
            name: text(&leg.name),
            r#ref: text(&leg.reference),
            highway: text(&leg.highway),
            structure: leg.structure.name(),
        });
        let parts = found.parts.iter().map(|part| PartDocument {
            points: part.points.iter().map(PointDocument::of).collect(),
        });
        Self {
            title,
            level: found.level,
            heights: &found.heights,
            height_tolerance_m: found.smooth.map(|_| found.height_tolerance_m),
            sample_tolerance_m: found.smooth.is_none().then_some(found.height_tolerance_m),
            length_2d_m: rounded(found.length_2d_m),
            length_3d_m: rounded(found.length_3d_m),
            on_structures_m: rounded(found.on_structures_m),
            line: GradesDocument::of(&found.grades),
            smooth: found.smooth.as_ref().map(|(grades, _)| GradesDocument::of(grades)),
            smoothing_max_m: found.smooth.map(|(_, most_off_m)| rounded(most_off_m)),
            legs: legs.collect(),
            parts: parts.collect(),
            attribution,
        }
    }
}
