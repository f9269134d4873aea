//! `corniche growth`: what laying roads on the terrain costs.

mod chart;
mod compare;
mod csv;
mod document;
mod factors;
mod per_way;
mod text;

use std::{
    io::{self, Write as _},
    path::Path,
};

use corniche_tileset::FilePackage;

use self::compare::Compared;
use crate::{
    args::GrowthArgs,
    documents::to_line,
    exit::ExitCode,
    failure::Failure,
    messages,
    names::Format,
    output::{Output, existing_of},
    table::Digits,
};

pub(crate) fn run(args: &GrowthArgs) -> Result<ExitCode, Failure> {
    if args.svg.is_some() {
        chart::refuse_too_many(args.packages.len())?;
    }
    let mut packages = Vec::with_capacity(args.packages.len());
    for path in &args.packages {
        let package = FilePackage::open(path)?;
        if package.manifest().growth.is_empty() {
            let path = path.display();
            return Err(Failure::unusable(format!(
                "{path} has no roads: it was built without --osm"
            )));
        }
        packages.push(package);
    }
    let compared = Compared::all(&packages, &args.packages);
    // Files are written first, because the reader of the table may close the pipe before its end.
    write_files(args, &packages, &compared)?;
    let mut out = io::stdout().lock();
    let answer = match &compared[..] {
        [one] if args.json => format!("{}\n", to_line(&document::document(one.manifest))),
        [one] if args.csv => csv::to_csv(one.manifest),
        [one] => text::to_text(one.manifest, Digits::on(&io::stdout())),
        several if args.json => format!("{}\n", to_line(&compare::to_document(several))),
        several if args.csv => {
            for difference in compare::differences(several) {
                messages::warning(&format!("not like with like: {}", difference.text(several)));
            }
            let named = several.iter().map(|package| (package.name.as_str(), package.manifest));
            csv::to_csv_of_several(named)
        }
        several => compare::to_text(several, Digits::on(&io::stdout())),
    };
    out.write_all(answer.as_bytes())?;
    Ok(ExitCode::Done)
}

fn write_files(
    args: &GrowthArgs,
    packages: &[FilePackage],
    compared: &[Compared<'_>],
) -> Result<(), Failure> {
    let existing = existing_of(args.overwrite);
    let others = |own: &Path| -> Vec<&Path> {
        let targets = args.svg.iter().chain(&args.per_way).filter(|&target| *target != *own);
        args.packages.iter().chain(targets).map(AsRef::as_ref).collect()
    };
    if args.svg.is_some() && args.svg == args.per_way {
        return Err(Failure::unusable("--svg and --per-way name one file; give each its own"));
    }
    let begin = |path: &Path| Output::create(path, existing, &others(path));
    // Both places are looked at before any work is done.
    let svg = args.svg.as_deref().map(begin).transpose()?;
    args.svg.as_deref().map_or(Ok(()), |path| Format::Chart.refuse_others(path))?;
    let per_way = match (&args.per_way, packages) {
        (Some(path), [package]) => Some((package, path, begin(path)?)),
        (Some(_), _) => {
            return Err(Failure::unusable(
                "--per-way tells of one package; run it once for each, with a file of its own",
            ));
        }
        (None, _) => None,
    };
    if let Some(output) = svg {
        let svg = match compared {
            [one] => chart::growth(one.manifest),
            several => chart::comparison(several),
        };
        let svg = svg.map_err(|error| Failure::new(ExitCode::Failed, error))?;
        output.write_whole(svg.as_bytes())?;
    }
    if let Some((package, path, output)) = per_way {
        per_way::write(package, path, output)?;
    }
    Ok(())
}
