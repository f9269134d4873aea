//! The command line.

mod build;
mod camera;
mod drawing;
mod export;
mod ground;
mod look;
mod part;
mod reading;
mod values;
mod view;

use clap::{Parser, Subcommand};

pub(crate) use build::{BuildArgs, PlanArgs, ReportArgs, WorkArgs};
pub(crate) use drawing::{FlyArgs, Lod, RenderArgs};
pub(crate) use export::{Export, ExportArgs, ExportCrs, ExportRoadsArgs};
pub(crate) use look::Roads;
pub(crate) use part::{JobsArgs, MergeArgs, PartArgs};
pub(crate) use reading::{Coordinates, GrowthArgs, InfoArgs, TileArgs, VerifyArgs};
pub(crate) use view::{Motion, ViewArgs};

/// Terrain tiles with roads laid exactly on them, from elevation rasters and OpenStreetMap extracts.
#[derive(Debug, Parser)]
#[command(version, name = "corniche", max_term_width = 100)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub(crate) command: Command,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Build a tile package from elevation rasters and an OpenStreetMap extract
    Build(Box<BuildArgs>),
    /// Tell what a build will make and what it will take, and write its plan
    Plan(Box<PlanArgs>),
    /// List the parts of a planned build for so many processes, one JSON object per line
    Jobs(JobsArgs),
    /// Make one part of a planned build; prints the path of its file
    Part(PartArgs),
    /// Write the package of a plan from all its parts
    Merge(MergeArgs),
    /// Tell what a package holds and what became of its inputs
    Info(InfoArgs),
    /// Tell what laying roads on the terrain costs, per level and class
    Growth(GrowthArgs),
    /// Check every promise a package makes; exits with 1 when one is broken
    Verify(VerifyArgs),
    /// Dump one decoded tile
    Tile(TileArgs),
    /// Give what a package holds to other programs
    Export(ExportArgs),
    /// Draw a package to a PNG, without a window
    Render(RenderArgs),
    /// Fly over a package and tell what each frame costs; needs no window
    Fly(FlyArgs),
    /// Open a window on a package
    View(ViewArgs),
}

#[cfg(test)]
#[path = "args_tests.rs"]
mod tests;
