//! The lines of the user's files that `--overlay` names.

use std::{path::Path, sync::Arc};

use corniche_overlay::{MOST_POINTS, OverlayError, VectorLines, place, read};
use corniche_styles::LineStyle;
use corniche_tileset::Manifest;
use corniche_viewer::tiles::{Overlays, StyledLine};

use crate::{
    args::{LookArgs, OverlayArg},
    failure::Result,
    messages,
    names::file_name,
};

/// Reads the files and projects their lines for a package. Features outside the package and
/// features that are not lines are reported.
pub(crate) fn load(look: &LookArgs, manifest: &Manifest) -> Result<Arc<Overlays>> {
    let files = &look.overlay;
    if files.len() > LineStyle::MOST {
        let most = LineStyle::MOST;
        refuse!("--overlay accepts at most {most} files");
    }
    let (mut lines, mut first, mut points) = (Vec::new(), 0, 0);
    for (style, file) in (0..).zip(files) {
        let found = read(&file.path, look.allow_ballpark)?;
        points += found.lines.iter().map(|line| line.positions_deg.len()).sum::<usize>();
        if points > MOST_POINTS {
            let (path, limit) = (file.path.clone(), MOST_POINTS);
            return Err(OverlayError::TooManyTogether { path, limit }.into());
        }
        let placed = place(&found.lines, manifest)?;
        tell(&file.path, &found);
        let is_near = placed.iter().any(|line| {
            let tile = manifest.frame.tile_lattice_bounds(corniche_geom::TileId::ROOT);
            line.points.iter().any(|point| tile.contains(*point))
        });
        if !is_near {
            note(&file.path, "no point of its lines is in the package");
        }
        lines.extend(placed.into_iter().map(|line| StyledLine {
            id: (first + line.line) as i64,
            style,
            points: line.points,
        }));
        first += found.lines.len();
    }
    Ok(Arc::new(Overlays::new(&lines, &manifest.frame).of_files(names(files))))
}

/// Reports features of a file that may be unintended.
pub(crate) fn tell(path: &Path, found: &VectorLines) {
    for notice in found.notices() {
        note(path, &notice);
    }
    found.datums.warnings().for_each(|text| messages::warning(&text));
}

fn note(path: &Path, what: &str) {
    note!("note: {path:?}: {what}");
}

/// The names of the files.
pub(crate) fn names(files: &[OverlayArg]) -> Vec<String> {
    files.iter().map(|file| file_name(&file.path)).collect()
}
