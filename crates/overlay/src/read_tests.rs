//! Lines and outlines are read in the order of their file.

use std::{fs, path::PathBuf};

use corniche_gis::VectorError;

use super::*;
use crate::LineFile;

fn written(folder: &Path, name: &str, text: &str) -> PathBuf {
    let path = folder.join(name);
    fs::write(&path, text).unwrap();
    path
}

const GEOJSON: &str = r#"{"type":"FeatureCollection","features":[
 {"type":"Feature","properties":{"name":"one"},"geometry":{"type":"LineString","coordinates":[[9.5,47.1],[9.6,47.2]]}},
 {"type":"Feature","properties":{},"geometry":{"type":"MultiLineString","coordinates":[[[9,47],[9,48]],[[8,47],[8,48],[8,49]]]}},
 {"type":"Feature","properties":{},"geometry":{"type":"Point","coordinates":[9,47]}},
 {"type":"Feature","properties":{},"geometry":null},
 {"type":"Feature","properties":{"name":"two"},"geometry":{"type":"Polygon","coordinates":[[[0,0],[4,0],[4,4],[0,0]],[[1,0.5],[2,0.5],[2,1],[1,0.5]]]}}
]}"#;

#[test]
fn lines_and_outlines_come_in_the_order_of_the_file() {
    let folder = tempfile::tempdir().unwrap();
    let found = read(&written(folder.path(), "a.geojson", GEOJSON), false).unwrap();
    let counts: Vec<usize> = found.lines.iter().map(|line| line.positions_deg.len()).collect();
    assert_eq!(counts, [2, 2, 3, 4, 4]);
    assert_eq!(found.others, 1, "the point");
    let names: Vec<_> = found.lines.iter().map(|line| line.name.as_deref()).collect();
    assert_eq!(names, [Some("one"), None, None, Some("two"), Some("two")]);
    let [lon, lat] = found.lines[0].positions_deg[1];
    assert!((lon - 9.6).abs() < 1e-12 && (lat - 47.2).abs() < 1e-12, "{lon}, {lat}");
}

/// GDAL also provides the points of a track in a separate layer.
#[test]
fn a_track_of_gpx_is_one_line() {
    let folder = tempfile::tempdir().unwrap();
    let text = r#"<?xml version="1.0"?><gpx version="1.1" creator="t" xmlns="http://www.topografix.com/GPX/1/1">
      <wpt lat="47" lon="9"><name>hut</name></wpt>
      <trk><name>up</name><trkseg><trkpt lat="47.0" lon="9.0"/><trkpt lat="47.1" lon="9.1"/></trkseg></trk></gpx>"#;
    let found = read(&written(folder.path(), "a.gpx", text), false).unwrap();
    assert_eq!((found.lines.len(), found.others), (1, 1));
    assert_eq!(found.lines[0].name.as_deref(), Some("up"));
}

/// One line as a route and as a track, as planners save it: the first time exactly the same, the
/// second time with fewer points.
#[test]
fn a_line_that_counts_twice_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let gpx = |route: &str| {
        let track = r#"<trkpt lat="47.0" lon="9.0"/><trkpt lat="47.05" lon="9.02"/><trkpt lat="47.1" lon="9.1"/>"#;
        format!(
            r#"<?xml version="1.0"?><gpx version="1.1" creator="t" xmlns="http://www.topografix.com/GPX/1/1">
            {route}<trk><trkseg>{track}</trkseg></trk></gpx>"#
        )
    };
    let notices = |name: &str, text: &str| {
        let found = read(&written(folder.path(), name, text), false).unwrap();
        (found.lines.len(), found.notices())
    };
    let same = r#"<rte><rtept lat="47.0" lon="9.0"/><rtept lat="47.05" lon="9.02"/><rtept lat="47.1" lon="9.1"/></rte>"#;
    let (lines, told) = notices("same.gpx", &gpx(same));
    assert_eq!((lines, told.len()), (2, 2), "{told:?}");
    assert!(
        told[0].contains("routes (1) and tracks (1)") && told[0].contains("ogr2ogr"),
        "{told:?}"
    );
    assert!(told[1].starts_with("1 of its lines"), "{told:?}");
    let coarse = r#"<rte><rtept lat="47.0" lon="9.0"/><rtept lat="47.1" lon="9.1"/></rte>"#;
    assert_eq!(notices("coarse.gpx", &gpx(coarse)).1.len(), 1);
    assert_eq!(notices("track.gpx", &gpx("")), (1, Vec::new()));
    // There and back on the same points, in any format.
    let line = |points: &str| {
        format!(
            r#"{{"type":"Feature","properties":{{}},"geometry":{{"type":"LineString","coordinates":{points}}}}}"#
        )
    };
    let both = [line("[[9,47],[9.1,47.2]]"), line("[[9.1,47.2],[9,47]]")].join(",");
    let both = format!(r#"{{"type":"FeatureCollection","features":[{both}]}}"#);
    let told = notices("both.geojson", &both).1;
    assert!(told.len() == 1 && told[0].starts_with("1 of its lines"), "{told:?}");
    assert_eq!(
        notices("a.geojson", GEOJSON).1,
        ["1 features are neither lines nor polygons and are skipped"]
    );
}

#[test]
fn what_gives_no_lines_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let told = |name: &str, text: &str| {
        read(&written(folder.path(), name, text), false).unwrap_err().to_string()
    };
    let point = r#"{"type":"Point","coordinates":[9,47]}"#;
    assert!(told("point.geojson", point).contains("no lines and no polygons, but 1 other"));
    assert!(told("no.geojson", "{}").contains("not a vector file"));
    assert!(told("half.geojson", &GEOJSON[..300]).contains("half.geojson"));
    assert!(told("empty.gpx", "").contains("not a vector file"));
    let missing = read(&folder.path().join("missing.gpx"), false).unwrap_err();
    assert!(matches!(missing, OverlayError::Vector(VectorError::Missing { .. })), "{missing}");
}

/// A file may have exactly the largest number of points; one more is rejected, also when drawn
/// lines are read again.
#[test]
fn a_file_has_a_million_points_at_most() {
    let folder = tempfile::tempdir().unwrap();
    let file = |points: usize| {
        let text = "[9,47],".repeat(points - 1) + "[9,48]";
        let text = format!(r#"{{"type":"LineString","coordinates":[{text}]}}"#);
        written(folder.path(), "a.geojson", &text)
    };
    assert_eq!(MOST_POINTS, 1 << 20);
    let most = file(MOST_POINTS);
    assert_eq!(read(&most, false).unwrap().lines[0].positions_deg.len(), MOST_POINTS);
    let more = file(MOST_POINTS + 1);
    for refused in [read(&more, false).map(drop), LineFile::read(&more).map(drop)] {
        let Err(OverlayError::TooManyPoints { path, limit }) = refused else {
            panic!("it is read: {refused:?}")
        };
        assert_eq!((path, limit), (more.clone(), MOST_POINTS));
    }
}
