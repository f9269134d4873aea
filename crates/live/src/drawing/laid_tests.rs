//! An edit drapes only the changed line again, and areas are filled.

use corniche_testing::package::written;
use corniche_viewer::tiles::{MapPackage as _, PackageSource, TileSource as _};

use super::*;
use crate::drawing::document::{DocumentLine, DrawnPoint};

fn source(folder: &std::path::Path) -> PackageSource {
    let path = folder.join("small.pmtiles");
    std::fs::write(&path, written()).unwrap();
    PackageSource::open(&path).unwrap()
}

fn point(at_m: [f64; 2]) -> DrawnPoint {
    DrawnPoint { lon_lat_deg: [0.0; 2], at_m }
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
    let mut document = Document::from_lines(vec![
        DocumentLine::new(None, false, vec![at(0.1, 0.1), at(0.9, 0.9)]),
        DocumentLine::new(None, false, vec![at(0.1, 0.9), at(0.9, 0.1)]),
    ]);
    let mut laid = LaidLines::default();
    let first = laid.update(&document, tiles.iter(), manifest);
    assert!(first.laid >= 4 && !first.changed.is_empty(), "{} laid", first.laid);
    let again = laid.update(&document, tiles.iter(), manifest);
    assert_eq!((again.laid, again.changed.len()), (0, 0), "nothing has changed");

    let id = document.lines[1].id;
    document.insert(id, 1, at(0.4, 0.5));
    let edited = laid.update(&document, tiles.iter(), manifest);
    assert!(edited.laid > 0 && edited.laid <= tiles.len(), "{} laid", edited.laid);
    // The result is the same as after draping all lines again.
    let mut anew = LaidLines::default();
    let expected = anew.update(&document, tiles.iter(), manifest).changed;
    assert!(!edited.changed.is_empty());
    for changed in &edited.changed {
        assert!(expected.contains(changed), "{}", changed.0);
    }

    document.remove_line(id);
    let removed = laid.update(&document, tiles.iter(), manifest);
    assert_eq!(removed.laid, 0);
    assert!(!removed.changed.is_empty());
}

#[test]
fn an_area_has_an_outline_that_is_closed_and_volumes_inside() {
    let folder = tempfile::tempdir().unwrap();
    let source = source(folder.path());
    let manifest = source.manifest();
    let tiles = [source.load(TileId::ROOT).unwrap().without_roads()];
    let bounds = manifest.data_bounds;
    let at = |x: f64, y: f64| {
        point([bounds.min_x + x * bounds.width(), bounds.min_y + y * bounds.height()])
    };
    let square = |from: f64, to: f64| vec![at(from, from), at(to, from), at(to, to), at(from, to)];
    let mut document = Document::from_lines(vec![
        DocumentLine::new(None, true, square(0.2, 0.5)),
        DocumentLine::new(None, true, square(0.4, 0.8)),
        DocumentLine::new(None, false, square(0.1, 0.3)),
    ]);
    let mut laid = LaidLines::default();
    let [(_, outlines, areas)] = &laid.update(&document, tiles.iter(), manifest).changed[..] else {
        panic!("one tile");
    };
    assert_eq!(areas.classes.iter().map(|class| class.polygons).collect::<Vec<_>>(), [2]);
    // Two squares of four walls each, and of two triangles.
    assert_eq!((areas.walls.len(), areas.triangles.len()), (8, 12));
    let before = outlines.segments.all().len();

    // As a line, the second one has no inside, and lacks the side that closed it.
    let id = document.lines[1].id;
    document.turn(id);
    let [(_, outlines, areas)] = &laid.update(&document, tiles.iter(), manifest).changed[..] else {
        panic!("one tile");
    };
    assert_eq!((areas.walls.len(), areas.triangles.len()), (4, 6));
    assert!(outlines.segments.all().len() < before);
    document.undo();
    let [(_, _, areas)] = &laid.update(&document, tiles.iter(), manifest).changed[..] else {
        panic!("one tile");
    };
    assert_eq!(areas.walls.len(), 8);
}

/// Tiles inside an area contain no part of its outline.
#[test]
fn a_tile_inside_an_area_is_filled() {
    let folder = tempfile::tempdir().unwrap();
    let source = source(folder.path());
    let manifest = source.manifest();
    let children = TileId::ROOT.children();
    let tiles: Vec<TileGeometry> =
        children.into_iter().map(|id| source.load(id).unwrap().without_roads()).collect();
    let bounds = manifest.data_bounds;
    let at = |x: f64, y: f64| {
        point([bounds.min_x + x * bounds.width(), bounds.min_y + y * bounds.height()])
    };
    let around = vec![at(-0.5, -0.5), at(1.5, -0.5), at(1.5, 1.5), at(-0.5, 1.5)];
    let document = Document::from_lines(vec![DocumentLine::new(None, true, around)]);
    let mut laid = LaidLines::default();
    let relaid = laid.update(&document, tiles.iter(), manifest);
    let with_ground = tiles.iter().filter(|tile| tile.summary.is_some()).count();
    assert_eq!(relaid.changed.len(), with_ground);
    for (id, outlines, areas) in &relaid.changed {
        assert!(outlines.is_empty() && areas.classes[0].polygons == 1, "{id}");
    }
}

/// A line that crosses too much ground of a tile has no outline there, which is reported; other
/// lines are draped.
#[test]
fn lines_that_take_too_much_work_are_told() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("full.pmtiles");
    let cases = corniche_testing::hostile::FAMILIES[4].1();
    let full = cases
        .into_iter()
        .find(|case| case.name == "four hundred segments over a hundred thousand triangles");
    std::fs::write(&path, full.unwrap().bytes).unwrap();
    let source = PackageSource::open(&path).unwrap();
    let manifest = source.manifest();
    let tile = [source.load(TileId::ROOT).unwrap().without_roads()];
    let bounds = manifest.frame.tile_bounds(TileId::ROOT);
    let at = |x: f64, y: f64| {
        point([bounds.min_x + x * bounds.width(), bounds.min_y + y * bounds.height()])
    };
    // The line goes from west to east and back, each time elsewhere, so that it is not simplified.
    let across = |k: u32| at(f64::from(k % 2), f64::from(k * 7919 % 10_000) / 1e4);
    let mut document = Document::from_lines(vec![
        DocumentLine::new(None, false, (0..10_000).map(across).collect()),
        DocumentLine::new(None, false, vec![at(0.1, 0.9), at(0.9, 0.1)]),
    ]);
    let long = document.lines[0].id;
    let mut laid = LaidLines::default();
    let first = laid.update(&document, tile.iter(), manifest);
    assert_eq!((first.laid, &first.not_laid), (1, &BTreeSet::from([long])));
    let again = laid.update(&document, tile.iter(), manifest);
    assert_eq!(again.not_laid, BTreeSet::from([long]), "nothing has changed");
    document.remove_line(long);
    assert!(laid.update(&document, tile.iter(), manifest).not_laid.is_empty());
}
