//! The table of growth as text for people.

use corniche_tileset::{GrowthRow, Manifest};

use super::factors::{PAPER_GROWTH, factors, of_level, whole};
use crate::{
    documents::growth::Factors,
    info::or_dash,
    table::{Digits, Table, bytes},
};

/// A growth factor; a dash where there is nothing to divide by.
pub(crate) fn factor(value: Option<f64>) -> String {
    or_dash(value, 2)
}

fn line(name: String, row: &GrowthRow, factors: &Factors, digits: Digits) -> [String; 13] {
    let count = |number| digits.count(number);
    [
        name,
        count(row.source_vertices),
        count(row.simplified_vertices),
        count(row.geo_vertices),
        count(row.sv_vertices),
        factor(factors.growth_over_simplified),
        factor(factors.growth_over_source),
        bytes(row.geo_raw_bytes),
        bytes(row.geo_stored_bytes),
        factor(factors.raw_bytes_over_source),
        factor(factors.stored_bytes_over_source),
        factor(factors.raw_bytes_over_simplified),
        factor(factors.stored_bytes_over_simplified),
    ]
}

/// The table for people.
pub(crate) fn to_text(manifest: &Manifest, digits: Digits) -> String {
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
        let (row, factors) = of_level(manifest, level.level);
        levels.row(line(format!("level {}", level.level), &row, &factors, digits));
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
         ({} as stored);\nVaaraniemi, Treib & Westermann 2011, section 7, report about {PAPER_GROWTH} times the size of the data.\n",
        levels.to_text(),
        classes.to_text(),
        factor(all_factors.growth_over_source),
        factor(all_factors.raw_bytes_over_source),
        factor(all_factors.stored_bytes_over_source),
    )
}
