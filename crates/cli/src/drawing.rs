//! The lines and areas that a person draws in a window: where they come from and where they go.

use std::{
    collections::BTreeMap,
    io,
    path::{Path, PathBuf},
    sync::Arc,
};

use corniche_overlay::{EllipsoidHeights, LineFile, SavedLine, Shape};
use corniche_store::is_same_file;
use corniche_viewer::tiles::{MapPackage as _, PackageSource, TileStore};
use corniche_window::{DrawnLine, NotSaved, SaveDrawing};

use crate::{
    failure::Failure,
    messages,
    output::{Existing, Output},
};

/// Without a name, lines go into a file with the first free number up to this.
const MOST: u32 = 99_999;

/// Lines to begin with, and the way to save them.
pub(crate) struct Drawing {
    pub(crate) lines: Vec<DrawnLine>,
    pub(crate) save: SaveDrawing,
}

/// Where lines are saved.
enum SaveTarget {
    File(PathBuf),
    /// The next free name in a folder.
    Folder(PathBuf),
}

impl Drawing {
    /// The lines of `file`, if that is given and is there. They are saved there, or, without one, in a new file in `folder`.
    pub(crate) fn begin(
        file: Option<&Path>,
        folder: &Path,
        used: &[&Path],
        package: Arc<PackageSource>,
    ) -> Result<Self, Failure> {
        let mut known = LineFile::default();
        if let Some(path) = file {
            if used.iter().any(|used| is_same_file(used, path)) {
                return Err(Failure::unusable(format!(
                    "--draw {}: the command uses that file itself; choose another name",
                    path.display()
                )));
            }
            if path.symlink_metadata().is_ok() {
                known = LineFile::read(path)?;
            }
            // A place that cannot be written is told before anything is drawn.
            drop(Output::create(path, Existing::Replace, used)?);
            if known.others() > 0 {
                messages::note(&format!(
                    "note: {}: {} features are no single lines or areas without holes; they stay as they are",
                    path.display(),
                    known.others()
                ));
            }
        }
        let lines = known
            .lines()
            .into_iter()
            .map(|(feature, shape, points_deg)| DrawnLine {
                feature: Some(feature),
                is_area: shape == Shape::Area,
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
) -> Result<PathBuf, Failure> {
    // Heights may be left out; lines may not be lost for want of them.
    let heights = EllipsoidHeights::of(package.manifest()).unwrap_or_else(|error| {
        without_heights(&Failure::from(error));
        None
    });
    let old = known.lines().into_iter();
    let old: BTreeMap<usize, (bool, Vec<[f64; 2]>)> = old
        .map(|(number, shape, points_deg)| (number, (shape == Shape::Area, points_deg)))
        .collect();
    let mut store: TileStore<'_> = TileStore::new(package);
    let mut saved = Vec::with_capacity(lines.len());
    for line in lines {
        // What has not changed stays as it is in the file.
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
        let shape = if line.is_area { Shape::Area } else { Shape::Line };
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

/// Heights of the finest ground at the points of a line, above the ellipsoid; `None` if one of them is not known.
fn heights_of(
    line: &DrawnLine,
    heights: &EllipsoidHeights,
    package: &PackageSource,
    store: &mut TileStore<'_>,
) -> Result<Option<Vec<f64>>, Failure> {
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

fn without_heights(failure: &Failure) {
    messages::note(&format!("note: lines are saved without heights: {failure}"));
}

fn free_name(folder: &Path) -> Result<PathBuf, Failure> {
    std::fs::create_dir_all(folder)
        .map_err(|error| Failure::unusable(format!("{}: {error}", folder.display())))?;
    let names = (1..=MOST).map(|number| folder.join(format!("lines-{number:05}.geojson")));
    names.into_iter().find(|path| path.symlink_metadata().is_err()).ok_or_else(|| {
        Failure::unusable(format!("all numbers up to {MOST} are taken in {}", folder.display()))
    })
}
