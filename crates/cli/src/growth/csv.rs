//! The growth table as CSV, of one package or of several.

use corniche_tileset::{GrowthRow, Manifest};

use super::factors::{factors, of_level, whole};
use crate::{defects::quoted, documents::growth::Factors};

const HEADINGS: &str = "level,class,source_vertices,simplified_vertices,geo_vertices,sv_vertices,source_bytes,simplified_bytes,\
                        geo_raw_bytes,geo_stored_bytes,sv_stored_bytes,growth_over_simplified,growth_over_source,\
                        raw_bytes_over_source,stored_bytes_over_source,raw_bytes_over_simplified,stored_bytes_over_simplified";

/// The rows of one package, with headings.
pub(crate) fn to_csv(manifest: &Manifest) -> String {
    format!("{HEADINGS}\n{}", rows("", manifest))
}

/// The rows of several packages, with a column for their names.
pub(crate) fn to_csv_of_several<'a>(
    packages: impl IntoIterator<Item = (&'a str, &'a Manifest)>,
) -> String {
    let rows =
        packages.into_iter().map(|(name, manifest)| rows(&format!("{},", quoted(name)), manifest));
    format!("package,{HEADINGS}\n{}", rows.collect::<String>())
}

fn rows(begin: &str, manifest: &Manifest) -> String {
    lines(manifest).iter().map(|line| [begin, line, "\n"].concat()).collect()
}

/// A row per level and class, then per level, then for all levels; ratios with a denominator of 0
/// are empty.
fn lines(manifest: &Manifest) -> Vec<String> {
    let mut lines = Vec::new();
    for row in &manifest.growth {
        lines.push(line(&row.level.to_string(), &row.class.to_string(), row, &factors(row)));
    }
    for level in &manifest.levels {
        let (row, factors) = of_level(manifest, level.level);
        lines.push(line(&level.level.to_string(), "all", &row, &factors));
    }
    let (all, factors) = whole(manifest);
    lines.push(line("all", "all", &all, &factors));
    lines
}

fn line(level: &str, class: &str, row: &GrowthRow, factors: &Factors) -> String {
    let counts = row.counts().map(|count| count.to_string());
    let ratios = [
        factors.growth_over_simplified,
        factors.growth_over_source,
        factors.raw_bytes_over_source,
        factors.stored_bytes_over_source,
        factors.raw_bytes_over_simplified,
        factors.stored_bytes_over_simplified,
    ];
    let ratios = ratios.map(|ratio| ratio.map_or_else(String::new, |ratio| ratio.to_string()));
    let cells = [level, class].into_iter().chain(counts.iter().chain(&ratios).map(String::as_str));
    cells.collect::<Vec<_>>().join(",")
}

#[cfg(test)]
#[path = "csv_tests.rs"]
mod tests;
