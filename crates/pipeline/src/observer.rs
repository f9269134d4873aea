use std::path::Path;

use crate::Defect;

/// A stage of a run, in the order in which they come.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Stage {
    /// Hash the input files.
    Hash,
    /// Look at every sample of the DEM for values that are no heights. Counted in blocks.
    Audit,
    /// Read the DEM, reproject it, fill its voids, make the level rasters. Counted in blocks.
    Heights,
    /// Triangulate all tiles of all levels. Counted in tiles.
    Mesh,
    /// Measure every tile against the full resolution. Counted in finest tiles.
    Deviations,
    /// Measure every level at the DEM's own samples, where they are not the nodes. Counted in blocks.
    Samples,
    /// Read roads from the extract. Counted in roads; the total is unknown.
    Roads,
    /// Clip, drape and encode. Counted in tiles.
    Tiles,
    /// Drape and encode the tiles above the finest level. Counted in tiles.
    CoarseTiles,
    /// Write the package. Counted in tiles.
    Package,
    /// Check a package. Counted in tiles.
    Verify,
}

impl Stage {
    /// What the stage does, for people.
    #[must_use]
    pub fn title(self) -> &'static str {
        match self {
            Self::Hash => "hashing inputs",
            Self::Audit => "checking heights",
            Self::Heights => "reading heights",
            Self::Mesh => "triangulating",
            Self::Deviations => "measuring errors",
            Self::Samples => "measuring at samples",
            Self::Roads => "reading roads",
            Self::CoarseTiles => "coarse tiles",
            Self::Tiles => "draping and encoding",
            Self::Package => "writing package",
            Self::Verify => "verifying",
        }
    }
}

/// What a run reports to its caller, and how the caller stops it.
pub trait Observer: Sync {
    /// A stage begins; `total` is how much it will count up to, where that is known.
    fn begin(&self, stage: Stage, total: Option<u64>);

    /// The stage has done `steps` more.
    fn advance(&self, stage: Stage, steps: u64);

    /// The stage is over.
    fn end(&self, stage: Stage);

    /// A defect of the input was skipped and counted. The order of reports depends on the inputs alone.
    fn defect(&self, _: &Defect) {}

    /// The run uses this file or folder and removes it when it ends. A caller that ends the program without waiting for the run
    /// removes it itself.
    fn temporary(&self, _: &Path) {}

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
