//! Whether a package keeps its promises: every tile, no sampling.

mod dem;
mod ground;
mod roads;
mod samples;
mod seams;
mod sums;
mod tiles;

use std::path::PathBuf;

use corniche_tileset::{Distribution, FilePackage, OpenError, SampleErrorRecord};

use crate::Observer;

/// What to verify.
#[derive(Debug, Clone)]
pub struct VerifySettings {
    /// The package.
    pub package: PathBuf,
    /// The elevation files it was made from, to check errors against; empty leaves that out.
    pub dem: Vec<PathBuf>,
    /// Worker threads, at least 1.
    pub threads: usize,
}

/// One promise, how often it was looked at, and where it is broken.
#[derive(Debug, Clone, PartialEq)]
pub struct Check {
    /// The promise in words.
    pub name: &'static str,
    /// How many things were looked at.
    pub checked: u64,
    /// How many of them break it.
    pub broken: u64,
    /// The first few of those, in words.
    pub examples: Vec<String>,
}

/// Examples kept of each broken promise.
const EXAMPLES: usize = 5;

impl Check {
    pub(crate) fn new(name: &'static str) -> Self {
        Self { name, checked: 0, broken: 0, examples: Vec::new() }
    }

    /// Whether nothing breaks it.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.broken == 0
    }

    pub(crate) fn look(&mut self, holds: bool, example: impl FnOnce() -> String) {
        self.checked += 1;
        if !holds {
            self.broken += 1;
            if self.examples.len() < EXAMPLES {
                self.examples.push(example());
            }
        }
    }

    pub(crate) fn merge(&mut self, other: Self) {
        self.checked += other.checked;
        self.broken += other.broken;
        let room = EXAMPLES - self.examples.len();
        self.examples.extend(other.examples.into_iter().take(room));
    }
}

/// How far GEO roads are from their TIN on one level.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct GapFigures {
    /// Level.
    pub level: u8,
    /// Edges looked at.
    pub edges: u64,
    /// Largest gap.
    pub largest_m: f64,
}

/// Stored errors beside true ones.
#[derive(Debug, Clone, PartialEq)]
pub struct ErrorFigures {
    /// Level.
    pub level: u8,
    /// Tiles measured.
    pub tiles: u64,
    /// Nodes with data that were compared.
    pub nodes: u64,
    /// Largest true error.
    pub largest_true_m: f64,
    /// Stored error over the largest true one of the tile and its children, over the tiles where that can be measured.
    pub tightness: Option<Distribution>,
    /// Nodes with data that the TINs do not cover.
    pub uncovered_nodes: u64,
}

/// What verification found.
#[derive(Debug, Clone, PartialEq)]
pub struct VerifyReport {
    /// Tiles looked at.
    pub tiles: u64,
    /// The promises.
    pub checks: Vec<Check>,
    /// Gaps between GEO roads and TINs, per level.
    pub gaps: Vec<GapFigures>,
    /// Borders between tiles of one level that were compared.
    pub borders: u64,
    /// With the DEM: stored errors beside true ones, per level.
    pub errors: Vec<ErrorFigures>,
    /// With the DEM: the finest level at the DEM's own samples.
    pub samples: Option<SampleErrorRecord>,
}

impl VerifyReport {
    /// Whether every promise holds.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.checks.iter().all(Check::holds)
    }
}

/// Why a package could not be verified.
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "each message documents its variant")]
#[non_exhaustive]
pub enum VerifyError {
    #[error(transparent)]
    Open(#[from] OpenError),
    #[error(transparent)]
    Dem(#[from] corniche_dem::DemError),
    #[error(
        "these are not the elevation files that the package was made from; give {expected:?}, the same files in the \
         same order"
    )]
    OtherDem { expected: Vec<String> },
    #[error("cannot read {path:?}")]
    Input { path: PathBuf, source: std::io::Error },
    #[error("interrupted")]
    Interrupted,
}

/// Verifies a package: without other inputs P1, P3, P6, the order of roads, checksums and sections; with the DEM
/// also P2.
///
/// # Errors
/// When the package or the DEM cannot be read at all; a broken promise is a finding, not an error.
pub fn verify(
    settings: &VerifySettings,
    observer: &dyn Observer,
) -> Result<VerifyReport, VerifyError> {
    let package = FilePackage::open(&settings.package)?;
    let mut report = tiles::verify(&package, settings.threads, observer)?;
    report.checks.extend(sums::verify(package.manifest()));
    if !settings.dem.is_empty() {
        dem::verify(&package, settings, &mut report, observer)?;
    }
    Ok(report)
}
