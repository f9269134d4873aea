//! Classes that cannot be reached: cases, and random tables against all objects of a small world.

use std::collections::BTreeMap;

use proptest::prelude::*;
use serde_json::{Value, json};

use super::*;
use crate::{LayerForm, LayerTable, TagRule};

/// The error of a table of lines with these classes.
fn error_of(classes: Value) -> Option<LayerTableError> {
    let mut form = json!({"id": "lines", "geometry": "line"});
    form["class"] = classes;
    LayerTable::new(serde_json::from_value(form).unwrap()).unwrap().check_reach().err()
}

#[test]
fn a_class_that_others_cover_is_named_with_them() {
    let cases = [
        (json!([{"id": "a", "tags": {"k": true}}, {"id": "b", "tags": {"k": "v"}}]), "a"),
        (
            json!([{"id": "a", "tags": {"k": ["v", "w"]}}, {"id": "b", "tags": {"k": "v", "l": "x"}}]),
            "a",
        ),
        // Together, but neither alone.
        (
            json!([
                {"id": "a", "tags": {"k": "v", "l": "x"}},
                {"id": "c", "tags": {"k": "v", "l": {"not": "x"}}},
                {"id": "b", "tags": {"k": "v"}},
            ]),
            "a, c",
        ),
        (
            json!([
                {"id": "a", "tags": {"k": {"min": 0, "below": 10}}},
                {"id": "c", "tags": {"k": {"min": 10}}},
                {"id": "b", "tags": {"k": {"min": 5, "below": 20}}},
            ]),
            "a, c",
        ),
        (
            json!([{"id": "a", "tags": {"k": {"min": 0}}}, {"id": "b", "tags": {"k": ["7", "12.5"]}}]),
            "a",
        ),
    ];
    for (classes, by) in cases {
        let error = error_of(classes).unwrap();
        assert!(error.problem.contains("class \"b\" is never reached"), "{error}");
        assert!(error.problem.contains(&format!("({by})")), "{error}");
    }
}

#[test]
fn a_class_with_an_object_of_its_own_is_allowed() {
    let cases = [
        json!([{"id": "a", "tags": {"k": "v"}}, {"id": "b", "tags": {"k": true}}]),
        json!([{"id": "a", "tags": {"k": {"min": 0}}}, {"id": "b", "tags": {"k": ["7", "x"]}}]),
        json!([{"id": "a", "tags": {"k": {"min": 0}}}, {"id": "b", "tags": {"k": {"min": -1}}}]),
        json!([{"id": "a", "tags": {"k": "v", "l": true}}, {"id": "b", "tags": {"k": "v", "l": false}}]),
        json!([{"id": "a", "tags": {"k": {"not": "v"}, "l": true}}, {"id": "b", "tags": {"l": true}}]),
    ];
    for classes in cases {
        assert_eq!(error_of(classes.clone()), None, "{classes}");
    }
}

#[test]
fn ranges_of_a_key_have_one_unit() {
    let classes = json!([
        {"id": "a", "tags": {"k": {"min": 5, "unit": "m"}}},
        {"id": "b", "tags": {"k": {"min": 1, "unit": "ft"}}},
    ]);
    let error = error_of(classes).unwrap();
    assert_eq!(error.path.to_string(), "class[1].tags.k");
    let classes = json!([
        {"id": "a", "tags": {"k": {"min": 5, "unit": "m"}}},
        {"id": "b", "tags": [{"l": true}, {"k": {"min": 1, "unit": "ft"}}]},
    ]);
    assert_eq!(error_of(classes).unwrap().path.to_string(), "class[1].tags[1].k");
}

/// Each pair of keys leaves two parts of a box, so 60 pairs leave 2^60, all of which the two
/// classes after them cover together. The same table with few pairs is decided.
#[test]
fn an_endless_decision_is_refused() {
    let table = |pairs: usize| {
        let pair = |k: usize| {
            let [a, b] = [format!("a{k}"), format!("b{k}")];
            let tags = json!([{&a: "x", &b: "x"}, {&a: {"not": "x"}, &b: true, "t": true}]);
            json!({"id": format!("c{k}"), "tags": tags})
        };
        let mut classes: Vec<Value> = (0..pairs).map(pair).collect();
        classes.push(json!({"id": "with", "tags": {"z": true, "y": true}}));
        classes.push(json!({"id": "without", "tags": {"z": true, "y": false}}));
        classes.push(json!({"id": "last", "tags": {"z": "q"}}));
        json!(classes)
    };
    let error = error_of(table(2)).unwrap();
    assert!(error.problem.contains("class \"last\" is never reached"), "{error}");
    let error = error_of(table(60)).unwrap();
    assert!(error.problem.contains("takes too long"), "{error}");
}

/// The largest tables are decided, and in little time: classes with disjoint values.
#[test]
fn a_large_table_is_decided() {
    let class = |k: usize| {
        let tags: Vec<Value> =
            (0..32).map(|alternative| json!({"k": format!("{k}-{alternative}")})).collect();
        json!({"id": format!("c{k}"), "tags": tags})
    };
    let mut classes: Vec<Value> = (0..255).map(class).collect();
    assert_eq!(error_of(json!(classes)), None);
    classes.push(json!({"id": "last", "tags": {"k": ["7-7", "254-31"]}}));
    let error = error_of(json!(classes)).unwrap();
    assert!(error.problem.contains("(c7, c254)"), "{error}");
}

/// All values of a key in the small world: none, named ones, another text, numbers.
const WORLD: [Option<&str>; 8] =
    [None, Some("v"), Some("w"), Some("other"), Some("-1"), Some("0"), Some("3"), Some("9")];

fn condition() -> impl Strategy<Value = TagCondition> {
    let text = prop::sample::select(vec!["v".to_owned(), "w".to_owned(), "3".to_owned()]);
    let values = || prop::collection::vec(text.clone(), 1..3);
    let range =
        (0..3_usize, 0..3_usize).prop_filter_map("a range with a number", |(min, below)| {
            let bounds = [None, Some(0.0), Some(5.0)];
            let (min, below) = (bounds[min], bounds[below]);
            let is_open = min.zip(below).is_none_or(|(min, below)| min < below);
            let unit = TagUnit::Count;
            (is_open && (min.is_some() || below.is_some())).then_some(TagCondition::Range {
                min,
                below,
                unit,
            })
        });
    prop_oneof![
        Just(TagCondition::Present),
        Just(TagCondition::Absent),
        values().prop_map(TagCondition::OneOf),
        values().prop_map(TagCondition::NoneOf),
        values().prop_map(TagCondition::OtherThan),
        range,
    ]
}

fn class() -> impl Strategy<Value = TagRule> {
    let key = prop::sample::select(vec!["k".to_owned(), "l".to_owned(), "m".to_owned()]);
    let conditions = prop::collection::btree_map(key, condition(), 1..4);
    let needs_tag = |conditions: &BTreeMap<String, TagCondition>| {
        conditions.values().any(TagCondition::needs_tag)
    };
    let conditions = conditions.prop_filter("a class requires a tag", needs_tag);
    prop::collection::vec(conditions, 1..3).prop_map(TagRule::AnyOf)
}

proptest! {
    /// The oracle tries all objects of the small world, whose values lie in every atom.
    #[test]
    fn random_tables_agree_with_all_objects(rules in prop::collection::vec(class(), 1..5)) {
        let classes = rules.iter().enumerate().map(|(index, rule)| {
            let class = json!({"id": format!("c{index}"), "tags": rule});
            serde_json::from_value(class).unwrap()
        });
        let classes: Vec<ClassForm> = classes.collect();
        let mut reached = vec![false; classes.len()];
        for k in WORLD {
            for l in WORLD {
                for m in WORLD {
                    let tags: Vec<(&str, &str)> = [("k", k), ("l", l), ("m", m)]
                        .into_iter()
                        .filter_map(|(key, value)| Some((key, value?)))
                        .collect();
                    if let Some(first) = classes.iter().position(|class| class.tags.is_met(&tags)) {
                        reached[first] = true;
                    }
                }
            }
        }
        let expected = reached.iter().position(|&is_reached| !is_reached);
        let found = shadows(&classes).unwrap().map(|(index, _)| index);
        prop_assert_eq!(found, expected);
        let form: LayerForm =
            serde_json::from_value(json!({"id": "a", "geometry": "line", "class": classes})).unwrap();
        let table = LayerTable::new(form).unwrap();
        prop_assert_eq!(table.check_reach().is_err(), expected.is_some());
    }
}
