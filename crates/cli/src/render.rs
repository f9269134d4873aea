//! `corniche render`: a picture of a package, without a window.

use std::{io::Cursor, path::Path};

use corniche_viewer::{CameraRequest, RenderError, RenderRequest, camera::Orientation, render};

use crate::{
    args::RenderArgs,
    exit::ExitCode,
    failure::Failure,
    output::{Existing, Output},
    styles,
};

pub(crate) fn run(args: &RenderArgs) -> Result<ExitCode, Failure> {
    let used: Vec<&Path> = [Some(args.package.as_path()), styles::file_of(&args.look.style)]
        .into_iter()
        .flatten()
        .collect();
    let style = styles::style(&args.look.style)?;
    let roads = args.look.roads(&[args.roads])?[0];
    let request = RenderRequest {
        package: args.package.clone(),
        size_px: args.size,
        roads: args.look.road_options(roads),
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
        supersampling: args.supersampling,
        style,
    };
    let output = Output::create(&args.output, Existing::Replace, &used)?;
    let rendered = render(&request)?;
    let mut png = Cursor::new(Vec::new());
    rendered
        .picture
        .write_to(&mut png, image::ImageFormat::Png)
        .map_err(|error| Failure::new(ExitCode::Failed, error))?;
    output.write_whole(png.get_ref())?;
    let report = &rendered.report;
    eprintln!(
        "{}: {} tiles, {} triangles, {} road segments, drawn by {}",
        args.output.display(),
        report.tiles,
        report.triangles,
        report.road_segments,
        report.adapter
    );
    if report.clamped_tiles > 0 {
        eprintln!(
            "note: in up to {} tiles roads may be drawn narrower than the style says, because their volumes reach no \
             farther than the package's width margin",
            report.clamped_tiles
        );
    }
    Ok(ExitCode::Done)
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
