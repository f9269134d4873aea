//! Checks every tile by itself, then compares all tiles with their neighbours, their parents and the manifest.

use std::collections::BTreeMap;

use corniche_geom::TileId;
use corniche_roads::Structure;
use corniche_spec::{Observer, levels::Levels};
use corniche_tileset::{Manifest, SvTail, SvTails};

use super::{
    attributes::Ways,
    checks::{CheckId, Findings},
    decoded_tiles::DecodedTiles,
    each_tile::each_tile,
    error::VerifyError,
    manifest_sums::{CUT_M, LENGTH_SHARE},
    one_tile::{Found, look_at},
    report::{GapFigures, VerifyReport},
    roads_on_tin::{RoadLengths, counts_for_sums},
    seams,
    tile_sums::{Kept, TileSums, check_growth, check_levels},
};

pub(crate) fn verify(
    tiles: &DecodedTiles<'_>,
    threads: usize,
    observer: &dyn Observer,
) -> Result<(VerifyReport, Findings), VerifyError> {
    let package = tiles.package;
    let manifest = package.manifest();
    let frame = manifest.frame;
    // `None` if the record is not valid; then the check `levels.derived` is broken.
    let levels = Levels::recorded(manifest);
    let ids = package.tile_ids()?;
    let mut findings = Findings::default();
    let mut kept = BTreeMap::new();
    let mut gaps: BTreeMap<u8, GapFigures> = BTreeMap::new();
    let mut finest = RoadLengths::default();
    let mut ways = Ways::default();
    let mut sums: BTreeMap<u8, TileSums> = BTreeMap::new();
    let mut sv_tails = SvTails::new();
    each_tile(
        package,
        threads,
        observer,
        |id| Ok(look_at(tiles, id, levels.as_ref())),
        |id, found: Found| {
            findings.look(CheckId::Whole, found.damage.is_none(), || {
                found.damage.clone().unwrap_or_default()
            });
            findings.merge(found.findings);
            if found.damage.is_none() {
                let level = gaps
                    .entry(id.z())
                    .or_insert(GapFigures { level: id.z(), ..GapFigures::default() });
                level.edges += found.gaps.edges;
                level.largest_m = level.largest_m.max(found.gaps.largest_m);
            }
            if counts_for_sums(id, &frame) {
                finest.add(found.lengths);
            }
            ways.add(id, found.ways, &mut findings);
            sums.entry(id.z()).or_default().add(found.sums);
            sv_tails.add(id, found.sv_tail_bytes);
            kept.extend(found.kept.map(|tile| (id, tile)));
        },
    )?;
    let borders = check_seams(&kept, &mut findings);
    check_nesting(&kept, &mut findings);
    check_heights(manifest.vertical.range_m, &kept, &mut findings);
    check_length(&finest, manifest.counts.roads_kept_um, &mut findings);
    check_structures(&finest, manifest, &mut findings);
    check_levels(package, &ids, &kept, &sums, &mut findings);
    check_growth(&manifest.growth, &sums, &mut findings);
    let sv_tails = sv_tails.list();
    findings.look(CheckId::SvTails, sv_tails == manifest.sv_tails, || {
        let recorded = &manifest.sv_tails;
        let counts = format!("{} in the tiles, {} are recorded", sv_tails.len(), recorded.len());
        let in_words = |tail: Option<&SvTail>| {
            tail.map_or("none".to_owned(), |tail| format!("{} bytes of {}", tail.bytes, tail.tile))
        };
        let longest = sv_tails.len().max(recorded.len());
        let mut pairs = (0..longest).map(|k| [sv_tails.get(k), recorded.get(k)]);
        let differ = pairs.find(|[found, told]| found != told).unwrap_or_default();
        let [found, told] = differ.map(in_words);
        format!("{counts}; the first that differ: {found}, {told}")
    });
    let report = VerifyReport {
        tiles: ids.len() as u64,
        checks: Vec::new(),
        gaps: gaps.into_values().collect(),
        borders,
        errors: Vec::new(),
        samples: None,
    };
    Ok((report, findings))
}

/// Compares the length of all GEO roads of the finest level with the recorded length.
fn check_length(found: &RoadLengths, recorded_um: u64, findings: &mut Findings) {
    let (found_m, expected_m) = (found.length_m(), recorded_um as f64 / 1e6);
    let allowed_m = LENGTH_SHARE * expected_m.max(1.0) + found.rounding_m(expected_m);
    let holds = (found_m - expected_m).abs() <= allowed_m;
    findings.look(CheckId::Length, holds, || {
        format!("{found_m} m lie in the tiles, {expected_m} m are recorded")
    });
}

/// Compares the lengths of roads on the ground, of bridges and of tunnels on the finest level with the recorded ones, which make up all that was kept.
fn check_structures(found: &RoadLengths, manifest: &Manifest, findings: &mut Findings) {
    let Some(spans) = &manifest.spans else { return };
    let (all_um, [bridges_um, tunnels_um]) =
        (manifest.counts.roads_kept_um, [spans.counts.bridges_um, spans.counts.tunnels_um]);
    for (number, structure) in Structure::ALL.iter().enumerate() {
        let (name, recorded_um) = match structure {
            Structure::Ground => (
                "roads on the ground",
                i128::from(all_um) - i128::from(bridges_um) - i128::from(tunnels_um),
            ),
            Structure::Bridge => ("bridges", i128::from(bridges_um)),
            Structure::Tunnel => ("tunnels", i128::from(tunnels_um)),
        };
        let (found_m, recorded_m) = (found.by_structure_m[number], recorded_um as f64 / 1e6);
        let allowed_m = LENGTH_SHARE * recorded_m
            + CUT_M * found.lines[number] as f64
            + found.rounding_m(recorded_m);
        let holds = (found_m - recorded_m).abs() <= allowed_m;
        findings.look(CheckId::Structures, holds, || {
            format!("{found_m} m of {name} lie in the tiles, {recorded_m} m are recorded")
        });
    }
}

/// Compares all neighbours, and gives the number of borders compared.
fn check_seams(kept: &BTreeMap<TileId, Kept>, findings: &mut Findings) -> u64 {
    for (&id, tile) in kept {
        for (other, own_edge, other_edge) in seams::neighbours(id) {
            let Some(neighbour) = kept.get(&other) else { continue };
            let differences = seams::differences(
                &tile.borders[own_edge as usize],
                &neighbour.borders[other_edge as usize],
            );
            if let (Some(own), Some(theirs)) = (tile.relief_borders, neighbour.relief_borders) {
                let same = own[own_edge as usize] == theirs[other_edge as usize];
                findings.look(CheckId::ReliefSeams, same, || {
                    format!("the reliefs of tiles {id} and {other} differ on their border")
                });
            }
            findings.look(CheckId::Seams, differences.is_empty(), || {
                format!("tiles {id} and {other} differ at border nodes {differences:?}")
            });
        }
    }
    findings.of(CheckId::Seams).checked
}

/// Checks that the height range of the package is that of the root tile.
fn check_heights(said_m: [f64; 2], kept: &BTreeMap<TileId, Kept>, findings: &mut Findings) {
    let Some(root) = kept.get(&TileId::ROOT) else { return };
    let root_m = root.height_range_m;
    let same = said_m.iter().zip(root_m).all(|(said_m, m)| (said_m - m).abs() <= 0.0);
    findings.look(CheckId::RootHeights, same, || {
        format!("heights from {said_m:?} are recorded, the root tile has {root_m:?}")
    });
}

fn check_nesting(kept: &BTreeMap<TileId, Kept>, findings: &mut Findings) {
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
        findings.look(CheckId::Nested, nested, || format!("tile {id} exceeds its parent {parent}"));
    }
}
