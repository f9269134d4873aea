//! The attribution is in the lower right corner, and long lines are wrapped.

use ab_glyph::{Font as _, FontRef};

use super::*;

fn picture() -> RgbaImage {
    RgbaImage::from_pixel(400, 300, image::Rgba([90, 120, 90, 255]))
}

fn changed(after: &RgbaImage) -> Vec<(u32, u32)> {
    let before = picture();
    after
        .enumerate_pixels()
        .filter(|(x, y, p)| before.get_pixel(*x, *y) != *p)
        .map(|(x, y, _)| (x, y))
        .collect()
}

#[test]
fn credits_stand_in_the_lower_right_corner() {
    let mut after = picture();
    draw_attribution(&mut after, &["© OpenStreetMap contributors".to_owned()]);
    let pixels = changed(&after);
    assert!(pixels.contains(&(399, 299)));
    assert!(pixels.iter().all(|(x, y)| *x > 150 && *y > 250));
    let dark = after.pixels().filter(|p| p.0[0] < 85).count();
    assert!(dark > 40, "letters are visible: {dark} dark pixels");
}

#[test]
fn the_copyright_sign_is_in_the_font() {
    let font = FontRef::try_from_slice(epaint_default_fonts::UBUNTU_LIGHT).unwrap();
    assert_ne!(font.glyph_id('©').0, 0);
}

#[test]
fn no_credits_change_nothing_and_long_ones_are_broken() {
    let mut after = picture();
    draw_attribution(&mut after, &[]);
    assert!(changed(&after).is_empty());
    draw_attribution(&mut after, &["Data from a great many contributors ".repeat(6)]);
    assert!(changed(&after).iter().any(|(_, y)| *y < 260), "more than one line");
}
