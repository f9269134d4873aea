//! Tunnels, slip roads and service roads are recognized by their attributes.

use super::*;

#[test]
fn tunnels_count_before_slip_roads() {
    let attributes =
        |form, structure| RoadAttributes { form, structure, ..RoadAttributes::default() };
    for (form, structure, look) in [
        (Form::default(), Structure::default(), RoadLook::Plain),
        (Form::Link, Structure::default(), RoadLook::Link),
        (Form::Link, Structure::Bridge, RoadLook::Link),
        (Form::DualCarriageway, Structure::Bridge, RoadLook::Carriageway),
        (Form::DualCarriageway, Structure::Tunnel, RoadLook::CarriagewayTunnel),
        (Form::Roundabout, Structure::default(), RoadLook::Plain),
        (Form::default(), Structure::Tunnel, RoadLook::Tunnel),
        (Form::Link, Structure::Tunnel, RoadLook::Tunnel),
    ] {
        assert_eq!(
            RoadLook::from_attributes(&attributes(form, structure)),
            look,
            "{form:?} {structure:?}"
        );
    }
}

#[test]
fn looks_have_their_numbers_in_shaders() {
    let shader = include_str!("../../shaders/common.wgsl");
    for look in RoadLook::ALL {
        assert_eq!(RoadLook::ALL[look as usize], look);
        let name = format!("{look:?}").replace("Carriageway", "CARRIAGEWAY_").to_uppercase();
        let constant = format!("const {} = {}u;", name.trim_end_matches('_'), look as u32);
        assert!(shader.contains(&constant), "{constant}");
    }
    let tunnels = RoadLook::ALL.into_iter().filter(|look| look.is_tunnel());
    assert!(tunnels.map(RoadLook::with_portals).all(RoadLook::is_bore));
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
        // Packages of the first versions do not have the value.
        ("", Structure::Ground, RoadLook::Plain),
    ] {
        assert_eq!(
            RoadLook::from_attributes(&tagged(highway, structure)),
            look,
            "{highway} {structure:?}"
        );
    }
}
