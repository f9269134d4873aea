//! Tiles that are loaded and evicted while a flight goes on, as the streamer plans.

use std::{collections::BTreeMap, time::Instant};

use corniche_geom::TileId;

use super::{ReplayError, elapsed::ms_since, frame_tiles::FrameTiles};
use crate::{
    camera::Camera,
    gpu::{Gpu, ResidentTiles, tile_bytes},
    lod::Quality,
    stream::{StreamBudget, Streamer, TileFacts},
    tiles::{BlockingPackage, TileGeometry},
};

/// How long a frame may wait for its tiles.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Patience {
    /// It is drawn with the tiles that are there; those that it requests are there for the next frame.
    None,
    /// It is drawn once no tile is missing or no more tiles fit.
    UntilSettled,
}

/// Tiles that are loaded and evicted as a [`Streamer`] plans. Each arrives in the frame after it was requested.
pub(crate) struct StreamedTiles<'a> {
    gpu: &'a Gpu,
    package: &'a dyn BlockingPackage,
    budget: StreamBudget,
    streamer: Streamer,
    /// Decoded, but not on the graphics card.
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

    /// Prepares a frame seen from `camera`. Tiles for `ahead`, where the camera will be later, are loaded too.
    pub(crate) fn advance(
        &mut self,
        camera: &Camera,
        ahead: Option<&Camera>,
        quality: Quality,
        patience: Patience,
        is_stopped: &dyn Fn() -> bool,
    ) -> Result<FrameTiles, ReplayError> {
        let mut frame = FrameTiles::default();
        loop {
            if is_stopped() {
                return Err(ReplayError::Stopped);
            }
            let is_settled = self.step(camera, ahead, quality, &mut frame)?;
            if is_settled && let Some(root) = self.decoded.get(&TileId::ROOT) {
                return Err(ReplayError::OverBudget {
                    wanted_bytes: tile_bytes(root),
                    budget_bytes: self.budget.gpu_bytes,
                    or_less: "",
                });
            }
            if is_settled || patience == Patience::None {
                return Ok(frame);
            }
        }
    }

    /// Carries out one plan in its order. Returns whether it loads and uploads nothing, so that only drawing is left.
    fn step(
        &mut self,
        camera: &Camera,
        ahead: Option<&Camera>,
        quality: Quality,
        frame: &mut FrameTiles,
    ) -> Result<bool, ReplayError> {
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

        frame.evicted += plan.evict.len();
        frame.uploaded += plan.upload.len();
        frame.loaded += plan.load.len();
        frame.missing = plan.missing;
        frame.drawn = plan.drawn;
        Ok(plan.load.is_empty() && plan.upload.is_empty())
    }
}
