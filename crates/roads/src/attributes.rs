use crate::{
    Form, Oneway, RoadAttributes, Structure,
    frc_table::{is_yes, tag},
};

/// What is kept of a way's `(key, value)` tags, besides its class. Of a key that occurs twice the first counts.
///
/// - **Form**: `junction=roundabout|circular`, else a link by its `highway` value, else one of two carriageways when
///   `dual_carriageway=yes` or when a motorway or trunk road is one-way.
/// - **Structure**: any `bridge` but `no`; any `tunnel` but `no`, `culvert` (the water is in it, not the road) and
///   `building_passage` (at ground level). `covered` is a roof and changes nothing. Where both are tagged, the way is
///   a tunnel if its layer is below 0, else a bridge.
/// - **Oneway**: as tagged; motorways and roundabouts are one-way unless tagged otherwise. Roads open to one direction
///   at a time (`reversible`, `alternating`) are open to both.
///
/// Source: OSM wiki, *Key:oneway*, *Key:junction*, *Key:bridge*, *Key:tunnel*, *Key:layer*.
#[must_use]
pub fn attributes(tags: &[(&str, &str)]) -> RoadAttributes {
    let value = |key| tag(tags, key).map(str::trim).unwrap_or_default();
    let highway = value("highway");
    let layer = layer(value("layer"));
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
        structure: structure(value("bridge"), value("tunnel"), layer),
        layer,
        oneway,
        name: value("name").to_owned(),
        reference: value("ref").to_owned(),
        surface: value("surface").to_owned(),
    }
}

/// The tags that [`attributes`] reads as another value, as `(key, value)`: a `layer` that is no whole number or too
/// large, which is taken for 0 or the largest; a `tunnel` that the road does not lie in, which is taken for none.
pub fn tags_taken_otherwise<'t>(
    tags: &[(&'t str, &'t str)],
) -> impl Iterator<Item = (&'static str, &'t str)> + use<'t> {
    let value = |key| tag(tags, key).map(str::trim).unwrap_or_default();
    let (layer, tunnel) = (value("layer"), value("tunnel"));
    let is_layer = layer.is_empty() || layer.parse::<i8>().is_ok();
    [("layer", layer, !is_layer), ("tunnel", tunnel, BESIDE_TUNNELS.contains(&tunnel))]
        .into_iter()
        .filter(|(.., is_otherwise)| *is_otherwise)
        .map(|(key, value, _)| (key, value))
}

/// Values of `tunnel` that do not put the road underground: the water is in a culvert, a building passage is at ground level.
const BESIDE_TUNNELS: [&str; 2] = ["culvert", "building_passage"];

fn structure(bridge: &str, tunnel: &str, layer: i8) -> Structure {
    let is_bridge = !matches!(bridge, "" | "no" | "false" | "0");
    let is_tunnel =
        !matches!(tunnel, "" | "no" | "false" | "0") && !BESIDE_TUNNELS.contains(&tunnel);
    match (is_bridge, is_tunnel) {
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

/// Whole numbers, clamped to what fits; anything else is layer 0, as for a way without the tag.
fn layer(tagged: &str) -> i8 {
    let clamped = tagged.parse::<i64>().map(|layer| layer.clamp(i8::MIN.into(), i8::MAX.into()));
    clamped.map_or(0, |layer| layer as i8)
}

#[cfg(test)]
#[path = "attributes_tests.rs"]
mod tests;
