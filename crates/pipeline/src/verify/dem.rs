//! P2: the stored error is never below the true one, and hardly above it.

use std::{collections::BTreeMap, rc::Rc};

use corniche_dem::{Dem, DemWindow, GridPlan, Reader};
use corniche_geom::{HeightGrid, NodeIndex, NodeWindow, TileId};
use corniche_tileset::{
    Distribution, FilePackage, InputRecord, Manifest, Sections, VerticalRecord,
};

use super::{
    Check, CheckId, ErrorFigures, VerifyError, VerifyReport, VerifySettings, gradient,
    ground::Ground, samples,
};
use crate::{
    Observer, Stage,
    inputs::{self, Inputs},
    manifest_texts,
    sample_error::SampleSums,
    settings_record, workers,
};

/// Slack for comparing two ways of computing the same height, metres.
pub(crate) const ROUNDING_M: f64 = 1e-6;
/// The same for ratios of them.
const RATIO_ROUNDING: f64 = 1e-3;
/// P2's tightness: stored ≤ this × true + a quantum, for this share of tiles.
const TIGHTNESS: f64 = 2.0;
const TIGHT_SHARE: f64 = 0.95;

/// True error of a tile as far as it is known.
#[derive(Debug, Clone, Copy, Default)]
struct Truth {
    largest_m: f64,
    nodes: u64,
    uncovered: u64,
    /// Lowest and highest node with data beneath.
    range_m: Option<[f32; 2]>,
    /// Uncovered nodes farther than one cell of the level from any void or edge.
    stray: u64,
}

impl Truth {
    fn merge(&mut self, other: Self) {
        self.largest_m = self.largest_m.max(other.largest_m);
        self.nodes += other.nodes;
        self.uncovered += other.uncovered;
        self.stray += other.stray;
        self.range_m = match (self.range_m, other.range_m) {
            (Some(a), Some(b)) => Some([a[0].min(b[0]), a[1].max(b[1])]),
            (a, b) => a.or(b),
        };
    }
}

pub(crate) fn verify(
    package: &FilePackage,
    settings: &VerifySettings,
    report: &mut VerifyReport,
    observer: &dyn Observer,
) -> Result<(), VerifyError> {
    let inputs = Inputs::find(&settings.dem, None)?;
    let compared = compare_all(package, settings, &inputs, report, observer);
    match &compared {
        Err(VerifyError::Interrupted) => compared,
        // What else is wrong may come of a change.
        _ => inputs.check_unchanged().map_err(VerifyError::from).and(compared),
    }
}

fn compare_all(
    package: &FilePackage,
    settings: &VerifySettings,
    inputs: &Inputs,
    report: &mut VerifyReport,
    observer: &dyn Observer,
) -> Result<(), VerifyError> {
    let manifest = package.manifest();
    let Some((dem, plan)) = open(settings, inputs, manifest, report, observer)? else {
        return Ok(());
    };
    let max_level = manifest.frame.max_level();
    // All finest tiles of the data, those without ground too: a coarser level may cover their nodes.
    let finest = crate::heights::pyramid::data_tiles(&plan);
    observer.begin(Stage::Errors, Some(finest.len() as u64));
    let mut truths: BTreeMap<TileId, Truth> = BTreeMap::new();
    let nodes_are_samples = plan.nodes_are_samples();
    let mut at_samples = samples::none(manifest);
    workers::in_order(
        settings.threads,
        finest.len(),
        || Ok((dem.reader(&plan), BTreeMap::<TileId, Rc<Ground>>::new())),
        |(reader, cache), index| {
            if observer.is_cancelled() {
                return Err(VerifyError::Interrupted);
            }
            let id = finest[index];
            let read = reader.window(manifest.frame.tile_window(id))?;
            let mut found_at_samples = samples::none(manifest);
            let window = &read.heights;
            // Of the levels above only the latest are kept: tiles come in an order that stays close.
            cache.retain(|cached, _| *cached == id.ancestor(cached.z()));
            let mut found = Vec::new();
            for level in 0..=max_level {
                let ancestor = id.ancestor(level);
                let ground = Rc::clone(cache.entry(ancestor).or_insert_with(|| {
                    // A tile that is not there, or cannot be read, covers nothing: all its nodes are bare.
                    let payload = package.payload(ancestor, Sections::TERRAIN).ok().flatten();
                    let tin =
                        payload.and_then(|payload| payload.terrain).map(|terrain| terrain.tin);
                    Rc::new(Ground::new(&tin.unwrap_or_default(), manifest.vertical.quantum_m))
                }));
                let sums = &mut found_at_samples[usize::from(level)];
                let mut look = |[column, row]: [usize; 2], distance_m: Option<f64>| {
                    if nodes_are_samples && is_own_sample(id, &read, [column, row]) {
                        sums.add(distance_m);
                    }
                };
                let (mut truth, bare) =
                    compare(&ground, [id, ancestor], window, manifest, &mut look);
                for (cell, nodes) in bare {
                    let stride = manifest.frame.stride(level);
                    truth.stray += if has_void_corner(cell, stride, reader)? { 0 } else { nodes };
                }
                found.push((ancestor, truth));
            }
            Ok((found, found_at_samples))
        },
        |_, (found, found_at_samples): (Vec<(TileId, Truth)>, Vec<SampleSums>)| {
            samples::merge(&mut at_samples, &found_at_samples);
            for (id, truth) in found {
                truths.entry(id).or_default().merge(truth);
            }
            observer.advance(Stage::Errors, 1);
            Ok(())
        },
    )?;
    observer.end(Stage::Errors);
    if !nodes_are_samples {
        at_samples = samples::measure(package, &dem, &plan, settings, observer)?;
    }
    judge(package, &truths, report)?;
    gradient::verify(package, &dem, &plan, settings.threads, report, observer)?;
    report.checks.extend(samples::judge(manifest, &at_samples));
    report.samples = at_samples.last().map(SampleSums::record);
    Ok(())
}

/// Opens the DEM as the build did and makes sure that it is the same one. `None`, and a broken check, where it gives
/// another grid than the package's: then nothing can be compared.
fn open(
    settings: &VerifySettings,
    inputs: &Inputs,
    manifest: &Manifest,
    report: &mut VerifyReport,
    observer: &dyn Observer,
) -> Result<Option<(Dem, GridPlan)>, VerifyError> {
    let is_dem = |input: &&InputRecord| input.kind == inputs::DEM || input.kind == inputs::DEM_PART;
    let expected: Vec<&InputRecord> = manifest.inputs.iter().filter(is_dem).collect();
    let other = || VerifyError::OtherDem {
        expected: expected.iter().map(|input| input.name.clone()).collect(),
    };
    let terrain = settings_record::terrain(&manifest.settings);
    let dem = Dem::open(&settings.dem, &terrain.open)?;
    let given = inputs.hash(observer)?;
    // By content, not by name: a file may have been moved or renamed since. The order of parts is that of their names.
    let mut sizes = Check::new(CheckId::DemInputs);
    for kind in [inputs::DEM, inputs::DEM_PART] {
        let of_kind = |records: &mut dyn Iterator<Item = &InputRecord>| {
            let mut found: Vec<InputRecord> =
                records.filter(|record| record.kind == kind).cloned().collect();
            if kind == inputs::DEM_PART {
                found.sort_by(|a, b| a.sha256.cmp(&b.sha256));
            }
            found
        };
        let (said, found) = (of_kind(&mut expected.iter().copied()), of_kind(&mut given.iter()));
        let hash = |record: &InputRecord| record.sha256.clone();
        if !said.iter().map(hash).eq(found.iter().map(hash)) {
            return Err(other());
        }
        for (said, found) in said.iter().zip(&found) {
            sizes.look(said.bytes == found.bytes, || {
                format!("{:?} has {} bytes, {} are recorded", said.name, found.bytes, said.bytes)
            });
        }
    }
    report.checks.push(sizes);
    let plan = dem.plan(&terrain.plan)?;
    report.checks.push(check_plan(&plan, manifest));
    Ok((plan.frame == manifest.frame).then_some((dem, plan)))
}

/// What the plan says that the build took over into the manifest.
fn check_plan(plan: &GridPlan, manifest: &Manifest) -> Check {
    let mut check = Check::new(CheckId::DemPlan);
    let vertical = &manifest.vertical;
    let mut same = |what: &str, said: &dyn std::fmt::Debug, found: &dyn std::fmt::Debug| {
        let (said, found) = (format!("{said:?}"), format!("{found:?}"));
        check.look(said == found, || {
            format!("{what} is recorded as {said}, but comes out as {found}")
        });
    };
    same("frame", &manifest.frame, &plan.frame);
    same("crs", &manifest.crs, &plan.crs);
    same("metres_per_unit", &manifest.metres_per_unit, &plan.metres_per_unit);
    same("point_scale", &manifest.point_scale, &plan.point_scale);
    let scale = (plan.scale.center, plan.scale.least, plan.scale.largest);
    let said = (manifest.scale.center, manifest.scale.least, manifest.scale.largest);
    same("scale", &said, &scale);
    same("data_bounds", &manifest.data_bounds, &plan.data_bounds);
    same("wgs84_bounds", &manifest.wgs84_bounds, &plan.wgs84_bounds);
    same("nodes_are_samples", &manifest.nodes_are_samples, &plan.nodes_are_samples());
    same("resampling", &manifest.resampling, &plan.resampling_text);
    same("vertical.datum", &vertical.datum.as_str(), &manifest_texts::datum(plan));
    same("vertical.treatment", &vertical.treatment, &plan.vertical);
    check
}

/// Compares an ancestor's TIN with the full resolution over one finest tile. Also gives the cells of the
/// ancestor's level, by north-west node, in which nodes with data are not covered, and how many each has.
fn compare(
    ground: &Ground,
    [finest, ancestor]: [TileId; 2],
    window: &HeightGrid,
    manifest: &Manifest,
    look: &mut dyn FnMut([usize; 2], Option<f64>),
) -> (Truth, BTreeMap<NodeIndex, u64>) {
    let frame = &manifest.frame;
    let stride = frame.stride(ancestor.z());
    let (corner, above) = (frame.tile_corner(finest), frame.tile_corner(ancestor));
    let mut truth = Truth { range_m: window.range_m(), ..Truth::default() };
    let mut bare: BTreeMap<NodeIndex, u64> = BTreeMap::new();
    for row in 0..window.rows() {
        for column in 0..window.columns() {
            let Some(height_m) = window.height(column, row) else { continue };
            let cells = [corner.i - above.i + column as i64, above.j - corner.j + row as i64];
            let ground_m = ground.height_m(cells.map(|cells| cells as f64 / stride as f64));
            let distance_m = ground_m.map(|ground_m| (ground_m - f64::from(height_m)).abs());
            look([column, row], distance_m);
            match distance_m {
                Some(distance_m) => {
                    truth.nodes += 1;
                    truth.largest_m = truth.largest_m.max(distance_m);
                }
                // Border nodes belong to the tile east or south of them, which counts them.
                None if column + 1 < window.columns() && row + 1 < window.rows() => {
                    truth.uncovered += 1;
                    let [i, j] = cells.map(|cells| cells.div_euclid(stride) * stride);
                    *bare.entry(NodeIndex { i: above.i + i, j: above.j - j }).or_default() += 1;
                }
                None => {}
            }
        }
    }
    (truth, bare)
}

/// Whether a node of a finest tile's window is a sample, no filled void, that no other tile counts: those on the east and
/// south border belong to the next tile, if there can be one.
fn is_own_sample(id: TileId, read: &DemWindow, [column, row]: [usize; 2]) -> bool {
    let (columns, rows) = (read.heights.columns(), read.heights.rows());
    let last = (1_u32 << id.z()) - 1;
    let is_own = (column + 1 < columns || id.x() == last) && (row + 1 < rows || id.y() == last);
    is_own && read.is_filled.get(row * columns + column) != Some(&true)
}

/// Whether a cell of a level lacks ground because one of its corners is void or beyond the data: then every node
/// in it lies within one cell of that level from a void or an edge.
fn has_void_corner(
    cell: NodeIndex,
    stride: i64,
    reader: &mut Reader<'_>,
) -> Result<bool, VerifyError> {
    for (i, j) in [(0, 0), (stride, 0), (0, stride), (stride, stride)] {
        let corner = NodeIndex { i: cell.i + i, j: cell.j - j };
        let node = reader.window(NodeWindow { corner, stride: 1, columns: 1, rows: 1 })?;
        if !node.heights.has_height(0, 0) {
            return Ok(true);
        }
    }
    Ok(false)
}

/// Puts stored errors beside true ones.
fn judge(
    package: &FilePackage,
    truths: &BTreeMap<TileId, Truth>,
    report: &mut VerifyReport,
) -> Result<(), VerifyError> {
    let manifest = package.manifest();
    let quantum_m = manifest.vertical.quantum_m;
    let mut bound = Check::new(CheckId::Bound);
    let mut finest = Check::new(CheckId::Finest);
    let mut stray = Check::new(CheckId::Stray);
    let mut tight = Check::new(CheckId::Tight);
    let mut loose = 0_u64;
    let mut counted = Check::new(CheckId::Uncovered);
    let mut ranges = Check::new(CheckId::Ranges);
    let mut stored = BTreeMap::new();
    for id in package.tile_ids()? {
        let payload = package.payload(id, Sections::TERRAIN).ok().flatten();
        if let Some(terrain) = payload.and_then(|payload| payload.terrain) {
            let said = terrain.uncovered_nodes;
            let truth = truths.get(&id).copied().unwrap_or_default();
            counted.look(said == truth.uncovered, || {
                format!("tile {id} says {said}, {} were found", truth.uncovered)
            });
            let [low, high] = terrain.height_range_m;
            let said = [low, high].map(f64::to_bits);
            let holds =
                truth.range_m.is_none_or(|range| range.map(|m| f64::from(m).to_bits()) == said);
            ranges.look(holds, || {
                format!("tile {id} says {low} to {high} m, nodes beneath: {:?}", truth.range_m)
            });
            stored.insert(id, terrain.geometric_error_m);
        }
    }
    let mut ratios: BTreeMap<u8, Vec<f64>> = BTreeMap::new();
    let mut levels: BTreeMap<u8, Truth> = BTreeMap::new();
    let mut tiles: BTreeMap<u8, u64> = BTreeMap::new();
    for (&id, truth) in truths {
        // Tiles that are not there count too: what lies beneath them must lie at a void or an edge.
        stray.look(truth.stray == 0, || format!("{} nodes of tile {id}", truth.stray));
        levels.entry(id.z()).or_default().merge(*truth);
    }
    for level in &manifest.levels {
        let found = levels.get(&level.level).map_or(0, |truth| truth.uncovered);
        counted.look(found == level.uncovered_nodes, || {
            format!("level {} says {}, {found} were found", level.level, level.uncovered_nodes)
        });
    }
    for (&id, &stored_m) in &stored {
        let truth = truths.get(&id).copied().unwrap_or_default();
        *tiles.entry(id.z()).or_default() += 1;
        bound.look(stored_m >= truth.largest_m - ROUNDING_M, || {
            format!("tile {id} stores {stored_m} m, but is off by {} m", truth.largest_m)
        });
        if id.z() == manifest.frame.max_level() {
            finest.look(truth.largest_m <= manifest.settings.max_error_m + ROUNDING_M, || {
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
    let count = stored.len() as u64;
    tight.look(loose as f64 <= (1.0 - TIGHT_SHARE) * count as f64, || {
        format!("{loose} of {count} tiles are loose")
    });
    let mut recorded = Check::new(CheckId::Recorded);
    for (level, truth) in levels {
        let tightness = Distribution::of(ratios.remove(&level).unwrap_or_default());
        let said = manifest.levels.get(usize::from(level)).and_then(|record| record.tightness);
        recorded.look(agree(said, tightness), || {
            format!("level {level} records {said:?}, found {tightness:?}")
        });
        report.errors.push(ErrorFigures {
            level,
            tiles: tiles.get(&level).copied().unwrap_or_default(),
            nodes: truth.nodes,
            largest_true_m: truth.largest_m,
            tightness,
            uncovered_nodes: truth.uncovered,
        });
    }
    report.checks.extend([bound, tight, recorded, finest, stray, counted, ranges]);
    Ok(())
}

/// Whether two distributions of ratios are the same but for rounding: their errors were computed in two ways.
fn agree(said: Option<Distribution>, found: Option<Distribution>) -> bool {
    let near = |a: f64, b: f64| (a - b).abs() <= RATIO_ROUNDING * a.max(b);
    match (said, found) {
        (Some(said), Some(found)) => {
            said.count == found.count
                && near(said.min, found.min)
                && near(said.median, found.median)
                && near(said.p95, found.p95)
                && near(said.max, found.max)
        }
        (None, None) => true,
        (Some(_), None) | (None, Some(_)) => false,
    }
}
