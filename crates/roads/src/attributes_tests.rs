//! Road attributes are read from tags as documented, and tags that are interpreted differently are
//! named.

use std::num::{NonZeroU8, NonZeroU32};

use super::*;

fn attributes_from(text: &str) -> RoadAttributes {
    let tags: Vec<(&str, &str)> =
        text.split_whitespace().map(|tag| tag.split_once('=').unwrap()).collect();
    attributes(&tags)
}

#[test]
fn form_follows_junction_then_link_then_carriageway() {
    let check = |tags, expected| assert_eq!(attributes_from(tags).form, expected, "{tags}");
    check("highway=primary", Form::Ordinary);
    check("highway=primary oneway=yes", Form::Ordinary);
    check("highway=primary oneway=yes dual_carriageway=yes", Form::DualCarriageway);
    check("highway=motorway", Form::DualCarriageway);
    check("highway=motorway oneway=no", Form::Ordinary);
    check("highway=trunk", Form::Ordinary);
    check("highway=trunk oneway=-1", Form::DualCarriageway);
    check("highway=trunk_link oneway=yes", Form::Link);
    check("highway=residential junction=roundabout", Form::Roundabout);
    check("highway=trunk_link junction=circular", Form::Roundabout);
    check("highway=residential junction=intersection", Form::Ordinary);
}

#[test]
fn oneway_is_as_tagged_or_implied() {
    let check = |tags, expected| assert_eq!(attributes_from(tags).oneway, expected, "{tags}");
    check("highway=primary", Oneway::No);
    for yes in ["yes", "true", "1"] {
        assert_eq!(attributes(&[("oneway", yes)]).oneway, Oneway::Forward);
    }
    check("oneway=-1", Oneway::Backward);
    check("oneway=reverse junction=roundabout", Oneway::Backward);
    check("highway=motorway", Oneway::Forward);
    check("highway=motorway_link", Oneway::No);
    check("highway=motorway oneway=no", Oneway::No);
    check("highway=motorway oneway=reversible", Oneway::No);
    check("highway=service junction=roundabout", Oneway::Forward);
    check("oneway=alternating", Oneway::No);
}

#[test]
fn structure_is_what_carries_the_road() {
    let check = |tags, expected| assert_eq!(attributes_from(tags).structure, expected, "{tags}");
    check("highway=primary covered=yes", Structure::Ground);
    check("bridge=yes", Structure::Bridge);
    check("bridge=viaduct", Structure::Bridge);
    check("bridge=no tunnel=no", Structure::Ground);
    check("tunnel=yes", Structure::Tunnel);
    check("tunnel=avalanche_protector", Structure::Tunnel);
    check("tunnel=culvert", Structure::Ground);
    check("tunnel=building_passage", Structure::Ground);
    check("bridge=boardwalk", Structure::Ground);
    check("bridge=low_water_crossing layer=1", Structure::Ground);
    check("bridge=viaduct", Structure::Bridge);
    check("bridge=yes tunnel=yes layer=1", Structure::Bridge);
    check("bridge=yes tunnel=yes layer=-1", Structure::Tunnel);
}

#[test]
fn layers_are_whole_numbers_that_fit() {
    for (text, expected) in [
        ("", 0),
        ("0", 0),
        ("+2", 2),
        ("-5", -5),
        (" 3 ", 3),
        ("1000", 127),
        ("-1000", -128),
        ("1.5", 0),
        ("1;2", 0),
        ("99999999999999999999", 0),
        ("ground", 0),
    ] {
        assert_eq!(attributes(&[("layer", text)]).layer, expected, "{text:?}");
    }
}

/// Tags whose values are interpreted differently are named, and tags that are read as written are
/// not.
#[test]
fn tags_that_are_taken_for_something_else_are_named() {
    let told = |tags: &[(&'static str, &'static str)]| -> Vec<(&'static str, &'static str)> {
        tags_taken_otherwise(tags).collect()
    };
    for value in ["1000", "-1000", "128", "1.5", "1;2", "ground", "99999999999999999999"] {
        assert_eq!(told(&[("layer", value)]), [("layer", value)]);
    }
    for value in ["", "0", "+2", "-5", " 3 ", "127", "-128"] {
        assert_eq!(told(&[("layer", value)]), [], "{value:?}");
    }
    for value in ["culvert", "building_passage"] {
        assert_eq!(told(&[("tunnel", value), ("layer", "-1")]), [("tunnel", value)]);
    }
    for value in ["yes", "no", "avalanche_protector", ""] {
        assert_eq!(told(&[("tunnel", value)]), [], "{value:?}");
    }
    let odd = [("lanes", "1.5"), ("width", "0"), ("maxspeed", "fast"), ("tracktype", "grade9")];
    assert_eq!(told(&odd), [("lanes", "1.5"), ("width", "0")]);
    assert_eq!(told(&[("width", "-2"), ("layer", "x")]), [("layer", "x"), ("width", "-2")]);
    assert_eq!(told(&[("lanes", "2"), ("width", "3.5 m")]), []);
}

#[test]
fn what_a_road_is_like_is_kept() {
    let road = attributes(&[
        ("highway", "track"),
        ("lanes", "2"),
        ("width", " 3.5 m "),
        ("maxspeed", "20 km/h"),
        ("sac_scale", "mountain_hiking"),
        ("tracktype", "grade3"),
    ]);
    assert_eq!(road.lanes.map(NonZeroU8::get), Some(2));
    assert_eq!((road.width_mm.map(NonZeroU32::get), road.width_m()), (Some(3500), Some(3.5)));
    let texts = [&road.highway, &road.max_speed, &road.sac_scale, &road.tracktype];
    assert_eq!(texts, ["track", "20", "mountain_hiking", "grade3"]);
    assert_eq!(road.text_bytes(), 5 + 2 + 15 + 6);
}

/// Spaces around numbers and keywords do not count; texts stay as tagged.
#[test]
fn texts_stay_as_tagged_with_the_spaces_around_them() {
    let road = attributes(&[
        ("name", " Pass Road  "),
        ("ref", "16 "),
        ("surface", "\tgravel"),
        ("sac_scale", " hiking"),
        ("tracktype", "grade3 "),
        ("maxspeed", " none "),
        ("oneway", " yes "),
        ("layer", " 1 "),
        ("lanes", " 2 "),
    ]);
    let RoadAttributes { name, reference, surface, sac_scale, tracktype, max_speed, .. } = &road;
    let texts = [name, reference, surface, sac_scale, tracktype, max_speed];
    assert_eq!(texts, [" Pass Road  ", "16 ", "\tgravel", " hiking", "grade3 ", " none "]);
    let lanes = road.lanes.map(NonZeroU8::get);
    assert_eq!((road.oneway, road.layer, lanes), (Oneway::Forward, 1, Some(2)));
    assert_eq!(attributes(&[("maxspeed", " 50 km/h ")]).max_speed, "50");
    let trimmed = road.trimmed();
    assert_eq!((&*trimmed.name, &*trimmed.reference), ("Pass Road", "16"));
    let odd: Vec<_> = tags_taken_otherwise(&[("layer", " x ")]).collect();
    assert_eq!(odd, [("layer", " x ")]);
}

#[test]
fn the_names_of_a_road_are_kept() {
    let road = attributes(&[
        ("name", "Hauptstraße"),
        ("ref", "16"),
        ("surface", "asphalt"),
        ("name", "second"),
    ]);
    assert_eq!((&*road.name, &*road.reference, &*road.surface), ("Hauptstraße", "16", "asphalt"));
    assert_eq!(attributes(&[]), RoadAttributes::default());
}

/// Records of attributes hold the index of a direction in this list.
#[test]
fn all_directions_are_listed() {
    for direction in Oneway::ALL {
        let index = match direction {
            Oneway::No => 0,
            Oneway::Forward => 1,
            Oneway::Backward => 2,
        };
        assert_eq!(Oneway::ALL.get(index), Some(&direction));
    }
}
