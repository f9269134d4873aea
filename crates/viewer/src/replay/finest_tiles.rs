//! All finest tiles of a package, loaded before a flight begins.

use std::{collections::BTreeMap, time::Instant};

use corniche_geom::TileId;

use super::{FrameRecord, elapsed::ms_since};
use crate::{
    draw_error::DrawError,
    gpu::{Gpu, ResidentTiles, SlopeChain, TileBuffers, tile_bytes},
    lod::DrawnTile,
    tiles::BlockingPackage,
};

/// All tiles that have no children, loaded before the flight begins.
#[derive(Default)]
pub(crate) struct FinestTiles {
    pub(crate) tiles: ResidentTiles,
    /// The lowest and highest true height of the ground of each tile; tiles without ground are not
    /// included.
    height_ranges_m: BTreeMap<TileId, [f64; 2]>,
    /// Bytes of the slopes of all ancestors, with which tiles far from the eye are shaded.
    pub(crate) above_bytes: u64,
}

impl FinestTiles {
    pub(crate) fn load(
        gpu: &Gpu,
        package: &dyn BlockingPackage,
        budget_bytes: u64,
        is_stopped: &dyn Fn() -> bool,
    ) -> Result<Self, DrawError> {
        let mut finest = Self::default();
        let mut next = vec![(TileId::ROOT, SlopeChain::default())];
        let mut gpu_bytes = 0;
        while let Some((id, above)) = next.pop() {
            if is_stopped() {
                return Err(DrawError::FlightStopped);
            }
            let tile = package.load(id)?;
            let mut children = Vec::new();
            if id.z() < package.frame().max_level() {
                children.extend(id.children().filter(|child| package.exists(*child)));
            }
            let is_finest = children.is_empty();
            gpu_bytes += if is_finest { tile_bytes(&tile) } else { SlopeChain::bytes_of(&tile) };
            if gpu_bytes > budget_bytes {
                return Err(DrawError::OverBudget {
                    wanted_bytes: gpu_bytes,
                    budget_bytes,
                    or_less: ", or draw by level of detail",
                });
            }
            if is_finest {
                finest.tiles.0.insert(id, TileBuffers::new(gpu, &tile, Some(&above)));
                let range_m = tile.summary.map(|ground| (id, ground.height_range_m));
                finest.height_ranges_m.extend(range_m);
            } else {
                finest.above_bytes += SlopeChain::bytes_of(&tile);
                let slopes = SlopeChain::new(gpu, &tile, Some(&above));
                next.extend(children.into_iter().map(|child| (child, slopes.clone())));
            }
        }
        Ok(finest)
    }

    /// Selects tiles by their ids and true heights.
    pub(crate) fn choose(
        &self,
        is_drawn: impl Fn(TileId, [f64; 2]) -> bool,
    ) -> (Vec<DrawnTile>, FrameRecord) {
        let started = Instant::now();
        let drawn = self
            .height_ranges_m
            .iter()
            .filter(|(id, range_m)| is_drawn(**id, **range_m))
            .map(|(id, _)| DrawnTile { id: *id, skirt_depth_m: 0.0 })
            .collect();
        (drawn, FrameRecord { select_ms: ms_since(started), ..FrameRecord::default() })
    }
}
