//! What the flights cost, side by side: the ablation of Agrawal et al. 2006, Table 1, and the loss by roads as
//! Vaaraniemi, Treib & Westermann 2011, section 7, give it.

use corniche_viewer::FrameRecord;

use super::Run;
use crate::{
    args::Roads,
    table::{Table, bytes, count},
};

pub(super) fn to_text(runs: &[Run]) -> String {
    let mut table = Table::new([
        "average per frame",
        "tiles",
        "missing",
        "triangles",
        "segments",
        "draw ms",
        "most ms",
        "per s",
        "terrain ms",
        "roads ms",
        "composite ms",
        "most memory",
        "loss %",
        "most %",
    ]);
    for run in runs {
        let mean = |of: &dyn Fn(&FrameRecord) -> f64| mean(run.frames.iter().map(of));
        let whole = |of: &dyn Fn(&FrameRecord) -> f64| count(mean(of).round() as u64);
        let pass = |of: &dyn Fn(&corniche_viewer::gpu::PassTimes) -> f64| {
            let times: Option<Vec<f64>> =
                run.frames.iter().map(|frame| frame.passes.as_ref().map(of)).collect();
            times.map_or_else(dash, |times| format!("{:.2}", self::mean(times.into_iter())))
        };
        let draw_ms = mean(&|frame| frame.draw_ms);
        let most_ms = run.frames.iter().map(|frame| frame.draw_ms).fold(0.0, f64::max);
        let most_bytes = run.frames.iter().map(|frame| frame.gpu_bytes).max().unwrap_or(0);
        let bare = runs.iter().find(|bare| bare.lod == run.lod && bare.roads == Roads::None);
        let losses = bare.filter(|_| run.roads != Roads::None).map(|bare| losses(run, bare));
        let percent = |share: Option<f64>| share.map_or_else(dash, |s| format!("{:.1}", s * 100.0));
        table.row([
            run.name(),
            whole(&|frame| frame.tiles_drawn as f64),
            format!("{:.1}", mean(&|frame| frame.tiles_missing as f64)),
            whole(&|frame| frame.triangles as f64),
            whole(&|frame| frame.road_segments as f64),
            format!("{draw_ms:.2}"),
            format!("{most_ms:.2}"),
            format!("{:.1}", 1000.0 / draw_ms),
            pass(&|passes| passes.terrain_ms),
            pass(&|passes| passes.roads_ms),
            pass(&|passes| passes.composite_ms),
            bytes(most_bytes),
            percent(losses.map(|[average, _]| average)),
            percent(losses.map(|[_, most]| most)),
        ]);
    }
    table.to_text()
}

/// Loss of frame rate against the same flight without roads, average and most over the frames, as shares.
fn losses(run: &Run, bare: &Run) -> [f64; 2] {
    let each = || {
        run.frames
            .iter()
            .zip(&bare.frames)
            .map(|(with, without)| 1.0 - without.draw_ms / with.draw_ms)
    };
    [mean(each()), each().fold(f64::NEG_INFINITY, f64::max)]
}

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0.0), |(sum, count), value| (sum + value, count + 1.0));
    sum / count
}

fn dash() -> String {
    "–".to_owned()
}

#[cfg(test)]
pub(super) mod tests {
    use corniche_viewer::{camera::Orientation, flight::Pose, gpu::PassTimes};

    use super::*;
    use crate::args::Lod;

    pub(in crate::fly) fn frame(draw_ms: f64) -> FrameRecord {
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
            passes: Some(PassTimes { terrain_ms: 1.0, roads_ms: 2.0, composite_ms: 0.5 }),
        }
    }

    #[test]
    fn losses_are_of_frame_rates_and_against_the_same_tiles_without_roads() {
        let run = |lod, roads, times: [f64; 2]| Run { lod, roads, frames: times.map(frame).into() };
        let runs = [
            run(Lod::Adaptive, Roads::None, [6.0, 8.0]),
            run(Lod::Adaptive, Roads::Geo, [8.0, 10.0]),
            run(Lod::Full, Roads::Geo, [100.0, 100.0]),
        ];
        // 6 of 8 ms are left, so a quarter of the frames is lost; then a fifth.
        let [average, most] = losses(&runs[1], &runs[0]);
        assert!((average - 0.225).abs() < 1e-12 && (most - 0.25).abs() < 1e-12);
        let text = to_text(&runs);
        let cells = |line: usize| -> Vec<&str> {
            text.lines()
                .nth(line)
                .unwrap()
                .split("  ")
                .filter(|c| !c.is_empty())
                .map(str::trim)
                .collect()
        };
        assert_eq!(cells(2)[0], "lod, roads geo");
        assert_eq!(cells(2)[5..8], ["9.00", "10.00", "111.1"]);
        assert_eq!(cells(2)[12..], ["22.5", "25.0"]);
        for without in [1, 3] {
            assert_eq!(cells(without)[12..], ["–", "–"], "{text}");
        }
    }
}
