//! `corniche render`: renders an image of a package, without a window.

mod picture_files;

use corniche_export::{PictureFacts, PlaceOfPicture};
use corniche_osm::AreaLoss;
use corniche_styles::OwnWidths;
use corniche_tileset::Manifest;
use corniche_viewer::{
    LegendRequest, Mapping, PictureOptions, RenderReport, RenderRequest, RoadMethod, ShownLayers,
    TitleFlaws, render,
    tiles::{MapPackage as _, TileDecoder},
};

use self::picture_files::PictureFiles;
use crate::{
    args::RenderArgs, failure::Result, interrupt, messages, overlays, packages, presets, styles,
    table::noted,
};

pub(crate) fn run(args: &RenderArgs) -> Result<()> {
    let used = styles::files_of_look(&args.look, &args.from);
    let style = args.look.styled(styles::style(&args.look.style)?);
    let roads = args.look.roads(&[args.roads])?[0];
    let mapping = match (args.unmapped, roads.method()) {
        (false, _) => Mapping::OnTriangles,
        (true, RoadMethod::Geometry) => Mapping::Unmapped,
        (true, _) => {
            refuse!("--unmapped applies only to roads as geometry; use it with --roads geo");
        }
    };
    let request = RenderRequest {
        name: args.from.package.to_string(),
        options: PictureOptions {
            size_px: args.size,
            roads: args.look.road_options(roads),
            screen_space_error_px: args.ground.screen_space_error,
            cell_px: args.ground.cell_px,
            exaggeration: args.ground.exaggeration,
            supersampling: args.supersampling,
            style,
            layers: args.look.shown_layers(),
        },
        camera: args.from_above.request(&args.camera),
        legend: None,
        title: args.title.clone(),
        is_wireframe: args.wireframe,
    };
    let files = PictureFiles::create(args, &used)?;
    request.check()?;
    let package = packages::source(&args.from.package)?;
    let overlays = overlays::load(&args.look, package.manifest())?;
    let options = &request.options;
    let looks = options.looks(package.manifest());
    let decoder =
        TileDecoder::default().for_look(options.roads.method, &options.style, looks.drawn_layers());
    let package = package.with_decoder(decoder.with_overlays(overlays).with_mapping(mapping));
    let scale = args.from_above.print_scale();
    let legend = args.legend.then(|| LegendRequest {
        road_labels: presets::class_labels(package.manifest()),
        scale: scale.map(|scale| scale.denominator),
    });
    let request = RenderRequest { legend, ..request };
    let rendered = render(&request, &package, &interrupt::is_noted)?;
    let manifest = package.manifest();
    let place = rendered.report.working_from_pixel;
    let place = place.map(|map| PlaceOfPicture::new(manifest, map)).transpose()?;
    let facts = PictureFacts {
        description: args.title.clone().unwrap_or_default(),
        software: format!("corniche {}", env!("CARGO_PKG_VERSION")),
        attribution: manifest.attribution.join("; "),
        dots_per_inch: None,
    };
    let is_same_crs = files.write(&rendered.picture, place.as_ref(), scale, facts)?;
    tell(args, &rendered.report);
    if !is_same_crs {
        warning!(
            "GeoTIFF cannot represent the whole coordinate system of the package ({}); programs may interpret it differently",
            manifest.crs
        );
    }
    if let Some(text) = incomplete_areas(manifest, &request.options.layers) {
        messages::note(&text);
    }
    Ok(())
}

/// Reports the contents of an image, and what differs from the request.
fn tell(args: &RenderArgs, report: &RenderReport) {
    let areas = match report.area_polygons {
        0 => String::new(),
        polygons => format!(" {polygons} polygons of areas with {} points,", report.area_points),
    };
    note!(
        "{}: {} tiles, {} triangles, {} road segments,{areas} drawn by {}",
        args.output.display(),
        report.tiles,
        report.triangles,
        report.road_segments,
        report.adapter
    );
    if report.clamped_tiles > 0 {
        note!(
            "note: in up to {} tiles roads may be drawn narrower than in the style, because a tile contains no roads \
             farther away than the package's width margin",
            report.clamped_tiles
        );
    }
    if report.capped_ways > 0 {
        note!(
            "note: roads drawn {} m wide although their tags are wider: {}",
            OwnWidths::WIDEST_M,
            report.capped_ways
        );
    }
    let TitleFlaws { lacking, is_cut } = &report.title_flaws;
    if !lacking.is_empty() {
        warning!("--title: the font of images has no {lacking}; boxes are drawn instead");
    }
    if *is_cut {
        messages::warning("--title: the title does not fit into the image and is truncated");
    }
    if report.is_legend_cut {
        messages::warning("--legend: the legend does not fit into the image and is truncated");
    }
}

/// A note about drawn areas that are incomplete in the extract; `None` if there are none.
fn incomplete_areas(manifest: &Manifest, shown: &ShownLayers) -> Option<String> {
    let reasons = [AreaLoss::MissingWays, AreaLoss::MissingNodes].map(AreaLoss::reason);
    let layers = manifest.layers.iter().filter(|of| shown.contains(&of.table.id));
    let lost = layers.flat_map(|layer| &layer.counts.lost);
    let objects =
        lost.filter(|(reason, _)| reasons.contains(&reason.as_str())).map(|(_, objects)| objects);
    let objects: u64 = objects.sum();
    (objects > 0).then(|| {
        format!(
            "note: areas that are not drawn because the extract lacks parts of their outlines: {}; they may be anywhere. corniche build --defects lists \
             them",
            noted(objects)
        )
    })
}

#[cfg(test)]
#[path = "render_tests.rs"]
mod tests;
