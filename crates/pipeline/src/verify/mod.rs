//! Whether a package keeps its promises: every tile, no sampling.

mod attributes;
mod checks;
mod dem;
mod gradient;
mod grid;
mod ground;
mod header;
mod levels;
mod methods;
mod osm;
mod place;
mod records;
mod roads;
mod samples;
mod seams;
mod shown;
mod sums;
mod tiles;

use std::path::PathBuf;

use corniche_roads::FrcTable;
use corniche_tileset::{Distribution, FilePackage, OpenError, SampleErrorRecord};

pub use checks::{Check, CheckId, Needs};

use crate::{BuildError, Observer};

/// What to verify.
#[derive(Debug, Clone)]
pub struct VerifySettings {
    /// The package.
    pub package: PathBuf,
    /// The elevation files it was made from, to check errors against; empty leaves that out.
    pub dem: Vec<PathBuf>,
    /// The extract it was made from, to check roads against; `None` leaves that out.
    pub osm: Option<VerifyOsm>,
    /// Worker threads, at least 1.
    pub threads: usize,
}

/// The extract that a package was made from, and how it was read.
#[derive(Debug, Clone)]
pub struct VerifyOsm {
    /// The extract.
    pub path: PathBuf,
    /// The FRC table that the manifest names.
    pub table: FrcTable,
    /// Memory for sorting roads by tile, bytes.
    pub memory_bytes: u64,
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
    #[error(
        "{path:?} is a pipe or a device; inputs are read more than once, so save it to a file first"
    )]
    Stream { path: PathBuf },
    #[error("the name of {path:?} is not UTF-8; rename the file")]
    InputName { path: PathBuf },
    #[error("{path:?} changed while it was read; run the same command again when it is left alone")]
    Changed { path: PathBuf },
    #[error(
        "{path:?} is not the extract that the package was made from; give {expected:?}, the same file"
    )]
    OtherOsm { path: PathBuf, expected: Vec<String> },
    #[error(
        "the FRC table {given:?} is not the one that the package was made with; give {expected:?} with --frc-table"
    )]
    OtherTable { given: String, expected: String },
    #[error("the package was made without an extract; leave --osm out")]
    NoExtract,
    #[error(
        "the package was made with another FRC table that is called {name:?}, too, read from a file; give that file with \
         --frc-table"
    )]
    OtherTableOfThatName { name: String },
    #[error("the extract could not be laid on the package's tiles")]
    Roads(#[source] BuildError),
    #[error("cannot read {path:?}")]
    Input { path: PathBuf, source: std::io::Error },
    #[error(
        "intermediate results could not be kept in the folder for temporary files (disk full?)"
    )]
    Work(#[source] std::io::Error),
    #[error("interrupted")]
    Interrupted,
}

impl From<BuildError> for VerifyError {
    fn from(error: BuildError) -> Self {
        match error {
            BuildError::Input { path, source } => Self::Input { path, source },
            BuildError::InputName { path } => Self::InputName { path },
            BuildError::Stream { path } => Self::Stream { path },
            BuildError::Changed { path } => Self::Changed { path },
            BuildError::Interrupted => Self::Interrupted,
            BuildError::Dem(error) => Self::Dem(error),
            other => Self::Roads(other),
        }
    }
}

/// Verifies a package: without other inputs all that the package says of itself; with the elevation files or the
/// extract also what it says of them. [`CheckId`] lists what is looked at.
///
/// # Errors
/// When the package, the DEM or the extract cannot be read at all, or is another; a broken promise is a finding, not
/// an error.
pub fn verify(
    settings: &VerifySettings,
    observer: &dyn Observer,
) -> Result<VerifyReport, VerifyError> {
    let package = FilePackage::open(&settings.package)?;
    let mut given = vec![Needs::Package];
    let (mut report, mut findings) = tiles::verify(&package, settings.threads, observer)?;
    sums::verify(package.manifest(), &mut findings);
    records::verify(package.manifest(), &mut findings);
    header::verify(&package, &mut findings)?;
    grid::verify(package.manifest(), &mut findings);
    place::verify(package.manifest(), &mut findings);
    if !settings.dem.is_empty() {
        given.push(Needs::Dem);
        dem::verify(&package, settings, &mut report, observer)?;
    }
    if let Some(osm) = &settings.osm {
        given.push(Needs::Osm);
        osm::verify(&package, osm, settings.threads, &mut findings, observer)?;
    }
    findings.merge(std::mem::take(&mut report.checks));
    report.checks = findings.into_checks(&given);
    Ok(report)
}
