//! The order of layers: above others, in the order of the list, and never in a cycle.

use serde_json::json;

use super::*;

/// Layers with these ids, each above others.
fn layers(above: &[(&str, &[&str])]) -> Vec<LayerTable> {
    let layer = |(id, above): &(&str, &[&str])| {
        let class = json!([{"id": "a", "tags": {"k": "v"}}]);
        let form = json!({"id": id, "geometry": "line", "above": above, "class": class});
        LayerTable::new(serde_json::from_value(form).unwrap()).unwrap()
    };
    above.iter().map(layer).collect()
}

#[test]
fn layers_come_after_those_below_them() {
    let all = layers(&[("c", &["a", "missing"]), ("a", &[]), ("d", &["c"]), ("b", &["a"])]);
    assert_eq!(stacked_layers(&all), Ok(vec![1, 0, 2, 3]));
    assert_eq!(stacked_layers(&layers(&[("b", &[]), ("a", &[])])), Ok(vec![0, 1]));
    assert_eq!(stacked_layers(&[]), Ok(Vec::new()));
}

#[test]
fn a_cycle_is_named() {
    let all =
        layers(&[("x", &["a"]), ("a", &["b"]), ("b", &["c", "d"]), ("c", &[]), ("d", &["a"])]);
    let error = stacked_layers(&all).unwrap_err();
    assert_eq!(
        error.to_string(),
        "the `above` entries of layers form a cycle: a above b above d above a"
    );
}

#[test]
fn equal_ids_and_too_many_layers_are_rejected() {
    let error = stacked_layers(&layers(&[("a", &[]), ("a", &[])])).unwrap_err();
    assert!(error.to_string().contains("two layers"), "{error}");
    let ids: Vec<String> = (0..=MAX_LAYERS).map(|k| format!("l{k}")).collect();
    let many: Vec<(&str, &[&str])> = ids.iter().map(|id| (id.as_str(), &[][..])).collect();
    assert_eq!(stacked_layers(&layers(&many)), Err(LayerStackError::TooMany { layers: 65 }));
    assert!(stacked_layers(&layers(&many[1..])).is_ok());
}
