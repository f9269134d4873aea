//! Growth tables of several packages, side by side.

use std::fmt::Write as _;

use corniche_settings::SettingValue;
use corniche_tileset::{
    DatumOperationRecord, FilePackage, InputKind, InputRecord, Manifest, SettingsRecord,
};

use super::{
    document::document,
    factors::{PAPER_GROWTH, of_level, whole},
    text::factor,
};
use crate::{
    documents::growth::{
        ComparedDocument, ComparisonDocument, DifferenceDocument, DifferentValueDocument,
    },
    escaped::in_line,
    info::{datum_operation, rounded, sides},
    table::{Digits, Table, wrapped},
};

/// A package in a comparison.
pub(crate) struct Compared<'a> {
    /// A letter for tables and charts.
    pub label: String,
    /// Its path as given, or its URL.
    pub name: String,
    pub manifest: &'a Manifest,
}

impl<'a> Compared<'a> {
    /// Labels the packages in their order: A, B, C and so on.
    pub(crate) fn all(packages: &'a [FilePackage]) -> Vec<Self> {
        let compared = |(index, package): (usize, &'a FilePackage)| Self {
            label: letters(index),
            name: package.path().display().to_string(),
            manifest: package.manifest(),
        };
        packages.iter().enumerate().map(compared).collect()
    }
}

/// The label of an index: A to Z, then AA, AB and so on.
fn letters(index: usize) -> String {
    const LETTERS: usize = 26;
    let last = char::from(b'A' + (index % LETTERS) as u8);
    match index / LETTERS {
        0 => last.to_string(),
        more => format!("{}{last}", letters(more - 1)),
    }
}

/// A difference between packages apart from cell and error bound; differences in growth may also
/// result from it.
#[derive(Debug, PartialEq)]
pub(crate) struct PackageDifference {
    pub what: &'static str,
    /// Each value, with the indices of the packages that have it.
    pub values: Vec<(Vec<usize>, String)>,
}

/// A property of a package: its name, and its value as text.
type Property = (&'static str, String);

/// The properties that differ between some packages.
pub(crate) fn differences(packages: &[Compared<'_>]) -> Vec<PackageDifference> {
    let of_each: Vec<_> = packages.iter().map(|package| properties(package.manifest)).collect();
    let Some(first) = of_each.first() else { return Vec::new() };
    let difference = |(property, &(what, _)): (usize, &Property)| {
        let mut values: Vec<(Vec<usize>, String)> = Vec::new();
        for (index, properties) in of_each.iter().enumerate() {
            let value = &properties[property].1;
            match values.iter_mut().find(|(_, known)| known == value) {
                Some((of, _)) => of.push(index),
                None => values.push((vec![index], value.clone())),
            }
        }
        (values.len() > 1).then_some(PackageDifference { what, values })
    };
    first.iter().enumerate().filter_map(difference).collect()
}

/// Settings that are not compared, or that are compared in other words.
const NOT_AS_THEY_ARE: [&str; 26] = [
    // The comparison is about these.
    "max_error_m",
    "cell_m",
    "cell_every",
    // The CRS of the package is compared instead.
    "crs",
    // These have no effect on roads.
    "relief",
    "photo",
    "areas",
    "boundaries",
    "spans",
    // The labels are determined by the table.
    "class_labels",
    // These are worded separately.
    "dem_band",
    "dem_crs",
    "dem_vertical_crs",
    "vertical_crs",
    "vertical_shift_m",
    "vertical_unit",
    "nodata",
    "fill_voids",
    "bounds_deg",
    "polygon",
    "height_range_m",
    "scale_latitude_deg",
    "frc_table",
    "classes",
    "class_max_cell_m",
    "simplify_cells",
];

/// All properties that growth depends on, except cell and error bound, which the comparison is
/// about.
fn properties(manifest: &Manifest) -> Vec<Property> {
    let settings = &manifest.settings;
    let nodata = Some(&settings.nodata).filter(|values| !values.is_empty());
    let usual = || "the default".to_owned();
    let mut properties = vec![
        ("extract", inputs(manifest, &[InputKind::Osm])),
        ("elevation data", inputs(manifest, &InputKind::OF_TERRAIN)),
        ("band of the elevation data", or(settings.dem_band.as_ref(), "the only one")),
        ("operations between datums", datum_operations(&manifest.datum_operations)),
        ("CRS of the elevation data", or(settings.dem_crs.as_ref(), "as in its files")),
        (
            "vertical CRS of the elevation data",
            or(settings.dem_vertical_crs.as_ref(), "as in its files"),
        ),
        ("vertical CRS", or(settings.vertical_crs.as_ref(), "that of the elevation data")),
        ("vertical shift", format!("{} m", settings.vertical_shift_m)),
        ("vertical unit", or(settings.vertical_unit.as_ref(), "that of the elevation data")),
        ("nodata values", or(nodata, "as in the files")),
        (
            "height range",
            settings.height_range_m.map_or_else(usual, |[low, high]| format!("{low} to {high} m")),
        ),
        ("voids filled", format!("with data within {} cells", settings.fill_voids)),
        ("classes", classes(settings)),
        ("classes by level", classes_by_level(&settings.class_max_cell_m)),
        (
            "simplification",
            match settings.simplify_cells {
                cells if cells > 0.0 => format!("{cells} cells of the level"),
                _ => "none".to_owned(),
            },
        ),
        ("CRS", in_line(&manifest.crs).into_owned()),
        (
            "scale latitude",
            settings.scale_latitude_deg.map_or_else(usual, |latitude| format!("{latitude}°")),
        ),
        ("bounds", or(settings.bounds_deg.as_ref(), "all of the elevation data")),
        ("polygon", or(settings.polygon.as_ref(), "none")),
    ];
    // New settings are compared without a wording of their own.
    let others = settings.facts().into_iter().filter(|fact| !NOT_AS_THEY_ARE.contains(&fact.key));
    properties.extend(others.map(|fact| (fact.name, in_line(&fact.value).into_owned())));
    properties
}

/// The value of a setting in one line, or `without` if it is not given.
fn or(value: Option<&impl SettingValue>, without: &str) -> String {
    value.map_or_else(|| without.to_owned(), |value| in_line(&value.text()).into_owned())
}

/// The operations that converted positions between datums.
fn datum_operations(found: &[DatumOperationRecord]) -> String {
    let texts: Vec<String> = found.iter().map(datum_operation).collect();
    if texts.is_empty() { "none".to_owned() } else { texts.join("; ") }
}

/// The inputs of some kinds, by name and hash.
fn inputs(manifest: &Manifest, kinds: &[InputKind]) -> String {
    let of_kind = |input: &&InputRecord| kinds.iter().any(|kind| kind.is_of(input));
    let name = |input: &InputRecord| {
        let hash = input.sha256.get(..12).map_or("not used".to_owned(), |hash| format!("{hash}…"));
        format!("{} ({})", in_line(&input.name), in_line(&hash))
    };
    manifest.inputs.iter().filter(of_kind).map(name).collect::<Vec<_>>().join(", ")
}

/// The road classes that are converted: the table by name and hash, and the selected classes.
fn classes(settings: &SettingsRecord) -> String {
    let SettingsRecord { frc_table, frc_table_sha256, classes, .. } = settings;
    let hash = frc_table_sha256.get(..12).unwrap_or_default();
    let chosen = classes.as_ref().map_or_else(
        || "the classes that are on by default".to_owned(),
        |classes| format!("classes {}", list(classes.iter())),
    );
    format!("table {} ({}…), {chosen}", in_line(frc_table), in_line(hash))
}

/// The classes that coarse levels show.
fn classes_by_level(limits: &[Option<f64>]) -> String {
    if limits.iter().all(Option::is_none) {
        return "every class on every level".to_owned();
    }
    let limit = |(class, limit): (usize, &Option<f64>)| {
        limit.map(|cell_m| format!("FRC {class} up to cells of {} m", rounded(cell_m)))
    };
    limits.iter().enumerate().filter_map(limit).collect::<Vec<_>>().join(", ")
}

fn list(values: impl Iterator<Item = impl ToString>) -> String {
    values.map(|value| value.to_string()).collect::<Vec<_>>().join(", ")
}

impl PackageDifference {
    /// The difference in one line of text.
    pub(crate) fn text(&self, packages: &[Compared<'_>]) -> String {
        let labels = |of: &[usize]| list(of.iter().map(|&index| &packages[index].label));
        let value = |(of, value): &(Vec<usize>, String)| format!("{}: {value}", labels(of));
        format!("{}: {}", self.what, self.values.iter().map(value).collect::<Vec<_>>().join("; "))
    }
}

/// The comparison as text.
pub(crate) fn to_text(packages: &[Compared<'_>], digits: Digits) -> String {
    let mut text = String::new();
    for Compared { label, name, .. } in packages {
        let _ = writeln!(text, "{label}  {}", in_line(name));
    }
    let differences = differences(packages);
    if !differences.is_empty() {
        let _ =
            writeln!(text, "\nThe packages differ not only in cell and error bound, but also in:");
        for difference in &differences {
            let _ = writeln!(text, "{}", wrapped(&difference.text(packages), "  ", "    "));
        }
    }
    let _ = write!(
        text,
        "\nVertices of clipped roads; stored/source: bytes of all levels\n{}\n\
         Per level\n{}\n\
         Vaaraniemi, Treib & Westermann 2011, section 7: clipping makes road data about {PAPER_GROWTH} times as large.\n",
        wholes(packages, digits).to_text(),
        levels(packages, digits).to_text(),
    );
    text
}

/// The table with a row per package.
fn wholes(packages: &[Compared<'_>], digits: Digits) -> Table {
    let mut table = Table::new([
        "",
        "cell m",
        "--max-error m",
        "levels",
        "source",
        "finest",
        "all",
        "finest/source",
        "all/source",
        "stored/source",
    ]);
    for Compared { label, manifest, .. } in packages {
        let (finest, finest_factors) = of_level(manifest, manifest.frame.max_level());
        let (all, factors) = whole(manifest);
        table.row([
            label.clone(),
            sides(manifest.frame.cell()),
            rounded(manifest.settings.max_error_m),
            manifest.levels.len().to_string(),
            digits.count(all.source_vertices),
            digits.count(finest.geo_vertices),
            digits.count(all.geo_vertices),
            factor(finest_factors.growth_over_source),
            factor(factors.growth_over_source),
            factor(factors.stored_bytes_over_source),
        ]);
    }
    table
}

/// The table with a row per level of each package.
fn levels(packages: &[Compared<'_>], digits: Digits) -> Table {
    let mut table = Table::new([
        "",
        "cell m",
        "tolerance m",
        "source",
        "simplified",
        "clipped",
        "/simplified",
        "/source",
        "raw/source",
        "stored/source",
    ]);
    for Compared { label, manifest, .. } in packages {
        for level in &manifest.levels {
            let (row, factors) = of_level(manifest, level.level);
            table.row([
                format!("{label} level {}", level.level),
                sides(level.cell_m),
                rounded(level.max_error_m),
                digits.count(row.source_vertices),
                digits.count(row.simplified_vertices),
                digits.count(row.geo_vertices),
                factor(factors.growth_over_simplified),
                factor(factors.growth_over_source),
                factor(factors.raw_bytes_over_source),
                factor(factors.stored_bytes_over_source),
            ]);
        }
    }
    table
}

/// The comparison as a JSON document.
pub(crate) fn to_document(packages: &[Compared<'_>]) -> ComparisonDocument {
    let names = |of: &[usize]| of.iter().map(|&index| packages[index].name.clone()).collect();
    let difference = |difference: PackageDifference| DifferenceDocument {
        what: difference.what.to_owned(),
        values: difference
            .values
            .into_iter()
            .map(|(of, value)| DifferentValueDocument { packages: names(&of), value })
            .collect(),
    };
    ComparisonDocument {
        packages: packages
            .iter()
            .map(|Compared { name, manifest, .. }| ComparedDocument {
                package: name.clone(),
                cell_m: manifest.frame.cell().to_array(),
                max_error_m: manifest.settings.max_error_m,
                growth: document(manifest),
            })
            .collect(),
        differences: differences(packages).into_iter().map(difference).collect(),
    }
}

#[cfg(test)]
#[path = "compare_tests.rs"]
mod tests;
