//! The command that a window offers renders the view in the window.

use clap::Parser as _;
use corniche_remote::PackagePlace;
use corniche_viewer::{ShownLayers, camera::Orientation};

use corniche_window::MapSettings;

use super::*;
use crate::args::{Arguments, CliCommand, RenderArgs};

fn shown(roads: RoadOptions) -> ShownView {
    ShownView {
        camera: CameraRequest::LookAt {
            lon_deg: -9.521_234_567_89,
            lat_deg: 47.140_123_456_78,
            height_m: Some(-3.456_78),
            distance_m: 2_345.678_9,
            orientation: Orientation { heading_deg: -123.456_78, pitch_deg: 61.234_56 },
        },
        size_px: [1234, 567],
        settings: MapSettings {
            photo: Some(0.25),
            exaggeration: 1.5,
            screen_space_error_px: 0.75,
            samples_per_side: 3,
            ..MapSettings::usual(roads)
        },
        style: "my styles/night 'n day.toml".to_owned(),
        overlay_colors: vec![[1.0, 0.5, 0.0], [0.0, 0.0, 1.0]],
    }
}

/// The same view with other settings.
fn with(shown: &ShownView, change: impl FnOnce(&mut MapSettings)) -> ShownView {
    let mut shown = shown.clone();
    change(&mut shown.settings);
    shown
}

/// Two files, the second with its own colour.
fn overlays() -> Vec<OverlayArg> {
    let of = |text| crate::args::overlay(text).unwrap();
    vec![of("my tracks/a.gpx"), of("b.geojson,color=#00FF00"), of("c.gpx")]
}

/// The arguments of the command, after a shell has split it into words.
fn read(package: &str, shown: &ShownView) -> RenderArgs {
    let command = command_of(Path::new(package), &overlays(), true)(shown);
    let words = shlex::split(&command).expect("quotes that a shell understands");
    match Arguments::try_parse_from(words)
        .unwrap_or_else(|error| panic!("{command}: {error}"))
        .command
    {
        CliCommand::Render(args) => args,
        other => panic!("{command}: {other:?}"),
    }
}

#[test]
fn the_command_draws_what_the_window_shows() {
    let shown = shown(RoadOptions::for_method(RoadMethod::ShadowVolumes));
    let args = read("my maps/$HOME.pmtiles", &shown);
    assert_eq!(args.from.package, PackagePlace::File("my maps/$HOME.pmtiles".into()));
    assert_eq!(args.look.style, shown.style);
    assert_eq!(args.size, [1234, 567]);
    assert_eq!(args.supersampling, 3);
    let ground = args.ground;
    let numbers = [ground.exaggeration, ground.screen_space_error, ground.cell_px];
    assert_eq!(numbers.map(f64::to_bits), [1.5, 0.75, f64::INFINITY].map(f64::to_bits));
    assert_eq!(args.look.photo.map(f32::to_bits), Some(0.25_f32.to_bits()));
    assert!(!args.wireframe && args.look.allow_ballpark);
    assert!(read("a", &with(&shown, |settings| settings.is_wireframe = true)).wireframe);
}

/// Hidden files are omitted, and no other file takes their colour.
#[test]
fn files_of_lines_are_drawn_as_they_are_shown() {
    let shown = shown(RoadOptions::for_method(RoadMethod::ShadowVolumes));
    let texts = |shown: &ShownView| -> Vec<String> {
        let given = read("a.pmtiles", shown).look.overlay;
        given.iter().map(|overlay| overlay.text.clone()).collect()
    };
    let colors = vec![[1.0, 0.5, 0.0], [0.0; 3], [0.0, 0.0, 1.0]];
    let shown = ShownView { overlay_colors: colors, ..shown };
    let all = ["my tracks/a.gpx,color=#FF8000", "b.geojson,color=#00FF00", "c.gpx,color=#0000FF"];
    assert_eq!(texts(&shown), all);
    let hiding = |numbers: &[usize]| {
        with(&shown, |settings| settings.hidden_overlays = numbers.iter().copied().collect())
    };
    assert_eq!(texts(&hiding(&[0, 1])), all[2..]);
    // An option for files of lines is not given without such a file.
    let without = hiding(&[0, 1, 2]);
    assert!(texts(&without).is_empty() && !read("a.pmtiles", &without).look.allow_ballpark);
}

/// A ten-millionth of a degree is at most 1.2 cm.
#[test]
fn the_command_looks_from_where_the_window_does() {
    let shown = shown(RoadOptions::for_method(RoadMethod::Geometry));
    let numbers = |camera| match camera {
        CameraRequest::LookAt { lon_deg, lat_deg, height_m, distance_m, orientation } => {
            let Orientation { heading_deg, pitch_deg } = orientation;
            [lon_deg, lat_deg, height_m.unwrap_or(f64::NAN), distance_m, heading_deg, pitch_deg]
        }
        _ => panic!("no place"),
    };
    let (asked, found) = (numbers(shown.camera), numbers(read("a", &shown).camera.request()));
    for ((asked, found), most) in asked.iter().zip(found).zip([6e-8, 6e-8, 6e-3, 6e-3, 6e-5, 6e-5])
    {
        assert!((asked - found).abs() <= most, "{asked} became {found}");
    }
}

#[test]
fn every_look_of_roads_is_read_as_it_was() {
    let mut count = 0;
    for method in [RoadMethod::Geometry, RoadMethod::ShadowVolumes] {
        for caps in [Caps::Round, Caps::None] {
            for width_growth in [WidthGrowth::None, WidthGrowth::Constant, WidthGrowth::ByDistance]
            {
                for outline in [
                    RoadOutline::OfStyle,
                    RoadOutline::None,
                    RoadOutline::Kernel3,
                    RoadOutline::Kernel5,
                ] {
                    for cap_test in [CapTest::Distance, CapTest::PaperQuadratic] {
                        let is_tested = method == RoadMethod::ShadowVolumes && caps == Caps::Round;
                        if cap_test == CapTest::PaperQuadratic && !is_tested {
                            continue;
                        }
                        for quads in [Quads::Beds, Quads::Level] {
                            if quads == Quads::Level && method != RoadMethod::Geometry {
                                continue;
                            }
                            let usual = RoadOptions::for_method(method);
                            let roads = RoadOptions {
                                caps,
                                cap_test,
                                quads,
                                width_growth,
                                outline,
                                ..usual
                            };
                            let args = read("a", &shown(roads));
                            let drawn = args.look.roads(&[args.roads]).unwrap()[0];
                            assert_eq!(args.look.road_options(drawn), roads);
                            count += 1;
                        }
                    }
                }
            }
        }
    }
    assert_eq!(count, 84);
    let none = shown(RoadOptions::for_method(RoadMethod::None));
    assert_eq!(read("a", &none).roads, Roads::None);
    for layers in [ShownLayers::ALL, ShownLayers::from_list("none"), ShownLayers::from_list("a,b")]
    {
        let shown = with(&none, |settings| settings.layers = layers.clone());
        assert_eq!(read("a", &shown).look.shown_layers(), layers);
    }
}

#[test]
fn a_view_from_above_is_drawn_from_above() {
    let camera = CameraRequest::FromAbove {
        lon_deg: 9.521_234_5,
        lat_deg: -47.140_123_4,
        pixel_m: 3.123_456,
        heading_deg: -12.5,
    };
    let shown = ShownView { camera, ..shown(RoadOptions::for_method(RoadMethod::Geometry)) };
    let args = read("p.pmtiles", &shown);
    assert_eq!(args.from_above.request(&args.camera), camera);
}
