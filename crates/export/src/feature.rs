//! Roads as features: which fields they have.

use corniche_geom::TileId;
use corniche_roads::{FunctionalRoadClass, Oneway, RoadAttributes, Structure};

use crate::{
    grades::SmoothGrades,
    measures::Measures,
    piece::PieceHeights,
    vector::{Field, FieldKind, Value, fields},
};

/// A grade is over its limit by more than this, percent points: what is left of rounding makes none too steep.
const ROUNDING_PCT: f64 = 1e-6;

/// What is known of a feature's road.
pub(crate) struct Road<'a> {
    pub(crate) way_id: i64,
    pub(crate) class: FunctionalRoadClass,
    pub(crate) attributes: &'a RoadAttributes,
    pub(crate) parts: usize,
    pub(crate) measures: Measures,
    pub(crate) heights: PieceHeights,
    /// With heights of the elevation files: what is measured of the smooth line.
    pub(crate) smooth: Option<Smooth>,
    /// The tile of a feature of one piece, and the piece's number there.
    pub(crate) piece: Option<(TileId, u32)>,
}

/// The grades of a road without the noise of its heights.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Smooth {
    /// `None` for bridges and tunnels whose deck is not known.
    pub(crate) grades: Option<SmoothGrades>,
    /// How far the smooth line is from the line at most, metres.
    pub(crate) most_off_m: f64,
    /// Whether the smooth line is that of a chain from junction to junction, not of the way alone.
    pub(crate) is_of_chain: bool,
    /// The grade that roads of its kind are built with at most, percent.
    pub(crate) limit_pct: Option<f64>,
    /// The least height between a bridge or a tunnel and what it crosses, metres.
    pub(crate) free_height_m: Option<f64>,
}

/// Where the heights of exported roads come from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum HeightSource {
    /// The ground of the package: its triangles.
    Ground,
    /// The elevation files that the package was made from.
    Dem,
}

impl HeightSource {
    /// What heights of a road are that a structure carries, whose deck is known or not.
    pub(crate) fn kind(self, structure: Structure, on_deck: bool) -> HeightKind {
        match (structure, self) {
            (Structure::Bridge, _) if on_deck => HeightKind::Deck,
            (Structure::Tunnel, _) if on_deck => HeightKind::Tunnel,
            (Structure::Bridge, _) => HeightKind::GroundUnderBridge,
            (Structure::Tunnel, _) => HeightKind::GroundOverTunnel,
            (Structure::Ground, Self::Ground) => HeightKind::Ground,
            (Structure::Ground, Self::Dem) => HeightKind::Dem,
        }
    }
}

/// What the heights of a road are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum HeightKind {
    /// The deck of a bridge.
    Deck,
    /// The road in a tunnel.
    Tunnel,
    /// The ground beneath a bridge whose deck is not known.
    GroundUnderBridge,
    /// The ground above a tunnel whose road is not known.
    GroundOverTunnel,
    /// The ground of the package.
    Ground,
    /// The ground of the elevation files.
    Dem,
}

impl HeightKind {
    /// Its name in features and profiles.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Deck => "deck",
            Self::Tunnel => "tunnel",
            Self::GroundUnderBridge => "ground_under_bridge",
            Self::GroundOverTunnel => "ground_over_tunnel",
            Self::Ground => "ground",
            Self::Dem => "dem",
        }
    }
}

fields! { FIELDS, values, road: &Road<'_>:
    "way_id", Integer64, "", "id of the way in OpenStreetMap", Value::Integer(road.way_id);
    "class", Integer, "", "functional road class, 0 (motorway) to 8 (other road)",
        Value::Integer(road.class.number().into());
    "highway", Text, "", "OSM's `highway`", text(&road.attributes.highway);
    "form", Text, "", "`ordinary`, `dual_carriageway`, `link` or `roundabout`",
        Value::Text(road.attributes.form.name().to_owned());
    "name", Text, "", "OSM's `name`; null without", text(&road.attributes.name);
    "ref", Text, "", "OSM's `ref`; null without", text(&road.attributes.reference);
    "bridge", Integer, "", "1 for a bridge, else 0", is(road, Structure::Bridge);
    "tunnel", Integer, "", "1 for a tunnel, else 0", is(road, Structure::Tunnel);
    "layer", Integer, "", "OSM's `layer`; 0 without", Value::Integer(road.attributes.layer.into());
    "oneway", Text, "", "`yes` (along the line), `-1` (against it) or `no`",
        Value::Text(oneway(road.attributes.oneway).to_owned());
    "surface", Text, "", "OSM's `surface`; null without", text(&road.attributes.surface);
    "lanes", Integer, "", "OSM's `lanes`, in both directions together; null without",
        road.attributes.lanes.map_or(Value::Null, |lanes| Value::Integer(lanes.get().into()));
    "width", Real, "m", "OSM's `width`; null without", road.attributes.width_m().map_or(Value::Null, Value::Real);
    "maxspeed", Text, "", "OSM's `maxspeed`: a number is km/h, `30 mph` miles an hour, else as tagged; null without",
        text(&road.attributes.max_speed);
    "sac_scale", Text, "", "OSM's `sac_scale`; null without", text(&road.attributes.sac_scale);
    "tracktype", Text, "", "OSM's `tracktype`; null without", text(&road.attributes.tracktype);
    "length_2d_m", Real, "m", "true length in plan, on the ellipsoid of WGS84", real(road.measures.length_2d_m);
    "length_3d_m", Real, "m", "true length with the ups and downs of the line", real(road.measures.length_3d_m);
}

fields! { GROUND_FIELDS, ground_values, road: &Road<'_>:
    "ascent_m", Real, "m", "sum of all that the line rises, in its direction; null for bridges and tunnels",
        on_ground(road, road.measures.ascent_m);
    "descent_m", Real, "m", "sum of all that it falls; null for bridges and tunnels",
        on_ground(road, road.measures.descent_m);
    "steepest_pct", Real, "%", "steepest grade over 20 m or more, up or down; null where no part is as long, and for bridges and tunnels",
        percent_on_ground(road, road.measures.steepest);
}

fields! { DEM_FIELDS, dem_values, road: &Road<'_>:
    "ascent_m", Real, "m", "sum of all that the smooth line rises, in the way's direction; null for bridges and tunnels without `deck` or `tunnel` heights",
        smooth(road, |grades| Some(grades.ascent_m));
    "descent_m", Real, "m", "sum of all that the smooth line falls; null as above",
        smooth(road, |grades| Some(grades.descent_m));
    "steepest_pct", Real, "%", "steepest grade of the smooth line over 50 m or more, up or down; null where no part is as long, and as above",
        smooth(road, |grades| grades.steepest.map(|grade| 100.0 * grade));
    "ground_ascent_m", Real, "m", "sum of all that the line itself rises, with the noise of the heights; null as above",
        on_ground(road, road.measures.ascent_m);
    "ground_descent_m", Real, "m", "sum of all that the line itself falls; null as above",
        on_ground(road, road.measures.descent_m);
    "ground_steepest_pct", Real, "%", "steepest grade of the line itself over 20 m or more; null where no part is as long, and as above",
        percent_on_ground(road, road.measures.steepest);
    "smoothing_max_m", Real, "m", "largest distance of the smooth line from the line, over its whole length; null for bridges and tunnels",
        smoothing_max(road);
    "smoothed_by", Text, "", "`chain`: from junction to junction, as --osm allows; `way`: by the way alone; null as above",
        smoothed_by(road);
    "grade_over_limit", Integer, "", "1 where `steepest_pct` is more than roads of that `highway` are built with, else 0; null where either is unknown",
        over_limit(road);
    "free_height_m", Real, "m", "of bridges and tunnels: the least height between them and the roads that they cross, an estimate; null without such a road",
        road.smooth.and_then(|smooth| smooth.free_height_m).map_or(Value::Null, real);
}

fields! { LAST_FIELDS, last_values, road: &Road<'_>:
    "vertices_in", Integer64, "", "points of the level's line before it was laid on the ground",
        Value::Integer(road.measures.vertices_in as i64);
    "vertices_out", Integer64, "", "vertices of the line on the ground",
        Value::Integer(road.measures.vertices_out as i64);
    "parts", Integer, "", "lines without a gap between them", Value::Integer(road.parts as i64);
    "height_source", Text, "", "`ground`: the package's triangles; `dem`: the elevation files; `deck`, `tunnel`: an estimate between the heights of both ends; `ground_under_bridge`, `ground_over_tunnel`: heights of what the road does not lie on",
        Value::Text(road.height_kind().name().to_owned());
}

fields! { BOUND_FIELDS, bound_values, road: &Road<'_>:
    "height_tolerance_m", Real, "m", "how far the line is from the DEM at most, over its whole length: from the surface that is bilinear between its samples; against the DEM, not against the world; null where the package's nodes are other places than samples",
        road.heights.tolerance_m.map_or(Value::Null, bound);
}

fields! { MEASURED_FIELDS, measured_values, road: &Road<'_>:
    "height_tolerance_m", Real, "m", "how far the line is from the DEM at most, over its whole length: from the surface that is bilinear between its own samples; against the DEM, not against the world; null for decks and tunnels, and where voids were filled",
        dem_tolerance(road);
    "ground_tolerance_m", Real, "m", "how far the package's triangles are from the same surface along the line at most; null where they were not compared",
        road.heights.ground_m.map_or(Value::Null, bound);
}

/// The fields of features that are pieces, beside the others.
const PIECE_FIELDS: &[Field] = &[
    Field::new("tile", FieldKind::Text, "", "with `--pieces`: the tile, as `z/x/y`"),
    Field::new(
        "part",
        FieldKind::Integer64,
        "",
        "with `--pieces`: number of the piece along the way within the tile",
    ),
];

/// The fields of features, in their order: of ways, or of pieces; with heights of the ground or of the elevation files.
#[must_use]
pub fn road_fields(pieces: bool, heights: HeightSource) -> Vec<Field> {
    let of_pieces = if pieces { PIECE_FIELDS } else { &[] };
    let groups: &[&[Field]] = match heights {
        HeightSource::Ground => &[FIELDS, GROUND_FIELDS, LAST_FIELDS, BOUND_FIELDS, of_pieces],
        HeightSource::Dem => &[FIELDS, DEM_FIELDS, LAST_FIELDS, MEASURED_FIELDS, of_pieces],
    };
    groups.concat()
}

/// The values of a road, one for each of [`road_fields`].
pub(crate) fn road_values(road: &Road<'_>) -> Vec<Value> {
    let mut values = values(road);
    match road.height_source() {
        HeightSource::Ground => {
            values.extend(ground_values(road));
            values.extend(last_values(road));
            values.extend(bound_values(road));
        }
        HeightSource::Dem => {
            values.extend(dem_values(road));
            values.extend(last_values(road));
            values.extend(measured_values(road));
        }
    }
    if let Some((tile, part)) = road.piece {
        values.extend([Value::Text(tile.to_string()), Value::Integer(part.into())]);
    }
    values
}

impl Road<'_> {
    fn height_kind(&self) -> HeightKind {
        self.height_source().kind(self.attributes.structure, self.heights.on_deck)
    }

    fn height_source(&self) -> HeightSource {
        if self.smooth.is_some() { HeightSource::Dem } else { HeightSource::Ground }
    }

    fn grades(&self) -> Option<SmoothGrades> {
        self.smooth.and_then(|smooth| smooth.grades)
    }
}

/// A number rounded to whole micrometres, so that sums of rounding do not fill files with digits.
pub(crate) fn real(value: f64) -> Value {
    Value::Real((value * 1e6).round() / 1e6)
}

/// A number that nothing exceeds: rounded up to whole micrometres.
pub(crate) fn bound(value: f64) -> Value {
    Value::Real((value * 1e6).ceil() / 1e6)
}

fn smoothing_max(road: &Road<'_>) -> Value {
    let known = road.smooth.filter(|smooth| smooth.grades.is_some() && !road.heights.has_deck);
    known.map_or(Value::Null, |smooth| bound(smooth.most_off_m))
}

fn dem_tolerance(road: &Road<'_>) -> Value {
    let known = road.heights.tolerance_m.filter(|_| !road.heights.has_deck);
    known.map_or(Value::Null, bound)
}

/// A measure of the line; none where it is not the road's.
fn on_ground(road: &Road<'_>, value: f64) -> Value {
    let is_its_own = road.attributes.structure == Structure::Ground || road.heights.on_deck;
    if is_its_own { real(value) } else { Value::Null }
}

fn percent_on_ground(road: &Road<'_>, grade: Option<f64>) -> Value {
    grade.map_or(Value::Null, |grade| on_ground(road, 100.0 * grade))
}

fn smooth(road: &Road<'_>, value: impl Fn(SmoothGrades) -> Option<f64>) -> Value {
    road.grades().and_then(value).map_or(Value::Null, real)
}

fn smoothed_by(road: &Road<'_>) -> Value {
    match road.smooth {
        Some(Smooth { grades: Some(_), is_of_chain, .. }) => {
            Value::Text(if is_of_chain { "chain" } else { "way" }.to_owned())
        }
        _ => Value::Null,
    }
}

fn over_limit(road: &Road<'_>) -> Value {
    let steepest = road.grades().and_then(|grades| grades.steepest);
    let limit_pct = road.smooth.and_then(|smooth| smooth.limit_pct);
    match (steepest, limit_pct) {
        (Some(grade), Some(limit_pct)) => {
            Value::Integer((100.0 * grade > limit_pct + ROUNDING_PCT).into())
        }
        _ => Value::Null,
    }
}

/// GDAL's texts end at a zero byte, which OpenStreetMap's never have and damaged ones may.
pub(crate) fn text(text: &str) -> Value {
    if text.is_empty() { Value::Null } else { Value::Text(text.replace('\0', "\u{fffd}")) }
}

fn is(road: &Road<'_>, structure: Structure) -> Value {
    Value::Integer((road.attributes.structure == structure).into())
}

pub(crate) fn oneway(oneway: Oneway) -> &'static str {
    match oneway {
        Oneway::No => "no",
        Oneway::Forward => "yes",
        Oneway::Backward => "-1",
    }
}
