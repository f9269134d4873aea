//! Checks every tile by itself and against its ancestors, then compares all tiles with their
//! neighbours, their parents and the manifest.

use std::collections::BTreeMap;

use corniche_geom::TileId;
use corniche_roads::Structure;
use corniche_spec::levels::Levels;
use corniche_tileset::{Manifest, SvTail, SvTails, TileTerrain};
use corniche_work::Stage;

use super::{
    attributes::{self, FirstWays, StoredWay},
    checks::{CheckId, Findings},
    decoded_tiles::DecodedTiles,
    derived_records::{CUT_M, LENGTH_SHARE},
    each_tile::VerifyRun,
    error::Result,
    geo_against_sv, relief,
    report::{GapFigures, VerifyReport},
    roads_of_parent,
    roads_on_tin::{self, RoadLengths},
    seams,
    tile_place::TilePlace,
    tile_sums::{TileSummary, TileSums, check_growth, check_levels},
    tin_against_parent::{self, Level},
};

pub(crate) fn verify(run: &VerifyRun<'_>) -> Result<(VerifyReport, Findings)> {
    let package = run.package;
    let manifest = package.manifest();
    let frame = manifest.frame;
    // `None` if the record is invalid; then the check `levels.derived` is broken.
    let levels = Levels::recorded(manifest);
    let ids = package.tile_ids()?;
    let mut findings = Findings::default();
    let mut kept = BTreeMap::new();
    let mut gaps: BTreeMap<u8, GapFigures> = BTreeMap::new();
    let mut finest = RoadLengths::default();
    let mut ways = FirstWays::default();
    let mut sums: BTreeMap<u8, TileSums> = BTreeMap::new();
    let mut sv_tails = SvTails::new();
    run.each_tile(
        Stage::Verify,
        |id| Ok(look_at(&run.tiles, id, levels.as_ref())),
        |id, found: TileFindings| {
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
            if id.z() == frame.max_level() {
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
        format!("{counts}; the first difference: {found} found, {told} recorded")
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
    look!(findings, Length, holds, "{found_m} m are in the tiles, {expected_m} m are recorded");
}

/// Compares the lengths of roads on the ground, of bridges and of tunnels on the finest level with
/// the recorded ones, which add up to the length of all kept roads.
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
        look!(
            findings,
            Structures,
            holds,
            "{found_m} m of {name} are in the tiles, {recorded_m} m are recorded"
        );
    }
}

/// Compares all neighbours, and returns the number of compared borders.
fn check_seams(kept: &BTreeMap<TileId, TileSummary>, findings: &mut Findings) -> u64 {
    for (&id, tile) in kept {
        for (other, own_edge, other_edge) in seams::neighbours(id) {
            let Some(neighbour) = kept.get(&other) else { continue };
            let differences = seams::differences(
                &tile.borders[own_edge as usize],
                &neighbour.borders[other_edge as usize],
            );
            if let (Some(own), Some(theirs)) = (tile.relief_borders, neighbour.relief_borders) {
                let same = own[own_edge as usize] == theirs[other_edge as usize];
                look!(
                    findings,
                    ReliefSeams,
                    same,
                    "the reliefs of tiles {id} and {other} differ on their border"
                );
            }
            look!(
                findings,
                Seams,
                differences.is_empty(),
                "tiles {id} and {other} differ at border nodes {differences:?}"
            );
        }
    }
    findings.check_mut(CheckId::Seams).checked
}

/// Checks that the height range of the package is that of the root tile.
fn check_heights(said_m: [f64; 2], kept: &BTreeMap<TileId, TileSummary>, findings: &mut Findings) {
    let Some(root) = kept.get(&TileId::ROOT) else { return };
    let root_m = root.height_range_m;
    let same = said_m.iter().zip(root_m).all(|(said_m, m)| (said_m - m).abs() <= 0.0);
    look!(
        findings,
        RootHeights,
        same,
        "the height range {said_m:?} is recorded, the root tile has {root_m:?}"
    );
}

fn check_nesting(kept: &BTreeMap<TileId, TileSummary>, findings: &mut Findings) {
    for (&id, tile) in kept {
        // An island too small for a cell of the parent leaves the parent without ground; the next
        // ancestor counts.
        let above = (0..id.z()).rev().find_map(|level| {
            let above = id.ancestor(level);
            kept.get(&above).map(|tile| (above, tile))
        });
        let Some((parent, above)) = above else { continue };
        let nested = above.geometric_error_m >= tile.geometric_error_m
            && above.height_range_m[0] <= tile.height_range_m[0]
            && above.height_range_m[1] >= tile.height_range_m[1];
        look!(
            findings,
            Nested,
            nested,
            "the error or height range of tile {id} exceeds that of its parent {parent}"
        );
    }
}

/// The findings of a worker in one tile.
#[derive(Default)]
pub(crate) struct TileFindings {
    pub kept: Option<TileSummary>,
    pub findings: Findings,
    pub gaps: GapFigures,
    pub lengths: RoadLengths,
    pub ways: Vec<(i64, StoredWay)>,
    pub sums: TileSums,
    pub sv_tail_bytes: u64,
    pub damage: Option<String>,
}

pub(crate) fn look_at(
    tiles: &DecodedTiles<'_>,
    id: TileId,
    levels: Option<&Levels>,
) -> TileFindings {
    let manifest = tiles.package.manifest();
    let quantum_m = manifest.vertical.quantum_m;
    let tile = tiles.tile_at(id);
    let (payload, sizes) = match &tile.whole {
        Ok(read) => read,
        Err(damage) => {
            return TileFindings { damage: Some(damage.clone()), ..TileFindings::default() };
        }
    };
    let mut findings = Findings::default();
    let least_class = manifest.levels.get(usize::from(id.z())).and_then(|level| level.least_class);
    let ways = attributes::of_tile(payload, least_class, &mut findings);
    roads_on_tin::verify_order(payload, &mut findings);
    let bounds = manifest.frame.tile_lattice_bounds(id);
    let sums = TileSums::from_payload(payload, sizes, bounds);
    let mut found =
        TileFindings { ways, sums, sv_tail_bytes: sizes.sv_tail, ..TileFindings::default() };
    let Some(terrain) = &payload.terrain else {
        let bare = payload.roads_geo.is_empty() && payload.roads_sv.is_empty();
        look!(findings, OnTin, bare, "tile {id} has roads but no ground");
        return TileFindings { findings, ..found };
    };
    let place = TilePlace::from_frame(&manifest.frame, id);
    let ground = &*tiles.ground(id);
    let on_tin =
        roads_on_tin::verify_on_tin(payload, &terrain.tin, ground, manifest, &mut findings);
    (found.gaps, found.lengths) = (on_tin.gaps, on_tin.lengths);
    check_vertices(id, terrain, quantum_m, &mut findings);
    let has_relief = payload.relief.is_some();
    let settings = &manifest.settings;
    let wants_relief = settings.relief.has(id.z(), manifest.frame.max_level());
    findings.look(CheckId::ReliefThere, has_relief == wants_relief, || {
        let found = if has_relief { "a" } else { "no" };
        format!("tile {id} has {found} relief; the setting is {}", settings.relief.name())
    });
    if let Some(levels) = levels {
        let margin_steps = levels.margin_steps(id.z());
        let view = geo_against_sv::TileView { payload, ground, place, margin_steps, quantum_m };
        geo_against_sv::verify_lines(&view, &on_tin.positions, &mut findings);
        geo_against_sv::verify_ranges(&view, &mut findings);
        let parent = id.parent().map(|parent| tiles.tile_at(parent));
        let parent = parent.as_ref().and_then(|parent| parent.payload());
        if let Some(parent) = parent.filter(|parent| parent.terrain.is_some()) {
            let ground_above = &*tiles.ground(parent.id);
            let above = roads_of_parent::ComparedTile { payload: parent, ground: ground_above };
            let own = roads_of_parent::ComparedTile { payload, ground };
            roads_of_parent::verify(&own, &above, levels, &mut findings);
        }
    }
    if id.z() == manifest.frame.max_level() {
        check_ancestors(tiles, id, &mut findings);
    }
    found.kept = Some(TileSummary {
        vertices: terrain.tin.vertices().len() as u64,
        triangles: terrain.tin.triangles().len() as u64,
        geometric_error_m: terrain.geometric_error_m,
        height_range_m: terrain.height_range_m,
        borders: seams::borders(&terrain.tin),
        relief_borders: payload.relief.as_ref().map(relief::borders),
    });
    TileFindings { findings, ..found }
}

/// Checks the heights of a TIN's vertices.
fn check_vertices(id: TileId, terrain: &TileTerrain, quantum_m: f64, findings: &mut Findings) {
    let [low_m, high_m] = terrain.height_range_m;
    // The height of a vertex is that of a node, rounded to the quantum.
    let range_m = low_m - quantum_m / 2.0..=high_m + quantum_m / 2.0;
    for vertex in terrain.tin.vertices() {
        let height_m = f64::from(vertex.height_q) * quantum_m;
        look!(
            findings,
            Vertices,
            range_m.contains(&height_m),
            "tile {id} has a vertex at {height_m} m, its range is {low_m} to {high_m} m"
        );
    }
}

/// Compares the TIN of a finest tile, and of each of its ancestors, with that of its parent.
/// Ancestors without ground and unreadable ones are skipped; the latter are reported when they are
/// checked themselves.
fn check_ancestors(tiles: &DecodedTiles<'_>, id: TileId, findings: &mut Findings) {
    let levels: Vec<Level> = (0..=id.z())
        .rev()
        .filter_map(|level| {
            let id = id.ancestor(level);
            let error_m = tiles.tile_at(id).payload()?.terrain.as_ref()?.geometric_error_m;
            Some(Level { id, ground: tiles.ground(id), error_m })
        })
        .collect();
    tin_against_parent::verify(&tiles.package.manifest().frame, &levels, findings);
}
