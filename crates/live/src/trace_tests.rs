//! Every line of the trace has a value for every column.

use corniche_viewer::camera::Orientation;

use super::*;

#[test]
fn every_line_has_a_cell_for_every_column() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("trace.csv");
    let mut trace = Trace::begin(Box::new(std::fs::File::create(&path).unwrap())).unwrap();
    let orientation = Orientation { heading_deg: -10.0, pitch_deg: 45.0 };
    let line = TraceLine {
        frame: 7,
        cursor_px: None,
        ground_m: None,
        pixel_m: None,
        pose: Pose { eye_m: [1.0, 2.0, 3.0], orientation },
        tiles: 4,
        missing: 5,
        loading: 6,
        is_moving: false,
        size_px: [320, 240],
    };
    trace.write(line).unwrap();
    let ground = TraceLine {
        cursor_px: Some(DVec2::new(10.5, 20.0)),
        ground_m: Some([2_600_000.123_4, 1.0, 455.5]),
        pixel_m: Some(0.25),
        ..line
    };
    trace.write(ground).unwrap();
    let text = std::fs::read_to_string(&path).unwrap();
    let lines: Vec<Vec<&str>> = text.lines().map(|line| line.split(',').collect()).collect();
    assert_eq!(lines.len(), 3);
    assert!(lines.iter().all(|cells| cells.len() == lines[0].len()), "{text}");
    assert_eq!(lines[1][..4], ["7", "", "", ""]);
    assert_eq!(lines[2][..4], ["7", "10.50", "20.00", "2600000.123"]);
    assert_eq!(lines[2][lines[0].iter().position(|name| *name == "missing").unwrap()], "5");
}
