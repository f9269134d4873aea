//! The table of frames: one line per frame and run. Milliseconds are in the last columns,
//! because all other columns are the same in each run of the program.

use std::fmt::Write as _;

use super::measured_run::MeasuredRun;

const HEADINGS: &str = "lod,roads,frame,time_s,x_m,y_m,height_m,heading_deg,pitch_deg,tiles_drawn,tiles_loaded,\
tiles_uploaded,tiles_evicted,tiles_missing,triangles,road_segments,gpu_bytes,select_ms,decode_ms,upload_ms,draw_ms,\
terrain_ms,areas_ms,roads_ms,composite_ms,bridges_ms\n";

/// Writes the table as CSV. Times of passes are empty if the adapter has no clock.
pub(crate) fn to_csv(runs: &[MeasuredRun]) -> String {
    let mut text = HEADINGS.to_owned();
    for run in runs {
        let [lod, roads] = run.words();
        for frame in &run.frames {
            let [x, y, height_m] = frame.pose.eye_m;
            // Writing to a string cannot fail.
            let _ = write!(
                text,
                "{lod},{roads},{},{:.4},{x:.3},{y:.3},{height_m:.3},{:.3},{:.3},{},{},{},{},{},{},{},{},{:.3},{:.3},{:.3},{:.3}",
                frame.frame,
                frame.time_s,
                frame.pose.orientation.heading_deg,
                frame.pose.orientation.pitch_deg,
                frame.tiles_drawn,
                frame.tiles_loaded,
                frame.tiles_uploaded,
                frame.tiles_evicted,
                frame.tiles_missing,
                frame.triangles,
                frame.road_segments,
                frame.gpu_bytes,
                frame.select_ms,
                frame.decode_ms,
                frame.upload_ms,
                frame.draw_ms,
            );
            let _ = match frame.passes {
                Some(passes) => writeln!(
                    text,
                    ",{:.3},{:.3},{:.3},{:.3},{:.3}",
                    passes.terrain_ms,
                    passes.areas_ms,
                    passes.roads_ms,
                    passes.composite_ms,
                    passes.decks_ms
                ),
                None => writeln!(text, ",,,,,"),
            };
        }
    }
    text
}

#[cfg(test)]
#[path = "list_tests.rs"]
mod tests;
