//! Every tile by itself, and each beside its neighbours, its parent and the manifest.

use std::{collections::BTreeMap, rc::Rc};

use corniche_geom::{LatticeBounds, LatticePoint, TileId};
use corniche_roads::FunctionalRoadClass;
use corniche_tileset::{
    Distribution, FilePackage, GrowthRow, PayloadSizes, Sections, TilePayload, decode,
    payload_sizes,
};

use super::{
    GapFigures, VerifyError, VerifyReport,
    attributes::{self, WayFacts, Ways},
    checks::{CheckId, Findings},
    ground::{Ground, Place},
    levels::{self, Level},
    methods,
    roads::{self, counts_for_sums},
    seams::{self, Borders},
    shown,
    sums::LENGTH_SHARE,
};
use crate::{Observer, Stage, levels::Levels, roads::shares::share, workers};

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
    findings: Findings,
    gaps: GapFigures,
    length_m: f64,
    ways: Vec<(i64, WayFacts)>,
    sums: TileSums,
    damage: Option<String>,
}

/// What of a tile goes into the manifest's sums.
#[derive(Default)]
struct TileSums {
    terrain_bytes: u64,
    uncovered_nodes: u64,
    classes: BTreeMap<u8, Row>,
}

/// What of a growth row follows from the tiles.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
struct Row {
    geo_vertices: u64,
    sv_vertices: u64,
    geo_stored_bytes: u64,
    sv_stored_bytes: u64,
    /// Source points of GEO lines inside the tiles: where there is one, there is a row.
    inner_points: u64,
}

/// A tile with its ground, kept for the tiles beneath.
struct Parent {
    payload: TilePayload,
    ground: Ground,
}

/// The tiles above the one looked at last, as far as they were asked for: the next one has most of them, too.
type Above = BTreeMap<TileId, Option<Rc<Parent>>>;

pub(crate) fn verify(
    package: &FilePackage,
    threads: usize,
    observer: &dyn Observer,
) -> Result<(VerifyReport, Findings), VerifyError> {
    let manifest = package.manifest();
    let frame = manifest.frame;
    // Without it `levels.derived` is broken, and tells so.
    let levels = Levels::recorded(manifest);
    let ids = package.tile_ids()?;
    observer.begin(Stage::Verify, Some(ids.len() as u64));
    let mut findings = Findings::default();
    let mut kept = BTreeMap::new();
    let mut gaps: BTreeMap<u8, GapFigures> = BTreeMap::new();
    let mut finest_length_m = 0.0;
    let mut ways = Ways::default();
    let mut sums: BTreeMap<u8, TileSums> = BTreeMap::new();
    workers::in_order(
        threads,
        ids.len(),
        || Ok(Above::new()),
        |above, index| {
            if observer.is_cancelled() {
                Err(VerifyError::Interrupted)
            } else {
                Ok(look_at(package, ids[index], levels.as_ref(), above))
            }
        },
        |index, found: Found| {
            let id = ids[index];
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
                finest_length_m += found.length_m;
            }
            ways.add(id, found.ways, &mut findings);
            sums.entry(id.z()).or_default().add(found.sums);
            kept.extend(found.kept.map(|tile| (id, tile)));
            observer.advance(Stage::Verify, 1);
            Ok(())
        },
    )?;
    observer.end(Stage::Verify);
    let borders = check_seams(&kept, &mut findings);
    check_nesting(&kept, &mut findings);
    check_heights(manifest.vertical.range_m, &kept, &mut findings);
    let expected_m = manifest.counts.roads_kept_um as f64 / 1e6;
    findings.look(
        CheckId::Length,
        (finest_length_m - expected_m).abs() <= LENGTH_SHARE * expected_m.max(1.0),
        || format!("{finest_length_m} m lie in the tiles, {expected_m} m are recorded"),
    );
    check_levels(package, &ids, &kept, &sums, &mut findings);
    check_growth(&manifest.growth, &sums, &mut findings);
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

fn look_at(package: &FilePackage, id: TileId, levels: Option<&Levels>, above: &mut Above) -> Found {
    let manifest = package.manifest();
    let quantum_m = manifest.vertical.quantum_m;
    let bytes = match package.tile(id) {
        Ok(Some(bytes)) => bytes,
        Ok(None) => return Found::damaged(id, format!("tile {id} is listed but not there")),
        Err(error) => return Found::damaged(id, chain(&error)),
    };
    let read = decode(&bytes, id, &manifest.frame, quantum_m, Sections::ALL)
        .and_then(|payload| Ok((payload, payload_sizes(&bytes, id)?)));
    let (payload, sizes) = match read {
        Ok(read) => read,
        Err(error) => return Found::damaged(id, chain(&error)),
    };
    let mut findings = Findings::default();
    let least_class = manifest.levels.get(usize::from(id.z())).and_then(|level| level.least_class);
    let ways = attributes::of_tile(&payload, least_class, &mut findings);
    roads::verify_order(&payload, &mut findings);
    let bounds = manifest.frame.tile_lattice_bounds(id);
    let mut found =
        Found { ways, sums: TileSums::of(&payload, &sizes, bounds), ..Found::empty(id) };
    let Some(terrain) = &payload.terrain else {
        let bare = payload.roads_geo.is_empty() && payload.roads_sv.is_empty();
        findings.look(CheckId::OnTin, bare, || format!("tile {id} has roads but no ground"));
        return Found { findings, ..found };
    };
    let place = Place::of(&manifest.frame, id);
    let ground = Ground::placed(&terrain.tin, quantum_m, place.steps);
    let on_tin = roads::verify_on_tin(&payload, &terrain.tin, &ground, manifest, &mut findings);
    (found.gaps, found.length_m) = (on_tin.gaps, on_tin.length_m);
    let [low_m, high_m] = terrain.height_range_m;
    // A vertex is a node beneath, rounded to the quantum.
    let range_m = low_m - quantum_m / 2.0..=high_m + quantum_m / 2.0;
    for vertex in terrain.tin.vertices() {
        let height_m = f64::from(vertex.height_q) * quantum_m;
        findings.look(CheckId::Vertices, range_m.contains(&height_m), || {
            format!("tile {id} has a vertex at {height_m} m, its range is {low_m} to {high_m} m")
        });
    }
    if let Some(levels) = levels {
        let margin_steps = levels.margin_steps(id.z());
        let view =
            methods::View { payload: &payload, ground: &ground, place, margin_steps, quantum_m };
        methods::verify_lines(&view, &on_tin.positions, &mut findings);
        methods::verify_ranges(&view, &mut findings);
        let parent = id.parent().and_then(|parent| ancestor(package, id, parent, above));
        if let Some(parent) = parent {
            let above = shown::Side { payload: &parent.payload, ground: &parent.ground };
            let own = shown::Side { payload: &payload, ground: &ground };
            shown::verify(&own, &above, levels, &mut findings);
        }
    }
    if id.z() == manifest.frame.max_level() {
        let parents: Vec<Rc<Parent>> = (0..id.z())
            .rev()
            .filter_map(|level| ancestor(package, id, id.ancestor(level), above))
            .collect();
        let own = Level { id, ground: &ground, error_m: terrain.geometric_error_m };
        let levels: Vec<Level<'_>> = std::iter::once(own)
            .chain(parents.iter().filter_map(|parent| parent.level()))
            .collect();
        levels::verify(&manifest.frame, &levels, &mut findings);
    }
    found.kept = Some(Kept {
        vertices: terrain.tin.vertices().len() as u64,
        triangles: terrain.tin.triangles().len() as u64,
        geometric_error_m: terrain.geometric_error_m,
        height_range_m: terrain.height_range_m,
        borders: seams::borders(&terrain.tin),
    });
    Found { findings, ..found }
}

/// A tile above `id`; `None` where it has no ground or cannot be read, which is told where it is looked at itself.
fn ancestor(
    package: &FilePackage,
    id: TileId,
    wanted: TileId,
    above: &mut Above,
) -> Option<Rc<Parent>> {
    // One tile a level is kept: memory does not grow with the package.
    above.retain(|&kept, _| kept.z() < id.z() && kept == id.ancestor(kept.z()));
    let load = || {
        let manifest = package.manifest();
        let payload = package.payload(wanted, Sections::ALL).ok().flatten()?;
        let tin = &payload.terrain.as_ref()?.tin;
        let steps = Place::of(&manifest.frame, wanted).steps;
        let ground = Ground::placed(tin, manifest.vertical.quantum_m, steps);
        Some(Rc::new(Parent { payload, ground }))
    };
    above.entry(wanted).or_insert_with(load).clone()
}

impl Parent {
    fn level(&self) -> Option<Level<'_>> {
        let error_m = self.payload.terrain.as_ref()?.geometric_error_m;
        Some(Level { id: self.payload.id, ground: &self.ground, error_m })
    }
}

impl TileSums {
    fn of(payload: &TilePayload, sizes: &PayloadSizes, bounds: LatticeBounds) -> Self {
        let terrain = payload.terrain.as_ref();
        let mut sums = Self {
            terrain_bytes: sizes.terrain.stored,
            uncovered_nodes: terrain.map_or(0, |terrain| terrain.uncovered_nodes),
            classes: BTreeMap::new(),
        };
        let LatticeBounds { min, max } = bounds;
        for road in &payload.roads_geo {
            let row = sums.classes.entry(road.class.number()).or_default();
            row.geo_vertices += road.line.vertices.len() as u64;
            // On a border a point may be a cut.
            let is_inside = |point: &LatticePoint| {
                (min.u + 1..max.u).contains(&point.u) && (min.v + 1..max.v).contains(&point.v)
            };
            row.inner_points += methods::source_points(&road.line).filter(is_inside).count() as u64;
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

    fn add(&mut self, other: Self) {
        self.terrain_bytes += other.terrain_bytes;
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

/// Tiles, triangles, bytes and errors of each level.
fn check_levels(
    package: &FilePackage,
    ids: &[TileId],
    kept: &BTreeMap<TileId, Kept>,
    sums: &BTreeMap<u8, TileSums>,
    findings: &mut Findings,
) {
    let nothing = TileSums::default();
    for level in &package.manifest().levels {
        let found = ids.iter().filter(|id| id.z() == level.level).count() as u64;
        findings.look(CheckId::LevelSums, found == level.tiles, || {
            format!("level {} has {found} tiles, {} are recorded", level.level, level.tiles)
        });
        let tiles = || kept.iter().filter(|(id, _)| id.z() == level.level).map(|(_, tile)| tile);
        let triangles: u64 = tiles().map(|tile| tile.triangles).sum();
        let vertices: u64 = tiles().map(|tile| tile.vertices).sum();
        let errors_m = Distribution::of(tiles().map(|tile| tile.geometric_error_m).collect());
        let largest_m = errors_m.map_or(0.0, |errors_m| errors_m.max);
        let sums = sums.get(&level.level).unwrap_or(&nothing);
        let said = (level.triangles, level.vertices, level.terrain_bytes, level.errors_m);
        let agrees = (triangles, vertices, sums.terrain_bytes, errors_m) == said
            && largest_m.to_bits() == level.geometric_error_m.to_bits()
            // Nodes where there is no tile count for the level alone.
            && sums.uncovered_nodes <= level.uncovered_nodes;
        findings.look(CheckId::LevelSums, agrees, || {
            format!(
                "level {} has {triangles} triangles, {vertices} vertices, {} bytes of ground, error {largest_m} m, \
                 {} uncovered nodes",
                level.level, sums.terrain_bytes, sums.uncovered_nodes
            )
        });
    }
}

/// The rows of the growth table, as far as they follow from the tiles.
fn check_growth(rows: &[GrowthRow], sums: &BTreeMap<u8, TileSums>, findings: &mut Findings) {
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
        findings.look(CheckId::Growth, found == said && last < Some(key), || {
            format!(
                "level {} class {}: {found:?} in the tiles, {row:?} recorded",
                row.level, row.class
            )
        });
        last = Some(key);
        // Pairs and triples of f64; the level's lines have no point that the source has not.
        let plain = [row.source_vertices * 16, row.simplified_vertices * 16, row.geo_vertices * 24];
        let bytes = [row.source_bytes, row.simplified_bytes, row.geo_raw_bytes];
        let thinned = row.simplified_vertices <= row.source_vertices;
        findings.look(CheckId::Growth, plain == bytes && thinned, || {
            format!("level {} class {}: {bytes:?} bytes for {plain:?}", row.level, row.class)
        });
    }
    // A class of which no point lies in a tile with ground has no row.
    for ((level, class), row) in left {
        findings.look(CheckId::Growth, row.inner_points == 0, || {
            format!("level {level} class {class} has no row, but {row:?} in the tiles")
        });
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
    fn empty(id: TileId) -> Self {
        Self {
            kept: None,
            findings: Findings::default(),
            gaps: GapFigures { level: id.z(), ..GapFigures::default() },
            length_m: 0.0,
            ways: Vec::new(),
            sums: TileSums::default(),
            damage: None,
        }
    }

    fn damaged(id: TileId, damage: String) -> Self {
        Self { damage: Some(damage), ..Self::empty(id) }
    }
}

/// Compares all neighbours, and says how many borders there are.
fn check_seams(kept: &BTreeMap<TileId, Kept>, findings: &mut Findings) -> u64 {
    for (&id, tile) in kept {
        for (other, own_edge, other_edge) in seams::neighbours(id) {
            let Some(neighbour) = kept.get(&other) else { continue };
            let differences = seams::differences(
                &tile.borders[own_edge as usize],
                &neighbour.borders[other_edge as usize],
            );
            findings.look(CheckId::Seams, differences.is_empty(), || {
                format!("tiles {id} and {other} differ at border nodes {differences:?}")
            });
        }
    }
    findings.of(CheckId::Seams).checked
}

/// The root tile lies over all heights of the package.
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
