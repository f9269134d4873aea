//! A small extract with a coastline, whole or with a gap.

use std::{
    fs,
    path::{Path, PathBuf},
};

use crate::pbf::{BlockBuilder, file};

/// Writes an extract with a road and a coast over the sample `pass`: the sea is south of a line
/// from west to east, with an island and, if `is_whole` is false, a missing way of the coast.
///
/// The coast runs along 46.9° north from 9.4° to 9.7° east, with the sea on its right; the way that
/// may be missing extends from 9.53° to 9.55°. The island is between 9.52° and 9.54° east and
/// between 46.87° and 46.88° north.
#[must_use]
pub fn extract_with_coast(folder: &Path, is_whole: bool) -> PathBuf {
    let mut block = BlockBuilder::new();
    let mut nodes = Vec::new();
    let mut node = |lon: i64, lat: i64| {
        nodes.push((1 + nodes.len() as i64, lat * 100_000, lon * 100_000));
        nodes.len() as i64
    };
    let coast = [940, 953, 954, 955, 970].map(|lon| node(lon, 4690));
    let island = [(952, 4687), (954, 4687), (954, 4688), (952, 4688)].map(|(x, y)| node(x, y));
    let road = [(951, 4691), (956, 4691)].map(|(x, y)| node(x, y));
    block.dense(&nodes);
    let tags = [("natural", "coastline")];
    block.way(1, &[("highway", "primary")], &road);
    block.way(2, &tags, &coast[..2]);
    if is_whole {
        block.way(3, &tags, &coast[1..4]);
    }
    block.way(4, &tags, &coast[3..]);
    block.way(5, &tags, &[island[0], island[1], island[2]]);
    block.way(6, &tags, &[island[2], island[3], island[0]]);
    let path = folder.join("coast.osm.pbf");
    fs::write(&path, file(&block)).unwrap();
    path
}
