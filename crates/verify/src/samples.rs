//! P2 at the DEM's own samples: computes the figures that the package states again.

use std::sync::Arc;

use corniche_dem::{Dem, GridPlan};
use corniche_geom::{GridFrame, TileId};
use corniche_tileset::{Manifest, SampleErrorRecord, SampleSums};
use corniche_work::{Stage, workers};

use super::{
    checks::{Check, CheckId, as_json},
    each_tile::VerifyRun,
    error::{Result, VerifyError},
    triangle_soup::{HEIGHT_ROUNDING_M, TriangleSoup},
};

/// Empty sums for every level, root first.
pub(crate) fn none(manifest: &Manifest) -> Vec<SampleSums> {
    let levels = usize::from(manifest.frame.max_level()) + 1;
    vec![SampleSums::new(manifest.vertical.quantum_m); levels]
}

/// Adds other sums, level by level.
pub(crate) fn merge(sums: &mut [SampleSums], others: &[SampleSums]) {
    for (sums, others) in sums.iter_mut().zip(others) {
        sums.merge(others);
    }
}

/// Measures every level at every used sample; for a DEM whose samples are not the nodes.
pub(crate) fn measure(
    run: &VerifyRun<'_>,
    (dem, plan): &(Dem, GridPlan),
) -> Result<Vec<SampleSums>> {
    let manifest = run.package.manifest();
    let ranges = dem.sample_ranges(plan)?;
    let mut sums = none(manifest);
    workers::side_by_side(
        (run.observer, Stage::Samples),
        run.threads,
        &ranges,
        || {
            Ok::<_, VerifyError>((
                dem.reader(plan),
                vec![None; usize::from(manifest.frame.max_level()) + 1],
            ))
        },
        |(reader, last), range| {
            let block = reader.used_samples(range)?;
            let mut found = none(manifest);
            for (&position_m, &height_m) in block.positions_m.iter().zip(&block.heights_m) {
                // The position is rounded to the lattice, as in the build: at the edge of the
                // ground, half a millimetre decides whether a sample lies on the ground.
                let frame = &manifest.frame;
                // A sample without a position in the working CRS is not used.
                let Some(position_m) = frame.snap(position_m).map(|point| frame.position_m(point))
                else {
                    continue;
                };
                for (level, sums) in found.iter_mut().enumerate() {
                    let ground_m = tile_at(frame, level as u8, position_m).and_then(|id| {
                        let last: &mut Option<(TileId, Arc<TriangleSoup>)> = &mut last[level];
                        if last.as_ref().is_none_or(|(of, _)| *of != id) {
                            *last = Some((id, run.tiles.ground(id)));
                        }
                        let (_, ground) = last.as_ref()?;
                        ground.height_m(cells(frame, id, position_m))
                    });
                    sums.add(ground_m.map(|ground_m| (ground_m - f64::from(height_m)).abs()));
                }
            }
            Ok(found)
        },
        |_, found| {
            merge(&mut sums, &found);
            Ok(())
        },
    )?;
    Ok(sums)
}

/// The tile of a level to which a position belongs: on a border, the tile in the east or south; on
/// the root's own east or south border, the last tile.
fn tile_at(frame: &GridFrame, level: u8, [x, y]: [f64; 2]) -> Option<TileId> {
    let root = frame.tile_bounds(TileId::ROOT);
    let tiles = f64::from(1_u32 << level);
    let column = (x - root.min_x) / root.width() * tiles;
    let row = (root.max_y - y) / root.height() * tiles;
    let index = |at: f64| {
        // Borders are exact in nodes. Here, a position is a sum of rounded numbers.
        let at = if (at - at.round()).abs() < 1e-10 * tiles { at.round() } else { at };
        (0.0..=tiles).contains(&at).then(|| at.min(tiles - 1.0) as u32)
    };
    TileId::new(level, index(column)?, index(row)?).ok()
}

/// The position in a tile in the tile's own cells: column, row.
fn cells(frame: &GridFrame, id: TileId, [x, y]: [f64; 2]) -> [f64; 2] {
    let corner = frame.tile_corner(id);
    let cell = frame.level_cell(id.z());
    [(x - frame.x_m(corner.i)) / cell.east_m, (frame.y_m(corner.j) - y) / cell.north_m]
}

/// Compares the computed figures with those in the package.
pub(crate) fn judge(manifest: &Manifest, sums: &[SampleSums]) -> [Check; 2] {
    let mut stated = Check::new(CheckId::Samples);
    let mut bound = Check::new(CheckId::SampleBound);
    let quantum_m = manifest.vertical.quantum_m;
    for (record, sums) in manifest.levels.iter().zip(sums) {
        let (said, found) = (record.sample_error, sums.record());
        stated.look(agree(said, found, quantum_m), || {
            format!("level {} records {}, found {}", record.level, as_json(&said), as_json(&found))
        });
    }
    if manifest.nodes_are_samples
        && let Some(finest) = sums.last()
    {
        let max_m = finest.record().max_m;
        bound.look(max_m <= manifest.settings.max_error_m + quantum_m, || {
            format!("{max_m} m at a sample, --max-error is {} m", manifest.settings.max_error_m)
        });
    }
    [stated, bound]
}

/// Whether two figures are equal apart from rounding: distances were computed in two ways.
fn agree(said: SampleErrorRecord, found: SampleErrorRecord, quantum_m: f64) -> bool {
    let near = |a: f64, b: f64, slack: f64| (a - b).abs() <= slack + 1e-9 * a.max(b);
    said.on_tin == found.on_tin
        && said.off_tin == found.off_tin
        && near(said.max_m, found.max_m, HEIGHT_ROUNDING_M)
        && near(said.rms_m, found.rms_m, quantum_m / 100.0)
        && near(said.p99_m, found.p99_m, quantum_m + said.p99_m / 2048.0)
}
