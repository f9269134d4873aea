//! A window lists the layers of a package and the classes that are drawn, each look once.

use corniche_styles::Style;

use super::*;
use crate::layers::{
    ShownLayers,
    tests::{built_in, own, package},
};

fn legends(manifest: &Manifest, shown: &ShownLayers) -> Vec<LayerLegend> {
    let looks = PackageLooks::new(manifest, &Style::road_atlas(), shown);
    LayerLegend::from_manifest(manifest, &looks)
}

fn labels(layer: &LayerLegend) -> Vec<&str> {
    layer.rows.iter().map(|row| row.label.as_str()).collect()
}

#[test]
fn layers_are_listed_from_the_highest_with_the_classes_that_are_there() {
    let walls = own("walls", LayerGeometry::Line, 3);
    let manifest = package(vec![
        (built_in("areas"), vec![5, 3]),
        (walls, vec![2, 0]),
        (built_in("boundaries"), vec![7, 2]),
    ]);
    let all = legends(&manifest, &ShownLayers::ALL);
    let titles: Vec<&str> = all.iter().map(|layer| layer.title.as_str()).collect();
    assert_eq!(titles, ["Boundaries", "walls", "Land and water"]);
    assert_eq!(labels(&all[0]), ["Boundary, level 4", "Protected area"]);
    // Classes without a style look alike.
    assert_eq!(labels(&all[1]), ["class-0, class-2"]);
    assert_eq!(labels(&all[2]), ["Water", "Forest"]);
    assert_eq!(all[2].geometry, LayerGeometry::Area);
    let one = legends(&manifest, &ShownLayers::from_list("areas"));
    assert_eq!(one.iter().map(|layer| layer.rows.len()).collect::<Vec<_>>(), [0, 0, 2]);
    assert!(legends(&package(Vec::new()), &ShownLayers::ALL).is_empty());
}

#[test]
fn scales_do_not_make_looks_differ() {
    let mut walls = own("walls", LayerGeometry::Line, 2);
    walls.classes[1].scale = Some(10_000.0);
    let manifest = package(vec![(walls, vec![0, 1])]);
    assert_eq!(labels(&legends(&manifest, &ShownLayers::ALL)[0]), ["class-0, class-1"]);
}

/// Counts of classes that the table does not have are no rows.
#[test]
fn damaged_counts_are_not_listed() {
    let manifest = package(vec![(built_in("areas"), vec![200])]);
    assert!(labels(&legends(&manifest, &ShownLayers::ALL)[0]).is_empty());
}
