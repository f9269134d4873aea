//! Every layer of lines is listed once, and its table says as much of each class.

use super::*;

/// The match has no `_`, so a new layer does not compile here until it has a place in the list.
#[test]
fn every_layer_is_listed_in_order_with_a_whole_table() {
    for (place, layer) in ClassedLayer::ALL.into_iter().enumerate() {
        let expected = match layer {
            ClassedLayer::Boundaries => 0,
        };
        assert_eq!((place, layer as usize), (expected, expected));
        let ClassTable { title, names, coarsest_cells_m, .. } = layer.table();
        assert_eq!(title.to_lowercase(), layer.name());
        assert_eq!(names.len(), coarsest_cells_m.len(), "{title}");
        let classes = layer.classes();
        assert_eq!(classes.iter().map(|class| class.name()).collect::<Vec<_>>(), *names);
        assert_eq!(layer.class(classes.len() as u8), None);
    }
}
