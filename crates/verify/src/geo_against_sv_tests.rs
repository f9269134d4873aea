//! The check of GEO against SV finds a missing line, inside the tile only.

use corniche_geom::{GridFrame, NodeIndex, TileId};

use super::*;

fn place() -> TilePlace {
    let frame = GridFrame::new([0.0; 2], 1.0, NodeIndex { i: 0, j: 0 }, 0).unwrap();
    TilePlace::from_frame(&frame, TileId::ROOT)
}

#[test]
fn a_piece_without_a_line_is_found_and_only_inside_the_tile() {
    let line = [[-1000.0, -5000.0], [9000.0, -5000.0]];
    let lines = [[[7000.0, -5001.0], [3000.0, -5000.0]], [[0.0, -5000.0], [2000.0, -5000.0]]];
    let bare = bare_pieces(place(), line, lines.into_iter());
    assert_eq!(
        bare,
        [[[2000.0, -5000.0], [3000.0, -5000.0]], [[7000.0, -5000.0], [9000.0, -5000.0]]]
    );
}

#[test]
fn along_a_border_nothing_is_asked() {
    assert!(bare_pieces(place(), [[0.0, -10.0], [0.0, -9000.0]], std::iter::empty()).is_empty());
    assert_eq!(bare_pieces(place(), [[1.0, -10.0], [1.0, -9000.0]], std::iter::empty()).len(), 1);
}

#[test]
fn a_point_is_on_a_segment_and_not_beyond_its_end() {
    let segments = [[[0.0, 0.0], [100.0, 0.0]]];
    let segments = NearSegments::new(segments.to_vec());
    let is_on = |point| segments.is_on(point, 2.0, &StepBudget::unlimited());
    assert!(is_on([50.0, 1.5]) && is_on([101.0, 0.0]));
    assert!(!is_on([50.0, 2.5]) && !is_on([103.0, 0.0]));
}
