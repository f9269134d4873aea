//! Roads as features: which fields they have.

use corniche_geom::TileId;
use corniche_roads::{FunctionalRoadClass, Oneway, RoadAttributes, Structure};

use crate::{
    measures::{Measures, ProfileGrades},
    piece::PieceHeights,
    vector::{Field, FieldKind, Value, fields, fields_of, real, text},
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
#[derive(Clone, Copy)]
pub(crate) struct Smooth {
    /// `None` for bridges and tunnels whose deck is not known.
    pub(crate) grades: Option<ProfileGrades>,
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

fields! { FIELDS, road: &Road<'_>:
    "way_id", Integer64, "", "id of the way in OpenStreetMap", road.way_id;
    "class", Integer, "", "functional road class, 0 (motorway) to 8 (other road)",
        i64::from(road.class.number());
    "highway", Text, "", "OSM's `highway`", text(&road.attributes.highway);
    "form", Text, "", "`ordinary`, `dual_carriageway`, `link` or `roundabout`",
        road.attributes.form.name();
    "name", Text, "", "OSM's `name`; null without", text(&road.attributes.name);
    "ref", Text, "", "OSM's `ref`; null without", text(&road.attributes.reference);
    "bridge", Integer, "", "1 for a bridge, else 0", is(road, Structure::Bridge);
    "tunnel", Integer, "", "1 for a tunnel, else 0", is(road, Structure::Tunnel);
    "layer", Integer, "", "OSM's `layer`; 0 without", i64::from(road.attributes.layer);
    "oneway", Text, "", "`yes` (along the line), `-1` (against it) or `no`",
        oneway(road.attributes.oneway);
    "surface", Text, "", "OSM's `surface`; null without", text(&road.attributes.surface);
    "lanes", Integer, "", "OSM's `lanes`, in both directions together; null without",
        road.attributes.lanes.map(|lanes| i64::from(lanes.get()));
    "width", Real, "m", "OSM's `width`; null without", road.attributes.width_m();
    "maxspeed", Text, "", "OSM's `maxspeed`: a number is km/h, `30 mph` miles an hour, else as tagged; null without",
        text(&road.attributes.max_speed);
    "sac_scale", Text, "", "OSM's `sac_scale`; null without", text(&road.attributes.sac_scale);
    "tracktype", Text, "", "OSM's `tracktype`; null without", text(&road.attributes.tracktype);
    "length_2d_m", Real, "m", "true length in plan, on the ellipsoid of WGS84", real(road.measures.length_2d_m);
    "length_3d_m", Real, "m", "true length with the ups and downs of the line", real(road.measures.length_3d_m);
}

fields! { GROUND_FIELDS, road: &Road<'_>:
    "ascent_m", Real, "m", "sum of all that the line rises, in its direction; null for bridges and tunnels",
        on_ground(road, road.measures.grades.ascent_m);
    "descent_m", Real, "m", "sum of all that it falls; null for bridges and tunnels",
        on_ground(road, road.measures.grades.descent_m);
    "steepest_pct", Real, "%", "steepest grade over 20 m or more, up or down; null where no part is as long, and for bridges and tunnels",
        percent_on_ground(road, road.measures.grades.steepest);
}

fields! { DEM_FIELDS, road: &Road<'_>:
    "ascent_m", Real, "m", "sum of all that the smooth line rises, in the way's direction; null for bridges and tunnels without `deck` or `tunnel` heights",
        road.grades().map(|grades| real(grades.ascent_m));
    "descent_m", Real, "m", "sum of all that the smooth line falls; null as above",
        road.grades().map(|grades| real(grades.descent_m));
    "steepest_pct", Real, "%", "steepest grade of the smooth line over 50 m or more, up or down; null where no part is as long, and as above",
        steepest_pct(road).map(real);
    "ground_ascent_m", Real, "m", "sum of all that the line itself rises, with the noise of the heights; null as above",
        on_ground(road, road.measures.grades.ascent_m);
    "ground_descent_m", Real, "m", "sum of all that the line itself falls; null as above",
        on_ground(road, road.measures.grades.descent_m);
    "ground_steepest_pct", Real, "%", "steepest grade of the line itself over 20 m or more; null where no part is as long, and as above",
        percent_on_ground(road, road.measures.grades.steepest);
    "smoothing_max_m", Real, "m", "largest distance of the smooth line from the line, over its whole length; null for bridges and tunnels",
        smoothing_max(road);
    "smoothed_by", Text, "", "`chain`: from junction to junction, as --osm allows; `way`: by the way alone; null as above",
        smoothed_by(road);
    "grade_over_limit", Integer, "", "1 where `steepest_pct` is more than roads of that `highway` are built with, else 0; null where either is unknown",
        over_limit(road);
    "free_height_m", Real, "m", "of bridges and tunnels: the least height between them and the roads that they cross, an estimate; null without such a road",
        road.smooth.and_then(|smooth| smooth.free_height_m).map(real);
}

fields! { LAST_FIELDS, road: &Road<'_>:
    "vertices_in", Integer64, "", "points of the level's line before it was laid on the ground",
        road.measures.vertices_in as i64;
    "vertices_out", Integer64, "", "vertices of the line on the ground",
        road.measures.vertices_out as i64;
    "parts", Integer, "", "lines without a gap between them", road.parts as i64;
    "height_source", Text, "", "`ground`: the package's triangles; `dem`: the elevation files; `deck`, `tunnel`: an estimate between the heights of both ends; `ground_under_bridge`, `ground_over_tunnel`: heights of what the road does not lie on",
        road.height_source().kind(road.attributes.structure, road.heights.on_deck).name();
}

fields! { BOUND_FIELDS, road: &Road<'_>:
    "height_tolerance_m", Real, "m", "how far the line is from the DEM at most, over its whole length: from the surface that is bilinear between its samples; against the DEM, not against the world; null where the package's nodes are other places than samples",
        road.heights.tolerance_m.map(bound);
}

fields! { MEASURED_FIELDS, road: &Road<'_>:
    "height_tolerance_m", Real, "m", "how far the line is from the DEM at most, over its whole length: from the surface that is bilinear between its own samples; against the DEM, not against the world; null for decks and tunnels, and where voids were filled",
        road.heights.tolerance_m.filter(|_| !road.heights.has_deck).map(bound);
    "ground_tolerance_m", Real, "m", "how far the package's triangles are from the same surface along the line at most; null where they were not compared",
        road.heights.ground_m.map(bound);
}

fields! { PIECE_FIELDS, road: &Road<'_>:
    "tile", Text, "", "with `--pieces`: the tile, as `z/x/y`",
        road.piece.map(|(tile, _)| tile.to_string()).as_deref();
    "part", Integer64, "", "with `--pieces`: number of the piece along the way within the tile",
        road.piece.map(|(_, part)| i64::from(part));
}

/// A field of roads with what is in it.
type RoadField = (Field, fn(&Road<'_>) -> Value);

/// The fields of features, in their order: of ways, or of pieces; with heights of the ground or of the elevation files.
fn fields_and_values(pieces: bool, heights: HeightSource) -> Vec<RoadField> {
    let of_pieces = if pieces { PIECE_FIELDS } else { &[] };
    let groups: &[&[RoadField]] = match heights {
        HeightSource::Ground => &[FIELDS, GROUND_FIELDS, LAST_FIELDS, BOUND_FIELDS, of_pieces],
        HeightSource::Dem => &[FIELDS, DEM_FIELDS, LAST_FIELDS, MEASURED_FIELDS, of_pieces],
    };
    groups.concat()
}

/// The fields of features, in their order: of ways, or of pieces; with heights of the ground or of the elevation files.
#[must_use]
pub fn road_fields(pieces: bool, heights: HeightSource) -> Vec<Field> {
    fields_of(&fields_and_values(pieces, heights))
}

/// The values of a road, one for each of [`road_fields`].
pub(crate) fn road_values(road: &Road<'_>) -> Vec<Value> {
    let fields = fields_and_values(road.piece.is_some(), road.height_source());
    fields.into_iter().map(|(_, value)| value(road)).collect()
}

impl Road<'_> {
    fn height_source(&self) -> HeightSource {
        if self.smooth.is_some() { HeightSource::Dem } else { HeightSource::Ground }
    }

    fn grades(&self) -> Option<ProfileGrades> {
        self.smooth.and_then(|smooth| smooth.grades)
    }
}

/// A number that nothing exceeds: rounded up to whole micrometres.
fn bound(value: f64) -> f64 {
    (value * 1e6).ceil() / 1e6
}

fn smoothing_max(road: &Road<'_>) -> Option<f64> {
    let known = road.smooth.filter(|smooth| smooth.grades.is_some() && !road.heights.has_deck);
    known.map(|smooth| bound(smooth.most_off_m))
}

/// A measure of the line; none where it is not the road's.
fn on_ground(road: &Road<'_>, value: f64) -> Option<f64> {
    let is_its_own = road.attributes.structure == Structure::Ground || road.heights.on_deck;
    is_its_own.then(|| real(value))
}

fn percent_on_ground(road: &Road<'_>, grade: Option<f64>) -> Option<f64> {
    grade.and_then(|grade| on_ground(road, 100.0 * grade))
}

fn steepest_pct(road: &Road<'_>) -> Option<f64> {
    road.grades()?.steepest.map(|grade| 100.0 * grade)
}

fn smoothed_by(road: &Road<'_>) -> Option<&'static str> {
    road.grades().zip(road.smooth).map(|(_, own)| if own.is_of_chain { "chain" } else { "way" })
}

fn over_limit(road: &Road<'_>) -> Option<i64> {
    let steepest = steepest_pct(road).zip(road.smooth?.limit_pct);
    steepest.map(|(steepest_pct, limit_pct)| (steepest_pct > limit_pct + ROUNDING_PCT).into())
}

fn is(road: &Road<'_>, structure: Structure) -> i64 {
    (road.attributes.structure == structure).into()
}

pub(crate) fn oneway(oneway: Oneway) -> &'static str {
    match oneway {
        Oneway::No => "no",
        Oneway::Forward => "yes",
        Oneway::Backward => "-1",
    }
}
