use corniche_testing::package::written;
use corniche_viewer::tiles::{MapPackage as _, PackageSource, TileSource as _};

use super::*;
use crate::drawing::Point;

fn source(folder: &std::path::Path) -> PackageSource {
    let path = folder.join("small.pmtiles");
    std::fs::write(&path, written()).unwrap();
    PackageSource::open(&path).unwrap()
}

fn point(at_m: [f64; 2]) -> Point {
    Point { lon_lat_deg: [0.0; 2], at_m }
}

#[test]
fn an_edit_lays_that_line_alone() {
    let folder = tempfile::tempdir().unwrap();
    let source = source(folder.path());
    let manifest = source.manifest();
    let root = source.load(TileId::ROOT).unwrap().without_roads();
    let children = TileId::ROOT.children().map(|id| source.load(id).unwrap().without_roads());
    let tiles: Vec<TileGeometry> = children.into_iter().chain([root]).collect();
    let bounds = manifest.data_bounds;
    let at = |x: f64, y: f64| {
        point([bounds.min_x + x * bounds.width(), bounds.min_y + y * bounds.height()])
    };
    let mut document = Document::of(vec![
        (None, vec![at(0.1, 0.1), at(0.9, 0.9)]),
        (None, vec![at(0.1, 0.9), at(0.9, 0.1)]),
    ]);
    let mut laid = LaidLines::default();
    let first = laid.update(&document, tiles.iter(), manifest);
    assert!(first.laid >= 4 && !first.changed.is_empty(), "{} laid", first.laid);
    let again = laid.update(&document, tiles.iter(), manifest);
    assert_eq!((again.laid, again.changed.len()), (0, 0), "nothing has changed");

    let id = document.lines()[1].id;
    document.insert(id, 1, at(0.4, 0.5));
    let edited = laid.update(&document, tiles.iter(), manifest);
    assert!(edited.laid > 0 && edited.laid <= tiles.len(), "{} laid", edited.laid);
    // What is shown is what laying all lines anew gives.
    let mut anew = LaidLines::default();
    let expected: BTreeMap<TileId, TileLayer> =
        anew.update(&document, tiles.iter(), manifest).changed.into_iter().collect();
    assert!(!edited.changed.is_empty());
    for (id, layer) in &edited.changed {
        assert_eq!(Some(layer), expected.get(id), "{id}");
    }

    document.remove_line(id);
    let removed = laid.update(&document, tiles.iter(), manifest);
    assert_eq!(removed.laid, 0);
    assert!(!removed.changed.is_empty());
}
