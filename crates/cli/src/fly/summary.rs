//! The costs of the flights, side by side: the ablation of Agrawal et al. 2006, Table 1, the
//! loss of frame rate by roads of Vaaraniemi, Treib & Westermann 2011, section 7, and the cost of
//! caps.

use corniche_viewer::{FrameRecord, gpu::PassTimes};

use super::measured_run::MeasuredRun;
use crate::{
    args::Roads,
    info::or_dash,
    table::{Digits, Table, bytes},
};

/// The summary; `point_scale` is the number of working metres per true metre.
pub(crate) fn to_text(runs: &[MeasuredRun], point_scale: f64, digits: Digits) -> String {
    let parts = [
        Some(drawn(runs, digits)),
        speed(runs, point_scale),
        Some(times(runs)),
        losses(runs),
        costs_of_caps(runs),
    ];
    parts.into_iter().flatten().collect::<Vec<_>>().join("\n")
}

/// The table of what was drawn.
fn drawn(runs: &[MeasuredRun], digits: Digits) -> String {
    let mut table = Table::new([
        "average, without first frame",
        "tiles",
        "missing",
        "triangles",
        "most",
        "segments",
        "most",
        "most memory",
    ]);
    for run in runs {
        let mean = |of: &dyn Fn(&FrameRecord) -> f64| mean(run.counted().iter().map(of));
        let whole = |of: &dyn Fn(&FrameRecord) -> f64| {
            mean(of).map_or_else(dash, |mean| digits.count(mean.round() as u64))
        };
        let most = |of: &dyn Fn(&FrameRecord) -> u64| run.counted().iter().map(of).max();
        let most_of = |of| most(of).map_or_else(dash, |most| digits.count(most));
        table.row([
            run.name(),
            whole(&|frame| frame.tiles_drawn as f64),
            or_dash(mean(&|frame| frame.tiles_missing as f64), 1),
            whole(&|frame| frame.triangles as f64),
            most_of(&|frame| frame.triangles),
            whole(&|frame| frame.road_segments as f64),
            most_of(&|frame| frame.road_segments),
            most(&|frame| frame.gpu_bytes).map_or_else(dash, bytes),
        ]);
    }
    table.to_text()
}

/// The average speed of the camera over the ground, of all frames, because every run is the same
/// flight. `None` for a flight without duration.
fn speed(runs: &[MeasuredRun], point_scale: f64) -> Option<String> {
    let frames = &runs.first()?.frames;
    let duration_s = frames.last()?.time_s - frames.first()?.time_s;
    let step_m = |pair: &[FrameRecord]| {
        let [from, to] = [pair[0].pose.eye_m, pair[1].pose.eye_m];
        let east_north_m = (to[0] - from[0]).hypot(to[1] - from[1]) / point_scale;
        east_north_m.hypot(to[2] - from[2])
    };
    let way_m: f64 = frames.windows(2).map(step_m).sum();
    (duration_s > 0.0).then(|| {
        format!(
            "average speed {:.0} m/s: {:.1} km in {duration_s:.1} s of flight\n",
            way_m / duration_s,
            way_m / 1000.0
        )
    })
}

/// The table of times: from the first command until everything is drawn, and by the GPU's clock.
fn times(runs: &[MeasuredRun]) -> String {
    let mut table = Table::new([
        "milliseconds, without first frame",
        "draw",
        "p50",
        "p95",
        "most",
        "per s",
        "GPU",
        "terrain",
        "areas",
        "roads",
        "bridges",
        "composite",
    ]);
    // Without areas, or bridges, their pass does not exist, and its column is omitted.
    let passes = runs.iter().flat_map(MeasuredRun::counted).filter_map(|frame| frame.passes);
    let has_areas = passes.clone().any(|passes| passes.areas_ms > 0.0);
    let has_decks = passes.clone().any(|passes| passes.decks_ms > 0.0);
    for run in runs {
        let draw_ms: Vec<f64> = run.counted().iter().map(|frame| frame.draw_ms).collect();
        let pass = |of: &dyn Fn(&PassTimes) -> f64| {
            let each: Option<Vec<f64>> =
                run.counted().iter().map(|frame| frame.passes.as_ref().map(of)).collect();
            two(each.and_then(|each| mean(each.into_iter())))
        };
        let average_ms = mean(draw_ms.iter().copied());
        table.row([
            run.name(),
            two(average_ms),
            two(percentile(&draw_ms, 50)),
            two(percentile(&draw_ms, 95)),
            two(percentile(&draw_ms, 100)),
            or_dash(average_ms.map(|ms| 1000.0 / ms), 1),
            pass(&PassTimes::total_ms),
            pass(&|passes| passes.terrain_ms),
            if has_areas { pass(&|passes| passes.areas_ms) } else { String::new() },
            pass(&|passes| passes.roads_ms),
            if has_decks { pass(&|passes| passes.decks_ms) } else { String::new() },
            pass(&|passes| passes.composite_ms),
        ]);
    }
    table.without_empty_columns().to_text()
}

/// The table of the loss of frame rate by roads, if the same flight was also flown without roads.
fn losses(runs: &[MeasuredRun]) -> Option<String> {
    let mut table = Table::new([
        "loss % of frame rate, without first frame",
        "draw, total",
        "draw, mean of frames",
        "draw, most",
        "GPU, total",
        "GPU, mean of frames",
        "GPU, most",
        "paper",
        "paper, most",
    ]);
    let mut is_empty = true;
    for run in runs.iter().filter(|run| run.roads != Roads::None) {
        let bare = runs.iter().find(|bare| bare.lod == run.lod && bare.roads == Roads::None);
        let Some(bare) = bare else { continue };
        let cells = |loss: Option<Loss>| {
            let shares = loss.map(|Loss { total, mean, most }| [total, mean, most].map(percent));
            shares.unwrap_or_else(|| [dash(), dash(), dash()])
        };
        let [draw, draw_mean, draw_most] = cells(loss(run, bare, |frame| Some(frame.draw_ms)));
        let [card, card_mean, card_most] =
            cells(loss(run, bare, |frame| frame.passes.as_ref().map(PassTimes::total_ms)));
        let [paper, paper_most] = of_paper(run.roads)
            .map_or_else(|| [dash(), dash()], |percent| percent.map(|p| p.to_string()));
        table.row([
            run.name(),
            draw,
            draw_mean,
            draw_most,
            card,
            card_mean,
            card_most,
            paper,
            paper_most,
        ]);
        is_empty = false;
    }
    let explained = "draw: from the first command until all is drawn; GPU: by the GPU's clock, for terrain, areas, roads \
                     and composite\n\
                     total: 1 - (time of all frames without roads) / (time with roads), the loss of frames per second over the \
                     whole flight\n\
                     mean of frames: the mean of the losses of single frames, with equal weights for fast and slow ones; most: of \
                     a single frame\n\
                     paper: Vaaraniemi, Treib & Westermann 2011, section 7: Utah, 1600 × 1200, Radeon HD 5870; GEO 26 % on average \
                     and 30 % at most, SV without caps 35 and 40 %, SV with caps 42 and 55 %\n";
    (!is_empty).then(|| table.to_text() + explained)
}

/// The table of the cost of caps in the roads pass, if the same flight was flown with and without
/// caps.
fn costs_of_caps(runs: &[MeasuredRun]) -> Option<String> {
    let mut table = Table::new([
        "caps, roads pass, without first frame",
        "ms with",
        "ms without",
        "share of caps %",
    ]);
    let mut is_empty = true;
    for run in runs.iter().filter(|run| run.roads != run.roads.without_caps()) {
        let without = run.roads.without_caps();
        let bare = runs.iter().find(|bare| bare.lod == run.lod && bare.roads == without);
        let Some(bare) = bare else { continue };
        let [with_ms, without_ms] = [run, bare].map(roads_ms);
        let share = with_ms.zip(without_ms).filter(|(with_ms, _)| *with_ms > 0.0);
        table.row([
            run.name(),
            two(with_ms),
            two(without_ms),
            share.map_or_else(dash, |(with_ms, without_ms)| percent(1.0 - without_ms / with_ms)),
        ]);
        is_empty = false;
    }
    (!is_empty).then(|| table.to_text())
}

/// The average time of the roads pass; `None` if the time of a frame is unknown, or no frame
/// counts.
fn roads_ms(run: &MeasuredRun) -> Option<f64> {
    let each: Option<Vec<f64>> =
        run.counted().iter().map(|frame| Some(frame.passes.as_ref()?.roads_ms)).collect();
    mean(each?.into_iter())
}

/// The average and the largest loss of the flight over Utah, percent.
fn of_paper(roads: Roads) -> Option<[u32; 2]> {
    match roads {
        Roads::Geo => Some([26, 30]),
        Roads::SvNoCaps => Some([35, 40]),
        Roads::Sv => Some([42, 55]),
        Roads::GeoNoCaps | Roads::None => None,
    }
}

/// The loss of frame rate compared with the same flight without roads, as fractions.
#[derive(Debug, Clone, Copy)]
struct Loss {
    /// The fraction of the frames per second that is lost, over all frames together.
    total: f64,
    /// The mean of the losses of single frames.
    mean: f64,
    /// The largest loss of a frame.
    most: f64,
}

/// Returns `None` if the time of a frame is unknown, or no frame counts.
fn loss(
    run: &MeasuredRun,
    bare: &MeasuredRun,
    time_ms: impl Fn(&FrameRecord) -> Option<f64>,
) -> Option<Loss> {
    let pairs: Option<Vec<[f64; 2]>> = run
        .counted()
        .iter()
        .zip(bare.counted())
        .map(|(with, without)| Some([time_ms(with)?, time_ms(without)?]))
        .collect();
    let pairs = pairs?;
    let sum = |which: usize| pairs.iter().map(|pair| pair[which]).sum::<f64>();
    let each = pairs.iter().map(|[with_ms, without_ms]| 1.0 - without_ms / with_ms);
    Some(Loss {
        total: 1.0 - sum(1) / sum(0),
        mean: mean(each.clone())?,
        most: each.reduce(f64::max)?,
    })
}

fn percent(share: f64) -> String {
    format!("{:.1}", share * 100.0)
}

fn mean(values: impl Iterator<Item = f64>) -> Option<f64> {
    let (sum, count) = values.fold((0.0, 0.0), |(sum, count), value| (sum + value, count + 1.0));
    (count > 0.0).then_some(sum / count)
}

/// The smallest value that is not below `percent` of all (nearest rank); 100 returns the maximum.
fn percentile(values: &[f64], percent: usize) -> Option<f64> {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let rank = (sorted.len() * percent).div_ceil(100).max(1);
    sorted.get(rank - 1).copied()
}

fn two(value: Option<f64>) -> String {
    or_dash(value, 2)
}

fn dash() -> String {
    "–".to_owned()
}

#[cfg(test)]
#[path = "summary_tests.rs"]
mod tests;
