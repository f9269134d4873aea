//! `corniche growth`: what laying roads on the terrain costs.

mod chart;

use std::io::{self, Write as _};

use corniche_tileset::{FilePackage, GrowthRow, Manifest};

use crate::{
    args::GrowthArgs,
    documents::{
        growth::{GrowthDocument, LevelGrowthDocument, WholeGrowthDocument},
        to_line,
    },
    exit::ExitCode,
    failure::Failure,
    output::{Existing, Output},
    table::{Digits, Table, bytes},
};

/// "About ten": Vaaraniemi, Treib & Westermann 2011, for whole data sets without class filter.
const PAPER_GROWTH: f64 = 10.0;

pub(crate) fn run(args: &GrowthArgs) -> Result<ExitCode, Failure> {
    let package = FilePackage::open(&args.package)?;
    let manifest = package.manifest();
    if manifest.growth.is_empty() {
        return Err(Failure::unusable(format!(
            "{} has no roads: it was built without --osm",
            args.package.display()
        )));
    }
    // The chart is written first, because the reader of the table may close the pipe before its end.
    if let Some(path) = &args.svg {
        let output = Output::create(path, Existing::of(args.overwrite), &[&args.package])?;
        let svg = chart::growth(manifest).map_err(|error| Failure::new(ExitCode::Failed, error))?;
        output.write_whole(svg.as_bytes())?;
    }
    let mut out = io::stdout().lock();
    if args.json {
        writeln!(out, "{}", to_line(&document(manifest)))?;
    } else if args.csv {
        out.write_all(to_csv(manifest).as_bytes())?;
    } else {
        out.write_all(to_text(manifest, Digits::on(&io::stdout())).as_bytes())?;
    }
    Ok(ExitCode::Done)
}

/// Rows of a level summed over its classes, or of all levels.
pub(crate) fn sum<'a>(rows: impl Iterator<Item = &'a GrowthRow>) -> GrowthRow {
    rows.fold(GrowthRow::default(), |sum, row| GrowthRow {
        level: row.level,
        class: 0,
        source_vertices: sum.source_vertices + row.source_vertices,
        simplified_vertices: sum.simplified_vertices + row.simplified_vertices,
        geo_vertices: sum.geo_vertices + row.geo_vertices,
        sv_vertices: sum.sv_vertices + row.sv_vertices,
        source_bytes: sum.source_bytes + row.source_bytes,
        simplified_bytes: sum.simplified_bytes + row.simplified_bytes,
        geo_raw_bytes: sum.geo_raw_bytes + row.geo_raw_bytes,
        geo_stored_bytes: sum.geo_stored_bytes + row.geo_stored_bytes,
        sv_stored_bytes: sum.sv_stored_bytes + row.sv_stored_bytes,
    })
}

/// Growth factors of a row, or of a sum of rows.
pub(crate) struct Factors {
    /// Clipped vertices over the level's own simplified line.
    pub(crate) over_simplified: Option<f64>,
    /// Clipped vertices over the source.
    pub(crate) over_source: Option<f64>,
    /// Clipped bytes, raw, over the source's.
    pub(crate) raw_bytes: Option<f64>,
    /// Clipped bytes, stored, over the source's.
    pub(crate) stored_bytes: Option<f64>,
    /// Clipped bytes, raw, over the level's own simplified line's.
    pub(crate) raw_over_simplified: Option<f64>,
    /// Clipped bytes, stored, over the level's own simplified line's.
    pub(crate) stored_over_simplified: Option<f64>,
}

/// All levels together cost the sum of the levels, against one copy of the source: what the finest level, which
/// shows every class, has of it.
pub(crate) fn whole(manifest: &Manifest) -> (GrowthRow, Factors) {
    let finest = manifest.levels.last().map_or(0, |level| level.level);
    let source = sum(manifest.growth.iter().filter(|row| row.level == finest));
    let all = GrowthRow {
        source_vertices: source.source_vertices,
        source_bytes: source.source_bytes,
        ..sum(manifest.growth.iter())
    };
    let factors = factors(&all);
    (all, factors)
}

pub(crate) fn factors(row: &GrowthRow) -> Factors {
    let ratio = |above: u64, below: u64| (below > 0).then(|| above as f64 / below as f64);
    Factors {
        over_simplified: ratio(row.geo_vertices, row.simplified_vertices),
        over_source: ratio(row.geo_vertices, row.source_vertices),
        raw_bytes: ratio(row.geo_raw_bytes, row.source_bytes),
        stored_bytes: ratio(row.geo_stored_bytes, row.source_bytes),
        raw_over_simplified: ratio(row.geo_raw_bytes, row.simplified_bytes),
        stored_over_simplified: ratio(row.geo_stored_bytes, row.simplified_bytes),
    }
}

fn factor(value: Option<f64>) -> String {
    value.map_or_else(|| "–".to_owned(), |value| format!("{value:.2}"))
}

fn line(name: String, row: &GrowthRow, factors: &Factors, digits: Digits) -> [String; 13] {
    let count = |number| digits.count(number);
    [
        name,
        count(row.source_vertices),
        count(row.simplified_vertices),
        count(row.geo_vertices),
        count(row.sv_vertices),
        factor(factors.over_simplified),
        factor(factors.over_source),
        bytes(row.geo_raw_bytes),
        bytes(row.geo_stored_bytes),
        factor(factors.raw_bytes),
        factor(factors.stored_bytes),
        factor(factors.raw_over_simplified),
        factor(factors.stored_over_simplified),
    ]
}

fn to_text(manifest: &Manifest, digits: Digits) -> String {
    let headings = [
        "",
        "source",
        "simplified",
        "clipped",
        "SV",
        "/simplified",
        "/source",
        "raw",
        "stored",
        "raw/source",
        "stored/source",
        "raw/simplified",
        "stored/simplified",
    ];
    let mut levels = Table::new(headings);
    for level in &manifest.levels {
        let row = sum(manifest.growth.iter().filter(|row| row.level == level.level));
        levels.row(line(format!("level {}", level.level), &row, &factors(&row), digits));
    }
    let (all, all_factors) = whole(manifest);
    levels.row(line("all levels".to_owned(), &all, &all_factors, digits));
    let mut classes = Table::new(headings);
    for row in &manifest.growth {
        let name = format!("level {} FRC {}", row.level, row.class);
        classes.row(line(name, row, &factors(row), digits));
    }
    format!(
        "Vertices and bytes of roads, per level (all classes)\n{}\nPer level and class\n{}\n\
         All levels together hold {} times the source's vertices and {} times its bytes as f64 pairs \
         ({} as stored);\nthe paper reports about {PAPER_GROWTH} for whole data sets, all classes on every level, \
         nothing simplified.\n",
        levels.to_text(),
        classes.to_text(),
        factor(all_factors.over_source),
        factor(all_factors.raw_bytes),
        factor(all_factors.stored_bytes),
    )
}

fn document(manifest: &Manifest) -> GrowthDocument {
    let (all, all_factors) = whole(manifest);
    let level = |level: u8| {
        let row = sum(manifest.growth.iter().filter(|row| row.level == level));
        let factors = factors(&row);
        LevelGrowthDocument {
            level,
            source_vertices: row.source_vertices,
            simplified_vertices: row.simplified_vertices,
            geo_vertices: row.geo_vertices,
            sv_vertices: row.sv_vertices,
            geo_raw_bytes: row.geo_raw_bytes,
            geo_stored_bytes: row.geo_stored_bytes,
            sv_stored_bytes: row.sv_stored_bytes,
            growth_over_simplified: factors.over_simplified,
            growth_over_source: factors.over_source,
            raw_bytes_over_simplified: factors.raw_over_simplified,
            stored_bytes_over_simplified: factors.stored_over_simplified,
            raw_bytes_over_source: factors.raw_bytes,
            stored_bytes_over_source: factors.stored_bytes,
        }
    };
    GrowthDocument {
        rows: manifest.growth.iter().map(Into::into).collect(),
        levels: manifest.levels.iter().map(|record| level(record.level)).collect(),
        all_levels: WholeGrowthDocument {
            source_vertices: all.source_vertices,
            geo_vertices: all.geo_vertices,
            growth_over_source: all_factors.over_source,
            raw_bytes_over_source: all_factors.raw_bytes,
            stored_bytes_over_source: all_factors.stored_bytes,
        },
        paper: PAPER_GROWTH,
    }
}

/// A row for each level and class, then for each level, then for the whole; ratios are empty where there is nothing to divide by.
fn to_csv(manifest: &Manifest) -> String {
    let mut text = "level,class,source_vertices,simplified_vertices,geo_vertices,sv_vertices,source_bytes,simplified_bytes,\
                    geo_raw_bytes,geo_stored_bytes,sv_stored_bytes,growth_over_simplified,growth_over_source,raw_bytes_over_source,\
                    stored_bytes_over_source,raw_bytes_over_simplified,stored_bytes_over_simplified\n"
        .to_owned();
    let mut line = |level: &str, class: &str, row: &GrowthRow, factors: &Factors| {
        let counts = row.counts().map(|count| count.to_string());
        let ratios = [
            factors.over_simplified,
            factors.over_source,
            factors.raw_bytes,
            factors.stored_bytes,
            factors.raw_over_simplified,
            factors.stored_over_simplified,
        ];
        let ratios = ratios.map(|ratio| ratio.map_or_else(String::new, |ratio| ratio.to_string()));
        text.push_str(
            &[level, class]
                .into_iter()
                .chain(counts.iter().chain(&ratios).map(String::as_str))
                .collect::<Vec<_>>()
                .join(","),
        );
        text.push('\n');
    };
    for row in &manifest.growth {
        line(&row.level.to_string(), &row.class.to_string(), row, &factors(row));
    }
    for level in &manifest.levels {
        let row = sum(manifest.growth.iter().filter(|row| row.level == level.level));
        line(&level.level.to_string(), "all", &row, &factors(&row));
    }
    let (all, all_factors) = whole(manifest);
    line("all", "all", &all, &all_factors);
    text
}
