//! Tiles that are loaded and evicted during a flight, as the streamer plans.

use std::{collections::BTreeMap, time::Instant};

use corniche_geom::TileId;

use super::{FrameRecord, elapsed::ms_since};
use crate::{
    camera::Camera,
    draw_error::DrawError,
    gpu::{Gpu, ResidentTiles, tile_bytes},
    lod::{DrawnTile, Quality},
    stream::{StreamBudget, Streamer, TileFacts},
    tiles::{BlockingPackage, TileGeometry},
};

/// Tiles that are loaded and evicted as a [`Streamer`] plans. Each tile arrives in the frame after
/// its request.
pub(crate) struct StreamedTiles<'a> {
    gpu: &'a Gpu,
    package: &'a dyn BlockingPackage,
    budget: StreamBudget,
    streamer: Streamer,
    /// Tiles that are decoded, but not on the GPU.
    decoded: BTreeMap<TileId, TileGeometry>,
    pub(crate) tiles: ResidentTiles,
}

impl<'a> StreamedTiles<'a> {
    pub(crate) fn new(
        gpu: &'a Gpu,
        package: &'a dyn BlockingPackage,
        budget: StreamBudget,
    ) -> Self {
        Self {
            gpu,
            package,
            budget,
            streamer: Streamer::new(budget),
            decoded: BTreeMap::new(),
            tiles: ResidentTiles::default(),
        }
    }

    /// Prepares a frame seen from `camera`. With `is_patient` it returns when no tile is missing or
    /// no more tiles fit; otherwise it uses the tiles that are loaded, and requested tiles are
    /// available in the next frame. It also loads tiles for `ahead`, the later position of the
    /// camera.
    pub(crate) fn advance(
        &mut self,
        camera: &Camera,
        ahead: Option<&Camera>,
        quality: Quality,
        is_patient: bool,
        is_stopped: &dyn Fn() -> bool,
    ) -> Result<(Vec<DrawnTile>, FrameRecord), DrawError> {
        let mut frame = FrameRecord::default();
        loop {
            if is_stopped() {
                return Err(DrawError::FlightStopped);
            }
            let (is_settled, drawn) = self.step(camera, ahead, quality, &mut frame)?;
            if is_settled && let Some(root) = self.decoded.get(&TileId::ROOT) {
                return Err(DrawError::OverBudget {
                    wanted_bytes: tile_bytes(root),
                    budget_bytes: self.budget.gpu_bytes,
                    or_less: "",
                });
            }
            if is_settled || !is_patient {
                return Ok((drawn, frame));
            }
        }
    }

    /// Executes one plan in its order. Returns whether the plan loads and uploads nothing, so that
    /// only drawing is left, and the tiles to draw.
    fn step(
        &mut self,
        camera: &Camera,
        ahead: Option<&Camera>,
        quality: Quality,
        frame: &mut FrameRecord,
    ) -> Result<(bool, Vec<DrawnTile>), DrawError> {
        let started = Instant::now();
        let plan = self.streamer.plan(self.package, camera, ahead, quality);
        frame.select_ms += ms_since(started);

        let started = Instant::now();
        let upload: Vec<TileGeometry> =
            plan.upload.iter().filter_map(|id| self.decoded.remove(id)).collect();
        self.tiles.change(self.gpu, &plan.evict, &upload);
        frame.upload_ms += ms_since(started);

        let started = Instant::now();
        for id in &plan.cancel {
            self.decoded.remove(id);
        }
        for id in &plan.load {
            let tile = self.package.load(*id)?;
            let facts = TileFacts { ground: tile.summary, gpu_bytes: tile_bytes(&tile) };
            self.streamer.arrived(*id, facts);
            self.decoded.insert(*id, tile);
        }
        frame.decode_ms += ms_since(started);

        frame.tiles_evicted += plan.evict.len();
        frame.tiles_uploaded += plan.upload.len();
        frame.tiles_loaded += plan.load.len();
        frame.tiles_missing = plan.missing;
        Ok((plan.load.is_empty() && plan.upload.is_empty(), plan.drawn))
    }
}
