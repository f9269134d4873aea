//! A small extract with areas, some of which are invalid.

use std::{
    fs,
    path::{Path, PathBuf},
};

use crate::pbf::{BlockBuilder, file};

/// Writes an extract with a road, a lake (way 2), a wood with a clearing (relation 7), and two
/// outlines that do not become areas.
///
/// The nodes form a lattice over the sample `pass`, whose roads are there, too: number 100 + 20 y +
/// x at (x, y), 0.005 and 0.004 degrees apart.
///
/// # Panics
/// When the file cannot be written.
#[must_use]
pub fn extract_with_areas(folder: &Path) -> PathBuf {
    let mut block = BlockBuilder::new();
    let place =
        |x: i64, y: i64| (100 + 20 * y + x, 468_700_000 + 40_000 * y, 95_000_000 + 50_000 * x);
    block.dense(&(0..400).map(|n| place(n % 20, n / 20)).collect::<Vec<_>>());
    let node = |x: i64, y: i64| place(x, y).0;
    let square = |x: i64, y: i64, side: i64| {
        let (east, north) = (x + side, y + side);
        [node(x, y), node(east, y), node(east, north), node(x, north), node(x, y)]
    };
    block.way(1, &[("highway", "primary")], &[node(1, 1), node(9, 9)]);
    block.way(2, &[("natural", "water"), ("name", "Lake")], &square(2, 2, 3));
    block.way(3, &[], &square(6, 3, 6));
    block.way(4, &[], &square(8, 5, 2));
    // The first outline is not closed; the second crosses itself.
    block.way(5, &[("landuse", "meadow")], &square(1, 8, 2)[..4]);
    block.way(
        6,
        &[("natural", "scree")],
        &[node(1, 10), node(3, 12), node(3, 10), node(1, 12), node(1, 10)],
    );
    block.relation(
        7,
        &[("type", "multipolygon"), ("natural", "wood")],
        &[(3, "outer"), (4, "inner")],
    );
    let path = folder.join("areas.osm.pbf");
    let written = fs::write(&path, file(&block));
    assert!(written.is_ok(), "{}: {written:?}", path.display());
    path
}
