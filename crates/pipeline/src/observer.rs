//! The interface by which a run reports its stages and progress and learns that it should stop.

use std::path::Path;

use crate::Defect;

/// What a stage counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Unit {
    /// Bytes of input files.
    Bytes,
    /// Blocks of the DEM's samples.
    Blocks,
    /// Patches of the grid: the finest tiles of one window of the DEM.
    Patches,
    /// Tiles of the package.
    Tiles,
}

/// A stage of a run, in the order in which they come.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Stage {
    /// Hash the input files.
    Hash,
    /// Read areas from the extract.
    MapAreas,
    /// Read boundaries from the extract.
    Boundaries,
    /// Read roads from the extract.
    Roads,
    /// Read the DEM, reproject it, fill its voids, make the level rasters.
    Heights,
    /// Read photos.
    Photos,
    /// Triangulate the tiles of all levels but the finest.
    CoarseTins,
    /// Measure every finest tile, and the coarser ones above it, against the full resolution.
    Deviations,
    /// Measure every level at the DEM's own samples, where they are not the nodes.
    Samples,
    /// Make the tiles: clip, drape and encode.
    Tiles,
    /// Make the tiles of all levels but the finest.
    CoarseTiles,
    /// Write the package.
    Package,
    /// Check a package.
    Verify,
}

impl Stage {
    /// All stages, in their order.
    pub const ALL: [Self; 13] = [
        Self::Hash,
        Self::MapAreas,
        Self::Boundaries,
        Self::Roads,
        Self::Heights,
        Self::Photos,
        Self::CoarseTins,
        Self::Deviations,
        Self::Samples,
        Self::Tiles,
        Self::CoarseTiles,
        Self::Package,
        Self::Verify,
    ];

    /// What the stage does, for people; at most 22 characters, one column of a table.
    #[must_use]
    pub fn title(self) -> &'static str {
        match self {
            Self::Hash => "hashing inputs",
            Self::MapAreas => "reading areas",
            Self::Boundaries => "reading boundaries",
            Self::Roads => "reading roads",
            Self::Heights => "reading heights",
            Self::Photos => "reading photos",
            Self::CoarseTins => "meshing coarse levels",
            Self::Deviations => "measuring errors",
            Self::Samples => "measuring at samples",
            Self::Tiles => "making tiles",
            Self::CoarseTiles => "making coarse tiles",
            Self::Package => "writing package",
            Self::Verify => "verifying",
        }
    }

    /// The stage's name for programs: small letters and hyphens. It does not change.
    #[must_use]
    pub fn id(self) -> &'static str {
        match self {
            Self::Hash => "hash",
            Self::MapAreas => "areas",
            Self::Boundaries => "boundaries",
            Self::Roads => "roads",
            Self::Heights => "heights",
            Self::Photos => "photos",
            Self::CoarseTins => "coarse-tins",
            Self::Deviations => "deviations",
            Self::Samples => "samples",
            Self::Tiles => "tiles",
            Self::CoarseTiles => "coarse-tiles",
            Self::Package => "package",
            Self::Verify => "verify",
        }
    }

    /// What the stage counts.
    #[must_use]
    pub fn unit(self) -> Unit {
        match self {
            Self::Hash | Self::MapAreas | Self::Boundaries | Self::Roads => Unit::Bytes,
            Self::Samples => Unit::Blocks,
            Self::Heights => Unit::Patches,
            Self::Photos
            | Self::CoarseTins
            | Self::Deviations
            | Self::Tiles
            | Self::CoarseTiles
            | Self::Package
            | Self::Verify => Unit::Tiles,
        }
    }
}

/// What a run reports to its caller, and how the caller stops it.
pub trait Observer: Sync {
    /// A stage begins; `total` is how many of its [`Unit`]s it will count up to, where that is known. Stages do not overlap.
    fn begin(&self, stage: Stage, total: Option<u64>);

    /// An earlier run did `steps` of the total. They count as done, but say nothing about how fast this run is.
    fn already(&self, _: Stage, _steps: u64) {}

    /// The stage has done `steps` more.
    fn advance(&self, stage: Stage, steps: u64);

    /// The stage has done `done` in all, of a `total` that is known only now or that changed.
    fn reached(&self, _: Stage, _done: u64, _total: u64) {}

    /// The stage is over.
    fn end(&self, stage: Stage);

    /// A defect of the input was skipped and counted. The order of reports depends on the inputs alone.
    fn defect(&self, _: &Defect) {}

    /// The run uses this file or folder and removes it when it ends. A caller that ends the program without waiting for the run
    /// removes it itself.
    fn temporary(&self, _: &Path) {}

    /// The run keeps its intermediate results in this folder, and may be gone on from there if it ends early. A caller that ends the program without
    /// waiting for the run tells so itself.
    fn keeps(&self, _: &Path) {}

    /// A warning about the inputs, as text for the user.
    fn warning(&self, _: &str) {}

    /// Whether to stop at the next opportunity; the run then fails with `Interrupted`.
    fn is_cancelled(&self) -> bool {
        false
    }
}

/// An observer that ignores all reports and never cancels.
#[derive(Debug, Clone, Copy)]
pub struct Silent;

impl Observer for Silent {
    fn begin(&self, _: Stage, _: Option<u64>) {}
    fn advance(&self, _: Stage, _: u64) {}
    fn end(&self, _: Stage) {}
}

#[cfg(test)]
#[path = "observer_tests.rs"]
mod tests;
