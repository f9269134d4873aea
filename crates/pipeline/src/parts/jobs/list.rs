//! The parts of a build as jobs: which there are, what each costs, and what it waits for.

use std::cmp::Reverse;

use corniche_osm::Share;
use corniche_plan::rates;
use serde::Serialize;

use super::tile_costs::{Subtree, TileCosts, tiles_above};
use crate::parts::step::Step;

/// No part is to be more than this part of what a slot has to do: with the largest first, slots then end nearly together.
const PARTS_PER_SLOT: u64 = 8;
/// The name of the step that writes the package.
const MERGE: &str = "merge";

/// A part of a build, for a scheduler.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Job {
    /// Step and subtree or share, such as "tiles-2-1-3". No two jobs of a plan have the same.
    pub id: String,
    /// The step's name; "merge" for the last one.
    pub step: &'static str,
    /// Its subtree as z/x/y, where the step has subtrees.
    pub subtree: Option<String>,
    /// Its share as I/N, where the step has shares.
    pub share: Option<String>,
    /// Estimated time on one core, seconds.
    pub work: f64,
    /// Names of the steps of which all jobs must be done before.
    pub after: Vec<&'static str>,
    /// What to say to `corniche part` behind plan and stores; for the merge, to `corniche merge`.
    pub args: Vec<String>,
}

/// What a build costs, microseconds of one core, without the start of processes.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Costs {
    pub(crate) hashes_us: u64,
    /// `None` without an extract.
    pub(crate) extract: Option<ExtractCosts>,
    /// `None` where the terrain comes from a package and there are no photos.
    pub(crate) heights: Option<TileCosts>,
    pub(crate) tiles: TileCosts,
    /// Adding up and copying of all tiles.
    pub(crate) merge_us: u64,
    /// What it costs to start a process and open the inputs.
    pub(crate) start_us: u64,
}

/// What the reading of an extract costs, microseconds of one core.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct ExtractCosts {
    /// How many shares are worth it; with 1 the step *roads* reads the extract itself.
    pub(crate) shares: u16,
    /// Both passes.
    pub(crate) ways_us: u64,
    pub(crate) nodes_us: u64,
    /// All that comes after them.
    pub(crate) roads_us: u64,
}

impl ExtractCosts {
    fn jobs(&self, start_us: u64) -> Vec<Job> {
        let &Self { shares, ways_us, nodes_us, roads_us } = self;
        if shares < 2 {
            return vec![whole(Step::Roads, ways_us + nodes_us + roads_us + start_us, Vec::new())];
        }
        let of_shares = |step: Step, cost_us: u64, after: &[&'static str]| -> Vec<Job> {
            let work_us = cost_us / u64::from(shares) + start_us;
            Share::all(shares).map(|share| of_share(step, share, work_us, after)).collect()
        };
        let mut jobs = of_shares(Step::Ways, ways_us, &[]);
        jobs.extend(of_shares(Step::Nodes, nodes_us, &[Step::Ways.name()]));
        let after = [Step::Ways, Step::Nodes].map(Step::name).to_vec();
        jobs.push(whole(Step::Roads, roads_us + start_us, after));
        jobs
    }
}

impl Costs {
    /// No part is made smaller than this without need: its start would take too much of it.
    pub(crate) fn least_us(&self) -> u64 {
        self.start_us.saturating_mul(rates::PART_WORTH_STARTS)
    }
}

/// All jobs, those of a step after those it waits for, and the largest of a step first. Subtrees are split until none has more than its
/// share for `slots` slots, or `least_us`.
pub(crate) fn list(costs: &Costs, slots: u32, least_us: u64) -> Vec<Job> {
    let most_us = |all: &TileCosts| {
        let parts = PARTS_PER_SLOT.saturating_mul(u64::from(slots)).max(1);
        (all.total_us() / parts).max(least_us)
    };
    let start_us = costs.start_us;
    let mut jobs = vec![whole(Step::Hashes, costs.hashes_us + start_us, Vec::new())];
    jobs.extend(costs.extract.iter().flat_map(|extract| extract.jobs(start_us)));
    let mut top_us = start_us;
    if let Some(heights) = &costs.heights {
        let subtrees = heights.split(most_us(heights));
        let above = tiles_above(&subtrees).len() as u64;
        top_us += heights.above_us(&subtrees) + above * micros(rates::COARSE_TIN_SECONDS);
        jobs.extend(of_subtrees(Step::Heights, &subtrees, start_us, &[]));
    }
    let after = |steps: &[Step], jobs: &[Job]| -> Vec<&'static str> {
        let is_there = |step: &Step| jobs.iter().any(|job| job.step == step.name());
        steps.iter().copied().filter(is_there).map(Step::name).collect()
    };
    jobs.push(whole(Step::Top, top_us, after(&[Step::Heights], &jobs)));
    let subtrees = costs.tiles.split(most_us(&costs.tiles));
    let before_tiles = after(&[Step::Roads, Step::Top], &jobs);
    jobs.extend(of_subtrees(Step::Tiles, &subtrees, start_us, &before_tiles));
    let merge_us = costs.merge_us + costs.tiles.above_us(&subtrees) + start_us;
    let after_tiles = after(&[Step::Hashes, Step::Tiles], &jobs);
    jobs.push(job(MERGE, merge_us, after_tiles, &[]));
    jobs
}

fn job(step: &'static str, cost_us: u64, after: Vec<&'static str>, args: &[&str]) -> Job {
    let args = args.iter().map(|&arg| arg.to_owned()).collect();
    let (id, work) = (step.to_owned(), seconds(cost_us));
    Job { id, step, subtree: None, share: None, work, after, args }
}

fn whole(step: Step, cost_us: u64, after: Vec<&'static str>) -> Job {
    job(step.name(), cost_us, after, &["--step", step.name()])
}

fn of_share(step: Step, share: Share, work_us: u64, after: &[&'static str]) -> Job {
    let (name, text) = (step.name(), share.to_string());
    Job {
        id: format!("{name}-{}-{}", share.number(), share.of()),
        args: ["--step", name, "--share", &text].map(str::to_owned).into(),
        share: Some(text),
        ..whole(step, work_us, after.to_vec())
    }
}

fn of_subtrees(
    step: Step,
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

/// Whole microseconds.
pub(crate) fn micros(seconds: f64) -> u64 {
    (seconds * 1e6).round() as u64
}

/// Rounds to the millisecond.
fn seconds(micros: u64) -> f64 {
    micros.div_ceil(1000) as f64 / 1e3
}

#[cfg(test)]
#[path = "list_tests.rs"]
mod tests;
