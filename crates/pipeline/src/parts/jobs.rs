//! Splits a planned build into jobs for a number of simultaneous processes.
//!
//! ```text
//!  rectangles of the files ─► nodes of each tile ─┐
//!  bytes of road pieces ──────────────────────────┴─► costs of tiles ─► subtrees of nearly the same cost ─► jobs
//! ```
//!
//! Estimates are based on recorded rates alone: the same plan and stores give the same jobs on
//! every machine.

mod grounds;
mod list;
mod tile_costs;

use std::{num::NonZeroU32, path::PathBuf};

use corniche_geom::TileId;
use corniche_ground::terrain::ground::GroundSource;
use corniche_plan::{BuildPlan, Opened, rates};
use corniche_spec::{
    PlanSettings, Resources,
    artifacts::{self, ArtifactKind},
    data_tiles::DataTiles,
    memory_shares::MemoryShares,
};
use corniche_store::Artifacts as _;
use corniche_tileset::InputKind;

use grounds::{LevelTileCosts, nodes_by_tile};
pub use list::Job;
use list::{BuildCosts, ExtractCosts, list, micros};
use tile_costs::TileCosts;

use super::{needed_parts::has_roads, planned::open, stores::Stores};
use crate::{BuildError, objects::ObjectAccess, steps::roads};

/// The largest useful number of shares (chunks of the extract): each share of nodes reads the ways
/// of all shares, and the following step *roads* takes longer than one of sixteen shares. The
/// number does not depend on that of slots, so a build with another number of slots can resume with
/// the existing shares.
const MOST_SHARES: u64 = 16;

/// The build to split, and the processes for it.
#[derive(Debug, Clone)]
pub struct JobSettings {
    /// The plan of the build.
    pub plan: BuildPlan,
    /// Stores with parts: if they contain the roads, the size of each tile's roads is known. The
    /// first store need not exist yet.
    pub stores: Vec<PathBuf>,
    /// The number of processes that run at the same time.
    pub slots: NonZeroU32,
    /// No part is smaller than this unless necessary, seconds on one core; `None`: a multiple of
    /// the time to start a process.
    pub least_seconds: Option<f64>,
    /// The resources that this process may use.
    pub resources: Resources,
    /// Program and version. It must be the program that created the plan.
    pub generator: String,
}

/// Returns the jobs of a plan, in an order in which one process could run them: those of a step
/// with the most work first, the merge last.
///
/// # Errors
/// When the inputs do not match the plan, or a store cannot be read.
pub fn jobs(settings: &JobSettings) -> Result<Vec<Job>, BuildError> {
    let JobSettings { plan, stores, slots, least_seconds, resources, generator } = settings;
    let (_, opened) = open(plan, generator, *resources)?;
    let pieces = if stores.is_empty() { None } else { piece_bytes(stores, plan, *resources)? };
    let costs = costs(&opened, slots.get(), pieces)?;
    let least_us = least_seconds.map_or_else(|| costs.least_us(), micros);
    Ok(list(&costs, slots.get(), least_us))
}

/// Returns a plan and its jobs, as [`jobs`] lists them before any part is built.
///
/// # Errors
/// When a file cannot be used, the files do not form a grid, or a setting does not match them.
pub fn plan_with_jobs(
    settings: &PlanSettings,
    resources: Resources,
    slots: NonZeroU32,
) -> Result<(BuildPlan, Vec<Job>), BuildError> {
    MemoryShares::limit_raster_cache(resources)?;
    let opened = Opened::new(settings)?;
    let costs = costs(&opened, slots.get(), None)?;
    let jobs = list(&costs, slots.get(), costs.least_us());
    Ok((BuildPlan::from_settings(settings, &opened)?, jobs))
}

/// Bytes of road pieces of each tile; `None` if the roads are not in the stores yet.
fn piece_bytes(
    stores: &[PathBuf],
    plan: &BuildPlan,
    resources: Resources,
) -> Result<Option<Vec<(TileId, u64)>>, BuildError> {
    let stores = Stores::look(stores, None, plan, ObjectAccess::new(resources), true)?;
    let Some(store) = stores.open_to_read(&has_roads)? else { return Ok(None) };
    if !roads::are_done(&store) {
        return Ok(None);
    }
    let mut bytes = Vec::new();
    for item in store.items(ArtifactKind::RoadPieces as u8) {
        let key = ArtifactKind::RoadPieces.item(item);
        bytes.push((artifacts::tile_of(key)?, store.length(key)?.unwrap_or_default()));
    }
    Ok(Some(bytes))
}

fn costs(
    opened: &Opened,
    slots: u32,
    pieces: Option<Vec<(TileId, u64)>>,
) -> Result<BuildCosts, BuildError> {
    let inputs = opened.inputs.planned()?;
    let input_bytes = inputs.iter().map(|input| input.bytes).fold(0, u64::saturating_add);
    let has_extract = inputs.iter().any(|input| input.kind == InputKind::Osm.name());
    let extract_bytes = opened.extract_bytes()? as f64;
    let LevelTileCosts { heights, mut tiles } = match &opened.source {
        GroundSource::Dem(dem) => {
            let rectangles = dem.file_nodes(&opened.grid)?;
            let data = DataTiles::from_plan(&opened.grid);
            LevelTileCosts::measured(opened, &nodes_by_tile(&opened.grid.frame, &data, &rectangles))
        }
        GroundSource::Package(terrain) => LevelTileCosts::recorded(opened, terrain)?,
    };
    let tiles_count = tiles.len() as f64;
    let pieces =
        pieces.unwrap_or_else(|| spread(rates::PIECES_PER_EXTRACT_BYTE * extract_bytes, &tiles));
    let piece_bytes: u64 = pieces.iter().map(|(_, bytes)| bytes).sum();
    tiles.extend(
        pieces
            .into_iter()
            .map(|(id, bytes)| (id, micros(bytes as f64 * rates::TILE_SECONDS_PER_PIECE_BYTE))),
    );
    let max_level = opened.grid.frame.max_level();
    Ok(BuildCosts {
        hashes_us: micros(input_bytes as f64 * rates::SECONDS_PER_HASHED_BYTE),
        extract: has_extract.then(|| extract_costs(extract_bytes, slots)),
        heights: heights.map(|heights| TileCosts::new(max_level, heights)),
        tiles: TileCosts::new(max_level, tiles),
        merge_us: micros(
            tiles_count * rates::MERGE_SECONDS_PER_TILE
                + piece_bytes as f64 * rates::MERGE_SECONDS_PER_PIECE_BYTE,
        ),
        start_us: micros(
            rates::PART_START_SECONDS + inputs.len() as f64 * rates::START_SECONDS_PER_INPUT,
        ),
    })
}

fn extract_costs(extract_bytes: f64, slots: u32) -> ExtractCosts {
    let most = if slots == 1 { 1 } else { MOST_SHARES };
    let shares = ((extract_bytes / rates::LEAST_SHARE_BYTES) as u64).clamp(1, most);
    let whole_us = |seconds_per_byte: f64| micros(extract_bytes * seconds_per_byte);
    ExtractCosts {
        shares: shares as u16,
        ways_us: whole_us(rates::WAY_SECONDS_PER_EXTRACT_BYTE),
        nodes_us: whole_us(rates::NODE_SECONDS_PER_EXTRACT_BYTE),
        roads_us: whole_us(rates::ROAD_SECONDS_PER_EXTRACT_BYTE),
    }
}

/// Distributes the bytes of road pieces before the positions of roads are known: as if the roads
/// were where the ground costs most.
fn spread(bytes: f64, tiles: &[(TileId, u64)]) -> Vec<(TileId, u64)> {
    let all_us = tiles.iter().map(|(_, cost_us)| cost_us).sum::<u64>().max(1) as f64;
    tiles.iter().map(|&(id, cost_us)| (id, (bytes * cost_us as f64 / all_us) as u64)).collect()
}
