//! The messages about missing data describe the data.

use super::*;

#[test]
fn what_is_missing_is_told_by_its_kind() {
    for (path, kind) in [
        ("liechtenstein/N47E009.hgt", "elevation files"),
        ("juan-de-fuca-1s/N48W125.hgt.zip", "elevation files"),
        ("liechtenstein/liechtenstein-2021-10-28.osm.pbf", "extracts"),
        ("swellendam/3420B_2010_328_RGB_LATLNG.tif", "photos"),
        ("cases/through-way/a.osm.pbf", "small cases of public bug reports"),
    ] {
        assert_eq!(kind_of(path), kind, "{path}");
    }
}
