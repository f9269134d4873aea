//! Changes of settings by the page affect only the named settings.

use corniche_styles::Style;

use super::*;

#[test]
fn what_is_not_named_stays_and_what_is_named_changes() {
    let usual = StoredSettings::default();
    let changed = usual.changed_by(r#"{"roads": "sv", "cell_px": null, "photo": 0.5}"#).unwrap();
    assert_eq!(
        changed,
        StoredSettings {
            roads: RoadMethod::ShadowVolumes,
            cell_px: None,
            photo: Some(0.5),
            ..usual.clone()
        }
    );
    assert_eq!(changed.of_session().roads.method, RoadMethod::ShadowVolumes);
    assert!(!changed.of_session().is_wireframe);
    let edges = usual.changed_by(r#"{"wireframe": true}"#).unwrap();
    assert!(edges.of_session().is_wireframe);
    let nothing = usual.changed_by(r#"{"roads": null, "divider": null}"#).unwrap();
    assert_eq!(nothing, usual);
    let text = serde_json::to_string(&changed).unwrap();
    assert_eq!(usual.changed_by(&text).unwrap(), changed);
    let both = usual
        .changed_by(
            r#"{"compare": "split", "classes": [true,false,true,true,true,true,true,true,true]}"#,
        )
        .unwrap();
    let MapSettings { roads, compare, .. } = both.of_session();
    let both = compare.pictures(roads);
    let methods: Vec<RoadMethod> = both.iter().map(|roads| roads.method).collect();
    assert_eq!(methods, [RoadMethod::Geometry, RoadMethod::ShadowVolumes]);
    let hidden = FunctionalRoadClass::new(1).unwrap();
    assert!(both.iter().all(|roads| !roads.classes.contains(hidden)));
}

#[test]
fn what_cannot_be_is_told_in_words() {
    for (changes, told) in [
        ("7", "settings"),
        (r#"{"road": "sv"}"#, "unknown field `road`"),
        (r#"{"roads": "both"}"#, "unknown variant `both`"),
        (r#"{"samples": 9}"#, "1 to 4"),
        (r#"{"exaggeration": 0}"#, "0.01 to 100"),
        (r#"{"widths": [1,1,1,1,1,1,1,1,-1]}"#, "0.01 to 100"),
        (r#"{"divider": 2}"#, "0 to 1"),
    ] {
        let why = StoredSettings::default().changed_by(changes).unwrap_err();
        assert!(why.contains(told), "{changes}: {why}");
    }
}

#[test]
fn widths_change_the_style_and_layers_what_is_drawn() {
    let look = |settings: &StoredSettings| settings.of_session().applied_to(&Style::road_atlas());
    let usual = StoredSettings::default();
    let changed = usual.changed_by(r#"{"widths": [2,1,1,1,1,1,1,1,1], "layers": ["walls"]}"#);
    let changed = changed.unwrap();
    let widths_m = [&changed, &usual].map(|settings| look(settings).roads[0].width_m);
    assert!((widths_m[0] / widths_m[1] - 2.0).abs() < 1e-6);
    let shown = |settings: &StoredSettings| {
        ["walls", "areas"].map(|id| settings.of_session().layers.contains(id))
    };
    assert_eq!(shown(&usual), [true, true]);
    assert_eq!(shown(&changed), [true, false]);
    let none = changed.changed_by(r#"{"layers": []}"#).unwrap();
    assert_eq!(shown(&none), [false, false]);
    assert_eq!(none.changed_by(r#"{"layers": null}"#).unwrap().layers, usual.layers);
}
