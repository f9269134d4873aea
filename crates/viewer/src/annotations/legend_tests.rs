//! A legend shows each class, a scale bar of the correct length and the direction of north.

use corniche_styles::{LineStyle, RoadBand};

use super::{
    super::legend_row::{LegendEdge, LegendRoad, LegendSample},
    *,
};

fn picture() -> RgbaImage {
    RgbaImage::from_pixel(640, 480, image::Rgba([90, 120, 90, 255]))
}

fn row(label: &str, sample: LegendSample) -> LegendRow {
    LegendRow { label: label.to_owned(), sample }
}

fn road(color: Rgb) -> LegendSample {
    LegendSample::Road(LegendRoad {
        width_px: 5.0,
        bands: vec![RoadBand { width_share: 1.0, color }],
        edge: Some(LegendEdge { color: [0.0, 0.0, 1.0], width_px: 1 }),
    })
}

fn legend(north_deg: f64) -> Legend {
    let dashed = LineStyle {
        dash: corniche_styles::Dash::new(&[6.0, 4.0]).unwrap(),
        ..LineStyle::solid([1.0, 0.0, 1.0], 3.0)
    };
    Legend {
        pixel_m: 10.0,
        north_deg,
        scale: None,
        ground: [1.0; 3],
        rows: vec![
            row("motorway", road([1.0, 0.0, 0.0])),
            row("track", road([1.0, 1.0, 0.0])),
            row("country border", LegendSample::Line(dashed)),
            row("water", LegendSample::Area([0.0, 1.0, 1.0])),
        ],
        heights: None,
    }
}

#[test]
fn numbers_are_grouped() {
    assert_eq!(grouped(7), "7");
    assert_eq!(grouped(1234), "1\u{a0}234");
    assert_eq!(grouped(123_456_789), "123\u{a0}456\u{a0}789");
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
        (0.0023, 0.002, "2 mm"),
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

/// At 10 m per pixel, 500 m are 50 pixels.
#[test]
fn the_bar_is_as_long_as_it_says() {
    let mut picture = picture();
    draw_legend(&mut picture, &legend(0.0), OccupiedMargins::default());
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
    draw_legend(&mut picture, &legend(0.0), OccupiedMargins::default());
    for color in [[255, 0, 0], [255, 255, 0], [0, 0, 255], [0, 255, 255], [255, 0, 255]] {
        let count = picture.pixels().filter(|pixel| pixel.0[..3] == color).count();
        assert!(count > 40, "{color:?}: {count}");
    }
}

/// The line is three pixels thick, and covers six of ten pixels along it.
#[test]
fn boundaries_have_their_dashes() {
    let mut picture = picture();
    draw_legend(&mut picture, &legend(0.0), OccupiedMargins::default());
    let is_line = |x: u32, y: u32| picture.get_pixel(x, y).0[..3] == [255, 0, 255];
    let rows: Vec<u32> = (0..480).filter(|&y| (0..640).any(|x| is_line(x, y))).collect();
    assert_eq!(rows.len(), 3, "{rows:?}");
    let columns: Vec<u32> = (0..640).filter(|&x| is_line(x, rows[0])).collect();
    let first = columns[0];
    assert!(columns.len() > 15, "{columns:?}");
    assert!(columns.iter().all(|x| (x - first) % 10 < 6), "{columns:?}");
}

/// The arrow's dark half is west of its axis; the tip turns with the north.
#[test]
fn the_arrow_points_to_the_north() {
    let tip = |north_deg: f64| {
        let mut picture = picture();
        draw_arrow(&mut picture, [100.0, 100.0], 20.0, north_deg);
        let changed =
            |x: i64, y: i64| picture.get_pixel(x as u32, y as u32).0[..3] != [90, 120, 90];
        [[100, 82], [118, 100], [100, 118], [82, 100]].map(|[x, y]| changed(x, y))
    };
    // The base has a notch.
    assert_eq!(tip(0.0), [true, false, false, false]);
    assert_eq!(tip(90.0), [false, true, false, false]);
    assert_eq!(tip(180.0), [false, false, true, false]);
    assert_eq!(tip(270.0), [false, false, false, true]);
}

#[test]
fn a_legend_without_room_says_so() {
    for (size_px, is_cut) in [([40, 20], true), ([120, 300], true), ([640, 480], false)] {
        let mut picture = RgbaImage::new(size_px[0], size_px[1]);
        assert_eq!(draw_legend(&mut picture, &legend(30.0), OccupiedMargins::default()), is_cut);
        assert!(picture.pixels().any(|pixel| pixel.0[0] > 0), "{size_px:?}: something is drawn");
    }
}

/// If both do not fit side by side, the legend is drawn above the attribution; below the title it
/// has fewer rows.
#[test]
fn a_legend_keeps_clear_of_credits_and_title() {
    let drawn = |credits_px, title_px| {
        let mut picture = RgbaImage::new(640, 480);
        draw_legend(&mut picture, &legend(0.0), OccupiedMargins { title_px, credits_px });
        let rows = (0..480).filter(|row| picture.get_pixel(3, *row).0[0] > 0);
        (rows.clone().min().unwrap(), rows.max().unwrap())
    };
    let (top, bottom) = drawn([0, 0], 0);
    assert_eq!(bottom, 479);
    assert_eq!(drawn([200, 30], 0), (top, bottom), "next to a short attribution");
    assert_eq!(drawn([600, 30], 0), (top - 30, bottom - 30), "above a long one");
    let title_px = top + 20;
    assert!(drawn([0, 0], title_px).0 >= title_px, "below the title");
}

/// Only the colours of the box, the ink, mixes of both, and samples occur: nothing of the picture
/// below.
#[test]
fn nothing_shows_through_the_box() {
    let drawn = |ground: [u8; 3]| {
        let [red, green, blue] = ground;
        let mut picture = RgbaImage::from_pixel(640, 480, image::Rgba([red, green, blue, 255]));
        draw_legend(&mut picture, &legend(0.0), OccupiedMargins::default());
        picture
    };
    let (dark, light) = (drawn([0; 3]), drawn([200, 250, 200]));
    let pixels = dark.pixels().zip(light.pixels());
    let (mut inside, mut outside) = (0, 0);
    for (dark, light) in pixels {
        if dark == light {
            inside += 1;
        } else {
            assert_eq!(dark.0[..3], [0; 3]);
            assert_eq!(light.0[..3], [200, 250, 200]);
            outside += 1;
        }
    }
    // 5 lines of 14 pixels and a half of one.
    assert_eq!(inside % (5 * 14 + 7), 0, "the box is a rectangle");
    assert!(inside > 77 * 100 && outside > 640 * 480 / 2, "{inside} {outside}");
}

#[test]
fn a_scale_in_print_stands_beside_the_bar() {
    assert_eq!(scale_text(500.0, None), "500 m");
    assert_eq!(scale_text(500.0, Some(25_000)), "500 m   1 : 25\u{a0}000");
    assert_eq!(scale_text(500.0, Some(500)), "500 m   1 : 500");
}

#[test]
fn heights_are_whole_metres_in_groups_of_three_digits() {
    for (height_m, text) in [
        (0.4, "0 m"),
        (-0.4, "0 m"),
        (-27.5, "−28 m"),
        (999.5, "1\u{a0}000 m"),
        (2340.2, "2\u{a0}340 m"),
        (-1_234_567.0, "−1\u{a0}234\u{a0}567 m"),
    ] {
        assert_eq!(height_text(height_m), text);
    }
}

/// The ramp runs from the lowest height at the left to the highest at the right.
#[test]
fn heights_have_a_ramp() {
    let colors = vec![[1.0, 0.5, 0.0], [0.0, 0.5, 1.0]];
    let heights = Some(LegendHeights { range_m: [412.0, 2340.0], colors });
    let mut picture = picture();
    draw_legend(&mut picture, &Legend { heights, ..legend(0.0) }, OccupiedMargins::default());
    let columns = |color: [u8; 3]| {
        let is_it = |x: &u32| (0..480).any(|y| picture.get_pixel(*x, y).0[..3] == color);
        (0..640).filter(is_it).collect::<Vec<u32>>()
    };
    let (low, high) = (columns([255, 128, 0]), columns([0, 128, 255]));
    assert_eq!([low.len(), high.len()], [28, 28]);
    assert_eq!(low.last().unwrap() + 1, high[0]);
}

#[test]
fn rows_without_room_are_counted() {
    let rows: Vec<LegendRow> = (0..9).map(|k| row(&k.to_string(), road([0.1; 3]))).collect();
    assert_eq!(fitting(&rows, 9), (&rows[..], None));
    assert_eq!(fitting(&rows, 4), (&rows[..3], Some("and 6 more".to_owned())));
    assert_eq!(fitting(&rows, 0), (&rows[..0], Some("and 9 more".to_owned())));
}
