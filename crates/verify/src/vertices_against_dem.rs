//! Compares TIN vertices and their normals with the DEM on each level, and counts the nodes with
//! data.

use corniche_dem::{Dem, DemError, GridPlan};
use corniche_geom::{HeightGrid, TileId};
use corniche_ground::{GroundError, heights::pyramid::Pyramid};
use corniche_tileset::TileTerrain;
use corniche_tin::normal_shift;
use corniche_work::Stage;

use super::{
    checks::{Findings, as_json},
    decoded_tiles::DecodedTiles,
    each_tile::VerifyRun,
    error::Result,
    relief,
    temporary_store::TemporaryStore,
};

/// Steps from the centre of the octahedron's square to its edge (Meyer et al. 2010, section 3).
const STEPS: f64 = 127.0;
/// The additional tolerance of a code, which is the nearest multiple of its level's step: it was
/// computed in two ways.
const COMPUTED: f64 = 1e-6;

/// Compares vertices and normals with the rasters of their levels, which are stored in a temporary
/// folder.
pub(crate) fn verify(
    run: &VerifyRun<'_>,
    (dem, plan): &(Dem, GridPlan),
    findings: &mut Findings,
) -> Result<()> {
    let &VerifyRun { package, ref tiles, threads, observer } = run;
    let manifest = package.manifest();
    let work = TemporaryStore::new(observer)?;
    let pyramid = Pyramid {
        dem,
        grid: plan,
        range_m: manifest.settings.height_range_m,
        threads,
        store: &work.store,
        observer,
    };
    pyramid.make(TileId::ROOT)?;
    let patches = pyramid.all_patches()?;
    let refused = refusal(pyramid.check(&patches))?;
    look!(
        findings,
        DemCounts,
        refused.is_none(),
        "heights that the settings do not allow: {}",
        refused.unwrap_or_default()
    );
    let sums = pyramid.sums(&patches);
    let (said, found) = (manifest.counts.samples, sums.samples);
    look!(
        findings,
        DemCounts,
        said == found,
        "recorded {}, found {}",
        as_json(&said),
        as_json(&found)
    );
    let (said_m, found_m) = (manifest.vertical.range_m, sums.range_m.map(f64::from));
    let same_range = said_m.map(f64::to_bits) == found_m.map(f64::to_bits);
    look!(
        findings,
        DemCounts,
        same_range,
        "the height range {said_m:?} is recorded, {found_m:?} was found"
    );
    let look_at = |id| look_at(tiles, &pyramid, id);
    run.each_tile(Stage::CompareHeights, look_at, |_, found| findings.merge(found))
}

/// The message if the audit rejects heights. Other errors are no findings: they end the
/// verification.
fn refusal(audited: Result<(), GroundError>) -> Result<Option<String>> {
    match audited {
        Ok(()) => Ok(None),
        Err(GroundError::Dem(error @ DemError::Audit(_))) => Ok(Some(error.to_string())),
        Err(error) => Err(error.into()),
    }
}

fn look_at(tiles: &DecodedTiles<'_>, pyramid: &Pyramid<'_>, id: TileId) -> Result<Findings> {
    let mut findings = Findings::default();
    let manifest = tiles.package.manifest();
    let tile = tiles.tile_at(id);
    let Some(TileTerrain { tin, normals, .. }) = tile.terrain() else { return Ok(findings) };
    let Some(heights) = pyramid.tile(id)? else {
        look!(findings, Nodes, false, "tile {id} has ground where the DEM has no height");
        return Ok(findings);
    };
    let cell = manifest.frame.level_cell(id.z());
    let cell_m = cell.to_array();
    let step = manifest
        .levels
        .get(usize::from(id.z()))
        .map_or(1.0, |level| f64::from(1_u8 << normal_shift(level.max_error_m, cell)));
    let farthest = (STEPS / step).floor() * step;
    if let Some(relief) = tile.payload().and_then(|payload| payload.relief.as_ref()) {
        let step_m = manifest.vertical.height_step_m;
        let may_move = relief::may_move(step_m, cell);
        let slope_at = |at| gradient(&heights, at, cell_m);
        relief::verify(id, relief, (&heights, may_move), slope_at, &mut findings);
    }
    for (vertex, normal) in tin.vertices().iter().zip(normals) {
        // The raster has the tile's own nodes and one row or column of nodes of its neighbours on
        // each side.
        let at = [usize::from(vertex.column) + 1, usize::from(vertex.row) + 1];
        let wanted = heights
            .height(at[0], at[1])
            .map(|height_m| (f64::from(height_m) / manifest.vertical.quantum_m).round());
        look!(
            findings,
            Nodes,
            wanted == Some(f64::from(vertex.height_q)),
            "tile {id} has height {} (in steps) at its node {}, {}, the DEM {wanted:?}",
            vertex.height_q,
            vertex.column,
            vertex.row
        );
        let [east, north] = gradient(&heights, at, cell_m);
        // The upward normal of the slope, on the octahedron |x| + |y| + |z| = 1.
        let size = east.abs() + north.abs() + 1.0;
        let exact = [-east, -north].map(|slope| STEPS * slope / size);
        let holds = (0..2).all(|axis| {
            let (code, exact) = (f64::from(normal[axis]), exact[axis].clamp(-farthest, farthest));
            code % step == 0.0 && (code - exact).abs() <= 0.5 * step + COMPUTED
        });
        look!(
            findings,
            Normals,
            holds,
            "tile {id} has the normal {normal:?} at its node {}, {}, the DEM {exact:?}",
            vertex.column,
            vertex.row
        );
    }
    Ok(findings)
}

/// The rise in metres per metre east and per metre north, from the nearest nodes with data on
/// either side.
fn gradient(heights: &HeightGrid, [column, row]: [usize; 2], cell_m: [f64; 2]) -> [f64; 2] {
    let slope = |low: [usize; 2], high: [usize; 2], cell_m: f64| {
        let at = |[column, row]: [usize; 2]| heights.height(column, row).map(f64::from);
        let (before, here, after) = (at(low), at([column, row]), at(high));
        match (before.or(here), after.or(here)) {
            (Some(from), Some(to)) => {
                let cells = f64::from(u8::from(before.is_some()) + u8::from(after.is_some()));
                if cells > 0.0 { (to - from) / (cells * cell_m) } else { 0.0 }
            }
            _ => 0.0,
        }
    };
    [
        slope([column - 1, row], [column + 1, row], cell_m[0]),
        slope([column, row + 1], [column, row - 1], cell_m[1]),
    ]
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "these numbers are exact")]
#[path = "vertices_against_dem_tests.rs"]
mod tests;
