//! The fields of roads as features.

use corniche_geom::TileId;
use corniche_roads::{Oneway, Structure};

use crate::{
    measures::{Measures, ProfileGrades},
    piece::WayPiece,
    vector::{FeatureField, FieldKind, FieldValue, fields, fields_of, real, text},
};

/// A grade exceeds its limit only if it is higher by more than this, percentage points: rounding
/// errors do not count.
const ROUNDING_PCT: f64 = 1e-6;

/// A road with its measures, the input of a feature.
pub(crate) struct FeatureRoad<'a> {
    /// The first of its pieces, with the heights of all.
    pub(crate) of: &'a WayPiece,
    pub(crate) parts: usize,
    pub(crate) measures: Measures,
    /// The measures of the smooth line; present with heights of the elevation files.
    pub(crate) smooth: Option<Smooth>,
    /// The tile of a feature that is a single piece, and the number of the piece in the tile.
    pub(crate) piece: Option<(TileId, u32)>,
}

/// The grades of a road without the noise of its heights.
#[derive(Clone, Copy)]
pub(crate) struct Smooth {
    /// `None` for bridges and tunnels whose deck is unknown.
    pub(crate) grades: Option<ProfileGrades>,
    /// The largest distance of the smooth line from the line, metres.
    pub(crate) most_off_m: f64,
    /// Whether the smooth line follows a chain from junction to junction, rather than a single way.
    pub(crate) is_of_chain: bool,
    /// The steepest grade at which roads of this kind are built, percent.
    pub(crate) limit_pct: Option<f64>,
    /// The least clearance between a bridge or a tunnel and the roads that it crosses, metres.
    pub(crate) free_height_m: Option<f64>,
}

/// The source of the heights of exported roads.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum HeightSource {
    /// The ground of the package: its triangles.
    Ground,
    /// The elevation files from which the package was built.
    Dem,
}

impl HeightSource {
    /// Returns what the heights of a road refer to, given its structure and whether its deck is
    /// known.
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

/// What the heights of a road refer to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum HeightKind {
    /// The deck of a bridge.
    Deck,
    /// The road in a tunnel.
    Tunnel,
    /// The ground beneath a bridge whose deck is unknown.
    GroundUnderBridge,
    /// The ground above a tunnel whose heights are unknown.
    GroundOverTunnel,
    /// The ground of the package.
    Ground,
    /// The ground of the elevation files.
    Dem,
}

impl HeightKind {
    /// The name in features and profiles.
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

fields! { FIELDS, road: &FeatureRoad<'_>:
    "way_id", Integer64, "", "id of the way in OpenStreetMap", road.of.key.way_id;
    "class", Integer, "", "functional road class, 0 (motorway) to 8 (other road)",
        i64::from(road.of.class.number());
    "highway", Text, "", "OSM's `highway`", text(&road.of.attributes.highway);
    "form", Text, "", "`ordinary`, `dual_carriageway`, `link` or `roundabout`",
        road.of.attributes.form.name();
    "name", Text, "", "OSM's `name`; null if not tagged", text(&road.of.attributes.name);
    "ref", Text, "", "OSM's `ref`; null if not tagged", text(&road.of.attributes.reference);
    "bridge", Integer, "", "1 for a bridge, else 0", is(road, Structure::Bridge);
    "tunnel", Integer, "", "1 for a tunnel, else 0", is(road, Structure::Tunnel);
    "layer", Integer, "", "OSM's `layer`; 0 if not tagged", i64::from(road.of.attributes.layer);
    "oneway", Text, "", "`yes` (along the line), `-1` (against it) or `no`",
        oneway(road.of.attributes.oneway);
    "surface", Text, "", "OSM's `surface`; null if not tagged", text(&road.of.attributes.surface);
    "lanes", Integer, "", "OSM's `lanes`, both directions together; null if unknown",
        road.of.attributes.lanes.map(|lanes| i64::from(lanes.get()));
    "width", Real, "m", "OSM's `width`; null if unknown", road.of.attributes.width_m();
    "maxspeed", Text, "", "OSM's `maxspeed`: a plain number is in km/h, `30 mph` in miles per hour, other values are as tagged; null if not tagged",
        text(&road.of.attributes.max_speed);
    "sac_scale", Text, "", "OSM's `sac_scale`; null if not tagged", text(&road.of.attributes.sac_scale);
    "tracktype", Text, "", "OSM's `tracktype`; null if not tagged", text(&road.of.attributes.tracktype);
    "length_2d_m", Real, "m", "2D length (in plan), on the WGS84 ellipsoid", real(road.measures.length_2d_m);
    "length_3d_m", Real, "m", "3D length, with the ups and downs of the line", real(road.measures.length_3d_m);
}

fields! { GROUND_FIELDS, road: &FeatureRoad<'_>:
    "ascent_m", Real, "m", "total ascent in the direction of the line; null for bridges and tunnels",
        on_ground(road, road.measures.grades.ascent_m);
    "descent_m", Real, "m", "total descent in the direction of the line; null for bridges and tunnels",
        on_ground(road, road.measures.grades.descent_m);
    "steepest_pct", Real, "%", "steepest grade, up or down, over 20 m or more; null for bridges and tunnels, and if no line is that long",
        percent_on_ground(road, road.measures.grades.steepest);
}

fields! { DEM_FIELDS, road: &FeatureRoad<'_>:
    "ascent_m", Real, "m", "total ascent of the smooth line in the direction of the way; null for bridges and tunnels without estimated heights",
        road.grades().map(|grades| real(grades.ascent_m));
    "descent_m", Real, "m", "total descent of the smooth line in the direction of the way; null for bridges and tunnels without estimated heights",
        road.grades().map(|grades| real(grades.descent_m));
    "steepest_pct", Real, "%", "steepest grade of the smooth line, up or down, over 50 m or more; null for bridges and tunnels without estimated heights, and if no line is that long",
        steepest_pct(road).map(real);
    "ground_ascent_m", Real, "m", "total ascent of the exported line itself, with the noise of its heights; null for bridges and tunnels without estimated heights",
        on_ground(road, road.measures.grades.ascent_m);
    "ground_descent_m", Real, "m", "total descent of the exported line itself; null for bridges and tunnels without estimated heights",
        on_ground(road, road.measures.grades.descent_m);
    "ground_steepest_pct", Real, "%", "steepest grade of the exported line itself over 20 m or more; null for bridges and tunnels without estimated heights, and if no line is that long",
        percent_on_ground(road, road.measures.grades.steepest);
    "smoothing_max_m", Real, "m", "largest height difference between the smooth line and the exported line; null for bridges and tunnels",
        smoothing_max(road);
    "smoothed_by", Text, "", "`chain`: smoothed from junction to junction (with --osm); `way`: each way by itself; null for bridges and tunnels without estimated heights",
        smoothed_by(road);
    "grade_over_limit", Integer, "", "1 if the road is steeper than roads with its `highway` value are built, else 0; null if `steepest_pct` or the limit is unknown",
        over_limit(road);
    "free_height_m", Real, "m", "for bridges and tunnels: the smallest height difference to a road that they cross, an estimate; null if none is known",
        road.smooth.and_then(|smooth| smooth.free_height_m).map(real);
}

fields! { LAST_FIELDS, road: &FeatureRoad<'_>:
    "vertices_in", Integer64, "", "number of points of the line on this level before it was draped on the ground",
        road.measures.vertices_in as i64;
    "vertices_out", Integer64, "", "number of vertices of the line after draping",
        road.measures.vertices_out as i64;
    "parts", Integer, "", "number of lines of the feature; gaps separate them", road.parts as i64;
    "height_source", Text, "", "`ground`: the package's triangles; `dem`: the elevation files; `deck`, `tunnel`: estimated from the heights of both ends; `ground_under_bridge`, `ground_over_tunnel`: the height of the ground under a bridge or over a tunnel, not that of the road",
        road.height_source().kind(road.of.attributes.structure, road.of.heights.on_deck).name();
}

fields! { BOUND_FIELDS, road: &FeatureRoad<'_>:
    "height_tolerance_m", Real, "m", "upper bound of the height difference between the whole line and the DEM (bilinear between samples); the DEM's own errors are not included; null if the package's grid nodes are not samples of the DEM",
        road.of.heights.tolerance_m.map(bound);
}

fields! { MEASURED_FIELDS, road: &FeatureRoad<'_>:
    "height_tolerance_m", Real, "m", "largest height difference between the whole line and the DEM (bilinear between its own samples); the DEM's own errors are not included; null for `deck` and `tunnel` heights, and where voids were filled",
        road.of.heights.tolerance_m.filter(|_| !road.of.heights.has_deck).map(bound);
    "ground_tolerance_m", Real, "m", "largest height difference between the package's triangles and the DEM along the line; null if they were not compared",
        road.of.heights.ground_m.map(bound);
}

fields! { PIECE_FIELDS, road: &FeatureRoad<'_>:
    "tile", Text, "", "with `--pieces`: the tile, as `z/x/y`",
        road.piece.map(|(tile, _)| tile.to_string()).as_deref();
    "part", Integer64, "", "with `--pieces`: number of the piece, counted along the way within the tile",
        road.piece.map(|(_, part)| i64::from(part));
}

/// A field of roads with the function that returns its value.
type RoadField = (FeatureField, fn(&FeatureRoad<'_>) -> FieldValue);

/// Returns the fields of features, in their order: for ways or for pieces, with heights of the
/// ground or of the elevation files.
fn fields_and_values(pieces: bool, heights: HeightSource) -> Vec<RoadField> {
    let of_pieces = if pieces { PIECE_FIELDS } else { &[] };
    let groups: &[&[RoadField]] = match heights {
        HeightSource::Ground => &[FIELDS, GROUND_FIELDS, LAST_FIELDS, BOUND_FIELDS, of_pieces],
        HeightSource::Dem => &[FIELDS, DEM_FIELDS, LAST_FIELDS, MEASURED_FIELDS, of_pieces],
    };
    groups.concat()
}

/// Returns the fields of features, in their order: for ways or for pieces, with heights of the
/// ground or of the elevation files.
#[must_use]
pub fn road_fields(pieces: bool, heights: HeightSource) -> Vec<FeatureField> {
    fields_of(&fields_and_values(pieces, heights))
}

/// Returns the values of a road, one for each of [`road_fields`].
pub(crate) fn road_values(road: &FeatureRoad<'_>) -> Vec<FieldValue> {
    let fields = fields_and_values(road.piece.is_some(), road.height_source());
    fields.into_iter().map(|(_, value)| value(road)).collect()
}

impl FeatureRoad<'_> {
    fn height_source(&self) -> HeightSource {
        if self.smooth.is_some() { HeightSource::Dem } else { HeightSource::Ground }
    }

    fn grades(&self) -> Option<ProfileGrades> {
        self.smooth.and_then(|smooth| smooth.grades)
    }
}

/// Rounds an upper bound up to whole micrometres.
fn bound(value: f64) -> f64 {
    (value * 1e6).ceil() / 1e6
}

fn smoothing_max(road: &FeatureRoad<'_>) -> Option<f64> {
    let known = road.smooth.filter(|smooth| smooth.grades.is_some() && !road.of.heights.has_deck);
    known.map(|smooth| bound(smooth.most_off_m))
}

/// Returns a measure of the line; `None` where the line is not at the road's own height.
fn on_ground(road: &FeatureRoad<'_>, value: f64) -> Option<f64> {
    let is_its_own = road.of.attributes.structure == Structure::Ground || road.of.heights.on_deck;
    is_its_own.then(|| real(value))
}

fn percent_on_ground(road: &FeatureRoad<'_>, grade: Option<f64>) -> Option<f64> {
    grade.and_then(|grade| on_ground(road, 100.0 * grade))
}

fn steepest_pct(road: &FeatureRoad<'_>) -> Option<f64> {
    road.grades()?.steepest.map(|grade| 100.0 * grade)
}

fn smoothed_by(road: &FeatureRoad<'_>) -> Option<&'static str> {
    road.grades().zip(road.smooth).map(|(_, own)| if own.is_of_chain { "chain" } else { "way" })
}

fn over_limit(road: &FeatureRoad<'_>) -> Option<i64> {
    let steepest = steepest_pct(road).zip(road.smooth?.limit_pct);
    steepest.map(|(steepest_pct, limit_pct)| (steepest_pct > limit_pct + ROUNDING_PCT).into())
}

fn is(road: &FeatureRoad<'_>, structure: Structure) -> i64 {
    (road.of.attributes.structure == structure).into()
}

pub(crate) fn oneway(oneway: Oneway) -> &'static str {
    match oneway {
        Oneway::No => "no",
        Oneway::Forward => "yes",
        Oneway::Backward => "-1",
    }
}
