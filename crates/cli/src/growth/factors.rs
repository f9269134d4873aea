//! Sums over rows of the growth table, and their growth factors.

use corniche_tileset::{GrowthRow, Manifest};

use crate::documents::growth::Factors;

/// "The preprocessing step for the geometric approach … increased the size of the road data by
/// about a factor of ten in all tested cases": Vaaraniemi, Treib & Westermann 2011, section 7.
pub(crate) const PAPER_GROWTH: f64 = 10.0;

/// Rows of a level summed over its classes, or of all levels.
fn sum<'a>(rows: impl Iterator<Item = &'a GrowthRow>) -> GrowthRow {
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

/// The cost of all levels: the sum of the levels, compared with one copy of the source, which is
/// that of the finest level, because it shows every class.
pub(crate) fn whole(manifest: &Manifest) -> (GrowthRow, Factors) {
    let (source, _) = of_level(manifest, manifest.frame.max_level());
    let all = GrowthRow {
        source_vertices: source.source_vertices,
        source_bytes: source.source_bytes,
        ..sum(manifest.growth.iter())
    };
    let factors = factors(&all);
    (all, factors)
}

/// A level's rows summed over its classes.
pub(crate) fn of_level(manifest: &Manifest, level: u8) -> (GrowthRow, Factors) {
    let row = sum(manifest.growth.iter().filter(|row| row.level == level));
    let factors = factors(&row);
    (row, factors)
}

/// The growth factors of a row or of a sum of rows.
pub(crate) fn factors(row: &GrowthRow) -> Factors {
    let ratio = |above: u64, below: u64| (below > 0).then(|| above as f64 / below as f64);
    Factors {
        growth_over_simplified: ratio(row.geo_vertices, row.simplified_vertices),
        growth_over_source: ratio(row.geo_vertices, row.source_vertices),
        raw_bytes_over_source: ratio(row.geo_raw_bytes, row.source_bytes),
        stored_bytes_over_source: ratio(row.geo_stored_bytes, row.source_bytes),
        raw_bytes_over_simplified: ratio(row.geo_raw_bytes, row.simplified_bytes),
        stored_bytes_over_simplified: ratio(row.geo_stored_bytes, row.simplified_bytes),
    }
}
