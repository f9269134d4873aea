//! A title is drawn on an opaque box, and its invisible parts are reported.

use super::*;

const GROUND: [u8; 3] = [90, 120, 90];

fn titled(size: [u32; 2], title: &str) -> (RgbaImage, TitleFlaws) {
    let [red, green, blue] = GROUND;
    let mut picture = RgbaImage::from_pixel(size[0], size[1], image::Rgba([red, green, blue, 255]));
    let flaws = draw_title(&mut picture, title).flaws;
    (picture, flaws)
}

#[test]
fn a_title_stands_on_white_in_the_upper_left_corner() {
    let (picture, flaws) = titled([640, 480], "Über den Paß");
    assert_eq!(flaws, TitleFlaws::default());
    let rgb = |x: u32, y: u32| <[u8; 3]>::try_from(&picture.get_pixel(x, y).0[..3]).unwrap();
    assert_eq!(rgb(0, 0), [255; 3]);
    assert_eq!(rgb(639, 0), GROUND);
    assert_eq!(rgb(0, 479), GROUND);
    // The ground is not visible in the box: all pixels are white, ink or a mix of both, which is
    // grey.
    let columns = (0..640).take_while(|x| rgb(*x, 0) == [255; 3]).count() as u32;
    let rows = (0..480).take_while(|y| rgb(0, *y) == [255; 3]).count() as u32;
    assert!(columns > 100 && columns < 320 && rows > 28 && rows < 60, "{columns} {rows}");
    let mut dark = 0;
    for (x, y) in (0..columns).flat_map(|x| (0..rows).map(move |y| (x, y))) {
        let [red, green, blue] = rgb(x, y).map(i32::from);
        assert!(red <= green + 1 && green <= blue + 1 && blue - red <= 9, "{x} {y}");
        dark += usize::from(red < 100);
    }
    assert!(dark > 100, "{dark}");
}

#[test]
fn letters_that_the_font_lacks_are_told_once() {
    let (_, flaws) = titled([640, 480], "Pass 峠 and 峠道");
    assert_eq!(flaws, TitleFlaws { lacking: "峠道".to_owned(), is_cut: false });
}

#[test]
fn a_long_title_has_several_lines() {
    let words = "a road over the pass ".repeat(4);
    let (picture, flaws) = titled([640, 480], &words);
    assert!(!flaws.is_cut);
    assert_eq!(picture.get_pixel(0, 60).0[..3], [255; 3]);
}

#[test]
fn a_picture_that_is_too_small_is_told() {
    assert!(titled([60, 40], "Liechtenstein").1.is_cut);
    assert!(titled([200, 30], "a b c d e f g h i j k l m n o p q r s t u v w x y z").1.is_cut);
}

#[test]
fn a_title_without_letters_changes_nothing() {
    assert!(titled([60, 40], " ").0.pixels().all(|pixel| pixel.0[..3] == GROUND));
}
