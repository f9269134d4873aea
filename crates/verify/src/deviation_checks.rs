//! P2: the stored error is never below the true one, and hardly above it.

use std::collections::BTreeMap;

use corniche_geom::TileId;
use corniche_tileset::{Distribution, Manifest, VerticalRecord};

use super::{
    checks::{CheckId, Findings},
    decoded_tiles::DecodedTiles,
    deviations::TrueDeviation,
    error::VerifyError,
    report::ErrorFigures,
    triangle_soup::HEIGHT_ROUNDING_M,
};

/// Slack for comparing ratios of heights that were computed in two ways.
const RATIO_ROUNDING: f64 = 1e-3;
/// P2's tightness: stored ≤ this × true + a quantum, for this share of tiles.
const TIGHTNESS: f64 = 2.0;
const TIGHT_SHARE: f64 = 0.95;

/// Compares stored errors with true ones; gives the figures of each level.
pub(crate) fn verify(
    tiles: &DecodedTiles<'_>,
    truths: &BTreeMap<TileId, TrueDeviation>,
    findings: &mut Findings,
) -> Result<Vec<ErrorFigures>, VerifyError> {
    let manifest = tiles.package.manifest();
    let stored_m = check_tiles(tiles, truths, findings)?;
    let mut levels: BTreeMap<u8, TrueDeviation> = BTreeMap::new();
    for (&id, truth) in truths {
        // Tiles that are not there count too: what lies beneath them must lie at a void or an edge.
        findings.look(CheckId::Stray, truth.stray == 0, || {
            format!("{} nodes of tile {id}", truth.stray)
        });
        levels.entry(id.z()).or_default().merge(*truth);
    }
    for level in &manifest.levels {
        let found = levels.get(&level.level).map_or(0, |truth| truth.uncovered);
        findings.look(CheckId::Uncovered, found == level.uncovered_nodes, || {
            format!("level {} says {}, {found} were found", level.level, level.uncovered_nodes)
        });
    }
    let mut ratios = check_errors(manifest, &stored_m, truths, findings);
    let figures = levels.into_iter().map(|(level, truth)| {
        let tightness = Distribution::of(ratios.remove(&level).unwrap_or_default());
        let said = manifest.levels.get(usize::from(level)).and_then(|record| record.tightness);
        findings.look(CheckId::Recorded, agree(said, tightness), || {
            format!("level {level} records {said:?}, found {tightness:?}")
        });
        ErrorFigures {
            level,
            tiles: stored_m.keys().filter(|id| id.z() == level).count() as u64,
            nodes: truth.nodes,
            largest_true_m: truth.largest_m,
            tightness,
            uncovered_nodes: truth.uncovered,
        }
    });
    Ok(figures.collect())
}

/// Looks at what tiles with ground say of the nodes beneath them; gives their stored errors.
fn check_tiles(
    tiles: &DecodedTiles<'_>,
    truths: &BTreeMap<TileId, TrueDeviation>,
    findings: &mut Findings,
) -> Result<BTreeMap<TileId, f64>, VerifyError> {
    let mut stored_m = BTreeMap::new();
    for id in tiles.package.tile_ids()? {
        let tile = tiles.of(id);
        let Some(terrain) = tile.terrain() else { continue };
        let said = terrain.uncovered_nodes;
        let truth = truths.get(&id).copied().unwrap_or_default();
        findings.look(CheckId::Uncovered, said == truth.uncovered, || {
            format!("tile {id} says {said}, {} were found", truth.uncovered)
        });
        let [low, high] = terrain.height_range_m;
        let said = [low, high].map(f64::to_bits);
        let holds = truth.range_m.is_none_or(|range| range.map(|m| f64::from(m).to_bits()) == said);
        findings.look(CheckId::Ranges, holds, || {
            format!("tile {id} says {low} to {high} m, nodes beneath: {:?}", truth.range_m)
        });
        stored_m.insert(id, terrain.geometric_error_m);
    }
    Ok(stored_m)
}

/// Compares each stored error with the true one; gives, per level, the stored error over the true one where that can be
/// measured.
fn check_errors(
    manifest: &Manifest,
    stored_m: &BTreeMap<TileId, f64>,
    truths: &BTreeMap<TileId, TrueDeviation>,
    findings: &mut Findings,
) -> BTreeMap<u8, Vec<f64>> {
    let quantum_m = manifest.vertical.quantum_m;
    let mut ratios: BTreeMap<u8, Vec<f64>> = BTreeMap::new();
    let mut loose = 0_u64;
    for (&id, &stored_m) in stored_m {
        let truth = truths.get(&id).copied().unwrap_or_default();
        findings.look(CheckId::Bound, stored_m >= truth.largest_m - HEIGHT_ROUNDING_M, || {
            format!("tile {id} stores {stored_m} m, but is off by {} m", truth.largest_m)
        });
        if id.z() == manifest.frame.max_level() {
            let most_m = manifest.settings.max_error_m + HEIGHT_ROUNDING_M;
            findings.look(CheckId::Finest, truth.largest_m <= most_m, || {
                format!("tile {id} is off by {} m", truth.largest_m)
            });
        }
        let children_m = id
            .children()
            .filter_map(|child| truths.get(&child))
            .fold(0.0_f64, |largest, child| largest.max(child.largest_m));
        let true_m = truth.largest_m.max(children_m);
        loose += u64::from(stored_m > TIGHTNESS * true_m + quantum_m);
        if true_m >= VerticalRecord::least_measured_error_m(quantum_m) {
            ratios.entry(id.z()).or_default().push(stored_m / true_m);
        }
    }
    let count = stored_m.len() as u64;
    let is_tight = loose as f64 <= (1.0 - TIGHT_SHARE) * count as f64;
    findings.look(CheckId::Tight, is_tight, || format!("{loose} of {count} tiles are loose"));
    ratios
}

/// Whether two distributions of ratios are the same but for rounding: their errors were computed in two ways.
fn agree(said: Option<Distribution>, found: Option<Distribution>) -> bool {
    let near = |a: f64, b: f64| (a - b).abs() <= RATIO_ROUNDING * a.max(b);
    match (said, found) {
        (Some(said), Some(found)) => {
            let figures = |of: Distribution| [of.min, of.median, of.p95, of.max];
            let mut pairs = figures(said).into_iter().zip(figures(found));
            said.count == found.count && pairs.all(|(said, found)| near(said, found))
        }
        (None, None) => true,
        (Some(_), None) | (None, Some(_)) => false,
    }
}
