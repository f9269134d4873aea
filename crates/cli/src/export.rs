//! `corniche export`: what a package holds, for other programs.

use std::{cell::RefCell, io::stderr, time::Duration};

use corniche_export::{
    Coordinates, ExportSummary, RoadsRequest, VectorFormat, Watch, Work, export_roads,
};
use corniche_tileset::FilePackage;
use indicatif::{ProgressBar, ProgressStyle};

use crate::{
    args::{Export, ExportArgs, ExportCrs, ExportRoadsArgs},
    exit::ExitCode,
    failure::Failure,
    interrupt, messages,
    named_output::NamedOutput,
    output::Existing,
    table::{Digits, bytes, length},
};

/// Memory for sorting pieces of roads by way.
const MEMORY_BYTES: u64 = 128 << 20;

pub(crate) fn run(args: &ExportArgs) -> Result<ExitCode, Failure> {
    match &args.what {
        Export::Roads(args) => roads(args),
    }
}

fn roads(args: &ExportRoadsArgs) -> Result<ExitCode, Failure> {
    let format = format(args)?;
    let coordinates = match (args.crs, args.heights) {
        (ExportCrs::Package, None) => Coordinates::Package,
        (ExportCrs::Wgs84, None) => Coordinates::Wgs84,
        (ExportCrs::Wgs84, Some(_)) => Coordinates::Wgs84WithPackageHeights,
        (ExportCrs::Package, Some(_)) => {
            return Err(Failure::unusable(
                "--heights as-is goes with --crs EPSG:4979; without it heights are the package's in any case",
            ));
        }
    };
    let package = FilePackage::open(&args.package)?;
    let request = RoadsRequest {
        format,
        level: args.level,
        classes: args.classes.classes(),
        bounds: args.bounds,
        pieces: args.pieces,
        coordinates,
        memory_bytes: MEMORY_BYTES,
    };
    let name = format!("roads.{}", format.ending());
    let existing = Existing::of(args.overwrite);
    let output = NamedOutput::create(&args.output, existing, name, &[&args.package])?;
    let bar = Bar::new(messages::is_for_people());
    let exported = export_roads(&package, &request, &output.path(), &bar);
    bar.end();
    let summary = exported?;
    let size = output.place()?;
    messages::note(&to_text(args, &summary, &package.manifest().attribution.join("; "), size));
    Ok(ExitCode::Done)
}

/// The format that is named, or that of the ending.
fn format(args: &ExportRoadsArgs) -> Result<VectorFormat, Failure> {
    let named = args.format.map(VectorFormat::from);
    named.or_else(|| VectorFormat::of_path(&args.output)).ok_or_else(|| {
        let endings = VectorFormat::ALL.map(|format| format!(".{}", format.ending())).join(", ");
        Failure::unusable(format!(
            "the ending of {} says no format; use one of {endings}, or name it with --format",
            args.output.display()
        ))
    })
}

fn to_text(
    args: &ExportRoadsArgs,
    summary: &ExportSummary,
    attribution: &str,
    size: u64,
) -> String {
    let count = |number| Digits::on(&stderr()).count(number);
    let what = if args.pieces {
        format!("{} pieces of {} ways", count(summary.features), count(summary.ways))
    } else {
        format!("{} ways", count(summary.features))
    };
    format!(
        "{}: {what} of level {}, {}, {} vertices, {}\nheights: {}\nto be shown with it: {attribution}",
        args.output.display(),
        summary.level,
        length((summary.length_2d_m * 1e6).round() as u64),
        count(summary.vertices),
        bytes(size),
        summary.heights,
    )
}

/// A bar on a terminal, and whether the program is asked to end.
pub(crate) struct Bar {
    bar: ProgressBar,
    work: RefCell<Option<Work>>,
}

impl Bar {
    pub(crate) fn new(is_shown: bool) -> Self {
        // Elsewhere than on a terminal it is not drawn.
        let bar = if is_shown { ProgressBar::new(0) } else { ProgressBar::hidden() };
        let style = ProgressStyle::with_template("{msg:22} {bar:40} {pos}/{len}  {elapsed}");
        if let Ok(style) = style {
            bar.set_style(style);
        }
        bar.enable_steady_tick(Duration::from_millis(200));
        Self { bar, work: RefCell::new(None) }
    }

    pub(crate) fn end(&self) {
        self.bar.finish_and_clear();
    }
}

impl Watch for Bar {
    fn done(&self, work: Work, done: u64, total: u64) {
        if self.work.replace(Some(work)) != Some(work) {
            self.bar.reset();
            self.bar.set_message(match work {
                Work::Tiles => "reading tiles",
                Work::Pieces => "writing roads",
            });
        }
        self.bar.set_length(total);
        self.bar.set_position(done);
    }

    fn should_stop(&self) -> bool {
        interrupt::is_noted()
    }
}
