//! What the flights cost, side by side: the ablation of Agrawal et al. 2006, Table 1, and the loss by roads as
//! Vaaraniemi, Treib & Westermann 2011, section 7, give it.

use std::fmt::Write as _;

use corniche_viewer::FrameRecord;

use super::measured_run::{MeasuredRun, gpu_ms};
use crate::{
    args::Roads,
    table::{Digits, Table, bytes},
};

pub(crate) fn to_text(runs: &[MeasuredRun], digits: Digits) -> String {
    let mut text = drawn(runs, digits);
    text.push('\n');
    text.push_str(&times(runs));
    let losses = losses(runs);
    if !losses.is_empty() {
        let _ = write!(text, "\n{losses}");
    }
    text
}

/// What was drawn.
fn drawn(runs: &[MeasuredRun], digits: Digits) -> String {
    let mut table = Table::new([
        "average, first frame left out",
        "tiles",
        "missing",
        "triangles",
        "segments",
        "most memory",
    ]);
    for run in runs {
        let mean = |of: &dyn Fn(&FrameRecord) -> f64| mean(run.counted().iter().map(of));
        let whole = |of: &dyn Fn(&FrameRecord) -> f64| {
            mean(of).map_or_else(dash, |mean| digits.count(mean.round() as u64))
        };
        let most_bytes = run.counted().iter().map(|frame| frame.gpu_bytes).max();
        table.row([
            run.name(),
            whole(&|frame| frame.tiles_drawn as f64),
            mean(&|frame| frame.tiles_missing as f64).map_or_else(dash, |m| format!("{m:.1}")),
            whole(&|frame| frame.triangles as f64),
            whole(&|frame| frame.road_segments as f64),
            most_bytes.map_or_else(dash, bytes),
        ]);
    }
    table.to_text()
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
        "roads",
        "composite",
    ]);
    for run in runs {
        let draw_ms: Vec<f64> = run.counted().iter().map(|frame| frame.draw_ms).collect();
        let pass = |of: &dyn Fn(&corniche_viewer::gpu::PassTimes) -> f64| {
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
            average_ms.map_or_else(dash, |ms| format!("{:.1}", 1000.0 / ms)),
            pass(&gpu_ms),
            pass(&|passes| passes.terrain_ms),
            pass(&|passes| passes.roads_ms),
            pass(&|passes| passes.composite_ms),
        ]);
    }
    table.to_text()
}

/// Loss of frame rate by roads, where the same flight was taken without; else nothing.
fn losses(runs: &[MeasuredRun]) -> String {
    let mut table = Table::new([
        "loss % of frame rate, first frame left out",
        "draw",
        "most",
        "card",
        "most",
        "paper",
        "most",
    ]);
    let mut is_empty = true;
    for run in runs.iter().filter(|run| run.roads != Roads::None) {
        let bare = runs.iter().find(|bare| bare.lod == run.lod && bare.roads == Roads::None);
        let Some(bare) = bare else { continue };
        let percent = |shares: Option<[f64; 2]>| {
            shares.map_or_else(|| [dash(), dash()], |s| s.map(|s| format!("{:.1}", s * 100.0)))
        };
        let [draw, draw_most] = percent(loss(run, bare, |frame| Some(frame.draw_ms)));
        let [card, card_most] = percent(loss(run, bare, |frame| frame.passes.as_ref().map(gpu_ms)));
        let [paper, paper_most] = of_paper(run.roads)
            .map_or_else(|| [dash(), dash()], |percent| percent.map(|p| p.to_string()));
        table.row([run.name(), draw, draw_most, card, card_most, paper, paper_most]);
        is_empty = false;
    }
    if is_empty {
        return String::new();
    }
    let mut text = table.to_text();
    text.push_str(
        "draw: from the first command until all is drawn; card: by the graphics card's clock, terrain, roads and \
         composite; each on average and at most\n\
         paper: Vaaraniemi, Treib & Westermann 2011, section 7: Utah, 1600 × 1200, Radeon HD 5870; GEO 26 % on average \
         and 30 % at most, SV without caps 35 and 40 %, SV with caps 42 and 55 %\n",
    );
    text
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

/// Loss of frame rate against the same flight without roads, average and most over the frames, as shares; `None` when a
/// frame's time is not known, or no frame counts.
fn loss(
    run: &MeasuredRun,
    bare: &MeasuredRun,
    time_ms: impl Fn(&FrameRecord) -> Option<f64>,
) -> Option<[f64; 2]> {
    let each: Option<Vec<f64>> = run
        .counted()
        .iter()
        .zip(bare.counted())
        .map(|(with, without)| Some(1.0 - time_ms(without)? / time_ms(with)?))
        .collect();
    let each = each?;
    let most = each.iter().copied().reduce(f64::max)?;
    Some([mean(each.into_iter())?, most])
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
    value.map_or_else(dash, |value| format!("{value:.2}"))
}

fn dash() -> String {
    "–".to_owned()
}

#[cfg(test)]
#[path = "summary_tests.rs"]
mod tests;
