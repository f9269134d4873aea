//! Resolves the relative paths in a settings file.

use std::path::{Path, PathBuf};

use crate::{
    InputFiles,
    build_options::Config,
    frc::frc_preset,
    layers::{is_no_layers, layer_preset},
    photo::is_photo_off,
};

impl Config {
    /// The same settings, with paths relative to `folder`, which the settings file is in, instead
    /// of the working folder. Absolute paths, URLs (`s3://…`), names with a GDAL driver (`GPKG:…`)
    /// and names of presets are unchanged.
    #[must_use]
    pub fn in_folder(mut self, folder: &Path) -> Self {
        let Self { inputs, output, roads, layers, resources, .. } = &mut self;
        let InputFiles { dem, terrain, osm, polygon, photo } = inputs;
        let files = dem.iter_mut().chain(terrain).chain(osm.iter_mut()).chain(polygon);
        let photo = if is_photo_off(photo) { &mut [] } else { &mut photo[..] };
        let files = files.chain(photo);
        let written =
            output.package.iter_mut().chain(&mut output.defects).chain(&mut resources.tmp);
        for path in files.chain(written) {
            *path = within(folder, path);
        }
        let layers = if is_no_layers(&layers.tables) { &mut [] } else { &mut layers.tables[..] };
        let layers = layers.iter_mut().filter(|table| layer_preset(table).is_none());
        let frc_table = roads.frc_table.as_mut().filter(|table| frc_preset(table).is_none());
        for table in layers.chain(frc_table) {
            if let Some(path) = within(folder, Path::new(table)).to_str() {
                path.clone_into(table);
            }
        }
        self
    }
}

/// Resolves a path. A list (`@list.txt`) stays a list, and names that only GDAL understands
/// (`GTIFF_DIR:1:dem.tif`, capitals before the first colon) are unchanged.
fn within(folder: &Path, path: &Path) -> PathBuf {
    let text = path.to_str().unwrap_or_default();
    if let Some(list) = text.strip_prefix('@') {
        let list = folder.join(list);
        return list.to_str().map_or_else(|| path.to_owned(), |list| format!("@{list}").into());
    }
    let is_driver_prefix = text.split_once(':').is_some_and(|(prefix, _)| {
        prefix.len() > 1
            && prefix
                .bytes()
                .all(|byte| byte.is_ascii_uppercase() || byte.is_ascii_digit() || byte == b'_')
    });
    if text.contains("://") || is_driver_prefix { path.to_owned() } else { folder.join(path) }
}

#[cfg(test)]
#[path = "folder_tests.rs"]
mod tests;
