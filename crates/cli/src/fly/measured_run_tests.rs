//! A flight whose frames show less than requested is reported.

use corniche_viewer::{camera::Orientation, flight::Pose, gpu::PassTimes};

use super::*;

/// A frame with this drawing time; 3.5 ms of it on the GPU.
pub(crate) fn frame(draw_ms: f64) -> FrameRecord {
    FrameRecord {
        frame: 4,
        time_s: 1.5,
        pose: Pose {
            eye_m: [1.0, 2.0, 3.0],
            orientation: Orientation { heading_deg: 45.0, pitch_deg: 65.0 },
        },
        tiles_drawn: 7,
        tiles_loaded: 0,
        tiles_uploaded: 0,
        tiles_evicted: 0,
        tiles_missing: 0,
        triangles: 1000,
        road_segments: 10,
        gpu_bytes: 5000,
        select_ms: 0.0,
        decode_ms: 0.0,
        upload_ms: 0.0,
        draw_ms,
        passes: Some(PassTimes {
            terrain_ms: 1.0,
            roads_ms: 2.0,
            composite_ms: 0.5,
            ..PassTimes::default()
        }),
    }
}

/// A flight whose frames have these times; the first one, which does not count, takes longest.

#[test]
fn flights_that_show_less_than_they_seem_to_say_so() {
    let run = |frames| MeasuredRun { lod: Detail::Adaptive, roads: Roads::Geo, frames };
    let whole = FrameRecord { triangles: 10, tiles_missing: 0, ..frame(1.0) };
    let coarse = FrameRecord { tiles_missing: 3, ..whole };
    let empty = FrameRecord { triangles: 0, ..whole };
    assert_eq!(run(vec![whole, empty]).doubt(), None);
    assert!(run(vec![empty, empty]).doubt().unwrap().contains("no frame shows any ground"));
    assert!(run(vec![whole, coarse]).doubt().unwrap().contains("1 of 2 frames"));
}
