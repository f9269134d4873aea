//! The growth table as text.

use corniche_tileset::{GrowthRow, Manifest, SectionLevelRecord};

use super::factors::{PAPER_GROWTH, factors, of_level, whole};
use crate::{
    documents::growth::Factors,
    info::or_dash,
    table::{Digits, Table, bytes},
};

/// A growth factor; a dash if the denominator is 0.
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

/// The table as text.
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
    let mut layers = Table::new(["layer", "parts", "points", "stored"]);
    for layer in &manifest.layers {
        let sum = |of: fn(&SectionLevelRecord) -> u64| layer.levels.iter().map(of).sum::<u64>();
        let [parts, points] = [sum(|of| of.parts), sum(|of| of.points)].map(|n| digits.count(n));
        layers.row([layer.table.id.clone(), parts, points, bytes(sum(|of| of.bytes))]);
    }
    let layers = if manifest.layers.is_empty() {
        String::new()
    } else {
        format!(
            "\nLayers, all levels together. They are stored in plan and laid on the ground when they are\n             drawn or exported, so they do not grow\n\n{}",
            layers.to_text()
        )
    };
    format!(
        "Vertices and bytes of roads, per level (all classes)\n\
         source: points in the extract; simplified: on the level; clipped: split at the triangle edges\n\
         (GEO); SV: for shadow volumes; raw, stored: bytes of clipped roads\n\n{}\nPer level and class\n{}\n\
         All levels together have {} times the vertices of the source, and {} times the bytes of the\n\
         source's coordinates as f64 pairs ({} times as stored).\nVaaraniemi, Treib & Westermann 2011, section 7: clipping makes road data about {PAPER_GROWTH} times as large.\n{layers}",
        levels.to_text(),
        classes.to_text(),
        factor(all_factors.growth_over_source),
        factor(all_factors.raw_bytes_over_source),
        factor(all_factors.stored_bytes_over_source),
    )
}
