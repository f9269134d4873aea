//! The failure of a command: an error, its exit code, and whether a retry may help.

use std::{fmt, io};

use corniche_drape::BadLine;
use corniche_export::{
    CoordinatesError, DatumError, ErrorKind, FeaturesError, GdalFileError, MeshError, ProfileError,
    QuantizedMeshError, RasterError, RouteError, Tiles3dError,
};
use corniche_gis::{CrsError, PolygonError};
use corniche_ground::TerrainError;
use corniche_matching::MatchError;
use corniche_overlay::OverlayError;
use corniche_pipeline::BuildError;
use corniche_plan::{PlanError, PlanFileError};
use corniche_serve::ServeError;
use corniche_spec::{ExtractBoundsError, inputs::InputError};
use corniche_tileset::{OpenError, ReadError, SourceError};
use corniche_verify::VerifyError;
use corniche_viewer::{DrawError, gpu::GpuError, tiles::LoadTileError};
use corniche_window::WindowError;

use crate::exit::ExitCode;

/// The reason why a command failed, and the exit code of the program.
#[derive(Debug)]
pub(crate) struct CommandFailure {
    code: ExitCode,
    error: anyhow::Error,
}

/// What commands and their parts return.
pub(crate) type Result<T, E = CommandFailure> = std::result::Result<T, E>;

impl CommandFailure {
    pub(crate) fn new(code: ExitCode, error: impl Into<anyhow::Error>) -> Self {
        Self { code, error: error.into() }
    }

    /// Creates a failure for wrong usage or unusable input, with a text for the user.
    pub(crate) fn unusable(message: impl fmt::Display) -> Self {
        Self::new(ExitCode::Unusable, anyhow::anyhow!("{message}"))
    }

    /// Creates a failure of processing, with a text for the user.
    pub(crate) fn failed(message: impl fmt::Display) -> Self {
        Self::new(ExitCode::Failed, anyhow::anyhow!("{message}"))
    }

    /// Prefixes the message with the file that it is about.
    pub(crate) fn about(self, path: &std::path::Path) -> Self {
        Self { error: self.error.context(format!("{path:?}")), ..self }
    }

    /// Prefixes the message with the target: users know it, but not the temporary file that becomes
    /// it.
    pub(crate) fn about_target(self, target: &std::path::Path) -> Self {
        if self.code == ExitCode::Failed { self.about(target) } else { self }
    }

    /// Creates a failure for a target that already exists, with a text for the user.
    pub(crate) fn exists(message: impl fmt::Display) -> Self {
        Self::new(ExitCode::Exists, anyhow::anyhow!("{message}"))
    }

    /// The failure after a signal.
    pub(crate) fn interrupted() -> Self {
        Self::new(ExitCode::Interrupted, anyhow::anyhow!("interrupted"))
    }

    pub(crate) fn code(&self) -> ExitCode {
        match self.code {
            _ if self.is_closed_pipe() => ExitCode::Done,
            ExitCode::Unusable if self.may_pass() => ExitCode::Failed,
            code => code,
        }
    }

    /// Whether a package could not be read because a server or the network failed: the package may
    /// still be usable.
    fn may_pass(&self) -> bool {
        self.error.chain().any(|cause| {
            cause.downcast_ref::<OpenError>().is_some_and(OpenError::may_pass)
                // When the error names a file, it is boxed.
                || cause.downcast_ref::<Box<OpenError>>().is_some_and(|error| error.may_pass())
                || cause.downcast_ref::<ReadError>().is_some_and(ReadError::may_pass)
                || cause.downcast_ref::<SourceError>().is_some_and(|error| error.may_pass)
        })
    }

    /// Whether the reader of our output has closed the pipe (`corniche info … | head`), which is
    /// not a failure.
    pub(crate) fn is_closed_pipe(&self) -> bool {
        self.error
            .downcast_ref::<io::Error>()
            .is_some_and(|error| error.kind() == io::ErrorKind::BrokenPipe)
    }
}

impl fmt::Display for CommandFailure {
    /// Writes the error and its causes on one line; a cause that the text before it repeats is
    /// omitted. Causes after advice are in brackets: the advice remains readable.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut said = self.error.to_string();
        let mut end = "";
        for cause in self.error.chain().skip(1) {
            let cause = cause.to_string();
            if said.contains(&cause) {
                continue;
            }
            let is_after_advice = end.is_empty() && said.contains("; ");
            said.push_str(if is_after_advice { " (" } else { ": " });
            said.push_str(&cause);
            if is_after_advice {
                end = ")";
            }
        }
        write!(f, "{said}{end}")
    }
}

/// A [`CommandFailure`] for unusable input, with a message formatted as by [`format!`].
macro_rules! unusable {
    ($($message:tt)*) => {
        $crate::failure::CommandFailure::unusable(format_args!($($message)*))
    };
}

/// Returns an error for an unusable input, in words like those of `format!`.
macro_rules! refuse {
    ($($message:tt)*) => { return Err(unusable!($($message)*)) };
}

/// Errors with the exit codes that they cause.
macro_rules! codes {
    ($($error:ty { $($case:pat $(if $condition:expr)? => $code:ident,)* })*) => {$(
        impl From<$error> for CommandFailure {
            fn from(error: $error) -> Self {
                let code = match &error {
                    $($case $(if $condition)? => ExitCode::$code,)*
                };
                Self::new(code, error)
            }
        }
    )*};
}

codes! {
    BuildError {
        BuildError::Exists { .. } => Exists,
        BuildError::Interrupted => Interrupted,
        other if other.is_unusable_input() => Unusable,
        _ => Failed,
    }
    VerifyError {
        VerifyError::Interrupted => Interrupted,
        VerifyError::Changed { .. } | VerifyError::Work(_) => Failed,
        VerifyError::Extract(error) if !error.is_unusable_input() => Failed,
        VerifyError::Ground(error) if !error.is_unusable_input() => Failed,
        VerifyError::Kept(error) if !error.is_unusable_input() => Failed,
        VerifyError::Setup(error) if !error.is_unusable_input() => Failed,
        _ => Unusable,
    }
    MatchError {
        MatchError::Interrupted => Interrupted,
        _ => Unusable,
    }
    ServeError {
        ServeError::NoAddress { .. } => Unusable,
        _ => Failed,
    }
    WindowError {
        WindowError::Load(_)
        | WindowError::NoGround { .. }
        | WindowError::OverBudget { .. }
        | WindowError::OffGround(_)
        | WindowError::Range(_)
        | WindowError::NoStyle
        | WindowError::Trace { .. } => Unusable,
        _ => Failed,
    }
    CoordinatesError { _ => Unusable, }
    BadLine { _ => Unusable, }
    CrsError { _ => Unusable, }
    PolygonError { _ => Unusable, }
    DatumError { _ => Unusable, }
    ExtractBoundsError { _ => Unusable, }
    LoadTileError { _ => Unusable, }
    OpenError { _ => Unusable, }
    OverlayError { _ => Unusable, }
    ReadError { _ => Unusable, }
    GdalFileError { _ => Failed, }
    io::Error { _ => Failed, }
    // Errors of charts and of writing flights.
    anyhow::Error { _ => Failed, }
    ctrlc::Error { _ => Failed, }
    image::ImageError { _ => Failed, }
}

/// Gives errors of builds the same exit code outside builds.
macro_rules! as_of_a_build {
    ($($error:ty),*) => {
        $(impl From<$error> for CommandFailure {
            fn from(error: $error) -> Self {
                BuildError::from(error).into()
            }
        })*
    };
}

as_of_a_build!(InputError, PlanError, PlanFileError, TerrainError);

/// Maps the errors of exports by their kind.
macro_rules! exports {
    ($($error:ident)*) => {
        codes! {$(
            $error {
                error if error.kind() == ErrorKind::Unusable => Unusable,
                error if error.kind() == ErrorKind::Interrupted => Interrupted,
                _ => Failed,
            }
        )*}
    };
}

exports! {
    FeaturesError RouteError ProfileError MeshError Tiles3dError QuantizedMeshError RasterError
}

impl From<DrawError> for CommandFailure {
    fn from(error: DrawError) -> Self {
        let code = match error {
            DrawError::Gpu(error) => return error.into(),
            DrawError::Stopped | DrawError::FlightStopped => return Self::interrupted(),
            DrawError::ReadBack(_) => ExitCode::Failed,
            _ => ExitCode::Unusable,
        };
        Self::new(code, error)
    }
}

impl From<GpuError> for CommandFailure {
    fn from(error: GpuError) -> Self {
        match error {
            GpuError::TooLarge { size_px, samples_per_side, limit_px }
                if samples_per_side > 1 && size_px.iter().all(|side| *side <= limit_px) =>
            {
                unusable!("{error}; use --supersampling 1 for this size")
            }
            GpuError::TooLarge { .. } | GpuError::Empty { .. } | GpuError::Samples { .. } => {
                Self::new(ExitCode::Unusable, error)
            }
            _ => Self::new(ExitCode::Failed, error),
        }
    }
}

#[cfg(test)]
#[path = "failure_tests.rs"]
mod tests;
