//! A PNG with a resolution is still a valid PNG.

use image::ImageDecoder as _;

use super::*;

/// The chunk as in the standard: 11811 pixels per metre are 300 per inch.
#[test]
fn a_picture_says_its_resolution() {
    let picture = RgbaImage::from_fn(7, 5, |x, y| image::Rgba([x as u8, y as u8, 9, 255]));
    let plain = png(&picture).unwrap();
    let told = with_resolution(plain.clone(), 11_811);
    assert_eq!(told.len(), plain.len() + 21);
    let expected = [0, 0, 0, 9, b'p', b'H', b'Y', b's', 0, 0, 0x2E, 0x23, 0, 0, 0x2E, 0x23, 1];
    assert_eq!(told[33..50], expected);
    // The checksum of this chunk at 300 pixels per inch, as written by other programs.
    assert_eq!(told[50..54], [0x78, 0xA5, 0x3F, 0x76]);
    let decoder = image::codecs::png::PngDecoder::new(std::io::Cursor::new(&told)).unwrap();
    assert_eq!(decoder.dimensions(), (7, 5));
    assert_eq!(image::load_from_memory(&told).unwrap().to_rgba8(), picture);
}

#[test]
fn only_a_picture_from_above_becomes_a_map() {
    let target = Path::new("map.tif");
    assert!(refuse_map(target, true, false).is_ok());
    let of = |is_from_above, has_world_file| {
        refuse_map(target, is_from_above, has_world_file).unwrap_err().to_string()
    };
    assert!(of(false, false).contains("--ortho"), "{}", of(false, false));
    assert!(of(true, true).contains("--world-file"), "{}", of(true, true));
}

#[test]
fn the_place_of_an_earlier_picture_is_not_left_beside_another() {
    let folder = tempfile::tempdir().unwrap();
    let target = folder.path().join("a.png");
    assert!(refuse_other_place(&target).is_ok());
    std::fs::write(folder.path().join("a.pgw"), "1\n0\n0\n-1\n0\n0\n").unwrap();
    let error = refuse_other_place(&target).unwrap_err().to_string();
    assert!(error.contains("a.pgw") && error.contains("--world-file"), "{error}");
}
