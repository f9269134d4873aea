//! Lines over the seam of a map are cut there, and other lines do not change.

#![expect(clippy::float_cmp, reason = "degrees and steps are exact")]

use super::*;

fn split(line: &[[f64; 2]]) -> Vec<Vec<[f64; 2]>> {
    Seam::of_degrees().split(Vec::from(line))
}

/// Lines that do not meet the seam are returned unchanged, whatever they contain.
#[test]
fn what_does_not_meet_the_seam_stays() {
    for line in [
        vec![],
        vec![[180.0, 1.0]],
        vec![[1.0, 1.0], [1.0, 1.0], [170.0, 2.0]],
        // Lines along the end of the map, and from an end to the centre: both ways around are
        // equally long.
        vec![[180.0, 1.0], [180.0, 2.0]],
        vec![[0.0, 1.0], [180.0, 2.0]],
    ] {
        assert_eq!(split(&line), std::slice::from_ref(&line));
    }
}

#[test]
fn a_line_over_the_seam_is_cut_at_both_ends_of_the_map() {
    let line = [[179.0, 10.0], [-177.0, 14.0], [-176.0, 14.0]];
    let parts =
        [vec![[179.0, 10.0], [180.0, 11.0]], vec![[-180.0, 11.0], [-177.0, 14.0], [-176.0, 14.0]]];
    assert_eq!(split(&line), parts);
    let back: Vec<_> = line.iter().rev().copied().collect();
    let [first, second] = parts.map(|part| part.into_iter().rev().collect::<Vec<_>>());
    assert_eq!(split(&back), [second, first]);
}

/// A position at the seam may have the coordinate of either end: the line ends there once, without
/// parts of zero length.
#[test]
fn a_line_that_ends_at_the_seam_has_one_part() {
    let east = vec![[179.0, 1.0], [180.0, 2.0]];
    let west = vec![[-180.0, 2.0], [-179.0, 3.0]];
    assert_eq!(split(&east), std::slice::from_ref(&east));
    assert_eq!(split(&[[179.0, 1.0], [-180.0, 2.0]]), std::slice::from_ref(&east));
    assert_eq!(split(&[[180.0, 2.0], [-179.0, 3.0]]), std::slice::from_ref(&west));
    let both = [east, west];
    assert_eq!(split(&[[179.0, 1.0], [180.0, 2.0], [-179.0, 3.0]]), both);
    assert_eq!(split(&[[179.0, 1.0], [-180.0, 2.0], [-179.0, 3.0]]), both);
    assert_eq!(split(&[[179.0, 1.0], [180.0, 2.0], [-180.0, 2.0], [-179.0, 3.0]]), both);
    assert_eq!(split(&[[179.0, 1.0], [-180.0, 2.0], [180.0, 2.0], [-179.0, 3.0]]), both);
    // A line along the seam and back to its start.
    let along = [[179.0, 1.0], [180.0, 2.0], [-180.0, 3.0], [179.0, 4.0]];
    let found = split(&along);
    let parts = [vec![[179.0, 1.0], [180.0, 2.0], [180.0, 3.0]], vec![[180.0, 3.0], [179.0, 4.0]]];
    assert_eq!(found, parts);
}

/// Positions past the end are moved back to the map, next to its centre; then each is moved next to
/// the one before.
#[test]
fn places_are_continuous_from_one_to_the_next() {
    let mut places = [[181.0, 0.0], [f64::NAN, 0.0], [-178.0, 0.0], [178.0, 0.0], [-90.0, 0.0]];
    Seam::of_degrees().unroll(&mut places);
    let found: Vec<f64> = places.iter().map(|place| place[0]).filter(|x| x.is_finite()).collect();
    assert_eq!(found, [-179.0, -178.0, -182.0, -90.0]);
    let seam = Seam::new(180.0, -360.0);
    assert_eq!([0.0, 360.0, -0.5, 361.0].map(|x| seam.image(x)), [0.0, 360.0, 359.5, 1.0]);
    assert_eq!([0.0, 360.0, -0.5, -360.5].map(|x| seam.turns(x)), [0.0, 0.0, -1.0, -2.0]);
}

#[test]
fn between_the_ends_the_eastern_one_is_the_western_one() {
    let from_west = |x: f64| Seam::of_degrees().image_from_west(x);
    let found = [-180.0, 180.0, 179.5, 540.0, -180.5, 725.0].map(from_west);
    assert_eq!(found, [-180.0, -180.0, 179.5, -180.0, 179.5, 5.0]);
}

/// On a lattice both ends are whole steps, a whole turn apart, and parts of a line meet.
#[test]
fn on_a_lattice_cuts_are_points() {
    let frame = GridFrame::new([0.0; 2], 10.0, crate::NodeIndex { i: 0, j: 0 }, 2).unwrap();
    // An earth of 40 km, which is not a whole number of steps.
    let half_m = 20_037.508_342_789_244;
    let seam = Seam::new(0.0, 2.0 * half_m).on_lattice(&frame);
    let [west, east] = seam.ends();
    assert!(west.fract() == 0.0 && east.fract() == 0.0 && east - west == seam.turn());
    let point = |x: f64, v: i64| LatticePoint::new(x as i64, v);
    let line = vec![(point(east - 300.0, 100), false), (point(west + 100.0, 500), true)];
    assert_eq!(
        seam.split(line.clone()),
        [vec![line[0], (point(east, 400), true)], vec![(point(west, 400), true), line[1]],]
    );
}

/// A turn of 10.3 steps with its eastern end at −0.4: the ends are 0 and −10, and a position at the
/// western end is rounded to −11.
#[test]
fn a_line_to_an_end_that_is_rounded_apart_ends_there_once() {
    let seam = Seam { middle: -5.0, turn: 10.0, rounding: 1.0 };
    let line = |u: i64| vec![LatticePoint::new(-2, 0), LatticePoint::new(u, 0)];
    for u in [-11, -10, -9] {
        let expected = vec![vec![LatticePoint::new(-2, 0), LatticePoint::new(0, 0)]];
        assert_eq!(seam.split(line(u)), expected, "{u}");
    }
    assert_eq!(seam.split(line(-8)).len(), 2);
}
