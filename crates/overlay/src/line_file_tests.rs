use super::*;

const TEXT: &str = r#"{"type":"FeatureCollection","name":"mine","features":[
 {"type":"Feature","id":7,"properties":{"name":"a","n":1.5},"geometry":{"type":"LineString","coordinates":[[9.123456789012345,47.1,500.25],[9.2,47.2,600]]}},
 {"type":"Feature","properties":{},"geometry":{"type":"Point","coordinates":[9,47]}},
 {"type":"Feature","properties":{"name":"b"},"bbox":[8,47,8.5,47.5],"geometry":{"type":"LineString","coordinates":[[8,47],[8.5,47.5]]}}
]}"#;

fn saved(file: &LineFile) -> Vec<SavedLine> {
    let line =
        |(feature, points_deg)| SavedLine { feature: Some(feature), points_deg, heights_m: None };
    file.lines().into_iter().map(line).collect()
}

#[test]
fn what_is_not_changed_is_saved_as_it_was() {
    let file = LineFile::parse(TEXT).unwrap();
    assert_eq!(file.lines().iter().map(|(number, _)| *number).collect::<Vec<_>>(), [0, 2]);
    assert_eq!(file.others(), 1);
    let again: Value = serde_json::from_str(&file.text_with(&saved(&file))).unwrap();
    assert_eq!(again, serde_json::from_str::<Value>(TEXT).unwrap());
}

/// The shortest decimal digits of an f64 that lead back to it.
#[test]
fn positions_come_back_to_the_last_bit() {
    let points_deg: Vec<[f64; 2]> =
        (1..500).map(|k| [f64::from(k) / 7.0, f64::from(k).sqrt() * 1.1]).collect();
    let line = SavedLine { feature: None, points_deg: points_deg.clone(), heights_m: None };
    let again = LineFile::parse(&LineFile::default().text_with(&[line])).unwrap();
    assert_eq!(again.lines(), [(0, points_deg)]);
}

#[test]
fn a_changed_line_keeps_its_properties_and_gets_new_heights() {
    let file = LineFile::parse(TEXT).unwrap();
    let mut lines = saved(&file);
    lines[1].points_deg[0] = [8.1, 47.1];
    lines[1].heights_m = Some(vec![400.000_4, 410.0]);
    lines.push(SavedLine { feature: None, points_deg: vec![[1.0, 2.0]], heights_m: None });
    let again: Value = serde_json::from_str(&file.text_with(&lines)).unwrap();
    let features = again["features"].as_array().unwrap();
    assert_eq!(features.len(), 3, "one point is no line");
    assert_eq!(features[2]["properties"]["name"], "b");
    assert_eq!(features[2].get("bbox"), None, "it was that of the old line");
    assert_eq!(features[2]["geometry"]["coordinates"], json!([[8.1, 47.1, 400.0], [8.5, 47.5]]));
}

#[test]
fn a_removed_line_is_gone_and_others_stay() {
    let file = LineFile::parse(TEXT).unwrap();
    let again = LineFile::parse(&file.text_with(&saved(&file)[1..])).unwrap();
    assert_eq!((again.lines().len(), again.others()), (1, 1));
}

#[test]
fn single_features_and_geometries_are_collections_of_one() {
    for text in [
        r#"{"type":"LineString","coordinates":[[1,2],[3,4]]}"#,
        r#"{"type":"Feature","properties":null,"geometry":{"type":"LineString","coordinates":[[1,2],[3,4]]}}"#,
    ] {
        assert_eq!(LineFile::parse(text).unwrap().lines(), [(0, vec![[1.0, 2.0], [3.0, 4.0]])]);
    }
}

#[test]
fn what_is_no_geojson_is_refused() {
    let crs = r#"{"type":"FeatureCollection","crs":{"type":"name","properties":{"name":"EPSG:2056"}},"features":[]}"#;
    for (text, part) in [
        ("", "EOF"),
        ("[]", "no object"),
        ("{}", "no features"),
        (r#"{"type":"FeatureCollection"}"#, "no features"),
        (crs, "EPSG:2056"),
    ] {
        let reason = LineFile::parse(text).unwrap_err();
        assert!(reason.contains(part), "{text}: {reason}");
    }
}

/// A track with elevations, of which one point is moved where no heights are known.
#[test]
fn points_that_stay_keep_their_elevations() {
    let file = LineFile::parse(TEXT).unwrap();
    let mut lines = saved(&file);
    lines[0].points_deg.push([9.3, 47.3]);
    let again: Value = serde_json::from_str(&file.text_with(&lines)).unwrap();
    let expected = json!([[9.123_456_789_012_345, 47.1, 500.25], [9.2, 47.2, 600], [9.3, 47.3]]);
    assert_eq!(again["features"][0]["geometry"]["coordinates"], expected);
}

#[test]
fn a_rectangle_around_all_lines_is_not_kept() {
    let text = r#"{"type":"FeatureCollection","bbox":[8,47,9,48],"features":[]}"#;
    let text = LineFile::parse(text).unwrap().text_with(&[]);
    assert!(!text.contains("bbox"), "{text}");
}
