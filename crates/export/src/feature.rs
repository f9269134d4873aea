//! Roads as features: which fields they have.

use corniche_geom::TileId;
use corniche_roads::{Form, FunctionalRoadClass, Oneway, RoadAttributes, Structure};

use crate::{
    measures::Measures,
    vector::{Field, FieldKind, Value},
};

/// Declares the fields together with what is in them, in one order.
macro_rules! fields {
    ($road:ident: $($name:literal, $kind:ident, $unit:literal, $meaning:literal, $value:expr;)+) => {
        const FIELDS: &[Field] = &[
            $(Field { name: $name, kind: FieldKind::$kind, unit: $unit, meaning: $meaning },)+
        ];

        fn values($road: &Road<'_>) -> Vec<Value> {
            vec![$($value),+]
        }
    };
}

/// What is known of a feature's road.
pub(crate) struct Road<'a> {
    pub(crate) way_id: i64,
    pub(crate) class: FunctionalRoadClass,
    pub(crate) attributes: &'a RoadAttributes,
    pub(crate) parts: usize,
    pub(crate) measures: Measures,
    /// The tile of a feature of one piece, and the piece's number there.
    pub(crate) piece: Option<(TileId, u32)>,
}

fields! { road:
    "way_id", Integer64, "", "id of the way in OpenStreetMap", Value::Integer(road.way_id);
    "class", Integer, "", "functional road class, 0 (motorway) to 8 (other road)",
        Value::Integer(road.class.number().into());
    "highway", Text, "", "OSM's `highway`", text(&road.attributes.highway);
    "form", Text, "", "`ordinary`, `dual_carriageway`, `link` or `roundabout`",
        Value::Text(form(road.attributes.form).to_owned());
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
    "length_2d_m", Real, "m", "true length in plan, on the ellipsoid of WGS84",
        Value::Real(to_micro(road.measures.length_2d_m));
    "length_3d_m", Real, "m", "true length with the ground's ups and downs",
        Value::Real(to_micro(road.measures.length_3d_m));
    "ascent_m", Real, "m", "sum of all that the line rises, in its direction",
        Value::Real(to_micro(road.measures.ascent_m));
    "descent_m", Real, "m", "sum of all that it falls", Value::Real(to_micro(road.measures.descent_m));
    "steepest_pct", Real, "%", "steepest grade over 20 m or more, up or down; null where no part is as long",
        road.measures.steepest.map_or(Value::Null, |grade| Value::Real(to_micro(100.0 * grade)));
    "vertices_in", Integer64, "", "points of the level's line before it was laid on the ground",
        Value::Integer(road.measures.vertices_in as i64);
    "vertices_out", Integer64, "", "vertices of the line on the ground",
        Value::Integer(road.measures.vertices_out as i64);
    "parts", Integer, "", "lines without a gap between them", Value::Integer(road.parts as i64);
}

/// The fields of features that are pieces, beside the others.
const PIECE_FIELDS: [Field; 2] = [
    Field {
        name: "tile",
        kind: FieldKind::Text,
        unit: "",
        meaning: "with `--pieces`: the tile, as `z/x/y`",
    },
    Field {
        name: "part",
        kind: FieldKind::Integer64,
        unit: "",
        meaning: "with `--pieces`: number of the piece along the way within the tile",
    },
];

/// The fields of features, in their order: of ways, or of pieces.
#[must_use]
pub fn road_fields(pieces: bool) -> Vec<Field> {
    let of_pieces = PIECE_FIELDS.iter().filter(|_| pieces);
    FIELDS.iter().chain(of_pieces).copied().collect()
}

/// The values of a road, one for each of [`road_fields`].
pub(crate) fn road_values(road: &Road<'_>) -> Vec<Value> {
    let mut values = values(road);
    if let Some((tile, part)) = road.piece {
        values.extend([Value::Text(tile.to_string()), Value::Integer(part.into())]);
    }
    values
}

/// Rounds to whole micrometres, so that sums of rounding do not fill files with digits.
fn to_micro(value: f64) -> f64 {
    (value * 1e6).round() / 1e6
}

/// GDAL's texts end at a zero byte, which OpenStreetMap's never have and damaged ones may.
fn text(text: &str) -> Value {
    if text.is_empty() { Value::Null } else { Value::Text(text.replace('\0', "\u{fffd}")) }
}

fn is(road: &Road<'_>, structure: Structure) -> Value {
    Value::Integer((road.attributes.structure == structure).into())
}

fn form(form: Form) -> &'static str {
    match form {
        Form::Ordinary => "ordinary",
        Form::DualCarriageway => "dual_carriageway",
        Form::Link => "link",
        Form::Roundabout => "roundabout",
    }
}

fn oneway(oneway: Oneway) -> &'static str {
    match oneway {
        Oneway::No => "no",
        Oneway::Forward => "yes",
        Oneway::Backward => "-1",
    }
}
