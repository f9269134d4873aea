//! The lines and areas that a user draws in a window: how they are loaded and saved.

use std::{
    collections::BTreeMap,
    io,
    path::{Path, PathBuf},
    sync::Arc,
};

use corniche_overlay::{EllipsoidHeights, LineFile, LineShape, SavedLine};
use corniche_store::is_same_file;
use corniche_viewer::tiles::{MapPackage as _, PackageSource, TileStore};
use corniche_window::{DrawnLine, NotSaved, SaveDrawing};

use crate::{
    failure::{CommandFailure, Result},
    output::{Existing, Output},
};

/// The largest number in a file name that is chosen automatically.
const MOST: u32 = 99_999;

/// The lines at the start, and where to save them.
pub(crate) struct DrawingFile {
    pub lines: Vec<DrawnLine>,
    pub save: SaveDrawing,
}

/// The target for saving lines.
enum SaveTarget {
    File(PathBuf),
    /// The next free name in a folder.
    Folder(PathBuf),
}

impl DrawingFile {
    /// Loads the lines of `file` if it is given and exists. They are saved there, or without a file
    /// in a new file in `folder`.
    pub(crate) fn begin(
        file: Option<&Path>,
        folder: &Path,
        used: &[&Path],
        package: Arc<PackageSource>,
    ) -> Result<Self> {
        let mut known = LineFile::default();
        if let Some(path) = file {
            if used.iter().any(|used| is_same_file(used, path)) {
                refuse!("--draw {path:?}: the command already uses this file; choose another name");
            }
            if path.symlink_metadata().is_ok() {
                known = LineFile::read(path)?;
            }
            // An unwritable path is reported before anything is drawn.
            drop(Output::create(path, Existing::Replace, used)?);
            if known.others() > 0 {
                note!(
                    "note: {path:?}: {} features are neither single lines nor areas without holes; they are kept unchanged",
                    known.others()
                );
            }
        }
        let lines = known
            .lines()
            .into_iter()
            .map(|(feature, shape, points_deg)| DrawnLine {
                feature: Some(feature),
                is_area: shape == LineShape::Area,
                points_deg,
            })
            .collect();
        let mut place = match file {
            Some(path) => SaveTarget::File(path.to_path_buf()),
            None => SaveTarget::Folder(folder.to_path_buf()),
        };
        let save = move |lines: &[DrawnLine]| {
            let saved = save(&known, lines, &mut place, &package);
            saved.map_err(|failure| NotSaved::File {
                folder: place.path().to_path_buf(),
                source: io::Error::other(failure.to_string()),
            })
        };
        Ok(Self { lines, save: Box::new(save) })
    }
}

impl SaveTarget {
    fn path(&self) -> &Path {
        let (Self::File(path) | Self::Folder(path)) = self;
        path
    }
}

/// Writes all lines, with heights where these are known.
fn save(
    known: &LineFile,
    lines: &[DrawnLine],
    place: &mut SaveTarget,
    package: &PackageSource,
) -> Result<PathBuf> {
    // Heights may be omitted, but lines must not be lost for lack of them.
    let heights = EllipsoidHeights::from_manifest(package.manifest()).unwrap_or_else(|error| {
        without_heights(&CommandFailure::from(error));
        None
    });
    let old = known.lines().into_iter();
    let old: BTreeMap<usize, (bool, Vec<[f64; 2]>)> = old
        .map(|(number, shape, points_deg)| (number, (shape == LineShape::Area, points_deg)))
        .collect();
    let mut store: TileStore<'_> = TileStore::new(package);
    let mut saved = Vec::with_capacity(lines.len());
    for line in lines {
        // Unchanged features are kept as they are in the file.
        let known = line.feature.and_then(|feature| old.get(&feature));
        let is_old = known.is_some_and(|(is_area, points_deg)| {
            (*is_area, points_deg) == (line.is_area, &line.points_deg)
        });
        let heights_m = match heights.as_ref().filter(|_| !is_old) {
            Some(heights) => {
                let found = heights_of(line, heights, package, &mut store);
                found.unwrap_or_else(|failure| {
                    without_heights(&failure);
                    None
                })
            }
            None => None,
        };
        let shape = if line.is_area { LineShape::Area } else { LineShape::Line };
        let (feature, points_deg) = (line.feature, line.points_deg.clone());
        saved.push(SavedLine { feature, shape, points_deg, heights_m });
    }
    let text = known.text_with(&saved);
    let (path, existing) = match place {
        SaveTarget::File(path) => (path.clone(), Existing::Replace),
        SaveTarget::Folder(folder) => (free_name(folder)?, Existing::Keep),
    };
    Output::create(&path, existing, &[])?.write_whole(text.as_bytes())?;
    *place = SaveTarget::File(path.clone());
    Ok(path)
}

/// The heights of the finest ground at the points of a line, above the ellipsoid; `None` if one of
/// them is unknown.
fn heights_of(
    line: &DrawnLine,
    heights: &EllipsoidHeights,
    package: &PackageSource,
    store: &mut TileStore<'_>,
) -> Result<Option<Vec<f64>>> {
    let coordinates = &package.manifest().coordinates;
    let mut positions_m = Vec::new();
    let mut heights_m = Vec::new();
    for &point_deg in &line.points_deg {
        let Some(at_m) = coordinates.working_from_wgs84(point_deg) else { return Ok(None) };
        let Some(height_m) = store.ground_height_m(at_m)? else {
            return Ok(None);
        };
        positions_m.push(at_m);
        heights_m.push(height_m);
    }
    Ok(heights.carry(&positions_m, &mut heights_m).then_some(heights_m))
}

fn without_heights(failure: &CommandFailure) {
    note!("note: lines were saved without heights: {failure}");
}

fn free_name(folder: &Path) -> Result<PathBuf> {
    std::fs::create_dir_all(folder).map_err(|error| unusable!("{folder:?}: {error}"))?;
    let names = (1..=MOST).map(|number| folder.join(format!("lines-{number:05}.geojson")));
    names.into_iter().find(|path| path.symlink_metadata().is_err()).ok_or_else(|| {
        unusable!("all file numbers up to {MOST} are used in {folder:?}; choose another folder")
    })
}
