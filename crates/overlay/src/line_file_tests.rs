//! A file of lines is saved with everything unchanged preserved.

use super::*;

const TEXT: &str = r#"{"type":"FeatureCollection","name":"mine","features":[
 {"type":"Feature","id":7,"properties":{"name":"a","n":1.5},"geometry":{"type":"LineString","coordinates":[[9.123456789012345,47.1,500.25],[9.2,47.2,600]]}},
 {"type":"Feature","properties":{},"geometry":{"type":"Point","coordinates":[9,47]}},
 {"type":"Feature","properties":{"name":"b"},"bbox":[8,47,8.5,47.5],"geometry":{"type":"LineString","coordinates":[[8,47],[8.5,47.5]]}}
]}"#;

fn saved(file: &LineFile) -> Vec<SavedLine> {
    let line = |(feature, shape, points_deg)| SavedLine {
        feature: Some(feature),
        shape,
        points_deg,
        heights_m: None,
    };
    file.lines().into_iter().map(line).collect()
}

#[test]
fn what_is_not_changed_is_saved_as_it_was() {
    let file = LineFile::parse(TEXT).unwrap();
    assert_eq!(file.lines().iter().map(|(number, ..)| *number).collect::<Vec<_>>(), [0, 2]);
    assert_eq!(file.others(), 1);
    let again: Value = serde_json::from_str(&file.text_with(&saved(&file))).unwrap();
    assert_eq!(again, serde_json::from_str::<Value>(TEXT).unwrap());
}

/// The shortest decimal digits of an f64 that can be parsed back to it.
#[test]
fn positions_come_back_to_the_last_bit() {
    let points_deg: Vec<[f64; 2]> =
        (1..500).map(|k| [f64::from(k) / 7.0, f64::from(k).sqrt() * 1.1]).collect();
    // The area becomes counter-clockwise, so its points are reversed.
    let closed: Vec<[f64; 2]> = points_deg.iter().rev().copied().collect();
    for (shape, points_deg) in [(LineShape::Line, points_deg), (LineShape::Area, closed)] {
        let known = points_deg.clone();
        let line = SavedLine { feature: None, shape, points_deg, heights_m: None };
        let again = LineFile::parse(&LineFile::default().text_with(&[line])).unwrap();
        assert!(again.lines() == [(0, shape, known)], "{shape:?}");
    }
}

#[test]
fn a_changed_line_keeps_its_properties_and_gets_new_heights() {
    let file = LineFile::parse(TEXT).unwrap();
    let mut lines = saved(&file);
    lines[1].points_deg[0] = [8.1, 47.1];
    lines[1].heights_m = Some(vec![400.000_4, 410.0]);
    let point = vec![[1.0, 2.0]];
    let line =
        SavedLine { feature: None, shape: LineShape::Line, points_deg: point, heights_m: None };
    lines.push(line);
    let again: Value = serde_json::from_str(&file.text_with(&lines)).unwrap();
    let features = again["features"].as_array().unwrap();
    assert_eq!(features.len(), 3, "one point is not a line");
    assert_eq!(features[2]["properties"]["name"], "b");
    assert_eq!(features[2].get("bbox"), None, "the bbox belonged to the old line");
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
        let line = (0, LineShape::Line, vec![[1.0, 2.0], [3.0, 4.0]]);
        assert_eq!(LineFile::parse(text).unwrap().lines(), [line]);
    }
}

#[test]
fn what_is_no_geojson_is_refused() {
    let crs = r#"{"type":"FeatureCollection","crs":{"type":"name","properties":{"name":"EPSG:2056"}},"features":[]}"#;
    for (text, part) in [
        ("", "EOF"),
        ("[]", "not a JSON object"),
        ("{}", "no features"),
        (r#"{"type":"FeatureCollection"}"#, "no features"),
        (crs, "EPSG:2056"),
    ] {
        let reason = LineFile::parse(text).unwrap_err();
        assert!(reason.contains(part), "{text}: {reason}");
    }
}

/// A track with elevations, one point of which is moved to a place without known heights.
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

/// RFC 7946, section 3.1.6: closed rings, the outer one counter-clockwise.
#[test]
fn areas_are_polygons_with_a_closed_ring() {
    let clockwise = vec![[0.0, 0.0], [0.0, 1.0], [1.0, 1.0]];
    let area = SavedLine {
        feature: None,
        shape: LineShape::Area,
        points_deg: clockwise,
        heights_m: Some(vec![1.0, 2.0, 3.0]),
    };
    let two = SavedLine { points_deg: vec![[0.0, 0.0], [1.0, 1.0]], ..area.clone() };
    let one = SavedLine { points_deg: vec![[0.0, 0.0]], ..area.clone() };
    let text = LineFile::default().text_with(&[area, two, one]);
    let written: Value = serde_json::from_str(&text).unwrap();
    let features = written["features"].as_array().unwrap();
    assert_eq!(features.len(), 2, "one point is dropped");
    assert_eq!(features[1]["geometry"]["type"], "LineString", "two points are not an area");
    let ring = json!([[1.0, 1.0, 3.0], [0.0, 1.0, 2.0], [0.0, 0.0, 1.0], [1.0, 1.0, 3.0]]);
    assert_eq!(features[0]["geometry"], json!({"type": "Polygon", "coordinates": [ring]}));
    let file = LineFile::parse(&text).unwrap();
    let points = vec![[1.0, 1.0], [0.0, 1.0], [0.0, 0.0]];
    assert_eq!(file.lines()[0], (0, LineShape::Area, points));
    // A point that is unchanged keeps its elevation, as an area and as a line.
    let mut lines = saved(&file);
    lines[0].points_deg[0] = [2.0, 0.5];
    for (shape, path) in [(LineShape::Area, "/coordinates/0"), (LineShape::Line, "/coordinates")] {
        lines[0].shape = shape;
        let again: Value = serde_json::from_str(&file.text_with(&lines)).unwrap();
        let positions = again["features"][0]["geometry"].pointer(path).unwrap();
        assert!(positions.as_array().unwrap().contains(&json!([0.0, 1.0, 2.0])), "{positions}");
    }
}

#[test]
fn areas_with_holes_stay_as_they_are() {
    let text =
        r#"{"type":"Polygon","coordinates":[[[0,0],[9,0],[9,9],[0,0]],[[5,2],[6,2],[6,3],[5,2]]]}"#;
    let file = LineFile::parse(text).unwrap();
    assert_eq!((file.lines().len(), file.others()), (0, 1));
}
