//! The parts of a build as jobs, with their costs and dependencies.

use std::cmp::Reverse;

use corniche_osm::Share;
use corniche_plan::rates;
use serde::Serialize;

use super::tile_costs::{Subtree, TileCosts, tiles_above};
use crate::parts::step::PartStep;

/// Each slot gets at least this many parts: since the largest jobs start first, all slots then end
/// at nearly the same time.
const PARTS_PER_SLOT: u64 = 8;
/// The name of the step that writes the package.
const MERGE: &str = "merge";

/// A part of a build, for a scheduler.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Job {
    /// Step and subtree or share, such as "tiles-2-1-3". It is unique among the jobs of a plan.
    pub id: String,
    /// Name of the step; "merge" for the last job.
    pub step: &'static str,
    /// Subtree as z/x/y, if the step has subtrees.
    pub subtree: Option<String>,
    /// Share as I/N, if the step has shares.
    pub share: Option<String>,
    /// Estimated time on one core, seconds.
    pub work: f64,
    /// Names of the steps whose jobs must all be done before this one.
    pub after: Vec<&'static str>,
    /// Arguments of `corniche part` after plan and stores; for the merge, of `corniche merge`.
    pub args: Vec<String>,
}

/// The cost of a build, microseconds of one core, without the start of processes.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct BuildCosts {
    pub hashes_us: u64,
    /// Cost of the extract; `None` without an extract.
    pub extract: Option<ExtractCosts>,
    /// Cost of heights; `None` if the terrain comes from a package and there are no photos.
    pub heights: Option<TileCosts>,
    pub tiles: TileCosts,
    /// Cost of summing up and copying all tiles.
    pub merge_us: u64,
    /// Cost of starting a process and opening the inputs.
    pub start_us: u64,
}

/// The cost of reading an extract, microseconds of one core.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct ExtractCosts {
    /// The useful number of shares; with 1 the step *roads* reads the extract itself.
    pub shares: u16,
    /// Cost of both passes.
    pub ways_us: u64,
    pub nodes_us: u64,
    /// Cost of all later work.
    pub roads_us: u64,
}

impl ExtractCosts {
    fn jobs(&self, start_us: u64) -> Vec<Job> {
        let &Self { shares, ways_us, nodes_us, roads_us } = self;
        if shares < 2 {
            return vec![whole(
                PartStep::Roads,
                ways_us + nodes_us + roads_us + start_us,
                Vec::new(),
            )];
        }
        let of_shares = |step: PartStep, cost_us: u64, after: &[&'static str]| -> Vec<Job> {
            let work_us = cost_us / u64::from(shares) + start_us;
            Share::all(shares).map(|share| of_share(step, share, work_us, after)).collect()
        };
        let mut jobs = of_shares(PartStep::Ways, ways_us, &[]);
        jobs.extend(of_shares(PartStep::Nodes, nodes_us, &[PartStep::Ways.name()]));
        let after = [PartStep::Ways, PartStep::Nodes].map(PartStep::name).to_vec();
        jobs.push(whole(PartStep::Roads, roads_us + start_us, after));
        jobs
    }
}

impl BuildCosts {
    /// No part is smaller than this unless necessary: too much of its time would be the start of
    /// its process.
    pub(crate) fn least_us(&self) -> u64 {
        self.start_us.saturating_mul(rates::PART_WORTH_STARTS)
    }
}

/// Returns all jobs: those of a step after those it depends on, and the largest job of a step
/// first. Subtrees are split until none costs more than its part of the work for `slots` slots, or
/// than `least_us`.
pub(crate) fn list(costs: &BuildCosts, slots: u32, least_us: u64) -> Vec<Job> {
    let most_us = |all: &TileCosts| {
        let parts = PARTS_PER_SLOT.saturating_mul(u64::from(slots)).max(1);
        (all.total_us() / parts).max(least_us)
    };
    let start_us = costs.start_us;
    let mut jobs = vec![whole(PartStep::Hashes, costs.hashes_us + start_us, Vec::new())];
    jobs.extend(costs.extract.iter().flat_map(|extract| extract.jobs(start_us)));
    let mut top_us = start_us;
    if let Some(heights) = &costs.heights {
        let subtrees = heights.split(most_us(heights));
        let above = tiles_above(&subtrees).len() as u64;
        top_us += heights.above_us(&subtrees) + above * micros(rates::COARSE_TIN_SECONDS);
        jobs.extend(of_subtrees(PartStep::Heights, &subtrees, start_us, &[]));
    }
    let after = |steps: &[PartStep], jobs: &[Job]| -> Vec<&'static str> {
        let is_there = |step: &PartStep| jobs.iter().any(|job| job.step == step.name());
        steps.iter().copied().filter(is_there).map(PartStep::name).collect()
    };
    jobs.push(whole(PartStep::Top, top_us, after(&[PartStep::Heights], &jobs)));
    let subtrees = costs.tiles.split(most_us(&costs.tiles));
    let before_tiles = after(&[PartStep::Roads, PartStep::Top], &jobs);
    jobs.extend(of_subtrees(PartStep::Tiles, &subtrees, start_us, &before_tiles));
    let merge_us = costs.merge_us + costs.tiles.above_us(&subtrees) + start_us;
    let after_tiles = after(&[PartStep::Hashes, PartStep::Tiles], &jobs);
    jobs.push(job(MERGE, merge_us, after_tiles, &[]));
    jobs
}

fn job(step: &'static str, cost_us: u64, after: Vec<&'static str>, args: &[&str]) -> Job {
    let args = args.iter().map(|&arg| arg.to_owned()).collect();
    let (id, work) = (step.to_owned(), seconds(cost_us));
    Job { id, step, subtree: None, share: None, work, after, args }
}

fn whole(step: PartStep, cost_us: u64, after: Vec<&'static str>) -> Job {
    job(step.name(), cost_us, after, &["--step", step.name()])
}

fn of_share(step: PartStep, share: Share, work_us: u64, after: &[&'static str]) -> Job {
    let (name, text) = (step.name(), share.to_string());
    Job {
        id: format!("{name}-{}-{}", share.number(), share.count()),
        args: ["--step", name, "--share", &text].map(str::to_owned).into(),
        share: Some(text),
        ..whole(step, work_us, after.to_vec())
    }
}

fn of_subtrees(
    step: PartStep,
    subtrees: &[Subtree],
    start_us: u64,
    after: &[&'static str],
) -> Vec<Job> {
    let mut sorted = subtrees.to_vec();
    sorted.sort_unstable_by_key(|subtree| (Reverse(subtree.cost_us), subtree.id));
    let job = |Subtree { id, cost_us }: Subtree| {
        let subtree = id.to_string();
        let name = step.name();
        Job {
            id: format!("{name}-{}", subtree.replace('/', "-")),
            args: ["--step", name, "--subtree", &subtree].map(str::to_owned).into(),
            subtree: Some(subtree),
            ..whole(step, cost_us + start_us, after.to_vec())
        }
    };
    sorted.into_iter().map(job).collect()
}

/// Converts seconds to whole microseconds.
pub(crate) fn micros(seconds: f64) -> u64 {
    (seconds * 1e6).round() as u64
}

/// Converts microseconds to seconds, rounded to the millisecond.
fn seconds(micros: u64) -> f64 {
    micros.div_ceil(1000) as f64 / 1e3
}

#[cfg(test)]
#[path = "list_tests.rs"]
mod tests;
