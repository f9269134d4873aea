//! Every line of the table of frames has every column.

use corniche_viewer::Detail;

use super::*;
use crate::{args::Roads, fly::measured_run::tests::frame};

#[test]
fn every_line_has_every_column() {
    let mut clockless = frame(8.0);
    clockless.passes = None;
    let runs = [MeasuredRun {
        lod: Detail::Culled,
        roads: Roads::Sv,
        frames: vec![frame(3.0), clockless],
    }];
    let csv = to_csv(&runs);
    let lines: Vec<&str> = csv.lines().collect();
    assert_eq!(lines.len(), 3);
    for line in &lines {
        assert_eq!(line.split(',').count(), 26, "{line}");
    }
    assert!(lines[1].starts_with("culled,sv,4,1.5000,1.000,2.000,3.000,45.000,65.000,7,"), "{csv}");
    assert!(lines[1].ends_with(",3.000,1.000,0.000,2.000,0.500,0.000"), "{csv}");
    assert!(lines[2].ends_with(",8.000,,,,,"), "{csv}");
}
