//! All output files of a flight: either all of them are written, or none.

use std::path::Path;

use corniche_viewer::{
    Replay,
    flight::{Flight, WorkingCrs},
};

use super::{chart, list, measured_run::MeasuredRun, pictures::Pictures};
use crate::{
    args::FlyArgs,
    failure::Result,
    names::CHART,
    output::{Complete, Existing, Output, existing_of},
    styles,
};

/// Temporary files and a folder next to their targets, which are still untouched.
pub(crate) struct Outputs {
    csv: Output,
    svg: Option<Output>,
    save_path: Option<Output>,
    pictures: Option<Pictures>,
}

impl Outputs {
    /// Begins the requested files. None of them may be an input of the command, and no two may be
    /// the same.
    pub(crate) fn create(args: &FlyArgs) -> Result<Self> {
        let existing = existing_of(args.overwrite);
        let mut used: Vec<&Path> = vec![args.from.package.name()];
        used.extend(args.flight.path.as_deref());
        used.extend(styles::file_of(&args.look.style));
        let csv = Output::create(&args.output, existing, &used)?;
        used.push(&args.output);
        let svg = create(args.svg.as_deref(), existing, &mut used)?;
        args.svg.as_deref().map_or(Ok(()), |path| CHART.refuse_others(path))?;
        let save_path = create(args.flight.save_path.as_deref(), existing, &mut used)?;
        let pictures =
            args.png.as_deref().map(|folder| Pictures::create(folder, &used)).transpose()?;
        Ok(Self { csv, svg, save_path, pictures })
    }

    /// Adds the last frame, if images are requested.
    pub(crate) fn add_picture(&self, name: &str, replay: &Replay<'_>) -> Result<()> {
        self.pictures.as_ref().map_or(Ok(()), |pictures| pictures.add(name, replay))
    }

    /// Writes everything, with the flight in working metres; then moves everything to its target,
    /// the table last: if the table exists, everything else does.
    ///
    /// This can fail if a target was created or became unwritable after the flight began. Files
    /// that were moved before stay, and the table is missing.
    pub(crate) fn finish(
        self,
        flight: &Flight,
        working: WorkingCrs<'_>,
        runs: &[MeasuredRun],
        adapter: &str,
    ) -> Result<()> {
        let Self { csv, svg, save_path, pictures } = self;
        let mut written = Vec::new();
        if let Some(svg) = svg {
            let drawing = chart::flights(runs, adapter)?;
            written.push(svg.fill(drawing.as_bytes())?);
        }
        if let Some(save_path) = save_path {
            let text = flight.to_text(working).map_err(anyhow::Error::from)?;
            written.push(save_path.fill(text.as_bytes())?);
        }
        written.push(csv.fill(list::to_csv(runs).as_bytes())?);
        pictures.map_or(Ok(()), Pictures::finish)?;
        written.into_iter().try_for_each(Complete::place)
    }
}

/// Begins a requested file, which must not be among `used`, and adds it to `used`.
fn create<'a>(
    path: Option<&'a Path>,
    existing: Existing,
    used: &mut Vec<&'a Path>,
) -> Result<Option<Output>> {
    let Some(path) = path else { return Ok(None) };
    let output = Output::create(path, existing, used)?;
    used.push(path);
    Ok(Some(output))
}
