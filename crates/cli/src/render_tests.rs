//! An image is reported with the areas that are incomplete in the extract.

use corniche_tileset::{LayerCounts, LayerRecord};

use super::*;

fn manifest(lost: &[(AreaLoss, u64)]) -> Manifest {
    let lost = lost.iter().map(|(loss, objects)| (loss.reason().to_owned(), *objects)).collect();
    let table = serde_json::json!({
        "id": "areas",
        "geometry": "area",
        "class": [{ "id": "water", "tags": { "natural": "water" } }],
    });
    let counts = LayerCounts { objects: 0, kept: Vec::new(), lost, unread_values: Vec::new() };
    let table = serde_json::from_value(table).unwrap();
    let layers = vec![LayerRecord { table, counts, levels: Vec::new() }];
    Manifest { layers, ..corniche_testing::package::manifest() }
}

#[test]
fn areas_that_lack_ways_or_nodes_are_counted() {
    let lost = [
        (AreaLoss::OpenWay, 5),
        (AreaLoss::MissingWays, 1200),
        (AreaLoss::Duplicate, 3),
        (AreaLoss::MissingNodes, 34),
    ];
    let text = incomplete_areas(&manifest(&lost), &ShownLayers::ALL).unwrap();
    assert!(text.contains("1 234") || text.contains("1234") || text.contains("1,234"), "{text}");
    assert!(text.contains("--defects") && !text.contains('\n'), "{text}");
}

#[test]
fn without_such_areas_nothing_is_told() {
    let all = &ShownLayers::ALL;
    assert_eq!(incomplete_areas(&manifest(&[(AreaLoss::OpenWay, 5)]), all), None);
    let some = manifest(&[(AreaLoss::MissingWays, 5)]);
    assert_eq!(incomplete_areas(&some, &ShownLayers::from_list("railways")), None);
    let without = Manifest { layers: Vec::new(), ..some };
    assert_eq!(incomplete_areas(&without, all), None);
}
