//! `corniche plan`: estimates what a build will produce and need.

use std::{
    borrow::Cow,
    fmt::Write as _,
    path::{Path, PathBuf},
};

use corniche_plan::{BuildEstimate, BuildPlan};
use corniche_remote::without_secrets;
use corniche_spec::{Resources, machine::MIN_MEMORY_BYTES};
use corniche_work::Observer;

use crate::{
    args::PlanArgs,
    documents::plan::PlanDocument,
    exit::ExitCode,
    failure::{CommandFailure, Result},
    info::datum_operation,
    interrupt, jobs, messages,
    output::{Output, existing_of},
    settings,
    table::{Digits, Table, bytes},
};

pub(crate) fn run(mut args: PlanArgs) -> Result<()> {
    settings::complete(&mut args.work)?;
    // An unwritable target is reported before the files are read.
    let inputs: Vec<&Path> = args.work.files().collect();
    let create = |path: &PathBuf| Output::create(path, existing_of(args.overwrite), &inputs);
    let written = args.output.as_ref().map(create).transpose()?;
    let write = |plan: &BuildPlan| written.map_or(Ok(()), |file| write_plan(file, plan));
    let work = settings::build_work(args.work)?;
    if let Some(level) = args.subtrees {
        let plan = BuildPlan::make(&work.plan)?;
        let subtrees = subtrees(&plan, level)?;
        write(&plan)?;
        return Ok(messages::answer(&subtrees)?);
    }
    if let Some(slots) = args.jobs {
        let (plan, jobs) = corniche_pipeline::plan_with_jobs(&work.plan, work.resources, slots)?;
        write(&plan)?;
        return jobs::print(&jobs);
    }
    let (plan, mut estimate) = corniche_plan::plan(&work.plan, work.resources, &Signals)?;
    write(&plan)?;
    let digits = Digits::of_answers();
    if args.json {
        estimate.memory.block_file = shown(&estimate.memory.block_file).into_owned();
        messages::answer_document(&PlanDocument { plan_sha256: plan.hash(), estimate })?;
    } else {
        messages::answer(&to_text(&plan, &estimate, work.resources, digits))?;
    }
    Ok(())
}

/// The path of an input without secrets, which only URLs contain: names of files are returned
/// unchanged.
fn shown(path: &str) -> Cow<'_, str> {
    let is_address = path.contains("://") || path.starts_with("/vsi");
    if is_address { without_secrets(path) } else { Cow::Borrowed(path) }
}

fn write_plan(file: Output, plan: &BuildPlan) -> Result<()> {
    let text = plan.to_json().map_err(|error| CommandFailure::new(ExitCode::Failed, error))?;
    file.write_whole(text.as_bytes())
}

/// The subtrees of a level, one per line.
fn subtrees(plan: &BuildPlan, level: u8) -> Result<String> {
    let finest = plan.grid.frame.max_level();
    if level > finest {
        let message = format!("--subtrees {level} does not exist: the finest level is {finest}");
        return Err(CommandFailure::unusable(message));
    }
    let mut lines = String::new();
    for id in plan.subtrees(level) {
        // Writing to a String cannot fail.
        let _ = writeln!(lines, "{id}");
    }
    Ok(lines)
}

/// An observer that only stops the work after a signal.
struct Signals;

impl Observer for Signals {
    fn is_cancelled(&self) -> bool {
        interrupt::is_noted()
    }
}

impl corniche_spec::BuildObserver for Signals {}

/// The plan and the estimates as text.
fn to_text(
    plan: &BuildPlan,
    estimate: &BuildEstimate,
    resources: Resources,
    digits: Digits,
) -> String {
    let mut text = String::new();
    let mut say = |name: &str, value: &str| {
        // Writing to a String cannot fail.
        let _ = writeln!(text, "{name:<12} {value}");
    };
    let grid = &plan.grid;
    let [east_m, north_m] = grid.frame.cell().to_array();
    say("plan", &plan.hash());
    say("CRS", &grid.crs);
    say("grid", &format!("cell {east_m:.3} × {north_m:.3} m, {}", grid.resampling));
    say("heights", &grid.vertical_treatment);
    for found in &grid.datum_operations {
        say("positions", &datum_operation(found));
    }
    say("max error", &format!("{:.3} m on the finest level", plan.settings.max_error_m));
    for input in &plan.inputs {
        say(&input.kind, &format!("{}, {}", shown(&input.path), bytes(input.bytes)));
    }
    say("nodes", &digits.count(estimate.nodes));
    let subtrees = |level| format!("{} on level {level}", plan.subtrees(level).len());
    let few: Vec<String> = (0..=grid.frame.max_level().min(3)).map(subtrees).collect();
    say("subtrees", &format!("with data: {}", few.join(", ")));
    say("tiles", &digits.count(estimate.tiles.iter().sum()));
    let memory = &estimate.memory;
    let least_bytes = memory.least_bytes.max(MIN_MEMORY_BYTES);
    say(
        "memory",
        &format!(
            "at least {} of the limit {}: {} for the program, {} for its list of tiles, {} threads × {} (never less than {})",
            mebibytes(least_bytes),
            mebibytes(resources.memory_bytes),
            mebibytes(memory.base_bytes),
            mebibytes(memory.tiles_bytes),
            memory.threads,
            mebibytes(memory.thread_bytes + memory.block_bytes),
            mebibytes(MIN_MEMORY_BYTES),
        ),
    );
    say(
        "",
        &format!(
            "the largest block of a file is {}, a row of blocks {}",
            bytes(memory.block_bytes),
            bytes(memory.block_row_bytes),
        ),
    );
    if least_bytes > resources.memory_bytes {
        say("", "the limit is too low: a build would fail with exit code 2");
    }
    say(
        "disk",
        &format!(
            "about {} for intermediate results, about {} for the package",
            bytes(estimate.store_bytes),
            bytes(estimate.package_bytes),
        ),
    );
    say("time", &format!("about {} on {} threads", duration(estimate.seconds), memory.threads));
    say("", &estimate.rates.text());
    text.push('\n');
    let mut table = Table::new(["level", "cell m", "max error m", "least class", "tiles"]);
    for (level, tiles) in plan.levels.iter().zip(&estimate.tiles) {
        let [east_m, north_m] = level.cell_m.to_array();
        table.row([
            level.level.to_string(),
            format!("{east_m:.2} × {north_m:.2}"),
            format!("{:.3}", level.max_error_m),
            level.least_class.map_or_else(|| "none".to_owned(), |class| class.to_string()),
            digits.count(*tiles),
        ]);
    }
    text + &table.to_text()
}

/// A size in the format of `--memory`, rounded up.
fn mebibytes(size: u64) -> String {
    format!("{}M", size.div_ceil(1 << 20))
}

/// A time for people.
fn duration(seconds: f64) -> String {
    match seconds {
        ..120.0 => format!("{seconds:.0} s"),
        120.0..7200.0 => format!("{:.0} min", seconds / 60.0),
        _ => format!("{:.1} h", seconds / 3600.0),
    }
}

#[cfg(test)]
#[path = "plan_tests.rs"]
mod tests;
