//! All options of how roads look affect the drawing.

use clap::Parser;

use super::*;

#[derive(Parser)]
struct Line {
    #[arg(long, value_parser = one_of(ROADS), value_delimiter = ',')]
    roads: Vec<Roads>,
    #[command(flatten)]
    look: LookArgs,
}

fn line(text: &str) -> Line {
    Line::parse_from(format!("corniche {text}").split(' '))
}

#[test]
fn nothing_said_is_the_method_as_it_is_meant_to_be_seen() {
    let look = line("--roads geo").look;
    for roads in [Roads::Geo, Roads::Sv, Roads::None] {
        assert_eq!(look.road_options(roads), RoadOptions::for_method(roads.method()), "{roads:?}");
    }
    assert_eq!(look.style, "road-atlas");
}

#[test]
fn every_option_reaches_the_drawing() {
    let Line { roads, look } =
        line("--roads sv --cap-test paper --width-growth constant --outline 5 --style dark");
    let expected = RoadOptions {
        method: RoadMethod::ShadowVolumes,
        classes: corniche_viewer::ClassSet::ALL,
        caps: corniche_viewer::Caps::Round,
        cap_test: corniche_viewer::CapTest::PaperQuadratic,
        quads: corniche_viewer::Quads::Beds,
        width_growth: corniche_viewer::WidthGrowth::Constant,
        outline: corniche_viewer::RoadOutline::Kernel5,
    };
    assert_eq!(look.road_options(look.roads(&roads).unwrap()[0]), expected);
    assert_eq!(look.style, "dark");
    assert!(look.shown_layers().contains("areas"));
    let shown = |list: &str| line(list).look.shown_layers();
    assert!(shown("--layers railways,areas").contains("areas"));
    assert!(
        !shown("--layers railways").contains("areas") && !shown("--layers none").contains("areas")
    );
    let look = line("--roads geo --width-growth none --outline none").look;
    let options = look.road_options(Roads::GeoNoCaps);
    assert_eq!(options.width_growth, corniche_viewer::WidthGrowth::None);
    assert_eq!(options.outline, corniche_viewer::RoadOutline::None);
    assert_eq!(options.caps, corniche_viewer::Caps::None);
    assert_eq!(options.method, RoadMethod::Geometry);
    let Line { roads, look } = line("--roads sv,geo --geo-quads level");
    let drawn = look.roads(&roads).unwrap();
    assert_eq!(look.road_options(drawn[1]).quads, corniche_viewer::Quads::Level);
    for without in ["sv", "none"] {
        let Line { roads, look } = line(&format!("--roads {without} --geo-quads level"));
        let refused = look.roads(&roads).unwrap_err().to_string();
        assert!(refused.contains("--geo-quads applies only to roads as geometry"), "{refused}");
    }
}

#[test]
fn caps_are_said_with_the_method_or_for_all_methods() {
    let Line { roads, look } = line("--roads none,geo,sv,sv-no-caps --caps none");
    let resolved = look.roads(&roads).unwrap();
    assert_eq!(resolved, [Roads::None, Roads::GeoNoCaps, Roads::SvNoCaps, Roads::SvNoCaps]);
    let Line { roads, look } = line("--roads sv,sv-no-caps");
    assert_eq!(look.roads(&roads).unwrap(), [Roads::Sv, Roads::SvNoCaps]);
    for roads in [Roads::GeoNoCaps, Roads::SvNoCaps] {
        assert_eq!(look.road_options(roads).caps, corniche_viewer::Caps::None);
    }
}

#[test]
fn a_test_of_caps_needs_caps_to_test() {
    for without in ["geo", "none", "sv-no-caps", "sv --caps none"] {
        let Line { roads, look } = line(&format!("--cap-test paper --roads {without}"));
        let message = look.roads(&roads).unwrap_err().to_string();
        assert!(message.contains("--cap-test") && message.contains("--roads sv"), "{message}");
    }
}
