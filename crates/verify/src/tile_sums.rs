//! Sums over tiles, which are compared with the manifest's sums for each level and class.

use std::collections::BTreeMap;

use corniche_geom::{LatticeBounds, LatticePoint, TileId};
use corniche_pieces::roads::proportions::share;
use corniche_roads::FunctionalRoadClass;
use corniche_tileset::{Distribution, FilePackage, GrowthRow, PayloadSizes, TilePayload};

use super::{
    checks::{Findings, as_json},
    geo_against_sv::source_points,
    seams::Borders,
};

/// The data of a tile that are kept for comparisons with other tiles.
pub(crate) struct TileSummary {
    pub vertices: u64,
    pub triangles: u64,
    pub geometric_error_m: f64,
    pub height_range_m: [f64; 2],
    pub borders: Borders,
    /// The hashes of the relief's borders; `None` without a relief.
    pub relief_borders: Option<[u64; 4]>,
}

/// The contribution of a tile to the manifest's sums.
#[derive(Default)]
pub(crate) struct TileSums {
    terrain_bytes: u64,
    relief_bytes: u64,
    uncovered_nodes: u64,
    classes: BTreeMap<u8, Row>,
}

/// The part of a row of the growth table that follows from the tiles.
#[derive(Debug, Clone, Copy, Default, PartialEq, serde::Serialize)]
pub(crate) struct Row {
    geo_vertices: u64,
    sv_vertices: u64,
    geo_stored_bytes: u64,
    sv_stored_bytes: u64,
    /// Source points of GEO lines inside the tiles: if there is one, the table has a row.
    inner_points: u64,
}

impl TileSums {
    pub(crate) fn from_payload(
        payload: &TilePayload,
        sizes: &PayloadSizes,
        bounds: LatticeBounds,
    ) -> Self {
        let terrain = payload.terrain.as_ref();
        let mut sums = Self {
            terrain_bytes: sizes.terrain.stored,
            relief_bytes: sizes.relief.stored,
            uncovered_nodes: terrain.map_or(0, |terrain| terrain.uncovered_nodes),
            classes: BTreeMap::new(),
        };
        let LatticeBounds { min, max } = bounds;
        for road in &payload.roads_geo {
            let row = sums.classes.entry(road.class.number()).or_default();
            row.geo_vertices += road.line.vertices.len() as u64;
            // A point on a border may come from cutting.
            let is_inside = |point: &LatticePoint| {
                (min.u + 1..max.u).contains(&point.u) && (min.v + 1..max.v).contains(&point.v)
            };
            row.inner_points += source_points(&road.line).filter(is_inside).count() as u64;
        }
        for road in &payload.roads_sv {
            sums.classes.entry(road.class.number()).or_default().sv_vertices +=
                road.line.points.len() as u64;
        }
        for class in FunctionalRoadClass::all().map(FunctionalRoadClass::number) {
            if let Some(row) = sums.classes.get_mut(&class) {
                let index = usize::from(class);
                row.geo_stored_bytes = share(sizes.roads_geo.stored, &sizes.geo_class_bytes, index);
                row.sv_stored_bytes = share(sizes.roads_sv.stored, &sizes.sv_class_bytes, index);
            }
        }
        sums
    }

    pub(crate) fn add(&mut self, other: Self) {
        self.terrain_bytes += other.terrain_bytes;
        self.relief_bytes += other.relief_bytes;
        self.uncovered_nodes += other.uncovered_nodes;
        for (class, row) in other.classes {
            let sum = self.classes.entry(class).or_default();
            sum.geo_vertices += row.geo_vertices;
            sum.sv_vertices += row.sv_vertices;
            sum.geo_stored_bytes += row.geo_stored_bytes;
            sum.sv_stored_bytes += row.sv_stored_bytes;
            sum.inner_points += row.inner_points;
        }
    }
}

/// Checks the tiles, triangles, bytes and errors of each level.
pub(crate) fn check_levels(
    package: &FilePackage,
    ids: &[TileId],
    kept: &BTreeMap<TileId, TileSummary>,
    sums: &BTreeMap<u8, TileSums>,
    findings: &mut Findings,
) {
    let nothing = TileSums::default();
    for level in &package.manifest().levels {
        let found = ids.iter().filter(|id| id.z() == level.level).count() as u64;
        look!(
            findings,
            LevelSums,
            found == level.tiles,
            "level {} has {found} tiles, {} are recorded",
            level.level,
            level.tiles
        );
        let tiles = || kept.iter().filter(|(id, _)| id.z() == level.level).map(|(_, tile)| tile);
        let triangles: u64 = tiles().map(|tile| tile.triangles).sum();
        let vertices: u64 = tiles().map(|tile| tile.vertices).sum();
        let errors_m =
            Distribution::from_values(tiles().map(|tile| tile.geometric_error_m).collect());
        let largest_m = errors_m.map_or(0.0, |errors_m| errors_m.max);
        let sums = sums.get(&level.level).unwrap_or(&nothing);
        let stored = [sums.terrain_bytes, sums.relief_bytes];
        let said_stored = [level.terrain_bytes, level.relief_bytes];
        let said = (level.triangles, level.vertices, said_stored, level.errors_m);
        let agrees = (triangles, vertices, stored, errors_m) == said
            && largest_m.to_bits() == level.geometric_error_m.to_bits()
            // Nodes without a tile count only for the level.
            && sums.uncovered_nodes <= level.uncovered_nodes;
        look!(
            findings,
            LevelSums,
            agrees,
            "level {} has {triangles} triangles, {vertices} vertices, {} bytes of ground, {} of relief, error {largest_m} m, \
                 {} uncovered nodes",
            level.level,
            sums.terrain_bytes,
            sums.relief_bytes,
            sums.uncovered_nodes
        );
    }
}

/// Checks the rows of the growth table, as far as they follow from the tiles.
pub(crate) fn check_growth(
    rows: &[GrowthRow],
    sums: &BTreeMap<u8, TileSums>,
    findings: &mut Findings,
) {
    let mut left: BTreeMap<(u8, u8), Row> = sums
        .iter()
        .flat_map(|(&level, sums)| {
            sums.classes.iter().map(move |(&class, &row)| ((level, class), row))
        })
        .collect();
    let mut last = None;
    for row in rows {
        let key = (row.level, row.class);
        let found = left.remove(&key).unwrap_or_default();
        let said = Row {
            geo_vertices: row.geo_vertices,
            sv_vertices: row.sv_vertices,
            geo_stored_bytes: row.geo_stored_bytes,
            sv_stored_bytes: row.sv_stored_bytes,
            inner_points: found.inner_points,
        };
        look!(
            findings,
            Growth,
            found == said && last < Some(key),
            "level {} class {}: {} in the tiles, {} recorded",
            row.level,
            row.class,
            as_json(&found),
            as_json(row)
        );
        last = Some(key);
        // Points are pairs or triples of f64; the level's lines have no more points than the
        // source.
        let plain = [row.source_vertices * 16, row.simplified_vertices * 16, row.geo_vertices * 24];
        let bytes = [row.source_bytes, row.simplified_bytes, row.geo_raw_bytes];
        let thinned = row.simplified_vertices <= row.source_vertices;
        look!(
            findings,
            Growth,
            plain == bytes && thinned,
            "level {} class {}: {bytes:?} bytes are recorded, the points take {plain:?}",
            row.level,
            row.class
        );
    }
    // A class has no row if none of its points lies in a tile with ground.
    for ((level, class), row) in left {
        look!(
            findings,
            Growth,
            row.inner_points == 0,
            "level {level} class {class} has no row in the growth table, but {} in the tiles",
            as_json(&row)
        );
    }
}
