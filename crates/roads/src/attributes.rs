//! Reads road attributes from the tags of a way.

use crate::{
    Form, Oneway, RoadAttributes, Structure,
    frc_table::{is_yes, tag},
    quantities::{lanes, max_speed, width_mm},
};

/// Reads the attributes of a way from its `(key, value)` tags, without its class. If a key occurs
/// twice, the first value counts.
///
/// - **Form**: `junction=roundabout|circular`, else a link by its `highway` value, else one of two
///   carriageways when `dual_carriageway=yes` or when a motorway or trunk road is one-way.
/// - **Structure**: any `bridge` except `no`, `boardwalk` (planks on soft ground) and
///   `low_water_crossing` (a paved ford); any `tunnel` except `no`, `culvert` (the water is in it,
///   not the road) and `building_passage` (at ground level). `covered` means a roof and changes
///   nothing. If both are tagged, the way is a tunnel if its layer is below 0, otherwise a bridge.
/// - **Oneway**: as tagged. Motorways and roundabouts are one-way unless tagged otherwise. Roads
///   that are open to one direction at a time (`reversible`, `alternating`) are open to both.
/// - **Lanes**: a whole number from 1 to 255.
/// - **Width**: metres if there is no unit, otherwise in the tagged unit; above 0 and at most 1 km.
/// - **Speed limit**: whole numbers of km/h or miles per hour are written in one way; any other
///   value stays as tagged.
/// - **Texts**, such as names, stay as tagged, including spaces around them. For all other values,
///   surrounding spaces are ignored.
///
/// Source: OSM wiki, *Key:oneway*, *Key:junction*, *Key:bridge*, *Key:tunnel*, *Key:layer*,
/// *Key:lanes*, *Key:width*, *Key:maxspeed*.
#[must_use]
pub fn attributes(tags: &[(&str, &str)]) -> RoadAttributes {
    let text = |key| tag(tags, key).unwrap_or_default();
    let value = |key| text(key).trim();
    let highway = value("highway");
    let (structure, layer) = structure_and_layer(tags);
    let is_roundabout = matches!(value("junction"), "roundabout" | "circular");
    let oneway = oneway(value("oneway"), is_roundabout || highway == "motorway");
    RoadAttributes {
        form: if is_roundabout {
            Form::Roundabout
        } else if highway.ends_with("_link") {
            Form::Link
        } else if is_yes(value("dual_carriageway"))
            || (oneway != Oneway::No && matches!(highway, "motorway" | "trunk"))
        {
            Form::DualCarriageway
        } else {
            Form::Ordinary
        },
        structure,
        layer,
        oneway,
        name: text("name").to_owned(),
        reference: text("ref").to_owned(),
        surface: text("surface").to_owned(),
        highway: highway.to_owned(),
        lanes: lanes(value("lanes")),
        width_mm: width_mm(value("width")),
        max_speed: max_speed(text("maxspeed")),
        sac_scale: text("sac_scale").to_owned(),
        tracktype: text("tracktype").to_owned(),
    }
}

/// Returns the structure that carries a way with these tags, and its layer, as [`attributes`] reads
/// them.
#[must_use]
pub fn structure_and_layer(tags: &[(&str, &str)]) -> (Structure, i8) {
    let value = |key| tag(tags, key).unwrap_or_default().trim();
    let layer = layer(value("layer"));
    (structure(value("bridge"), value("tunnel"), layer), layer)
}

/// Returns the tags that [`attributes`] interprets as another value, as `(key, value)` with the
/// value as tagged: a `layer` that is not a whole number or too large (read as 0 or as the largest
/// number); a `bridge` or a `tunnel` that leaves the road on the ground; `lanes` that are not a
/// count, and a `width` that is not a width, for example 0 (both read as unknown).
pub fn tags_taken_otherwise<'t>(
    tags: &[(&'t str, &'t str)],
) -> impl Iterator<Item = (&'static str, &'t str)> + use<'t> {
    let text = |key| tag(tags, key).unwrap_or_default();
    let known: [(&'static str, IsRead); 5] = [
        ("bridge", |bridge| !BESIDE_BRIDGES.contains(&bridge)),
        ("layer", |layer| layer.parse::<i8>().is_ok()),
        ("tunnel", |tunnel| !BESIDE_TUNNELS.contains(&tunnel)),
        ("lanes", |text| lanes(text).is_some()),
        ("width", |text| width_mm(text).is_some()),
    ];
    known
        .map(|(key, is_read)| (key, text(key), is_read))
        .into_iter()
        .filter(|(_, text, is_read)| !text.trim().is_empty() && !is_read(text.trim()))
        .map(|(key, text, _)| (key, text))
}

/// Whether the value of a tag is read as it is written.
type IsRead = fn(&str) -> bool;

/// Values of `bridge` that leave the road on the ground, so that it has the ground's heights.
const BESIDE_BRIDGES: [&str; 2] = ["boardwalk", "low_water_crossing"];
/// Values of `tunnel` that do not put the road underground: in a culvert is water, and a building
/// passage is at ground level.
const BESIDE_TUNNELS: [&str; 2] = ["culvert", "building_passage"];

fn structure(bridge: &str, tunnel: &str, layer: i8) -> Structure {
    let is = |tagged: &str, beside: [&str; 2]| {
        !["", "no", "false", "0"].contains(&tagged) && !beside.contains(&tagged)
    };
    match (is(bridge, BESIDE_BRIDGES), is(tunnel, BESIDE_TUNNELS)) {
        (false, false) => Structure::Ground,
        (true, true) if layer < 0 => Structure::Tunnel,
        (true, _) => Structure::Bridge,
        (false, true) => Structure::Tunnel,
    }
}

fn oneway(tagged: &str, is_implied: bool) -> Oneway {
    match tagged {
        "-1" | "reverse" => Oneway::Backward,
        "" if is_implied => Oneway::Forward,
        yes if is_yes(yes) => Oneway::Forward,
        _ => Oneway::No,
    }
}

/// Reads a whole number, clamped to what fits. Any other value is layer 0, as for a way without the
/// tag.
fn layer(tagged: &str) -> i8 {
    let clamped = tagged.parse::<i64>().map(|layer| layer.clamp(i8::MIN.into(), i8::MAX.into()));
    clamped.map_or(0, |layer| layer as i8)
}

#[cfg(test)]
#[path = "attributes_tests.rs"]
mod tests;
