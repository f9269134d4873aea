//! Values are interpolated between centres of texels. The line filter responds to a line at its
//! position, and not to an edge.

use super::*;

const SCALE: TexelScale = TexelScale { origin_m: [0.0, 100.0], texel_m: [1.0, 1.0] };
const PROFILE: RoadCrossSection = RoadCrossSection { half_width_m: 2.0, beside_m: 1.5 };

/// An image of a hundred by a hundred texels; `value` receives the place in working metres.
fn image(value: impl Fn([f64; 2]) -> f32) -> Grey {
    let at = |n: usize| value([(n % 100) as f64 + 0.5, 99.5 - (n / 100) as f64]);
    Grey { first: [0, 0], columns: 100, values: (0..10_000).map(at).collect() }
}

fn found(grey: &Grey, at: [f64; 2]) -> Option<Vec<f32>> {
    let search = ShiftSearch::new(4.0, 1.0);
    responses(grey, &SCALE, &RoadSample { at, normal: [-1.0, 0.0] }, PROFILE, &search)
}

#[test]
fn a_line_answers_where_it_lies_and_an_edge_does_not() {
    // Four metres wide, three metres east of the sample.
    let line = image(|[x, _]| if (x - 53.0).abs() < 2.0 { 30.0 } else { 100.0 });
    let answers = found(&line, [50.0, 50.0]).unwrap();
    let best = answers.iter().copied().reduce(f32::min).unwrap();
    let search = ShiftSearch::new(4.0, 1.0);
    for ([east, _], answer) in search.shifts().zip(&answers) {
        assert_eq!(*answer <= best + 1.0, (east - 3.0).abs() < 1.1, "{east}: {answer}");
    }
    let edge = image(|[x, _]| if x < 51.0 { 30.0 } else { 100.0 });
    assert!(found(&edge, [50.0, 50.0]).unwrap().iter().all(|answer| answer.abs() < 1e-3));
}

#[test]
fn places_without_image_give_no_answer() {
    let grey = image(|[x, _]| if x > 80.0 { f32::NAN } else { 1.0 });
    assert!(found(&grey, [50.0, 50.0]).is_some());
    assert!(found(&grey, [74.0, 50.0]).is_none());
    assert!(found(&grey, [3.0, 50.0]).is_none(), "beyond the image");
}

#[test]
fn texels_wider_than_roads_are_the_least_that_is_looked_at() {
    for (width_m, texel_m, half_width_m) in
        [(7.0, 2.0, 3.5), (0.5, 2.0, 1.0), (90.0, 2.0, 15.0), (7.0, 92.7, 46.35)]
    {
        let profile = RoadCrossSection::new(width_m, texel_m);
        assert!((profile.half_width_m - half_width_m).abs() < 1e-9, "{profile:?}");
    }
}

#[test]
fn values_are_mixed_between_centres() {
    let grey = Grey { first: [10, -5], columns: 3, values: (0..9).map(|n| n as f32).collect() };
    for (at, expected) in [([10.5, -4.5], 0.0_f32), ([11.0, -4.5], 0.5), ([11.0, -4.0], 2.0)] {
        assert!((grey.at(at) - expected).abs() < 1e-6, "{at:?}");
    }
    assert!(grey.at([10.4, -4.5]).is_nan());
    assert!(grey.at([12.5, -4.5]).is_nan(), "the last centre has no neighbour");
}
