//! The JSON document of `corniche profile`.

use corniche_export::{ProfileGrades, ProfilePoint, RoadProfile};
use schemars::JsonSchema;
use serde::Serialize;

/// Heights and grades along OSM ways, or along lines of a file.
#[derive(Serialize, JsonSchema)]
pub(crate) struct ProfileDocument<'a> {
    /// Title: the names of the roads, or of a file.
    title: &'a str,
    /// The level whose terrain the line follows.
    level: u8,
    /// The reference of the heights, in words.
    heights: &'a str,
    /// Largest difference between heights and elevation files, metres; null without `--dem`.
    height_tolerance_m: Option<f64>,
    /// Largest difference between heights and elevation data at the samples of the data, metres;
    /// null with `--dem`.
    sample_tolerance_m: Option<f64>,
    /// True length in plan, metres.
    length_2d_m: f64,
    /// True length with heights, metres.
    length_3d_m: f64,
    /// Length in plan on bridges and tunnels without known decks, metres; ascents and descents
    /// exclude them.
    on_structures_m: f64,
    /// Ascents and descents of the line itself; its steepest grade is over 20 m.
    line: GradesDocument,
    /// Ascents and descents of a smoothed line, whose steepest grade is over 50 m; null without
    /// `--dem`.
    smooth: Option<GradesDocument>,
    /// Largest distance of the smoothed line from the line, metres; null without `--dem`.
    smoothing_max_m: Option<f64>,
    /// The OSM ways or the lines of the file, in order.
    legs: Vec<LegDocument<'a>>,
    /// Parts without gaps, in order.
    parts: Vec<PartDocument>,
    /// Attribution that must be displayed with the profile.
    attribution: &'a [String],
}

/// Ascents and descents.
#[derive(Serialize, JsonSchema)]
struct GradesDocument {
    /// Sum of all ascents, metres.
    ascent_m: f64,
    /// Sum of all descents, metres.
    descent_m: f64,
    /// Steepest grade, up or down; null if no part is long enough.
    steepest_pct: Option<f64>,
}

/// A stretch along one OSM way, or along one line of a file.
#[derive(Serialize, JsonSchema)]
struct LegDocument<'a> {
    /// OSM id of the way; with `--line` the number of the line in the file, from 1.
    way_id: i64,
    /// Start and end of the stretch: true distances in plan from the beginning, metres.
    range_m: [f64; 2],
    /// OSM's `name`, or the name of the line; null if there is none.
    name: Option<&'a str>,
    /// OSM's `ref`; null if there is none.
    r#ref: Option<&'a str>,
    /// OSM's `highway`; null for lines of a file.
    highway: Option<&'a str>,
    /// "ground", "bridge" or "tunnel".
    structure: &'static str,
}

/// A part without gaps.
#[derive(Serialize, JsonSchema)]
struct PartDocument {
    /// The vertices of the part.
    points: Vec<PointDocument>,
}

/// A vertex.
#[derive(Serialize, JsonSchema)]
struct PointDocument {
    /// OSM id of the way of the vertex; where two ways meet, the id of the first. With `--line` the
    /// number of the line in the file, from 1.
    way_id: i64,
    /// True distance in plan from the beginning, metres.
    distance_m: f64,
    /// Height of the line, metres.
    height_m: f64,
    /// Rise over run along 20 m around the vertex, or along a shorter distance at the ends of the
    /// part; upwards is positive.
    grade_pct: f64,
    /// Longitude and latitude of WGS84, degrees.
    position_deg: [f64; 2],
    /// Source of the height, as in exported roads.
    height_source: &'static str,
    /// Height of the smoothed line, metres; null if there is none.
    smooth_m: Option<f64>,
    /// Rise over run of the smoothed line along 50 m around the vertex; null if there is none.
    smooth_grade_pct: Option<f64>,
}

/// Rounds to significant digits: micrometres, and 1e-9 degrees.
fn rounded(value: f64) -> f64 {
    (value * 1e6).round() / 1e6
}

impl GradesDocument {
    fn from_grades(grades: &ProfileGrades) -> Self {
        Self {
            ascent_m: rounded(grades.ascent_m),
            descent_m: rounded(grades.descent_m),
            steepest_pct: grades.steepest.map(|grade| rounded(100.0 * grade)),
        }
    }
}

impl PointDocument {
    fn from_point(point: &ProfilePoint) -> Self {
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
    pub(crate) fn from_profile(
        found: &'a RoadProfile,
        title: &'a str,
        attribution: &'a [String],
    ) -> Self {
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
            points: part.points.iter().map(PointDocument::from_point).collect(),
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
            line: GradesDocument::from_grades(&found.grades),
            smooth: found.smooth.as_ref().map(|(grades, _)| GradesDocument::from_grades(grades)),
            smoothing_max_m: found.smooth.map(|(_, most_off_m)| rounded(most_off_m)),
            legs: legs.collect(),
            parts: parts.collect(),
            attribution,
        }
    }
}
