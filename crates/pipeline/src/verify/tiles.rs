//! Every tile by itself, and each beside its neighbours, its parent and the manifest.

use std::collections::BTreeMap;

use corniche_geom::TileId;
use corniche_tileset::{Distribution, FilePackage, Sections};

use super::{
    Check, GapFigures, VerifyError, VerifyReport,
    roads::{self, counts_for_sums},
    seams::{self, Borders},
    sums::LENGTH_SHARE,
};
use crate::{Observer, Stage, workers};

/// What is kept of a tile to compare it with others.
struct Kept {
    vertices: u64,
    triangles: u64,
    geometric_error_m: f64,
    height_range_m: [f64; 2],
    borders: Borders,
}

/// What a worker found in a tile.
struct Found {
    kept: Option<Kept>,
    checks: [Check; 2],
    gaps: GapFigures,
    length_m: f64,
    damage: Option<String>,
}

pub(crate) fn verify(
    package: &FilePackage,
    threads: usize,
    observer: &dyn Observer,
) -> Result<VerifyReport, VerifyError> {
    let manifest = package.manifest();
    let frame = manifest.frame;
    let ids = package.tile_ids()?;
    observer.begin(Stage::Verify, Some(ids.len() as u64));
    let mut damaged = Check::new("every tile's sections are whole and match their checksums");
    let mut on_tin = Check::new("P1: GEO roads lie on their TIN");
    let mut order = Check::new("roads are sorted by class, way and part");
    let mut kept = BTreeMap::new();
    let mut gaps: BTreeMap<u8, GapFigures> = BTreeMap::new();
    let mut finest_length_m = 0.0;
    workers::in_order(
        threads,
        ids.len(),
        || Ok(()),
        |(), index| {
            if observer.is_cancelled() {
                Err(VerifyError::Interrupted)
            } else {
                Ok(look_at(package, ids[index]))
            }
        },
        |index, found: Found| {
            let id = ids[index];
            damaged.look(found.damage.is_none(), || found.damage.clone().unwrap_or_default());
            let [tile_on_tin, tile_order] = found.checks;
            on_tin.merge(tile_on_tin);
            order.merge(tile_order);
            if found.damage.is_none() {
                let level = gaps
                    .entry(id.z())
                    .or_insert(GapFigures { level: id.z(), ..GapFigures::default() });
                level.edges += found.gaps.edges;
                level.largest_m = level.largest_m.max(found.gaps.largest_m);
            }
            if counts_for_sums(id, &frame) {
                finest_length_m += found.length_m;
            }
            kept.extend(found.kept.map(|tile| (id, tile)));
            observer.advance(Stage::Verify, 1);
            Ok(())
        },
    )?;
    observer.end(Stage::Verify);
    let (seam_check, borders) = check_seams(&kept);
    let mut lengths =
        Check::new("P6: GEO roads of the finest level are as long as the manifest says");
    let expected_m = manifest.counts.roads_kept_um as f64 / 1e6;
    lengths
        .look((finest_length_m - expected_m).abs() <= LENGTH_SHARE * expected_m.max(1.0), || {
            format!("{finest_length_m} m lie in the tiles, {expected_m} m are recorded")
        });
    let mut count = Check::new("tiles and their sums are those that the manifest counts");
    for level in &manifest.levels {
        let found = ids.iter().filter(|id| id.z() == level.level).count() as u64;
        count.look(found == level.tiles, || {
            format!("level {} has {found} tiles, {} are recorded", level.level, level.tiles)
        });
    }
    for level in &manifest.levels {
        let tiles = || kept.iter().filter(|(id, _)| id.z() == level.level).map(|(_, tile)| tile);
        let triangles: u64 = tiles().map(|tile| tile.triangles).sum();
        let vertices: u64 = tiles().map(|tile| tile.vertices).sum();
        let errors_m = Distribution::of(tiles().map(|tile| tile.geometric_error_m).collect());
        let largest_m = errors_m.map_or(0.0, |errors_m| errors_m.max);
        let said = (level.triangles, level.vertices, level.errors_m);
        let agrees = (triangles, vertices, errors_m) == said
            && largest_m.to_bits() == level.geometric_error_m.to_bits();
        count.look(agrees, || {
            format!(
                "level {} has {triangles} triangles, {vertices} vertices, error {largest_m} m",
                level.level
            )
        });
    }
    Ok(VerifyReport {
        tiles: ids.len() as u64,
        checks: vec![damaged, count, on_tin, seam_check, check_nesting(&kept), order, lengths],
        gaps: gaps.into_values().collect(),
        borders,
        errors: Vec::new(),
        samples: None,
    })
}

fn look_at(package: &FilePackage, id: TileId) -> Found {
    let manifest = package.manifest();
    let payload = match package.payload(id, Sections::ALL) {
        Ok(Some(payload)) => payload,
        Ok(None) => return Found::damaged(id, format!("tile {id} is listed but not there")),
        Err(error) => return Found::damaged(id, chain(&error)),
    };
    let max_error_m =
        manifest.levels.get(usize::from(id.z())).map_or(0.0, |level| level.max_error_m);
    let findings = roads::verify(&payload, manifest, max_error_m);
    Found {
        kept: payload.terrain.map(|terrain| Kept {
            vertices: terrain.tin.vertices().len() as u64,
            triangles: terrain.tin.triangles().len() as u64,
            geometric_error_m: terrain.geometric_error_m,
            height_range_m: terrain.height_range_m,
            borders: seams::borders(&terrain.tin),
        }),
        checks: [findings.on_tin, findings.order],
        gaps: findings.gaps,
        length_m: findings.length_m,
        damage: None,
    }
}

/// An error with its causes, on one line.
fn chain(error: &dyn std::error::Error) -> String {
    let mut text = error.to_string();
    let mut source = error.source();
    while let Some(cause) = source {
        text = format!("{text}: {cause}");
        source = cause.source();
    }
    text
}

impl Found {
    fn damaged(id: TileId, damage: String) -> Self {
        Self {
            kept: None,
            checks: [
                Check::new("P1: GEO roads lie on their TIN"),
                Check::new("roads are sorted by class, way and part"),
            ],
            gaps: GapFigures { level: id.z(), ..GapFigures::default() },
            length_m: 0.0,
            damage: Some(damage),
        }
    }
}

fn check_seams(kept: &BTreeMap<TileId, Kept>) -> (Check, u64) {
    let mut check = Check::new("P3: neighbours of one level share bit-identical border vertices");
    for (&id, tile) in kept {
        for (other, own_edge, other_edge) in seams::neighbours(id) {
            let Some(neighbour) = kept.get(&other) else { continue };
            let differences = seams::differences(
                &tile.borders[own_edge as usize],
                &neighbour.borders[other_edge as usize],
            );
            check.look(differences.is_empty(), || {
                format!("tiles {id} and {other} differ at border nodes {differences:?}")
            });
        }
    }
    let borders = check.checked;
    (check, borders)
}

fn check_nesting(kept: &BTreeMap<TileId, Kept>) -> Check {
    let mut check = Check::new("a parent's error and height range are never below its children's");
    for (&id, tile) in kept {
        // An island too small for a cell of the parent leaves it without ground; the next tile above counts.
        let above = (0..id.z()).rev().find_map(|level| {
            let above = id.ancestor(level);
            kept.get(&above).map(|tile| (above, tile))
        });
        let Some((parent, above)) = above else { continue };
        let nested = above.geometric_error_m >= tile.geometric_error_m
            && above.height_range_m[0] <= tile.height_range_m[0]
            && above.height_range_m[1] >= tile.height_range_m[1];
        check.look(nested, || format!("tile {id} exceeds its parent {parent}"));
    }
    check
}
