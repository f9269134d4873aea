//! Draws a flight over a package, frame by frame, without a window, and reports which tiles are
//! drawn and loaded, and how long this takes.
//!
//! Time steps are fixed, tiles arrive in the frame after their request, and the first frame waits
//! until no tile is missing. So the same flight gives the same tiles, numbers and pictures each
//! time; only the milliseconds differ.

mod elapsed;
mod eye_over_ground;
mod finest_tiles;
mod options;
mod record;
mod streamed_tiles;
mod timetable;

use std::time::Instant;

use glam::DVec3;
use image::RgbaImage;

use self::{
    elapsed::ms_since, eye_over_ground::Survey, finest_tiles::FinestTiles, options::check,
    streamed_tiles::StreamedTiles, timetable::Timetable,
};
use crate::{
    annotations::draw_attribution,
    camera::{Camera, WorldBox},
    draw_error::DrawError,
    flight::{Flight, Pose},
    gpu::{Gpu, PassTimer, Renderer, ResidentTiles, Targets},
    layers::PackageLooks,
    lod::DrawnTile,
    tiles::{BlockingPackage, TileStore},
};

pub use self::{
    eye_over_ground::{Lifted, default_flight},
    options::{Detail, ReplayOptions},
    record::FrameRecord,
};

/// A flight that is being drawn.
pub struct Replay<'a> {
    gpu: &'a Gpu,
    package: &'a dyn BlockingPackage,
    options: &'a ReplayOptions,
    looks: PackageLooks,
    is_stopped: &'a dyn Fn() -> bool,
    timetable: Timetable<'a>,
    height_range_m: [f64; 2],
    survey: Survey,
    next: u32,
    tiles: TileSupply<'a>,
    renderer: Renderer,
    targets: Targets,
    timer: Option<PassTimer>,
}

/// The source of the tiles that are drawn.
enum TileSupply<'a> {
    /// Tiles for [`Detail::Full`] and [`Detail::Culled`].
    Finest(FinestTiles),
    /// Tiles for [`Detail::Adaptive`].
    Streamed(StreamedTiles<'a>),
}

impl TileSupply<'_> {
    /// The tiles on the GPU, and the bytes of the slopes of other tiles there.
    fn resident(&self) -> (&ResidentTiles, u64) {
        match self {
            Self::Finest(finest) => (&finest.tiles, finest.above_bytes),
            Self::Streamed(streamed) => (&streamed.tiles, 0),
        }
    }
}

impl<'a> Replay<'a> {
    /// Prepares a flight: looks up the ground below all of it and, for [`Detail::Full`] and
    /// [`Detail::Culled`], loads all finest tiles. `is_stopped` is called often, here and in each
    /// frame; once it returns true, the result is [`DrawError::FlightStopped`].
    ///
    /// # Errors
    /// When an option is out of range, a keyframe is under the ground, a tile cannot be read, the
    /// tiles do not fit, or the flight was stopped.
    pub fn new(
        gpu: &'a Gpu,
        package: &'a dyn BlockingPackage,
        flight: &'a Flight,
        options: &'a ReplayOptions,
        is_stopped: &'a dyn Fn() -> bool,
    ) -> Result<Self, DrawError> {
        check(options)?;
        options.picture.layers.check(package.manifest())?;
        let coarsest =
            TileStore::new(package).coarsest_ground()?.ok_or(DrawError::NothingBeneath)?;
        let timetable = Timetable { flight, frames: options.frames };
        let survey = Survey::new(package, timetable, options, coarsest, is_stopped)?;
        let tiles = match options.detail {
            Detail::Adaptive => {
                TileSupply::Streamed(StreamedTiles::new(gpu, package, options.budget))
            }
            Detail::Full | Detail::Culled => {
                let budget_bytes = options.budget.gpu_bytes;
                TileSupply::Finest(FinestTiles::load(gpu, package, budget_bytes, is_stopped)?)
            }
        };
        Ok(Self {
            gpu,
            package,
            options,
            looks: options.picture.looks(package.manifest()),
            is_stopped,
            timetable,
            height_range_m: coarsest.height_range_m,
            survey,
            next: 0,
            tiles,
            renderer: Renderer::new(gpu),
            targets: Targets::new(gpu, options.picture.size_px, options.picture.supersampling)?,
            timer: PassTimer::new(gpu),
        })
    }

    /// Draws the next frame, and waits until it is drawn; `None` after the last frame.
    ///
    /// # Errors
    /// When a tile cannot be read, the device is lost, or the flight was stopped.
    pub fn next_frame(&mut self) -> Result<Option<FrameRecord>, DrawError> {
        if self.next == self.options.frames {
            return Ok(None);
        }
        if (self.is_stopped)() {
            return Err(DrawError::FlightStopped);
        }
        let frame = self.next;
        let time_s = self.timetable.time_s(frame);
        let stand = self.survey.stand(frame);
        let mut pose = self.timetable.flight.at(time_s);
        pose.eye_m[2] += stand.lift_m;
        let camera = self.camera(pose, stand.focus_m);
        let (drawn, prepared) = self.prepare_tiles(frame, &camera)?;
        let started = Instant::now();
        let (resident, above_bytes) = self.tiles.resident();
        let tiles = resident.draw_list(&drawn);
        let manifest = self.package.manifest();
        let view = self.options.picture.view(&camera, &self.looks, manifest, self.height_range_m);
        self.renderer.draw_timed(self.gpu, &view, &tiles, &self.targets, self.timer.as_mut());
        self.gpu.finish()?;
        let draw_ms = ms_since(started);
        let passes = self.timer.as_mut().map(|timer| timer.read(self.gpu)).transpose()?;
        self.next += 1;
        Ok(Some(FrameRecord {
            frame,
            time_s,
            pose,
            tiles_drawn: tiles.len(),
            triangles: tiles.iter().map(|tile| tile.buffers.triangles).sum(),
            road_segments: tiles.iter().map(|tile| tile.road_segments(&view)).sum(),
            gpu_bytes: above_bytes + resident.gpu_bytes(),
            draw_ms,
            passes,
            ..prepared
        }))
    }

    /// The picture of the frame drawn last, with attribution.
    ///
    /// # Errors
    /// When the device is lost.
    pub fn picture(&self) -> Result<RgbaImage, DrawError> {
        let mut picture = self.targets.picture.read_image(self.gpu)?;
        draw_attribution(&mut picture, &self.package.manifest().attribution);
        Ok(picture)
    }

    /// Seconds between two frames.
    #[must_use]
    pub fn step_s(&self) -> f64 {
        self.timetable.step_s()
    }

    /// The frames in which the flight is too close to the ground; there the eye is lifted, as in a
    /// window.
    #[must_use]
    pub fn lifted(&self) -> Lifted {
        self.survey.lifted
    }

    fn vertical_scale(&self) -> f64 {
        self.options.picture.exaggeration * self.package.manifest().point_scale
    }

    fn camera(&self, Pose { eye_m: [x, y, height_m], orientation }: Pose, focus_m: f64) -> Camera {
        let eye = DVec3::new(x, y, height_m * self.vertical_scale());
        // Only the direction of view matters here; it does not depend on the position of the eye.
        Camera::at_eye(eye, focus_m, orientation, self.options.picture.size_px)
    }

    /// Uploads the tiles that a frame shows to the GPU, as far as they are loaded and fit.
    fn prepare_tiles(
        &mut self,
        frame: u32,
        camera: &Camera,
    ) -> Result<(Vec<DrawnTile>, FrameRecord), DrawError> {
        let vertical_scale = self.vertical_scale();
        let ahead_s = self.options.ahead_s;
        let ahead = (ahead_s > 0.0).then(|| {
            let time_s = self.timetable.time_s(frame) + ahead_s;
            let stand = self.survey.stand(self.timetable.frame_at(time_s));
            self.camera(self.timetable.flight.at(time_s), stand.focus_m)
        });
        match &mut self.tiles {
            TileSupply::Streamed(streamed) => {
                let quality = self.options.picture.quality(self.package.manifest());
                // The first frame waits until no tile is missing; the others do not wait.
                streamed.advance(camera, ahead.as_ref(), quality, frame == 0, self.is_stopped)
            }
            TileSupply::Finest(finest) => {
                let frustum = camera.frustum();
                Ok(finest.choose(|id, range_m| {
                    let plan = self.package.frame().tile_bounds(id);
                    let heights = range_m.map(|height_m| height_m * vertical_scale);
                    self.options.detail == Detail::Full
                        || frustum.may_see(&WorldBox::new(plan, heights))
                }))
            }
        }
    }
}
