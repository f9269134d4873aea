//! An image is reported with the areas that are incomplete in the extract.

use corniche_tileset::{AreaCounts, AreasRecord};

use super::*;

fn manifest(lost: &[(AreaLoss, u64)]) -> Manifest {
    let lost = lost.iter().map(|(loss, objects)| (loss.reason().to_owned(), *objects)).collect();
    let counts = AreaCounts { objects: 0, kept: Vec::new(), lost };
    let areas = Some(AreasRecord { counts, levels: Vec::new() });
    Manifest { areas, ..corniche_testing::package::manifest() }
}

#[test]
fn areas_that_lack_ways_or_nodes_are_counted() {
    let style = Style::road_atlas();
    let lost = [
        (AreaLoss::OpenWay, 5),
        (AreaLoss::MissingWays, 1200),
        (AreaLoss::Duplicate, 3),
        (AreaLoss::MissingNodes, 34),
    ];
    let text = incomplete_areas(&manifest(&lost), &style).unwrap();
    assert!(text.contains("1 234") || text.contains("1234") || text.contains("1,234"), "{text}");
    assert!(text.contains("--defects") && !text.contains('\n'), "{text}");
}

#[test]
fn without_such_areas_nothing_is_told() {
    let style = Style::road_atlas();
    assert_eq!(incomplete_areas(&manifest(&[(AreaLoss::OpenWay, 5)]), &style), None);
    let some = manifest(&[(AreaLoss::MissingWays, 5)]);
    assert_eq!(incomplete_areas(&some, &style.without_areas()), None);
    let without = Manifest { areas: None, ..some };
    assert_eq!(incomplete_areas(&without, &Style::road_atlas()), None);
}
