//! What the flights cost, side by side: the ablation of Agrawal et al. 2006, Table 1, the loss by roads, which Vaaraniemi,
//! Treib & Westermann 2011, section 7, give, and what caps cost.

use corniche_viewer::{FrameRecord, gpu::PassTimes};

use super::measured_run::MeasuredRun;
use crate::{
    args::Roads,
    info::or_dash,
    table::{Digits, Table, bytes},
};

/// `point_scale`: working metres to a true metre.
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

/// What was drawn.
fn drawn(runs: &[MeasuredRun], digits: Digits) -> String {
    let mut table = Table::new([
        "average, first frame left out",
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

/// Average speed of the eye over the ground, with all frames: the same flight is taken each time. `None` for a flight without
/// duration.
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

/// How long it took: from the first command until all is drawn, and by the graphics card's clock.
fn times(runs: &[MeasuredRun]) -> String {
    let mut table = Table::new([
        "milliseconds, first frame left out",
        "draw",
        "p50",
        "p95",
        "most",
        "per s",
        "card",
        "terrain",
        "areas",
        "roads",
        "bridges",
        "composite",
    ]);
    // Without areas, or bridges, there is no such pass, and nothing to tell of it.
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

/// Loss of frame rate by roads, where the same flight was taken without.
fn losses(runs: &[MeasuredRun]) -> Option<String> {
    let mut table = Table::new([
        "loss % of frame rate, first frame left out",
        "draw, total",
        "draw, mean of frames",
        "draw, most",
        "card, total",
        "card, mean of frames",
        "card, most",
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
    let explained = "draw: from the first command until all is drawn; card: by the graphics card's clock, terrain, areas, roads \
                     and composite\n\
                     total: 1 - (time of all frames without roads) / (time with roads), the loss of frames per second over the \
                     whole flight\n\
                     mean of frames: the mean of each frame's own loss, where a quick frame counts as much as a slow one; most: of \
                     a frame\n\
                     paper: Vaaraniemi, Treib & Westermann 2011, section 7: Utah, 1600 × 1200, Radeon HD 5870; GEO 26 % on average \
                     and 30 % at most, SV without caps 35 and 40 %, SV with caps 42 and 55 %\n";
    (!is_empty).then(|| table.to_text() + explained)
}

/// What caps cost in the roads pass, where the same flight was taken with and without.
fn costs_of_caps(runs: &[MeasuredRun]) -> Option<String> {
    let mut table = Table::new([
        "caps, roads pass, first frame left out",
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

/// Average time of the roads pass; `None` when a frame's is not known, or no frame counts.
fn roads_ms(run: &MeasuredRun) -> Option<f64> {
    let each: Option<Vec<f64>> =
        run.counted().iter().map(|frame| Some(frame.passes.as_ref()?.roads_ms)).collect();
    mean(each?.into_iter())
}

/// Average and most loss over the flight over Utah, percent.
fn of_paper(roads: Roads) -> Option<[u32; 2]> {
    match roads {
        Roads::Geo => Some([26, 30]),
        Roads::SvNoCaps => Some([35, 40]),
        Roads::Sv => Some([42, 55]),
        Roads::GeoNoCaps | Roads::None => None,
    }
}

/// Loss of frame rate against the same flight without roads, as shares.
#[derive(Debug, Clone, Copy)]
struct Loss {
    /// The share of the frames per second that is lost, over all frames together.
    total: f64,
    /// The mean of what each frame loses.
    mean: f64,
    /// The most that a frame loses.
    most: f64,
}

/// `None` when a frame's time is not known, or no frame counts.
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

/// The least value that is not below `percent` of all (nearest rank); 100 gives the most.
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
