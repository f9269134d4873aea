//! The parts of a drawn area in all tiles form the area.

use corniche_testing::package::written;

use super::*;
use crate::tiles::{MapPackage as _, PackageSource, TileSource as _};

/// In plan the volumes over all tiles of a level have the size of the drawn area, with a hole by
/// the even-odd rule where its outline encloses a point twice.
#[test]
fn the_parts_in_tiles_make_up_the_area() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("small.pmtiles");
    std::fs::write(&path, written()).unwrap();
    let source = PackageSource::open(&path).unwrap();
    let frame = &source.manifest().frame;
    let bounds = source.manifest().data_bounds;
    let at = |x: f64, y: f64| {
        let at_m = [bounds.min_x + x * bounds.width(), bounds.min_y + y * bounds.height()];
        frame.snap(at_m).unwrap()
    };
    // The outline runs around a large square and then around a small one inside it, so it encloses
    // the small square twice.
    let square = |from: f64, to: f64| {
        [at(from, from), at(to, from), at(to, to), at(from, to), at(from, from)]
    };
    let outline = [square(0.2, 0.8), square(0.4, 0.6)].concat();
    let area = DrawnArea::new(&outline).unwrap();
    let expected_m2 = (0.36 - 0.04) * bounds.width() * bounds.height();
    let covered = |id| {
        let tile = source.load(id).unwrap();
        tile.summary?;
        let volumes = area.over(&tile, frame);
        assert!(
            volumes.classes.iter().all(|of| of.class.layer.index() == 0 && of.class.class == 0)
        );
        let triangles = volumes.triangles.as_chunks::<3>().0.iter();
        let doubled = triangles.map(|corners| {
            let [a, b, c] =
                corners.map(|corner| volumes.corners[corner as usize].place_in_tile.map(f64::from));
            (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        });
        Some(doubled.sum::<f64>() / 2.0)
    };
    let root_m2 = covered(corniche_geom::TileId::ROOT).unwrap();
    assert!((root_m2 - expected_m2).abs() < 1e-3 * expected_m2, "{root_m2} {expected_m2}");
    // A quarter of the area is in each child. Along the borders of tiles, volumes extend a quarter
    // of a cell outwards.
    let children = corniche_geom::TileId::ROOT.children();
    let with_ground: Vec<f64> = children.into_iter().filter_map(covered).collect();
    assert!(!with_ground.is_empty());
    for area_m2 in with_ground {
        let strips_m2 = area_m2 - expected_m2 / 4.0;
        assert!((0.0..0.05 * expected_m2).contains(&strips_m2), "{area_m2} {expected_m2}");
    }
}
