//! `corniche render`: a picture of a package, without a window.

use std::{
    fs,
    io::{Cursor, Write as _},
    path::Path,
};

use corniche_viewer::{
    CameraRequest, RenderError, RenderRequest, RoadMethod, camera::Orientation, render,
    style::Style,
};

use crate::{
    args::{RenderArgs, Roads},
    exit::ExitCode,
    failure::Failure,
};

/// Samples along each side of a pixel: enough that roads of a pixel's width do not sparkle.
const SUPERSAMPLING: u32 = 2;

pub(crate) fn run(args: &RenderArgs) -> Result<ExitCode, Failure> {
    let request = RenderRequest {
        package: args.package.clone(),
        size_px: args.size,
        roads: match args.roads {
            Roads::Geo => RoadMethod::Geometry,
            Roads::None => RoadMethod::None,
        },
        camera: match args.look_at {
            Some([lon_deg, lat_deg]) => CameraRequest::LookAt {
                lon_deg,
                lat_deg,
                distance_m: args.distance,
                orientation: Orientation { heading_deg: args.heading, pitch_deg: args.pitch },
            },
            None => CameraRequest::FrameAll,
        },
        screen_space_error_px: args.screen_space_error,
        exaggeration: args.exaggeration,
        supersampling: SUPERSAMPLING,
        style: Style::road_atlas(),
    };
    let rendered = render(&request)?;
    let mut png = Cursor::new(Vec::new());
    rendered
        .picture
        .write_to(&mut png, image::ImageFormat::Png)
        .map_err(|error| Failure::new(ExitCode::Failed, error))?;
    write(&args.output, png.get_ref()).map_err(|error| {
        let context = format!("cannot write {}", args.output.display());
        Failure::new(ExitCode::Failed, anyhow::Error::new(error).context(context))
    })?;
    let report = &rendered.report;
    eprintln!(
        "{}: {} tiles, {} triangles, {} road segments, drawn by {}",
        args.output.display(),
        report.tiles,
        report.triangles,
        report.road_segments,
        report.adapter
    );
    Ok(ExitCode::Done)
}

/// Writes beside the target and renames: a picture that is cut off never stands at the target.
fn write(target: &Path, bytes: &[u8]) -> std::io::Result<()> {
    let folder =
        target.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let mut file = tempfile::NamedTempFile::new_in(folder)?;
    file.write_all(bytes)?;
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt as _;
        // Temporary files are private; a picture is for everyone, as one written directly would be.
        file.as_file().set_permissions(fs::Permissions::from_mode(0o644))?;
    }
    file.persist(target)?;
    Ok(())
}

impl From<RenderError> for Failure {
    fn from(error: RenderError) -> Self {
        let code = match &error {
            RenderError::Gpu(_) | RenderError::ReadBack(_) => ExitCode::Failed,
            _ => ExitCode::Unusable,
        };
        Self::new(code, error)
    }
}
