//! A legend shows each class, a scale bar of the right length and where north is.

use super::*;

fn picture() -> RgbaImage {
    RgbaImage::from_pixel(640, 480, image::Rgba([90, 120, 90, 255]))
}

fn legend(north_deg: f64) -> Legend {
    let road = |label: &str, color| LegendRoad {
        label: label.to_owned(),
        bands: RoadBands::one(color),
        outline: [0.0, 0.0, 1.0],
    };
    Legend {
        pixel_m: 10.0,
        north_deg,
        roads: vec![road("motorway", [1.0, 0.0, 0.0]), road("track", [1.0, 1.0, 0.0])],
        areas: vec![LegendArea { label: "water".to_owned(), color: [0.0, 1.0, 1.0] }],
        boundaries: vec![LegendLine {
            label: "country border".to_owned(),
            style: LineStyle {
                dash: corniche_styles::Dash::new(&[6.0, 4.0]).unwrap(),
                ..LineStyle::solid([1.0, 0.0, 1.0], 3.0)
            },
        }],
    }
}

#[test]
fn bars_have_round_lengths() {
    for (most_m, bar_m, text) in [
        (768.0, 500.0, "500 m"),
        (500.0, 500.0, "500 m"),
        (499.0, 200.0, "200 m"),
        (19.0, 10.0, "10 m"),
        (1.5, 1.0, "1 m"),
        (2300.0, 2000.0, "2 km"),
        (150_000.0, 100_000.0, "100 km"),
        (0.5, 0.5, "50 cm"),
    ] {
        let found_m = bar_length_m(most_m).unwrap();
        let found = bar_length(found_m);
        assert!((found_m - bar_m).abs() < 1e-9 && found == text, "{most_m}: {found_m} {found}");
    }
}

#[test]
fn lengths_of_bars_have_their_usual_unit() {
    assert_eq!([bar_length(0.2), bar_length(50.0), bar_length(2000.0)], ["20 cm", "50 m", "2 km"]);
}

#[test]
fn without_a_length_there_is_no_bar() {
    for most_m in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert_eq!(bar_length_m(most_m), None, "{most_m}");
    }
}

/// 500 m at 10 m a pixel are 50 pixels.
#[test]
fn the_bar_is_as_long_as_it_says() {
    let mut picture = picture();
    draw_legend(&mut picture, &legend(0.0));
    let dark = |x: u32, y: u32| picture.get_pixel(x, y).0[..3] == [32, 36, 40];
    let longest = (400..480)
        .map(|y| {
            (0..640).fold((0_u32, 0_u32), |(run, most), x| {
                let run = if dark(x, y) { run + 1 } else { 0 };
                (run, most.max(run))
            })
        })
        .map(|(_, most)| most)
        .max();
    assert_eq!(longest, Some(50));
}

#[test]
fn each_class_has_its_colours() {
    let mut picture = picture();
    draw_legend(&mut picture, &legend(0.0));
    for color in [[255, 0, 0], [255, 255, 0], [0, 0, 255], [0, 255, 255], [255, 0, 255]] {
        let count = picture.pixels().filter(|pixel| pixel.0[..3] == color).count();
        assert!(count > 40, "{color:?}: {count}");
    }
}

/// Three pixels thick, six of ten along it.
#[test]
fn boundaries_have_their_dashes() {
    let mut picture = picture();
    draw_legend(&mut picture, &legend(0.0));
    let is_line = |x: u32, y: u32| picture.get_pixel(x, y).0[..3] == [255, 0, 255];
    let rows: Vec<u32> = (0..480).filter(|&y| (0..640).any(|x| is_line(x, y))).collect();
    assert_eq!(rows.len(), 3, "{rows:?}");
    let columns: Vec<u32> = (0..640).filter(|&x| is_line(x, rows[0])).collect();
    let first = columns[0];
    assert!(columns.len() > 15, "{columns:?}");
    assert!(columns.iter().all(|x| (x - first) % 10 < 6), "{columns:?}");
}

/// The arrow's dark half lies west of its axis; the tip turns with the north.
#[test]
fn the_arrow_points_to_the_north() {
    let tip = |north_deg: f64| {
        let mut picture = picture();
        draw_arrow(&mut picture, [100.0, 100.0], 20.0, north_deg);
        let changed =
            |x: i64, y: i64| picture.get_pixel(x as u32, y as u32).0[..3] != [90, 120, 90];
        [[100, 82], [118, 100], [100, 118], [82, 100]].map(|[x, y]| changed(x, y))
    };
    // At the base there is a notch.
    assert_eq!(tip(0.0), [true, false, false, false]);
    assert_eq!(tip(90.0), [false, true, false, false]);
    assert_eq!(tip(180.0), [false, false, true, false]);
    assert_eq!(tip(270.0), [false, false, false, true]);
}

#[test]
fn a_legend_fits_into_a_small_picture() {
    let mut small = RgbaImage::new(40, 20);
    draw_legend(&mut small, &legend(30.0));
}
