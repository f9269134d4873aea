//! An extract with boundaries on the ground of the sample `pass`.

use std::{
    fs,
    path::{Path, PathBuf},
};

use crate::pbf::{BlockBuilder, file};

/// Writes an extract with a road and boundaries: way 2 is a border of a country and of a district,
/// way 3 only of the district, way 4 is a park by its own tags, and way 9 of the country is
/// missing.
///
/// # Panics
/// When the file cannot be written.
#[must_use]
pub fn extract_with_boundaries(folder: &Path) -> PathBuf {
    let mut block = BlockBuilder::new();
    let place =
        |x: i64, y: i64| (100 + 20 * y + x, 468_700_000 + 40_000 * y, 95_000_000 + 50_000 * x);
    block.dense(&(0..400).map(|n| place(n % 20, n / 20)).collect::<Vec<_>>());
    let node = |x: i64, y: i64| place(x, y).0;
    block.way(1, &[("highway", "primary")], &[node(1, 1), node(9, 9)]);
    block.way(2, &[], &[node(1, 2), node(4, 4), node(8, 3)]);
    block.way(3, &[], &[node(8, 3), node(7, 8), node(2, 7), node(1, 2)]);
    let park = [node(4, 4), node(6, 5), node(5, 7), node(4, 4)];
    block.way(4, &[("boundary", "protected_area")], &park);
    let admin = |level: &'static str| {
        [("type", "boundary"), ("boundary", "administrative"), ("admin_level", level)]
    };
    block.relation(10, &admin("2"), &[(2, "outer"), (9, "outer")]);
    block.relation(11, &admin("6"), &[(2, "outer"), (3, "outer")]);
    let path = folder.join("boundaries.osm.pbf");
    let written = fs::write(&path, file(&block));
    assert!(written.is_ok(), "{}: {written:?}", path.display());
    path
}
