//! A description of how nodes relate to samples.

use corniche_gis::first_names;

use crate::Dem;
use crate::mosaics::mosaic::{Mosaic, MosaicFile};
use crate::plan::grid_plan::{Method, MosaicRole};
use crate::plan::kernel::Alignment;

/// Describes how nodes relate to samples. A single grid is "the DEM"; of several grids each names
/// its files, in the given order.
pub(crate) fn describe(dem: &Dem, roles: &[MosaicRole]) -> String {
    let is_one = dem.mosaics.len() == 1;
    let mut texts: Vec<String> = Vec::new();
    for (mosaic, role) in dem.mosaics.iter().zip(roles) {
        let whose = if is_one { String::new() } else { format!(" of {}", names(dem, mosaic)) };
        let text = match &role.method {
            Method::Aligned(Alignment { every, .. }) => {
                let nodes =
                    if is_one { "nodes are the DEM's samples" } else { "nodes are the samples" };
                let share = match every {
                    1 => String::new(),
                    every => format!(", one in {every} along both axes"),
                };
                format!("{nodes}{whose}{share}")
            }
            Method::Resampled(positions, kernel) => {
                let how = if kernel.is_average() { "area average of" } else { "bilinear between" };
                let the = if is_one { "" } else { "the " };
                let step = positions.step;
                let exact = if step == 1 {
                    "every node transformed".to_owned()
                } else {
                    format!("positions interpolated over {step} × {step} nodes")
                };
                format!("{how} {the}samples{whose} in {}, {exact}", mosaic.crs.label)
            }
        };
        texts.push(text);
    }
    texts.join("; where those have no data: ")
}

/// Files on other grids than the first one's, whose samples are nodes, and the first file.
pub(crate) fn resampled_onto_first(dem: &Dem, roles: &[MosaicRole]) -> Option<[String; 2]> {
    let is_resampled = |role: &MosaicRole| matches!(role.method, Method::Resampled(..));
    let (_, others) = roles.split_first().filter(|(first, _)| !is_resampled(first))?;
    let told: Vec<String> = dem.mosaics[1..]
        .iter()
        .zip(others)
        .filter(|(_, role)| is_resampled(role))
        .map(|(mosaic, _)| names(dem, mosaic))
        .collect();
    (!told.is_empty()).then(|| [told.join(", "), names(dem, &dem.mosaics[0])])
}

/// The names of a mosaic's files, without folders.
fn names(dem: &Dem, mosaic: &Mosaic) -> String {
    let name = |file: &MosaicFile| {
        let path = &dem.sources[file.index].path;
        path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned()
    };
    first_names(mosaic.files.iter().map(name))
}
