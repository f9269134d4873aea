use std::{collections::BTreeMap, time::Instant};

use corniche_geom::TileId;

use super::{ReplayError, elapsed::ms_since, frame_tiles::FrameTiles};
use crate::{
    camera::{Camera, WorldBox},
    gpu::{Gpu, TileBuffers, tile_bytes},
    lod::Drawn,
    tiles::BlockingPackage,
};

/// All tiles that have no finer tiles beneath them, loaded before the flight begins.
pub(crate) struct FinestTiles {
    buffers: BTreeMap<TileId, TileBuffers>,
    /// The lowest and highest true height of their ground; tiles without ground are left out.
    height_ranges_m: BTreeMap<TileId, [f64; 2]>,
}

impl FinestTiles {
    pub(crate) fn load(
        gpu: &Gpu,
        package: &dyn BlockingPackage,
        budget_bytes: u64,
        is_stopped: &dyn Fn() -> bool,
    ) -> Result<Self, ReplayError> {
        let mut finest = Self { buffers: BTreeMap::new(), height_ranges_m: BTreeMap::new() };
        let mut next = vec![TileId::ROOT];
        let mut gpu_bytes = 0;
        while let Some(id) = next.pop() {
            if is_stopped() {
                return Err(ReplayError::Stopped);
            }
            let beneath = next.len();
            if id.z() < package.frame().max_level() {
                next.extend(id.children().filter(|child| package.exists(*child)));
            }
            if next.len() > beneath {
                continue;
            }
            let tile = package.load(id)?;
            gpu_bytes += tile_bytes(&tile);
            if gpu_bytes > budget_bytes {
                return Err(ReplayError::OverBudget {
                    wanted_bytes: gpu_bytes,
                    budget_bytes,
                    or_less: ", or draw by level of detail",
                });
            }
            finest.buffers.insert(id, TileBuffers::new(gpu, &tile));
            finest.height_ranges_m.extend(tile.summary.map(|ground| (id, ground.height_range_m)));
        }
        Ok(finest)
    }

    pub(crate) fn buffers(&self) -> &BTreeMap<TileId, TileBuffers> {
        &self.buffers
    }

    /// Chooses all of them.
    pub(crate) fn all(&self) -> FrameTiles {
        let started = Instant::now();
        self.choose(started, |_, _| true)
    }

    /// Chooses those in view. World heights are true heights times `vertical_scale`.
    pub(crate) fn in_view(
        &self,
        package: &dyn BlockingPackage,
        camera: &Camera,
        vertical_scale: f64,
    ) -> FrameTiles {
        let started = Instant::now();
        let frustum = camera.frustum();
        self.choose(started, |id, range_m| {
            let plan = package.frame().tile_bounds(id);
            frustum.may_see(&WorldBox::new(plan, range_m.map(|height_m| height_m * vertical_scale)))
        })
    }

    fn choose(&self, started: Instant, is_drawn: impl Fn(TileId, [f64; 2]) -> bool) -> FrameTiles {
        let drawn = self
            .height_ranges_m
            .iter()
            .filter(|(id, range_m)| is_drawn(**id, **range_m))
            .map(|(id, _)| Drawn { id: *id, skirt_depth_m: 0.0 })
            .collect();
        FrameTiles { drawn, select_ms: ms_since(started), ..FrameTiles::default() }
    }
}
