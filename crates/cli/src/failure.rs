//! Why a command failed: an error, its exit code, and whether trying again may help.

use std::{fmt, io};

use corniche_export::{
    CoordinatesError, DatumError, ErrorKind, FeaturesError, GdalFileError, MeshError, ProfileError,
    QuantizedMeshError, RasterError, RouteError, Tiles3dError,
};
use corniche_ground::TerrainError;
use corniche_matching::MatchError;
use corniche_overlay::OverlayError;
use corniche_pipeline::BuildError;
use corniche_plan::{PlanError, PlanFileError};
use corniche_serve::ServeError;
use corniche_spec::{ExtractBoundsError, inputs::InputError};
use corniche_tileset::{OpenError, ReadError, SourceError};
use corniche_verify::VerifyError;
use corniche_viewer::{RenderError, ReplayError, gpu::GpuError, tiles::LoadTileError};
use corniche_window::WindowError;

use crate::exit::ExitCode;

/// Why a command failed, and with which exit code the program ends.
#[derive(Debug)]
pub(crate) struct Failure {
    code: ExitCode,
    error: anyhow::Error,
}

impl Failure {
    pub(crate) fn new(code: ExitCode, error: impl Into<anyhow::Error>) -> Self {
        Self { code, error: error.into() }
    }

    /// Wrong usage or unusable input, with a text for the user.
    pub(crate) fn unusable(message: impl fmt::Display) -> Self {
        Self::new(ExitCode::Unusable, anyhow::anyhow!("{message}"))
    }

    /// Something failed, with a text for the user.
    pub(crate) fn failed(message: impl fmt::Display) -> Self {
        Self::new(ExitCode::Failed, anyhow::anyhow!("{message}"))
    }

    /// The same, with the file that it is about in front.
    pub(crate) fn about(self, path: &std::path::Path) -> Self {
        Self { error: self.error.context(path.display().to_string()), ..self }
    }

    /// What could not be written is known to people by the name of the target, not of the file that becomes it.
    pub(crate) fn about_target(self, target: &std::path::Path) -> Self {
        if self.code == ExitCode::Failed { self.about(target) } else { self }
    }

    /// The target exists, with a text for the user.
    pub(crate) fn exists(message: impl fmt::Display) -> Self {
        Self::new(ExitCode::Exists, anyhow::anyhow!("{message}"))
    }

    /// A signal came.
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

    /// Whether a package could not be read because a server or the network failed: it need not be unusable.
    fn may_pass(&self) -> bool {
        self.error.chain().any(|cause| {
            cause.downcast_ref::<OpenError>().is_some_and(OpenError::may_pass)
                // Behind the name of a file it is boxed.
                || cause.downcast_ref::<Box<OpenError>>().is_some_and(|error| error.may_pass())
                || cause.downcast_ref::<ReadError>().is_some_and(ReadError::may_pass)
                || cause.downcast_ref::<SourceError>().is_some_and(|error| error.may_pass)
        })
    }

    /// Whether the reader of our output has closed the pipe (`corniche info … | head`), which is no failure.
    pub(crate) fn is_closed_pipe(&self) -> bool {
        self.error
            .downcast_ref::<io::Error>()
            .is_some_and(|error| error.kind() == io::ErrorKind::BrokenPipe)
    }
}

impl fmt::Display for Failure {
    /// The error and its causes on one line; a cause that the text before it repeats is left out.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut said = self.error.to_string();
        for cause in self.error.chain().skip(1) {
            let cause = cause.to_string();
            if !said.contains(&cause) {
                said = format!("{said}: {cause}");
            }
        }
        f.write_str(&said)
    }
}

/// Errors with the codes that they end with.
macro_rules! codes {
    ($($error:ty { $($case:pat $(if $condition:expr)? => $code:ident,)* })*) => {$(
        impl From<$error> for Failure {
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
    DatumError { _ => Unusable, }
    ExtractBoundsError { _ => Unusable, }
    LoadTileError { _ => Unusable, }
    OpenError { _ => Unusable, }
    OverlayError { _ => Unusable, }
    ReadError { _ => Unusable, }
    GdalFileError { _ => Failed, }
    io::Error { _ => Failed, }
    // What draws charts, and what writes flights.
    anyhow::Error { _ => Failed, }
    ctrlc::Error { _ => Failed, }
    image::ImageError { _ => Failed, }
}

/// What a build may fail with fails the same way outside one.
macro_rules! as_of_a_build {
    ($($error:ty),*) => {
        $(impl From<$error> for Failure {
            fn from(error: $error) -> Self {
                BuildError::from(error).into()
            }
        })*
    };
}

as_of_a_build!(InputError, PlanError, PlanFileError, TerrainError);

/// What exports end with, by the kind of their errors.
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

/// What drawing ends with.
macro_rules! drawings {
    ($($error:ident)*) => {
        $(impl From<$error> for Failure {
            fn from(error: $error) -> Self {
                let code = match error {
                    $error::Gpu(error) => return error.into(),
                    $error::Stopped => return Self::interrupted(),
                    $error::ReadBack(_) => ExitCode::Failed,
                    _ => ExitCode::Unusable,
                };
                Self::new(code, error)
            }
        })*
    };
}

drawings! { RenderError ReplayError }

impl From<GpuError> for Failure {
    fn from(error: GpuError) -> Self {
        match error {
            GpuError::TooLarge { size_px, samples_per_side, limit_px }
                if samples_per_side > 1 && size_px.iter().all(|side| *side <= limit_px) =>
            {
                Self::unusable(format!("{error}; it fits with --supersampling 1"))
            }
            GpuError::TooLarge { .. } | GpuError::Empty { .. } | GpuError::Samples { .. } => {
                Self::new(ExitCode::Unusable, error)
            }
            _ => Self::new(ExitCode::Failed, error),
        }
    }
}
