//! A world file has the steps of a picture and the middle of its first pixel.

use super::*;

fn place(crs_wkt: &str, crs_from_pixel: [f64; 6]) -> PlaceOfPicture {
    PlaceOfPicture { crs_wkt: crs_wkt.to_owned(), crs_from_pixel }
}

#[test]
fn a_world_file_is_about_the_middle_of_the_first_pixel() {
    let north_up = place("EPSG:32632", [1000.0, 2.0, 0.0, 5000.0, 0.0, -2.0]);
    assert_eq!(north_up.world_file(), "2\n0\n0\n-2\n1001\n4999\n");
    // East is at the top: columns go south, and rows go west.
    let east_up = place("EPSG:32632", [1000.0, 0.0, -2.0, 5000.0, -2.0, 0.0]);
    assert_eq!(east_up.world_file(), "0\n-2\n-2\n0\n999\n4999\n");
}

#[test]
fn units_divide_each_axis() {
    let working_m = [600.0, 6.0, 3.0, 800.0, 4.0, -8.0];
    assert_eq!(in_units(working_m, [1.0, 1.0]), working_m);
    assert_eq!(in_units(working_m, [-3.0, 4.0]), [-200.0, -2.0, -1.0, 200.0, 1.0, -2.0]);
}

#[test]
fn a_prj_file_has_the_words_of_esri() {
    let text = place("EPSG:32632", [0.0; 6]).prj();
    assert!(text.starts_with("PROJCS[\"WGS_1984_UTM_Zone_32N\""), "{text}");
    assert!(text.ends_with("]\n"), "{text}");
}

#[test]
fn a_crs_without_such_words_stays_as_it_is() {
    assert_eq!(place("no CRS", [0.0; 6]).prj(), "no CRS\n");
}
