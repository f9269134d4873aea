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
