//! Tables: classes by order, and what is rejected, at which place.

use serde_json::{Value, json};

use super::*;

fn table(value: Value) -> Result<LayerTable, LayerTableError> {
    LayerTable::new(serde_json::from_value(value).unwrap())
}

/// A layer of lines with these classes.
fn lines(classes: Value) -> Value {
    let mut form = json!({"id": "lines", "geometry": "line"});
    form["class"] = classes;
    form
}

/// Tags of an object, and its class.
type TagsCase<'a> = (&'a [(&'a str, &'a str)], Option<&'a str>);

fn class(table: &LayerTable, tags: &[(&str, &str)]) -> Option<String> {
    Some(table.classes()[usize::from(table.classify(tags)?)].id.clone())
}

#[test]
fn the_first_class_whose_tags_match_wins() {
    let railways = table(lines(json!([
        {"id": "siding", "tags": {"railway": "rail", "service": true}},
        {"id": "main", "tags": {"railway": "rail", "usage": "main"}},
        {"id": "branch", "tags": [
            {"railway": ["rail", "narrow_gauge"], "usage": {"not": ["main", "industrial"]}, "rack": {"not": "abt"}},
            {"railway": "light_rail", "tunnel": false},
        ]},
        {"id": "wide", "tags": {"railway": true, "gauge": {"min": 1500, "below": 2000, "unit": "mm"}}},
    ])))
    .unwrap();
    let cases: [TagsCase; 12] = [
        (&[("railway", "rail"), ("usage", "main"), ("service", "yard")], Some("siding")),
        (&[("usage", "main"), ("railway", "rail")], Some("main")),
        (&[("railway", "rail")], Some("branch")),
        (&[("railway", "rail"), ("usage", "industrial")], None),
        (&[("railway", "rail"), ("usage", "industrial"), ("gauge", "1668")], Some("wide")),
        (&[("railway", "x"), ("gauge", "1.668 m")], Some("wide")),
        (&[("railway", "x"), ("gauge", "2000")], None),
        (&[("railway", "x"), ("gauge", "1500;1435")], None),
        (&[("railway", "light_rail")], Some("branch")),
        (&[("railway", "light_rail"), ("tunnel", "yes")], None),
        (&[("highway", "service")], None),
        // The first value of a key counts.
        (&[("railway", "tram"), ("railway", "rail")], None),
    ];
    for (tags, expected) in cases {
        assert_eq!(class(&railways, tags).as_deref(), expected, "{tags:?}");
    }
    assert_eq!(railways.check_reach(), Ok(()));
    assert_eq!(railways.needed_keys(), ["gauge", "railway"]);
}

/// Every object of a class has one of the needed keys.
#[test]
fn needed_keys_find_every_object() {
    let walls = table(lines(json!([
        {"id": "wall", "tags": [{"barrier": "wall"}, {"wall": {"not": "no"}, "man_made": true}]},
    ])))
    .unwrap();
    assert_eq!(walls.needed_keys(), ["barrier", "man_made"]);
    assert_eq!(walls.classify(&[("wall", "brick")]), None);
    let classes =
        json!([{"id": "sea", "coastline": true}, {"id": "wood", "tags": {"landuse": "forest"}}]);
    let areas = table(json!({"id": "areas", "geometry": "area", "class": classes})).unwrap();
    assert_eq!(areas.needed_keys(), ["landuse", "natural"]);
    assert_eq!(areas.coastline_class(), Some(0));
    assert_eq!(areas.classify(&[("natural", "coastline")]), None);
}

#[test]
fn a_table_is_the_same_after_json() {
    let written = json!({
        "id": "railways",
        "title": {"de": "Bahnen", "en": "Railways"},
        "geometry": "line",
        "placement": "spans",
        "members": {"types": ["boundary"], "roles": ["", "outer"]},
        "above": ["areas"],
        "simplify_cells": 0.25,
        "attributes": {"electrified": "yes-no", "gauge": {"number": "mm"}, "name": "names"},
        "class": [
            {"id": "main", "title": "Main line", "scale": 250_000.0, "tags": {"railway": "rail", "usage": {"not": "industrial"}}},
            {"id": "wide", "tags": [{"railway": true, "gauge": {"min": 1500.0, "unit": "mm"}}, {"railway": ["tram", "funicular"], "tunnel": false}, {"rack": {"except": "no"}}]},
        ],
    });
    let form: LayerForm = serde_json::from_value(written.clone()).unwrap();
    assert_eq!(serde_json::to_value(&form).unwrap(), written);
    LayerTable::new(form).unwrap();
}

/// A cell of 13.2 m is two pixels of 1/96 inch at 1:25 000 (`m/px = scale / 3780`).
#[test]
fn a_scale_limits_the_cells_of_levels() {
    let walls = table(lines(json!([
        {"id": "wall", "scale": 25_000, "tags": {"barrier": "wall"}},
        {"id": "hedge", "tags": {"barrier": "hedge"}},
    ])))
    .unwrap();
    let cell = walls.classes()[0].coarsest_cell_m().unwrap();
    assert!((cell - 2.0 * 25_000.0 / 3779.5).abs() < 0.01, "{cell}");
    assert_eq!(walls.classes()[1].coarsest_cell_m(), None);
}

#[test]
fn what_is_wrong_is_named_with_its_place() {
    let class = json!({"id": "a", "tags": {"k": "v"}});
    let with = |key: &str, value: Value| {
        let mut layer = lines(json!([class]));
        layer[key] = value;
        layer
    };
    let with_class = |key: &str, value: Value| {
        let mut own = class.clone();
        own[key] = value;
        lines(json!([{"id": "first", "tags": {"first": true}}, own]))
    };
    let many: Vec<Value> =
        (0..10_000).map(|k| json!({"id": format!("c{k}"), "tags": {"k": k.to_string()}})).collect();
    let values: Vec<Value> = (0..10)
        .map(|k| {
            let values: Vec<String> = (0..2000).map(|value| format!("{k}-{value}")).collect();
            json!({"id": format!("c{k}"), "tags": {"k": values}})
        })
        .collect();
    let conditions: Vec<Value> = (0..160)
        .map(|k| json!({"id": format!("c{k}"), "tags": vec![json!({"k": k.to_string()}); 64]}))
        .collect();
    let area = |classes: Value| json!({"id": "a", "geometry": "area", "class": classes});
    let cases = [
        (with("id", json!("Bahn")), "id", "is not an id"),
        (with("id", json!("bahn-")), "id", "is not an id"),
        (with("title", json!("a\u{202e}b")), "title", "direction of writing"),
        (with("closed_ways", json!(false)), "closed_ways", "geometry \"point\""),
        (with("above", json!(["lines"])), "above[0]", "cannot be above itself"),
        (with("above", json!(["areas", "areas"])), "above[1]", "twice"),
        (with("simplify_cells", json!(9.0)), "simplify_cells", "0 to 8"),
        (with("attributes", json!({" a": "text"})), "attributes.\" a\"", "not accepted as a key"),
        (with("members", json!({"types": []})), "members.types", "no type"),
        (
            with("members", json!({"types": ["a"], "roles": ["\n"]})),
            "members.roles[0]",
            "not accepted as a value",
        ),
        (lines(json!([])), "class", "1 to 256"),
        (lines(json!(many)), "class", "got 10000"),
        (lines(json!([class, class])), "class[1].id", "two classes"),
        (with_class("id", json!("")), "class[1].id", "is not an id"),
        (with_class("title", json!("")), "class[1].title", "not a title"),
        (with_class("scale", json!(0.5)), "class[1].scale", "1:25 000"),
        (with_class("tags", json!([])), "class[1].tags", "no tags"),
        (with_class("tags", json!({})), "class[1].tags", "requires no tag"),
        (
            with_class("tags", json!([{"k": "v"}, {"l": false}])),
            "class[1].tags[1]",
            "requires no tag",
        ),
        (with_class("tags", json!({"k": []})), "class[1].tags.k", "no value"),
        (with_class("tags", json!({"k": "v\u{0}"})), "class[1].tags.k", "not accepted as a value"),
        (with_class("tags", json!({"k": {"min": 3, "below": 3}})), "class[1].tags.k", "no number"),
        (with_class("tags", json!({"k": {"min": 2e15}})), "class[1].tags.k", "at most 1e15"),
        (with_class("title", json!({})), "class[1].title", "1 to 64 languages"),
        (lines(json!(values)), "class", "has 20000 values"),
        (lines(json!(conditions)), "class", "has 10240 conditions"),
        (with_class("tags", json!({"k": {"unit": "m"}})), "class[1].tags.k", "no number"),
        (with_class("coastline", json!(true)), "class[1].coastline", "areas"),
        (
            area(json!([{"id": "s", "coastline": true, "tags": {"k": "v"}}])),
            "class[0].tags",
            "no tags",
        ),
        (
            area(json!([{"id": "s", "coastline": true}, {"id": "t", "coastline": true}])),
            "class[1].coastline",
            "only one class",
        ),
        (
            json!({"id": "a", "geometry": "point", "placement": "spans", "class": [class]}),
            "placement",
            "\"line\"",
        ),
        (
            json!({"id": "a", "geometry": "area", "members": {"types": ["x"]}, "class": [class]}),
            "members",
            "\"line\"",
        ),
    ];
    for (written, path, problem) in cases {
        let error = table(written).unwrap_err();
        assert_eq!(error.path.to_string(), path, "{error}");
        assert!(error.problem.contains(problem), "{error}");
    }
}

#[test]
fn unknown_keys_and_other_types_are_rejected() {
    let cases = [
        json!({"id": "a", "geometry": "line", "class": [], "colour": "red"}),
        json!({"id": "a", "geometry": "surface", "class": []}),
        lines(json!([{"id": "a", "tag": {"k": "v"}}])),
        lines(json!([{"id": "a", "tags": {"k": 5}}])),
        lines(json!([{"id": "a", "tags": {"k": {"min": 5, "max": 7}}}])),
        lines(json!([{"id": "a", "tags": {"k": {"not": "a", "min": 7}}}])),
        lines(json!([{"id": "a", "tags": {"k": {"min": 5, "unit": "furlong"}}}])),
        json!({"id": "a", "geometry": "line", "class": [], "attributes": {"name": "blob"}}),
    ];
    for case in cases {
        assert!(serde_json::from_value::<LayerForm>(case.clone()).is_err(), "{case}");
    }
}
