//! Camera options are consistent: a position, a distance or a scale.

use clap::Parser;

use super::*;

#[derive(Parser)]
struct Line {
    #[command(flatten)]
    camera: CameraArgs,
    #[command(flatten)]
    from_above: FromAboveArgs,
}

#[test]
fn a_view_from_above_has_a_scale_and_no_distance() {
    let check = |line: &str, expected: Option<CameraRequest>| {
        let line = Line::try_parse_from(line.split_whitespace());
        assert_eq!(line.ok().map(|line| line.from_above.request(&line.camera)), expected);
    };
    let place = |pixel_m, heading_deg| CameraRequest::FromAbove {
        lon_deg: -9.5,
        lat_deg: 47.0,
        pixel_m,
        heading_deg,
    };
    check("corniche", Some(CameraRequest::Overview));
    check("corniche --ortho", Some(CameraRequest::OverviewFromAbove { pixel_m: None }));
    check("corniche --ortho --look-at -9.5,47", Some(place(5.0, 0.0)));
    let all = "corniche --ortho --look-at -9.5,47 --pixel 0.5 --heading -30";
    check(all, Some(place(0.5, -30.0)));
    for lacking in ["--pixel 2", "--pixel 2 --look-at 1,2", "--ortho --pixel 2"] {
        check(&format!("corniche {lacking}"), None);
    }
    for senseless in ["--distance 20", "--pitch 10", "--height 5"] {
        check(&format!("corniche --ortho --look-at 1,2 {senseless}"), None);
    }
}

/// 1 : 25 000 at 300 dots per inch: 25 000 · 0.0254 m / 300 = 2.11666… m.
#[test]
fn a_scale_in_print_says_how_large_a_pixel_is() {
    let check = |line: &str, expected_m: f64, expected_dots: u32| {
        let line = Line::try_parse_from(line.split_whitespace()).unwrap();
        let scale = line.from_above.print_scale().unwrap();
        assert!((scale.pixel_m() - expected_m).abs() < 1e-12, "{scale:?}");
        assert_eq!(scale.dots_per_metre(), expected_dots);
        match line.from_above.request(&line.camera) {
            CameraRequest::OverviewFromAbove { pixel_m: Some(pixel_m) }
            | CameraRequest::FromAbove { pixel_m, .. } => {
                assert!((pixel_m - expected_m).abs() < 1e-12);
            }
            other => panic!("{other:?}"),
        }
    };
    check("corniche --ortho --scale 1:25000 --dpi 300", 6.35 / 3.0, 11_811);
    check("corniche --ortho --scale 25000", 6.35 / 3.0, 11_811);
    check("corniche --ortho --scale 1:10000 --dpi 254 --look-at 1,2", 1.0, 10_000);
    for senseless in [
        "--scale 25000",
        "--ortho --dpi 300",
        "--ortho --look-at 1,2 --scale 25000 --pixel 5",
        "--world-file",
    ] {
        let line = format!("corniche {senseless}");
        assert!(Line::try_parse_from(line.split_whitespace()).is_err(), "{senseless}");
    }
}

#[test]
fn numbers_that_are_no_scale_are_refused_by_the_name_of_their_option() {
    for (option, values) in [
        ("--scale", "0 -1 1:0 1:-5 2:25000 25000: 1:2:3 99 1:200000000 2.5 many NaN"),
        ("--dpi", "0 -300 9 2401 NaN inf many"),
    ] {
        for value in values.split_whitespace() {
            let rest = if option == "--dpi" { "--scale=5000" } else { "--dpi=300" };
            let words = ["corniche", "--ortho", rest, option, value];
            let error = Line::try_parse_from(words).err().unwrap().to_string();
            assert!(error.contains(option), "{value}: {error}");
        }
    }
}

#[test]
fn a_place_is_looked_at_from_where_the_options_say() {
    let check = |line: &str, expected: Option<CameraRequest>| {
        let line = Line::try_parse_from(line.split_whitespace());
        assert_eq!(line.ok().map(|line| line.camera.request()), expected);
    };
    let place = |distance_m, heading_deg, pitch_deg| CameraRequest::LookAt {
        lon_deg: -9.5,
        lat_deg: 47.0,
        height_m: None,
        distance_m,
        orientation: Orientation { heading_deg, pitch_deg },
    };
    check("corniche", Some(CameraRequest::Overview));
    check("corniche --look-at -9.5,47", Some(place(5000.0, 0.0, 60.0)));
    let all = "corniche --look-at -9.5,47 --distance 20 --heading -30 --pitch 5";
    check(all, Some(place(20.0, -30.0, 5.0)));
    check("corniche --distance 20", None);
    check("corniche --height 20", None);
    let high = match place(5000.0, 0.0, 60.0) {
        CameraRequest::LookAt { lon_deg, lat_deg, distance_m, orientation, .. } => {
            let height_m = Some(-12.5);
            CameraRequest::LookAt { lon_deg, lat_deg, height_m, distance_m, orientation }
        }
        _ => panic!("no place"),
    };
    check("corniche --look-at -9.5,47 --height -12.5", Some(high));
}
