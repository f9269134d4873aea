//! Each pixel of an image, its georeference and its resolution can be read back from its GeoTIFF.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use gdal::{Dataset, Metadata as _};
use image::Rgba;

use corniche_tileset::Manifest;

use super::*;

/// Larger than a block in one direction, and smaller in the other.
fn picture() -> RgbaImage {
    RgbaImage::from_fn(300, 100, |x, y| Rgba([x as u8, y as u8, (x / 2 + y) as u8, 255]))
}

#[test]
fn a_picture_is_read_again_as_it_was() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("map.tif");
    let manifest =
        Manifest { crs_wkt: "EPSG:32632".to_owned(), ..corniche_testing::package::manifest() };
    // Turned by 30 degrees.
    let working_from_pixel = [1000.0, 1.732, 1.0, 5000.0, 1.0, -1.732];
    let place = PlaceOfPicture::new(&manifest, working_from_pixel).unwrap();
    let facts = PictureFacts {
        description: "Über den Pass".to_owned(),
        dots_per_inch: Some(300.0),
        ..PictureFacts::default()
    };
    export_picture(&picture(), &place, &facts, &path).unwrap();

    let dataset = Dataset::open(&path).unwrap();
    assert_eq!(dataset.raster_size(), (300, 100));
    assert_eq!(dataset.raster_count(), 3);
    for (number, known) in dataset.geo_transform().unwrap().iter().zip(place.crs_from_pixel()) {
        assert!((number - known).abs() < 1e-9, "{number} {known}");
    }
    for band in 0..3 {
        let read = dataset.rasterband(band + 1).unwrap().read_band_as::<u8>().unwrap();
        let expected: Vec<u8> = picture().pixels().map(|pixel| pixel.0[band]).collect();
        assert!(read.data() == expected, "band {band}");
    }
    let item = |name: &str| dataset.metadata_item(name, "").unwrap_or_default();
    assert_eq!(item("TIFFTAG_XRESOLUTION"), "300");
    assert_eq!(item("TIFFTAG_YRESOLUTION"), "300");
    assert!(item("TIFFTAG_RESOLUTIONUNIT").starts_with('2'));
    assert_eq!(item("TIFFTAG_IMAGEDESCRIPTION"), "Über den Pass");
    assert_eq!(item("AREA_OR_POINT"), "Area");
}
