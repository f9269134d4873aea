//! Where the paths in a settings file begin.

use std::path::{Path, PathBuf};

use crate::{config::Config, files::InputFiles, frc::frc_preset};

impl Config {
    /// The same settings, with paths that begin at `folder`, which the settings file is in, instead of the working folder. Absolute
    /// paths and addresses (`s3://…`) stay, and so do names of presets.
    #[must_use]
    pub fn in_folder(mut self, folder: &Path) -> Self {
        let Self { inputs, output, roads, resources, .. } = &mut self;
        let InputFiles { dem, terrain, osm, polygon } = inputs;
        let files = dem.iter_mut().chain(terrain).chain(osm.iter_mut()).chain(polygon);
        let written =
            output.package.iter_mut().chain(&mut output.defects).chain(&mut resources.tmp);
        for path in files.chain(written) {
            *path = within(folder, path);
        }
        if let Some(table) = roads.frc_table.as_mut().filter(|table| frc_preset(table).is_none())
            && let Some(path) = within(folder, Path::new(table)).to_str()
        {
            path.clone_into(table);
        }
        self
    }
}

fn within(folder: &Path, path: &Path) -> PathBuf {
    let is_address = path.to_str().is_some_and(|text| text.contains("://"));
    if is_address { path.to_owned() } else { folder.join(path) }
}

#[cfg(test)]
#[path = "folder_tests.rs"]
mod tests;
