//! Levels beside each other: a child's TIN and its parent's, at every finest node that both cover.

use std::{collections::BTreeMap, rc::Rc};

use corniche_geom::{TILE_NODES, TileId};
use corniche_tileset::{FilePackage, Sections};

use super::{
    VerifyError,
    checks::{CheckId, Findings},
    ground::Ground,
};
use crate::{Observer, Stage, workers};

/// Slack for comparing sums of heights, metres.
const ROUNDING_M: f64 = 1e-6;

/// A tile's ground and its stored error.
type Known = Option<Rc<(Ground, f64)>>;

/// Compares the TINs of all levels over every finest tile. Nodes that the finest level does not cover may be void,
/// and nothing is promised there.
pub(crate) fn verify(
    package: &FilePackage,
    threads: usize,
    findings: &mut Findings,
    observer: &dyn Observer,
) -> Result<(), VerifyError> {
    let frame = package.manifest().frame;
    let finest: Vec<TileId> =
        package.tile_ids()?.into_iter().filter(|id| id.z() == frame.max_level()).collect();
    observer.begin(Stage::Verify, Some(finest.len() as u64));
    workers::in_order(
        threads,
        finest.len(),
        || Ok(BTreeMap::<TileId, Known>::new()),
        |cache, index| {
            if observer.is_cancelled() {
                return Err(VerifyError::Interrupted);
            }
            let id = finest[index];
            cache.retain(|cached, _| *cached == id.ancestor(cached.z()));
            Ok(look_at(package, id, cache))
        },
        |_, found: Findings| {
            findings.merge(found);
            observer.advance(Stage::Verify, 1);
            Ok(())
        },
    )?;
    observer.end(Stage::Verify);
    Ok(())
}

fn look_at(package: &FilePackage, finest: TileId, cache: &mut BTreeMap<TileId, Known>) -> Findings {
    let mut findings = Findings::default();
    let manifest = package.manifest();
    let frame = &manifest.frame;
    let corner = frame.tile_corner(finest);
    // The data nodes are known by the finest level; then each level beside the one above it.
    let mut below: Option<(TileId, Vec<f64>, f64)> = None;
    let mut has_data: Vec<bool> = Vec::new();
    for level in (0..=finest.z()).rev() {
        let id = finest.ancestor(level);
        let known = cache.entry(id).or_insert_with(|| load(package, id));
        let Some(known) = known else {
            if level == finest.z() {
                return findings;
            }
            below = None;
            continue;
        };
        let (ground, error_m) = &**known;
        let (own, stride) = (frame.tile_corner(id), frame.stride(level) as f64);
        let first = [(corner.i - own.i) as f64 / stride, (own.j - corner.j) as f64 / stride];
        let heights_m = ground.raster(first, 1.0 / stride, TILE_NODES);
        if level == finest.z() {
            has_data = heights_m.iter().map(|height_m| !height_m.is_nan()).collect();
        }
        if let Some((child, child_m, child_error_m)) = &below {
            let allowed_m = error_m + child_error_m + ROUNDING_M;
            let worst = heights_m
                .iter()
                .zip(child_m)
                .zip(&has_data)
                .filter(|&((above_m, below_m), &has_data)| {
                    has_data && !above_m.is_nan() && !below_m.is_nan()
                })
                .map(|((above_m, below_m), _)| (above_m - below_m).abs())
                .fold(0.0, f64::max);
            findings.look(CheckId::Levels, worst <= allowed_m, || {
                format!(
                    "tiles {child} and {id} are {worst} m apart, their errors allow {allowed_m} m"
                )
            });
        }
        below = Some((id, heights_m, *error_m));
    }
    findings
}

/// `None` for a tile that is not there or cannot be read, which other checks tell.
fn load(package: &FilePackage, id: TileId) -> Known {
    let terrain = package.payload(id, Sections::TERRAIN).ok().flatten()?.terrain?;
    let ground = Ground::new(&terrain.tin, package.manifest().vertical.quantum_m);
    Some(Rc::new((ground, terrain.geometric_error_m)))
}
