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

/// A straight line that is cut anywhere has its dashes at the same places.
#[test]
fn dashes_go_on_where_a_line_is_cut() {
    let [start, cut, end] =
        [[530_003.0, 5_210_004.0], [530_006.0, 5_210_008.0], [530_012.0, 5_210_016.0]];
    let [whole, first, second] = [[start, end], [start, cut], [cut, end]].map(dash_m);
    assert!((first - whole).abs() < 1e-2);
    assert!((second - first - 5.0).abs() < 2e-2, "{first} {second}");
    assert!((0.0..65_536.0).contains(&dash_m([[-5.0, 0.0], [-4.0, 0.0]])));
    assert!(dash_m([start, start]).abs() < 1e-9);
}
