//! Rows that look alike are merged, and others are not.

use corniche_styles::Dash;

use super::*;

fn road(grey: f32, width_px: f32) -> LegendRoad {
    LegendRoad {
        width_px,
        bands: vec![RoadBand { width_share: 1.0, color: [grey; 3] }],
        edge: Some(LegendEdge { color: [0.4; 3], width_px: 1 }),
    }
}

fn joined(samples: &[LegendSample]) -> Vec<String> {
    let names = ["one", "two", "three", "four"].map(str::to_owned);
    let rows = names.into_iter().zip(samples.iter().cloned());
    let rows = rows.map(|(label, sample)| LegendRow { label, sample }).collect();
    LegendRow::joined(rows).into_iter().map(|row| row.label).collect()
}

#[test]
fn roads_that_look_alike_share_a_row() {
    let all = [road(1.0, 3.2), road(1.0, 2.8), road(0.7, 2.8), road(0.99, 3.0)];
    assert_eq!(joined(&all.map(LegendSample::Road)), ["one, two, four", "three"]);
}

#[test]
fn roads_of_other_widths_edges_or_bands_have_rows_of_their_own() {
    let bare = LegendRoad { edge: None, ..road(1.0, 3.0) };
    let double = road(1.0, 3.0).bands.repeat(2);
    let all =
        [road(1.0, 3.0), road(1.0, 4.0), bare, LegendRoad { bands: double, ..road(1.0, 3.0) }];
    assert_eq!(joined(&all.map(LegendSample::Road)).len(), 4);
}

#[test]
fn a_tunnel_is_no_road_and_a_line_no_area() {
    let samples = [
        LegendSample::Road(road(1.0, 3.0)),
        LegendSample::Tunnel(road(1.0, 3.0)),
        LegendSample::Line(LineStyle::solid([1.0; 3], 3.0)),
        LegendSample::Area([1.0; 3]),
    ];
    assert_eq!(joined(&samples).len(), 4);
    let point = PointStyle {
        color: [1.0; 3],
        size_px: 6.0,
        outline: None,
        opacity: 1.0,
        max_pixel_m: None,
    };
    let edged = PointStyle { outline: Some([0.0; 3]), ..point };
    let larger = PointStyle { size_px: 8.0, ..point };
    let points = [point, edged, larger].map(LegendSample::Point);
    assert_eq!(joined(&points).len(), 3);
    assert_eq!(joined(&[points[0].clone(), samples[3].clone()]).len(), 2);
}

#[test]
fn lines_are_told_apart_by_their_dashes_and_areas_by_less_colour_than_lines() {
    let solid = LineStyle::solid([0.5; 3], 2.0);
    let dashed = LineStyle { dash: Dash::new(&[4.0, 4.0]).unwrap(), ..solid };
    let paler = LineStyle { color: [0.55; 3], ..solid };
    let lines = [solid, dashed, paler].map(LegendSample::Line);
    assert_eq!(joined(&lines), ["one, three", "two"]);
    let areas = [[0.5; 3], [0.55; 3], [0.52; 3]].map(LegendSample::Area);
    assert_eq!(joined(&areas), ["one, three", "two"]);
}

#[test]
fn what_has_the_same_name_is_named_once() {
    let row = LegendRow { label: "water".to_owned(), sample: LegendSample::Area([0.5; 3]) };
    assert_eq!(LegendRow::joined(vec![row.clone(), row.clone()]), [row]);
}

/// Twelve pixels: six with the edge above and below, and six without.
#[test]
fn the_edge_of_a_tunnel_is_dashed() {
    let mut picture = RgbaImage::from_pixel(24, 14, image::Rgba([255; 4]));
    let tunnel =
        LegendRoad { edge: Some(LegendEdge { color: [0.0; 3], width_px: 1 }), ..road(0.8, 4.0) };
    LegendSample::Tunnel(tunnel).draw(&mut picture, [0, 0], [24, 14]);
    let of_row = |y: u32| {
        (0..24)
            .map(|x| if picture.get_pixel(x, y).0[0] == 0 { '#' } else { '.' })
            .collect::<String>()
    };
    let edges: Vec<u32> = (0..14).filter(|y| of_row(*y).contains('#')).collect();
    assert_eq!(edges, [4, 9]);
    assert_eq!(of_row(4), "######......######......");
    // The surface continues without gaps.
    assert!((0..24).all(|x| picture.get_pixel(x, 6).0[0] == 204));
}

/// The band in the middle of a road has its share of the width, to a pixel. On a thin road it does
/// not fill everything except the rims.
#[test]
fn a_middle_band_has_its_share_of_the_pixels() {
    for (width_px, share, expected) in
        [(5.0, 0.3, 1), (6.0, 0.3, 2), (9.0, 0.3, 3), (10.0, 0.3, 2), (3.0, 0.9, 3), (7.0, 0.05, 1)]
    {
        let band = |width_share, grey: f32| RoadBand { width_share, color: [grey; 3] };
        let bands = vec![band(1.0, 0.0), band(share, 1.0)];
        let road = LegendRoad { width_px, bands, edge: None };
        let mut picture = RgbaImage::from_pixel(4, 20, image::Rgba([128, 128, 128, 255]));
        LegendSample::Road(road).draw(&mut picture, [0, 0], [4, 20]);
        let light = (0..20).filter(|y| picture.get_pixel(1, *y).0[0] == 255).count();
        let dark = (0..20).filter(|y| picture.get_pixel(1, *y).0[0] == 0).count();
        assert_eq!((light, light + dark), (expected, width_px as usize), "{width_px} {share}");
    }
}
