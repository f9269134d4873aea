//! A session reports the fields that pages know, and records no flight from above.

use corniche_styles::Style;
use corniche_viewer::{RoadMethod, RoadOptions};

use super::*;
use crate::{
    map_canvas::SceneCounts,
    polled_loader::{PolledLoader, late_package},
    session_json::FrameRest,
    style_list::NamedStyle,
    views::first_view,
};

const SIZE_PX: [u32; 2] = [640, 480];

fn session() -> Session {
    let package = late_package(corniche_testing::package::written());
    let manifest = package.manifest();
    let heights_m = [0.0, 1000.0];
    let extent = MapExtent::of_data(manifest.data_bounds, heights_m);
    let ground = SightedGround { extent, heights_m, at_place_m: None };
    let scale = manifest.point_scale;
    let home = first_view(CameraRequest::Overview, manifest, ground, scale, SIZE_PX, 0).unwrap();
    let atlas = NamedStyle { name: "road-atlas".to_owned(), style: Style::road_atlas() };
    Session::new(SessionStart {
        loader: Box::new(PolledLoader::new(&package)),
        package,
        height_range_m: heights_m,
        home,
        settings: MapSettings::usual(RoadOptions::for_method(RoadMethod::Geometry)),
        styles: StyleList::new(vec![atlas], None),
        budget: StreamBudget {
            tiles_in_flight: 8,
            upload_bytes_per_frame: 1 << 20,
            gpu_bytes: 1 << 24,
        },
        size_px: SIZE_PX,
        pixels_per_point: 1.0,
        has_inertia: false,
    })
}

/// The names are those of `FrameReport` in the types of the page; it adds requests, bytes and
/// notices.
#[test]
fn a_report_has_the_names_that_pages_know() {
    let rest = FrameRest { is_busy: false, troubled: 0 };
    let (report, is_settled) = session().report(SceneCounts::default(), rest, 1.0, 0.0);
    assert!(is_settled && report["next"] == "asked" && report["mode"] == "map", "{report}");
    let mut names: Vec<&String> = report.as_object().unwrap().keys().collect();
    names.sort();
    let expected = [
        "cursor",
        "gpu_bytes",
        "is_playing",
        "is_settled",
        "metres_per_pixel",
        "metres_per_point",
        "mode",
        "next",
        "progress",
        "recording_s",
        "segments",
        "tiles",
        "triangles",
        "view",
    ];
    assert_eq!(names, expected);
    let busy = FrameRest { is_busy: true, ..rest };
    let (report, is_settled) = session().report(SceneCounts::default(), busy, 1.0, 0.0);
    assert!(!is_settled && report["next"] == "now");
}

#[test]
fn no_flight_is_recorded_from_above() {
    let mut session = session();
    assert!(session.toggle_above(1.0));
    assert!(session.camera.view().from_above.is_some());
    assert!(!session.start_recording(2.0));
    assert!(session.toggle_above(3.0));
    assert!(session.start_recording(4.0));
    assert!(!session.toggle_above(5.0), "while a flight is recorded");
    assert!(session.camera.view().from_above.is_none());
    assert_eq!(session.flights.recording_s(6.0), Some(2.0));
}

#[test]
fn heights_that_grow_keep_the_camera_over_the_same_ground() {
    let mut session = session();
    let before = session.camera.view().eye_in_world;
    let twice = MapSettings { exaggeration: 2.0, ..session.settings.clone() };
    session.change(twice);
    let after = session.camera.view().eye_in_world;
    assert_eq!(before.truncate(), after.truncate());
    assert!(after.z > before.z);
}
