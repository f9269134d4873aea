//! The extract once more: its roads clipped and laid on the package's own ground, tile by tile, beside what the
//! package has. What lies on the ground is checked without the extract, by geometry of its own.

use std::collections::BTreeMap;

use corniche_drape::{Neighbours, OwnedBorders};
use corniche_geom::TileId;
use corniche_roads::Road;
use corniche_tileset::{FilePackage, Manifest, Sections, TilePayload, pmtiles_order};
use corniche_tin::{Placement, Surface};

use super::{
    VerifyError, VerifyOsm,
    checks::{CheckId, Findings},
    grid,
    ground::Ground,
    place,
};
use crate::{
    BuildError, DiskStorage, Observer, Stage,
    inputs::{self, Inputs},
    levels::{Levels, most_scale},
    roads::{
        counts::road_counts,
        lay::{self, ClassSums, Laid, LaidSums, RoadFate, TileToLayOn},
        lengths::TrueLengths,
        read::{ReadRoads, RoadInput, read},
    },
    settings_record, workers,
};

/// Tiles whose lists of roads are in memory at once.
const BATCH: usize = 1024;

pub(crate) fn verify(
    package: &FilePackage,
    osm: &VerifyOsm,
    threads: usize,
    findings: &mut Findings,
    observer: &dyn Observer,
) -> Result<(), VerifyError> {
    let inputs = Inputs::find(&[], Some(&osm.path))?;
    let compared = compare_all(package, osm, threads, &inputs, findings, observer);
    match &compared {
        Err(VerifyError::Interrupted) => compared,
        // What else is wrong may come of a change.
        _ => inputs.check_unchanged().map_err(VerifyError::from).and(compared),
    }
}

fn compare_all(
    package: &FilePackage,
    osm: &VerifyOsm,
    threads: usize,
    inputs: &Inputs,
    findings: &mut Findings,
    observer: &dyn Observer,
) -> Result<(), VerifyError> {
    let manifest = package.manifest();
    check_inputs(manifest, osm, inputs, findings, observer)?;
    // Without either, `levels.derived` or `manifest.crs` is broken, and there is nothing to lay roads by.
    let (Some(settings), Some([first, last])) =
        (settings_record::roads(&manifest.settings, osm.table.clone()), grid::data_tiles(manifest))
    else {
        return Ok(());
    };
    let Ok(crs) = place::recorded(manifest) else { return Ok(()) };
    let projection = crs.projection(manifest.wgs84_bounds)?;
    let frame = manifest.frame;
    let widest = most_scale(manifest.scale.largest);
    let levels = Levels::new(frame, manifest.settings.max_error_m, &settings, widest);
    let lengths = TrueLengths::new(frame, &manifest.coordinates, &projection);
    let work = tempfile::tempdir().map_err(VerifyError::Work)?;
    observer.work_folder(work.path());
    let storage = DiskStorage::create(work.path()).map_err(VerifyError::Work)?;
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .map_err(|error| BuildError::Start { what: error.to_string() })?;
    let mut roads = read(
        &RoadInput {
            osm: &osm.path,
            settings: &settings,
            projection: &projection,
            levels: &levels,
            lengths: &lengths,
            data_bounds: frame.tile_lattice_bounds(first).union(&frame.tile_lattice_bounds(last)),
            pool: &pool,
            memory_bytes: osm.memory_bytes,
        },
        &storage,
        observer,
    )?;
    let laid = lay(
        &Laying { package, levels: &levels, lengths: &lengths, data: [first, last] },
        &mut roads,
        threads,
        findings,
        observer,
    )?;
    check_counts(manifest, &roads, &laid, findings);
    check_growth(manifest, &laid, findings);
    Ok(())
}

/// The extract is the one that was read, and so is the table of classes.
fn check_inputs(
    manifest: &Manifest,
    osm: &VerifyOsm,
    inputs: &Inputs,
    findings: &mut Findings,
    observer: &dyn Observer,
) -> Result<(), VerifyError> {
    if manifest.inputs.iter().all(|input| input.kind != inputs::OSM) {
        return Err(VerifyError::NoExtract);
    }
    let given = inputs.hash(observer)?;
    let extracts = || manifest.inputs.iter().filter(|input| input.kind == inputs::OSM);
    let pair = given
        .iter()
        .find_map(|found| Some((extracts().find(|input| input.sha256 == found.sha256)?, found)));
    let Some((said, found)) = pair else {
        let expected = extracts().map(|input| input.name.clone()).collect();
        return Err(VerifyError::OtherOsm { path: osm.path.clone(), expected });
    };
    findings.look(CheckId::OsmInputs, said.bytes == found.bytes, || {
        format!("{:?} has {} bytes, {} are recorded", said.name, found.bytes, said.bytes)
    });
    let settings = &manifest.settings;
    if settings_record::table_sha256(&osm.table) != settings.frc_table_sha256 {
        let (given, expected) = (osm.table.name().to_owned(), settings.frc_table.clone());
        return Err(if given == expected {
            VerifyError::OtherTableOfThatName { name: expected }
        } else {
            VerifyError::OtherTable { given, expected }
        });
    }
    findings.look(CheckId::OsmInputs, osm.table.name() == settings.frc_table, || {
        format!("the FRC table is {:?}, {:?} is recorded", osm.table.name(), settings.frc_table)
    });
    Ok(())
}

/// What roads are laid again by.
struct Laying<'a> {
    package: &'a FilePackage,
    levels: &'a Levels,
    lengths: &'a TrueLengths<'a>,
    /// First and last of the finest tiles of the data.
    data: [TileId; 2],
}

/// What a worker found in a tile.
struct Found {
    findings: Findings,
    fates: Vec<(u32, RoadFate)>,
    /// Of a tile with ground.
    classes: BTreeMap<u8, ClassSums>,
}

/// Lays all roads again, and compares each tile; the sums are those of what was laid.
fn lay(
    laying: &Laying<'_>,
    roads: &mut ReadRoads<'_>,
    threads: usize,
    findings: &mut Findings,
    observer: &dyn Observer,
) -> Result<LaidSums, VerifyError> {
    let [first, last] = laying.data;
    let mut ids = laying.package.tile_ids()?;
    for y in first.y()..=last.y() {
        for x in first.x()..=last.x() {
            ids.extend(TileId::new(first.z(), x, y).ok());
        }
    }
    ids.sort_unstable_by_key(|&id| pmtiles_order(id));
    ids.dedup();
    observer.begin(Stage::Tiles, Some(ids.len() as u64));
    let mut sums = LaidSums::of_roads(roads.log.len());
    for batch in ids.chunks(BATCH) {
        let mut lists = Vec::with_capacity(batch.len());
        for &id in batch {
            lists.push(roads.by_tile.roads_of(id)?);
        }
        let log = &roads.log;
        workers::in_order(
            threads,
            batch.len(),
            || Ok(Grounds::default()),
            |grounds, index| {
                if observer.is_cancelled() {
                    return Err(VerifyError::Interrupted);
                }
                let (id, ordinals) = (batch[index], &lists[index]);
                let mut with_roads = Vec::with_capacity(ordinals.len());
                for &ordinal in ordinals {
                    with_roads.push((ordinal, log.load(ordinal)?));
                }
                Ok(look_at(laying, grounds, id, &with_roads))
            },
            |index, found: Found| {
                findings.merge(found.findings);
                sums.add_fates(&found.fates);
                for (class, found) in found.classes {
                    let all = sums.classes.entry((batch[index].z(), class)).or_default();
                    all.source_vertices += found.source_vertices;
                    all.simplified_vertices += found.simplified_vertices;
                }
                observer.advance(Stage::Tiles, 1);
                Ok(())
            },
        )?;
    }
    observer.end(Stage::Tiles);
    Ok(sums)
}

fn look_at(laying: &Laying<'_>, grounds: &mut Grounds, id: TileId, roads: &[(u32, Road)]) -> Found {
    let mut found =
        Found { findings: Findings::default(), fates: Vec::new(), classes: BTreeMap::new() };
    let manifest = laying.package.manifest();
    let frame = &manifest.frame;
    let payload = laying.package.payload(id, Sections::ALL).ok().flatten();
    let terrain = payload.as_ref().and_then(|payload| payload.terrain.as_ref());
    let (Some(payload), Some(terrain)) = (&payload, terrain) else {
        if id.z() == frame.max_level() {
            let owned = grounds.owned_borders(laying, id, !roads.is_empty());
            let bounds = frame.tile_lattice_bounds(id);
            found.fates.extend(roads.iter().map(|(ordinal, road)| {
                (*ordinal, lay::lost_road(road, &bounds, owned, laying.lengths))
            }));
        }
        return found;
    };
    let placement = Placement::of_tile(frame, id, manifest.vertical.quantum_m);
    let surface = Surface::new(&terrain.tin, placement);
    let owned = grounds.owned_borders(laying, id, !roads.is_empty());
    let on = TileToLayOn { id, surface: &surface, owned };
    let mut laid = Laid::default();
    for (ordinal, road) in roads {
        laid.lay(road, *ordinal, &on, laying.levels, laying.lengths);
    }
    laid.sort();
    compare(payload, &laid, &mut found.findings);
    (found.fates, found.classes) = (laid.fates, laid.classes);
    found
}

fn compare(payload: &TilePayload, laid: &Laid, findings: &mut Findings) {
    let id = payload.id;
    let geo = |geo: &[corniche_tileset::GeoRoad]| -> Vec<_> {
        geo.iter().map(|road| ((road.class, road.way_id, road.part), road.line.clone())).collect()
    };
    let sv = |sv: &[corniche_tileset::SvRoad]| -> Vec<_> {
        sv.iter()
            .map(|road| ((road.class, road.way_id, road.part), road.line.points.clone()))
            .collect()
    };
    let (said, wanted) = (geo(&payload.roads_geo), geo(&laid.geo));
    each(CheckId::OsmGeo, id, &said, &wanted, findings);
    let (said, wanted) = (sv(&payload.roads_sv), sv(&laid.sv));
    each(CheckId::OsmSv, id, &said, &wanted, findings);
    let said: Vec<_> =
        payload.attributes.iter().map(|record| (record.way_id, &record.attributes)).collect();
    let wanted: Vec<_> =
        laid.attributes.values().map(|record| (record.way_id, &record.attributes)).collect();
    each(CheckId::OsmAttributes, id, &said, &wanted, findings);
}

/// Looks at every thing of two lists, by what it is called.
fn each<K: Ord + Copy + std::fmt::Debug, V: PartialEq>(
    check: CheckId,
    id: TileId,
    said: &[(K, V)],
    wanted: &[(K, V)],
    findings: &mut Findings,
) {
    let said_by: BTreeMap<K, &V> = said.iter().map(|(key, value)| (*key, value)).collect();
    for (key, value) in wanted {
        let own = said_by.get(key);
        findings.look(check, own == Some(&value), || match own {
            Some(_) => format!("{key:?} in tile {id} is not what the extract has"),
            None => format!("{key:?} of the extract is not in tile {id}"),
        });
    }
    let wanted_by: BTreeMap<K, &V> = wanted.iter().map(|(key, value)| (*key, value)).collect();
    for (key, _) in said.iter().filter(|(key, _)| !wanted_by.contains_key(key)) {
        findings.look(check, false, || format!("{key:?} in tile {id} is not in the extract"));
    }
}

/// The ground of tiles looked at lately, for their neighbours.
#[derive(Default)]
struct Grounds {
    kept: BTreeMap<TileId, Option<Ground>>,
}

/// Grounds kept at once: a tile, its neighbours, and some of the way along the curve.
const GROUNDS: usize = 32;

impl Grounds {
    fn load(&mut self, package: &FilePackage, id: TileId) {
        if self.kept.len() >= GROUNDS && !self.kept.contains_key(&id) {
            self.kept.clear();
        }
        self.kept.entry(id).or_insert_with(|| {
            let terrain = package.payload(id, Sections::TERRAIN).ok().flatten()?.terrain?;
            Some(Ground::new(&terrain.tin, package.manifest().vertical.quantum_m))
        });
    }

    /// What a tile owns of its borders, by the cells on both sides that TINs cover: they cover exactly those with ground.
    fn owned_borders(&mut self, laying: &Laying<'_>, id: TileId, has_roads: bool) -> OwnedBorders {
        if !has_roads {
            return OwnedBorders::ALL;
        }
        let [first, last] = laying.data;
        let around =
            [(0, 0), (1, 0), (0, 1), (-1, 0), (0, -1)].map(|(dx, dy)| id.neighbour(dx, dy));
        for other in around.iter().flatten() {
            self.load(laying.package, *other);
        }
        let ground_of = |other: Option<TileId>| self.kept.get(&other?)?.as_ref();
        let is_asked = |other: Option<TileId>| {
            other.is_some_and(|other| {
                ground_of(Some(other)).is_some()
                    || (other.z() == first.z()
                        && (first.x()..=last.x()).contains(&other.x())
                        && (first.y()..=last.y()).contains(&other.y()))
            })
        };
        let neighbours = Neighbours { east: is_asked(around[1]), south: is_asked(around[2]) };
        OwnedBorders::among(neighbours).where_ground(|column, row| {
            let cells = corniche_geom::TILE_CELLS;
            let (dx, dy) = (column.div_euclid(cells), row.div_euclid(cells));
            let other = id.neighbour(dx as i32, dy as i32);
            let at = [column.rem_euclid(cells), row.rem_euclid(cells)];
            ground_of(other)
                .is_some_and(|ground| ground.height_m(at.map(|index| index as f64 + 0.5)).is_some())
        })
    }
}

/// Counts and lengths.
fn check_counts(
    manifest: &Manifest,
    roads: &ReadRoads<'_>,
    laid: &LaidSums,
    findings: &mut Findings,
) {
    let said = &manifest.counts;
    let wanted = road_counts(said.samples, roads, laid);
    let mut same = |what: &str, said: &dyn std::fmt::Debug, found: &dyn std::fmt::Debug| {
        let (said, found) = (format!("{said:?}"), format!("{found:?}"));
        findings.look(CheckId::OsmCounts, said == found, || {
            format!("{what}: {said} are recorded, {found} are in the extract")
        });
    };
    same("roads_in", &said.roads_in, &wanted.roads_in);
    same("roads_kept", &said.roads_kept, &wanted.roads_kept);
    same("defects", &said.defects, &wanted.defects);
    same("unknown_highways", &said.unknown_highways, &wanted.unknown_highways);
    same("blobs_passed_over", &said.blobs_passed_over, &wanted.blobs_passed_over);
    same("tags_taken_otherwise", &said.tags_taken_otherwise, &wanted.tags_taken_otherwise);
    same("highways_in", &said.highways_in, &wanted.highways_in);
    same("highways_left_out", &said.highways_left_out, &wanted.highways_left_out);
    same("roads_in_um", &said.roads_in_um, &wanted.roads_in_um);
    same("roads_kept_um", &said.roads_kept_um, &wanted.roads_kept_um);
    same("roads_lost", &said.roads_lost, &wanted.roads_lost);
    same("classes", &said.classes, &wanted.classes);
}

/// Source and simplified points of each level and class.
fn check_growth(manifest: &Manifest, laid: &LaidSums, findings: &mut Findings) {
    let wanted: BTreeMap<(u8, u8), [u64; 2]> = laid
        .classes
        .iter()
        .filter(|(_, sums)| sums.source_vertices > 0)
        .map(|(&key, sums)| (key, [sums.source_vertices, sums.simplified_vertices]))
        .collect();
    let said: BTreeMap<(u8, u8), [u64; 2]> = manifest
        .growth
        .iter()
        .map(|row| ((row.level, row.class), [row.source_vertices, row.simplified_vertices]))
        .collect();
    let keys: std::collections::BTreeSet<_> = wanted.keys().chain(said.keys()).collect();
    for key in keys {
        let (said, wanted) = (said.get(key), wanted.get(key));
        findings.look(CheckId::OsmGrowth, said == wanted, || {
            format!(
                "level {} class {}: {said:?} source and simplified points are recorded, {wanted:?} were found",
                key.0, key.1
            )
        });
    }
}
