//! A window lists the boundaries that a package has and a style draws, each look once.

use corniche_tileset::{LineClassRecord, LineCounts, LinesRecord};

use super::*;

/// Returns a package with ways of each of these classes, and with an empty record for the class of
/// countries.
fn manifest(classes: &[u8]) -> Manifest {
    let kept = |class, ways| LineClassRecord { class, ways, length_um: 1000 * ways };
    let kept = [kept(0, 0)].into_iter().chain(classes.iter().map(|class| kept(*class, 3)));
    let counts = LineCounts { ways: 1, kept: kept.collect(), lost: Vec::new() };
    let boundaries = Some(LinesRecord { counts, levels: Vec::new() });
    Manifest { boundaries, ..corniche_testing::package::manifest() }
}

fn labels(manifest: &Manifest, style: &Style) -> Vec<String> {
    BoundaryLines::from_manifest(manifest, style).into_iter().map(|lines| lines.label).collect()
}

#[test]
fn classes_that_are_there_and_drawn_are_listed() {
    let style = Style::road_atlas();
    let all = labels(&manifest(&[2, 6, 7]), &style);
    assert_eq!(all, ["boundary, level 4", "boundary, level 8", "protected area"]);
    assert!(labels(&manifest(&[2, 6]), &style.without_boundaries()).is_empty());
    let without = Manifest { boundaries: None, ..manifest(&[]) };
    assert!(labels(&without, &Style::road_atlas()).is_empty());
}

#[test]
fn classes_that_are_drawn_alike_stand_together() {
    let mut style = Style::road_atlas();
    style.boundaries[6] = LineStyle { max_pixel_m: Some(1.0), ..style.boundaries[2] };
    let all = labels(&manifest(&[2, 6, 7]), &style);
    assert_eq!(all, ["boundary, level 4, boundary, level 8", "protected area"]);
}
