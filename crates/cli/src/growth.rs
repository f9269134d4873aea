//! `corniche growth`: the cost of draping roads on the terrain.

mod chart;
mod compare;
mod csv;
mod document;
mod factors;
mod per_way;
mod text;

use std::path::Path;

use corniche_remote::PackagePlace;
use corniche_tileset::FilePackage;

use self::compare::Compared;
use crate::{
    args::GrowthArgs,
    documents::to_line,
    failure::Result,
    messages,
    output::{Output, existing_of, report_files::ReportFiles},
    packages,
    table::Digits,
};

pub(crate) fn run(args: &GrowthArgs) -> Result<()> {
    if args.svg.is_some() {
        chart::refuse_too_many(args.packages.len())?;
    }
    let mut packages = Vec::with_capacity(args.packages.len());
    for place in &args.packages {
        let package = packages::open(place)?;
        if package.manifest().growth.is_empty() {
            refuse!(
                "{:?} has no roads: it was built without --osm, or from an extract without roads; build it again with roads",
                place.name()
            );
        }
        packages.push(package);
    }
    let compared = Compared::all(&packages);
    // Files are written first, because the reader of the table may close the pipe early.
    write_files(args, &packages, &compared)?;
    let answer = match &compared[..] {
        [one] if args.json => format!("{}\n", to_line(&document::document(one.manifest))),
        [one] if args.csv => csv::to_csv(one.manifest),
        [one] => text::to_text(one.manifest, Digits::of_answers()),
        several if args.json => format!("{}\n", to_line(&compare::to_document(several))),
        several if args.csv => {
            for difference in compare::differences(several) {
                warning!(
                    "the packages differ not only in cell and error bound: {}",
                    difference.text(several)
                );
            }
            let named = several.iter().map(|package| (package.name.as_str(), package.manifest));
            csv::to_csv_of_several(named)
        }
        several => compare::to_text(several, Digits::of_answers()),
    };
    Ok(messages::answer(&answer)?)
}

fn write_files(
    args: &GrowthArgs,
    packages: &[FilePackage],
    compared: &[Compared<'_>],
) -> Result<()> {
    if args.per_way.is_some() && packages.len() != 1 {
        refuse!(
            "--per-way accepts a single package; run the command once for each, with a separate file"
        );
    }
    let inputs: Vec<&Path> = args.packages.iter().map(PackagePlace::name).collect();
    let list = [("--per-way", args.per_way.as_deref())];
    // Both paths are checked before any work is done.
    let files =
        ReportFiles::begin(args.svg.as_deref(), list, &inputs, existing_of(args.overwrite))?;
    let make_svg = || {
        Ok(match compared {
            [one] => chart::growth(one.manifest)?,
            several => chart::comparison(several)?,
        })
    };
    let mut told = None;
    let fill_list = |_, output: Output| {
        // The list exists only for a single package, which was checked above.
        let path = args.per_way.as_deref().unwrap_or(Path::new(""));
        let (list, note) = per_way::fill(&packages[0], path, output)?;
        told = Some(note);
        Ok(list)
    };
    files.write(fill_list, make_svg)?;
    if let Some(note) = &told {
        messages::note(note);
    }
    Ok(())
}
