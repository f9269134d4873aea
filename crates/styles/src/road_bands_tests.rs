//! Bands are nested, from the whole road to its middle.

use super::*;

const DARK: Rgb = [0.1; 3];
const RED: Rgb = [0.8, 0.2, 0.1];
const PALE: Rgb = [0.9; 3];

fn bands(parts: &[(f32, Rgb)]) -> Result<RoadBands, StyleError> {
    let bands = parts.iter().map(|&(width_share, color)| RoadBand { width_share, color });
    RoadBands::new(&bands.collect::<Vec<_>>())
}

#[test]
fn bands_are_nested_from_the_whole_road_to_its_middle() {
    let three = bands(&[(1.0, DARK), (0.7, RED), (0.2, PALE)]).unwrap();
    assert_eq!(three.all().len(), 3);
    assert_eq!(bands(&[(1.0, RED)]).unwrap(), RoadBands::one(RED));
    for (parts, words) in [
        (&[][..], "1 to 16 bands, not 0"),
        (&[(1.0, RED); 17], "1 to 16 bands, not 17"),
        (&[(0.9, RED)], "first band must have a width of 1 (the whole road), not 0.9"),
        (&[(f32::NAN, RED)], "first band"),
        (&[(1.0, RED), (1.0, PALE)], "band 2"),
        (&[(1.0, RED), (0.5, PALE), (0.6, DARK)], "band 3"),
        (&[(1.0, RED), (0.009, PALE)], "band 2"),
        (&[(1.0, RED), (f32::NAN, PALE)], "band 2"),
    ] {
        let error = bands(parts).unwrap_err().to_string();
        assert!(error.contains(words), "{parts:?}: {error}");
    }
}

#[test]
fn as_many_bands_as_are_promised_can_be_had() {
    let most: Vec<(f32, Rgb)> = (0..16_u8).map(|k| (1.0 - f32::from(k) / 17.0, RED)).collect();
    assert_eq!(bands(&most).unwrap().all().len(), RoadBands::MOST);
}

#[test]
fn where_a_road_has_one_colour_it_is_the_one_most_seen() {
    for (parts, expected) in [
        (&[(1.0, RED), (0.3, PALE)][..], RED),
        (&[(1.0, DARK), (0.8, RED), (0.1, PALE)], RED),
        (&[(1.0, DARK), (0.5, RED)], DARK),
        (&[(1.0, DARK), (0.9, RED), (0.6, PALE)], PALE),
    ] {
        assert_eq!(bands(parts).unwrap().main_color(), expected, "{parts:?}");
    }
}

#[test]
fn slip_roads_have_no_line_along_their_middle() {
    for (parts, expected) in [
        (&[(1.0, RED), (0.3, PALE)][..], 1),
        (&[(1.0, DARK), (0.8, RED), (0.1, PALE)], 2),
        (&[(1.0, RED)], 1),
    ] {
        assert_eq!(bands(parts).unwrap().of_slip_roads(), expected);
    }
}
