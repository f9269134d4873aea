//! Tunnels, slip roads and service roads are told by their attributes.

use super::*;

#[test]
fn tunnels_count_before_slip_roads() {
    let attributes =
        |form, structure| RoadAttributes { form, structure, ..RoadAttributes::default() };
    for (form, structure, look) in [
        (Form::default(), Structure::default(), RoadLook::Plain),
        (Form::Link, Structure::default(), RoadLook::Link),
        (Form::Link, Structure::Bridge, RoadLook::Link),
        (Form::default(), Structure::Tunnel, RoadLook::Tunnel),
        (Form::Link, Structure::Tunnel, RoadLook::Tunnel),
    ] {
        assert_eq!(RoadLook::of(&attributes(form, structure)), look, "{form:?} {structure:?}");
    }
}

#[test]
fn service_roads_are_known_by_their_highway_value() {
    let tagged = |highway: &str, structure| RoadAttributes {
        highway: highway.to_owned(),
        structure,
        ..RoadAttributes::default()
    };
    for (highway, structure, look) in [
        ("service", Structure::Ground, RoadLook::Service),
        ("service", Structure::Bridge, RoadLook::Service),
        ("service", Structure::Tunnel, RoadLook::Tunnel),
        ("services", Structure::Ground, RoadLook::Plain),
        ("track", Structure::Ground, RoadLook::Plain),
        // Packages of the first programs do not have the value.
        ("", Structure::Ground, RoadLook::Plain),
    ] {
        assert_eq!(RoadLook::of(&tagged(highway, structure)), look, "{highway} {structure:?}");
    }
}
