//! The growth table with one line per way (CSV).

use std::{fmt::Write as _, io::Write as _, path::Path};

use corniche_export::{WayGrowth, growth_by_way};
use corniche_roads::FunctionalRoadClass;
use corniche_store::folder_of;
use corniche_tileset::{FilePackage, Manifest};

use crate::{
    export::MEMORY_BYTES,
    failure::Result,
    output::{Complete, Output, failed},
    progress::Progress,
    table::Digits,
};

/// Fills the file at `path`, and returns its summary: a line per way, sorted by id, then a line per
/// class for vertices of the growth table that belong to no OSM way, if there are any. So the
/// columns add up to the growth table.
pub(crate) fn fill(
    package: &FilePackage,
    path: &Path,
    mut output: Output,
) -> Result<(Complete, String)> {
    let manifest = package.manifest();
    let cannot = |error: std::io::Error| failed(path, &error);
    output.write_all(headings(manifest).as_bytes()).map_err(cannot)?;
    let mut sums = Sums::new(manifest);
    let mut ways = 0_u64;
    Progress::show_during(|progress| {
        growth_by_way(package, folder_of(path), MEMORY_BYTES, progress, |way| {
            ways += 1;
            sums.add(way);
            output.write_all(line(way).as_bytes()).map_err(cannot)
        })
    })?;
    sums.fit(manifest, package.path())?;
    let mut off_ground = 0;
    for (class, points) in sums.left(manifest) {
        off_ground += points;
        // The same number of cells as in the other lines.
        let empty = ",".repeat(manifest.levels.len() + 3);
        output.write_all(format!(",{class},,{points}{empty}\n").as_bytes()).map_err(cannot)?;
    }
    Ok((output.end()?, note(path, ways, off_ground, Digits::of_notes())))
}

fn note(path: &Path, ways: u64, off_ground: i64, digits: Digits) -> String {
    let mut text = format!("{}: {} OSM ways", path.display(), digits.count(ways));
    if off_ground != 0 {
        let _ = write!(
            text,
            "; {off_ground} points of the source are in tiles with ground, but not on the ground (void, edge, outside the bounds); \
             lines without a way id count these points"
        );
    }
    text
}

fn headings(manifest: &Manifest) -> String {
    let levels = manifest.levels.iter().map(|level| format!("geo_vertices_level_{}", level.level));
    let columns = ["way_id", "class", "length_m", "source_vertices"].map(str::to_owned);
    let ratios = ["geo_vertices_all_levels", "growth_over_source", "growth_over_source_all_levels"];
    let columns = columns.into_iter().chain(levels).chain(ratios.map(str::to_owned));
    format!("{}\n", columns.collect::<Vec<_>>().join(","))
}

/// A line; ratios with a denominator of 0 are empty.
fn line(way: &WayGrowth) -> String {
    let WayGrowth { way_id, class, length_m, source_vertices, geo_vertices } = way;
    let all: u64 = geo_vertices.iter().sum();
    let finest = geo_vertices.last().copied().unwrap_or_default();
    let ratio = |above: u64| match source_vertices {
        0 => String::new(),
        below => format!("{:.6}", above as f64 / *below as f64),
    };
    let mut text = format!("{way_id},{},{length_m:.6},{source_vertices}", class.number());
    for vertices in geo_vertices {
        let _ = write!(text, ",{vertices}");
    }
    let _ = writeln!(text, ",{all},{},{}", ratio(finest), ratio(all));
    text
}

/// Sums over the lines, by class.
struct Sums {
    source: [u64; FunctionalRoadClass::COUNT],
    /// Numbers of vertices by level, then by class.
    geo: Vec<[u64; FunctionalRoadClass::COUNT]>,
}

impl Sums {
    fn new(manifest: &Manifest) -> Self {
        Self {
            source: [0; FunctionalRoadClass::COUNT],
            geo: vec![[0; FunctionalRoadClass::COUNT]; manifest.levels.len()],
        }
    }

    fn add(&mut self, way: &WayGrowth) {
        let class = usize::from(way.class.number());
        self.source[class] += way.source_vertices;
        for (sums, vertices) in self.geo.iter_mut().zip(&way.geo_vertices) {
            sums[class] += vertices;
        }
    }

    /// Checks that the vertices of the lines add up to those of the growth table.
    fn fit(&self, manifest: &Manifest, package: &Path) -> Result<()> {
        for row in &manifest.growth {
            let sums = self.geo.get(usize::from(row.level));
            let found = sums.and_then(|sums| sums.get(usize::from(row.class))).copied();
            if found != Some(row.geo_vertices) {
                refuse!(
                    "{package:?}: FRC {} has {} vertices on level {} in the growth table, but {} in the tiles; run corniche verify for details",
                    row.class,
                    row.geo_vertices,
                    row.level,
                    found.unwrap_or_default()
                );
            }
        }
        Ok(())
    }

    /// The classes for which the growth table has another number of source points on the finest
    /// level, and the differences.
    fn left(&self, manifest: &Manifest) -> Vec<(u8, i64)> {
        let finest = manifest.frame.max_level();
        let rows = manifest.growth.iter().filter(|row| row.level == finest);
        let left = rows.map(|row| {
            let found = self.source.get(usize::from(row.class)).copied().unwrap_or_default();
            (row.class, row.source_vertices.cast_signed() - found.cast_signed())
        });
        left.filter(|&(_, points)| points != 0).collect()
    }
}

#[cfg(test)]
#[path = "per_way_tests.rs"]
mod tests;
