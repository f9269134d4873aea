//! `corniche render`: a picture of a package, without a window.

use std::path::Path;

use corniche_styles::OwnWidths;
use corniche_viewer::{RenderError, RenderRequest, Wireframe, render, tiles::MapPackage as _};

use crate::{
    args::{OverlayArg, RenderArgs},
    exit::ExitCode,
    failure::Failure,
    interrupt, messages,
    names::Format,
    output::{Output, existing_of, png},
    overlays, packages, presets, styles,
};

pub(crate) fn run(args: &RenderArgs) -> Result<ExitCode, Failure> {
    let overlay_files = args.look.overlay.iter().map(OverlayArg::path);
    let used: Vec<&Path> = [Some(args.from.package.name()), styles::file_of(&args.look.style)]
        .into_iter()
        .flatten()
        .chain(overlay_files)
        .collect();
    let style = args.look.styled(styles::style(&args.look.style)?);
    let roads = args.look.roads(&[args.roads])?[0];
    let request = RenderRequest {
        name: args.from.package.to_string(),
        size_px: args.size,
        roads: args.look.road_options(roads),
        camera: args.from_above.request(&args.camera),
        screen_space_error_px: args.ground.screen_space_error,
        cell_px: args.ground.cell_px,
        exaggeration: args.ground.exaggeration,
        supersampling: args.supersampling,
        style,
        legend: None,
        wireframe: if args.wireframe { Wireframe::Shown } else { Wireframe::Hidden },
    };
    let output = Output::create(&args.output, existing_of(args.overwrite), &used)?;
    Format::Picture.refuse_others(&args.output)?;
    request.check()?;
    let package =
        packages::source(&args.from.package)?.for_look(request.roads.method, &request.style);
    let overlays = overlays::load(&args.look, package.manifest())?;
    let package = package.with_overlays(overlays);
    let legend = args.legend.then(|| presets::class_labels(package.manifest()));
    let request = RenderRequest { legend, ..request };
    let rendered = render(&request, &package, &interrupt::is_noted)?;
    output.write_whole(&png(&rendered.picture)?)?;
    let report = &rendered.report;
    let areas = match report.area_polygons {
        0 => String::new(),
        polygons => format!(" {polygons} polygons of areas with {} points,", report.area_points),
    };
    messages::note(&format!(
        "{}: {} tiles, {} triangles, {} road segments,{areas} drawn by {}",
        args.output.display(),
        report.tiles,
        report.triangles,
        report.road_segments,
        report.adapter
    ));
    if report.clamped_tiles > 0 {
        messages::note(&format!(
            "note: in up to {} tiles roads may be drawn narrower than the style says, because a tile knows of no roads \
             farther away than the package's width margin",
            report.clamped_tiles
        ));
    }
    if report.capped_ways > 0 {
        messages::note(&format!(
            "note: roads drawn {} m wide although their tags ask for more: {}",
            OwnWidths::WIDEST_M,
            report.capped_ways
        ));
    }
    Ok(ExitCode::Done)
}

impl From<RenderError> for Failure {
    fn from(error: RenderError) -> Self {
        let code = match error {
            RenderError::Gpu(error) => return error.into(),
            RenderError::Stopped => return Self::interrupted(),
            RenderError::ReadBack(_) => ExitCode::Failed,
            _ => ExitCode::Unusable,
        };
        Self::new(code, error)
    }
}
