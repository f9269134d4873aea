//! A flight over a package, frame by frame, without a window: what is drawn, what is loaded, how long it takes.
//!
//! Time steps are fixed, tiles arrive in the frame after they were asked for, and the first frame waits until nothing is
//! missing; so the same flight gives the same tiles, numbers and pictures each time. Only the milliseconds differ.

mod finest;
mod streamed;
mod survey;

use std::{collections::BTreeMap, time::Instant};

use corniche_geom::TileId;
use glam::DVec3;
use image::RgbaImage;

use self::{
    finest::Finest,
    streamed::{Patience, Streamed},
    survey::Survey,
};
use crate::{
    attribution::draw_attribution,
    camera::Camera,
    flight::{Flight, Pose},
    gpu::{
        DrawTile, FrameView, Gpu, GpuError, PassTimer, PassTimes, ReadBackError, Renderer, Targets,
        TileBuffers, Wireframe,
    },
    lod::{Drawn, Quality},
    options::RoadOptions,
    range::{self, OutOfRange},
    stream::StreamBudget,
    style::Style,
    tiles::{LoadTileError, MapPackage, TileStore},
};

pub use self::survey::{Lifted, default_flight};

/// How much of the ground is drawn: the ablation of Agrawal et al. 2006, Table 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Detail {
    /// All finest tiles, in view or not.
    Full,
    /// The finest tiles in view.
    Culled,
    /// Tiles by screen-space error, loaded while flying.
    Adaptive,
}

/// How a flight is drawn.
#[derive(Debug, Clone, PartialEq)]
pub struct ReplayOptions {
    /// Width and height of the picture.
    pub size_px: [u32; 2],
    /// How roads are drawn.
    pub roads: RoadOptions,
    /// How much of the ground is drawn.
    pub detail: Detail,
    /// A tile is refined while its error looks larger than this.
    pub screen_space_error_px: f64,
    /// Factor on heights; 1 is true.
    pub exaggeration: f64,
    /// Samples per pixel along each side, averaged; 1 takes the pixel's centre alone.
    pub supersampling: u32,
    /// Colours and widths.
    pub style: Style,
    /// What may be loaded and kept.
    pub budget: StreamBudget,
    /// Tiles are loaded for where the camera will be in so many seconds; 0 loads none in advance.
    pub ahead_s: f64,
    /// How many frames the flight has, evenly spread from its beginning to its end.
    pub frames: u32,
}

/// What one frame came to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FrameRecord {
    /// Its number, 0 first.
    pub frame: u32,
    /// When in the flight.
    pub time_s: f64,
    /// Where the camera is, lifted off the ground where the flight led too near to it.
    pub pose: Pose,
    /// Tiles drawn.
    pub tiles_drawn: usize,
    /// Tiles decoded after this frame, for later ones; in the first frame those it waited for too.
    pub tiles_loaded: usize,
    /// Tiles handed to the graphics card.
    pub tiles_uploaded: usize,
    /// Tiles removed from the graphics card.
    pub tiles_evicted: usize,
    /// Tiles that the view wants and that are not there yet: coarser ones are drawn instead.
    pub tiles_missing: usize,
    /// Triangles of the ground drawn, skirts not counted.
    pub triangles: u64,
    /// Road segments drawn.
    pub road_segments: u64,
    /// Bytes of tiles on the graphics card.
    pub gpu_bytes: u64,
    /// Choosing tiles, processor.
    pub select_ms: f64,
    /// Reading and decoding tiles, processor. A window does it beside the drawing.
    pub decode_ms: f64,
    /// Handing tiles over, processor.
    pub upload_ms: f64,
    /// From the first command of the frame until the graphics card has drawn it.
    pub draw_ms: f64,
    /// The passes by the graphics card's own clock, if it has one.
    pub passes: Option<PassTimes>,
}

/// Why a flight cannot be flown.
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "each message documents its variant")]
#[non_exhaustive]
pub enum ReplayError {
    #[error(transparent)]
    Load(#[from] LoadTileError),
    #[error(transparent)]
    Gpu(#[from] GpuError),
    #[error(transparent)]
    ReadBack(#[from] ReadBackError),
    #[error("the package has no ground to fly over")]
    NoGround,
    #[error(
        "at {time_s:.2} s the eye is {depth_m:.1} m too low: it lies under the ground; give its true height, in the \
         package's vertical datum"
    )]
    UnderGround { time_s: f64, depth_m: f64 },
    #[error(transparent)]
    Range(#[from] OutOfRange),
    #[error(
        "{wanted_bytes} bytes of tiles do not fit the {budget_bytes} bytes of graphics memory allowed; allow more{or_less}"
    )]
    OverBudget { wanted_bytes: u64, budget_bytes: u64, or_less: &'static str },
    #[error("stopped before the flight was over")]
    Stopped,
}

/// A flight under way.
pub struct Replay<'a> {
    gpu: &'a Gpu,
    source: &'a dyn MapPackage,
    options: &'a ReplayOptions,
    is_stopped: &'a dyn Fn() -> bool,
    timetable: Timetable<'a>,
    height_range_m: [f64; 2],
    survey: Survey,
    next: u32,
    ground: Ground<'a>,
    renderer: Renderer,
    targets: Targets,
    timer: Option<PassTimer>,
}

/// Where the ground that is drawn comes from.
enum Ground<'a> {
    /// [`Detail::Full`] and [`Detail::Culled`].
    Finest(Finest),
    /// [`Detail::Adaptive`].
    Streamed(Streamed<'a>),
}

impl Ground<'_> {
    fn buffers(&self) -> &BTreeMap<TileId, TileBuffers> {
        match self {
            Self::Finest(finest) => finest.buffers(),
            Self::Streamed(streamed) => streamed.buffers(),
        }
    }
}

/// When each frame of a flight is.
#[derive(Clone, Copy)]
struct Timetable<'a> {
    flight: &'a Flight,
    frames: u32,
}

impl Timetable<'_> {
    /// Seconds between two frames.
    fn step_s(&self) -> f64 {
        self.flight.duration_s() / f64::from(self.frames.saturating_sub(1).max(1))
    }

    fn time_s(&self, frame: u32) -> f64 {
        self.flight.span_s()[0] + f64::from(frame) * self.step_s()
    }

    /// The frame nearest to a time.
    fn frame_at(&self, time_s: f64) -> u32 {
        let steps = (time_s - self.flight.span_s()[0]) / self.step_s();
        (steps.round() as u32).min(self.frames - 1)
    }
}

/// What was done besides drawing.
#[derive(Default)]
struct Work {
    drawn: Vec<Drawn>,
    loaded: usize,
    uploaded: usize,
    evicted: usize,
    missing: usize,
    select_ms: f64,
    decode_ms: f64,
    upload_ms: f64,
}

impl<'a> Replay<'a> {
    /// Gets ready: looks up the ground beneath the whole flight and, for [`Detail::Full`] and
    /// [`Detail::Culled`], loads all finest tiles. `is_stopped` is asked again and again, here and in each frame; when it
    /// says yes, the answer is [`ReplayError::Stopped`].
    ///
    /// # Errors
    /// When the options make no sense, a keyframe lies under the ground, a tile cannot be had, not all fits, or it was stopped.
    pub fn new(
        gpu: &'a Gpu,
        source: &'a dyn MapPackage,
        flight: &'a Flight,
        options: &'a ReplayOptions,
        is_stopped: &'a dyn Fn() -> bool,
    ) -> Result<Self, ReplayError> {
        check(options)?;
        let coarsest = TileStore::new(source).coarsest_ground()?.ok_or(ReplayError::NoGround)?;
        let timetable = Timetable { flight, frames: options.frames };
        let survey = Survey::new(source, timetable, options, coarsest, is_stopped)?;
        let ground = match options.detail {
            Detail::Adaptive => Ground::Streamed(Streamed::new(gpu, source, options.budget)),
            Detail::Full | Detail::Culled => {
                let budget_bytes = options.budget.gpu_bytes;
                Ground::Finest(Finest::load(gpu, source, budget_bytes, is_stopped)?)
            }
        };
        Ok(Self {
            gpu,
            source,
            options,
            is_stopped,
            timetable,
            height_range_m: coarsest.height_range_m,
            survey,
            next: 0,
            ground,
            renderer: Renderer::new(gpu),
            targets: Targets::new(gpu, options.size_px, options.supersampling)?,
            timer: PassTimer::new(gpu),
        })
    }

    /// Flies on and draws; `None` after the last frame.
    ///
    /// # Errors
    /// When a tile cannot be had, the device is lost, or it was stopped.
    pub fn next_frame(&mut self) -> Result<Option<FrameRecord>, ReplayError> {
        if self.next == self.options.frames {
            return Ok(None);
        }
        if (self.is_stopped)() {
            return Err(ReplayError::Stopped);
        }
        let frame = self.next;
        let time_s = self.timetable.time_s(frame);
        let stand = self.survey.stand(frame);
        let mut pose = self.timetable.flight.at(time_s);
        pose.eye_m[2] += stand.lift_m;
        let camera = self.camera(pose, stand.focus_m);
        let work = self.work(frame, &camera)?;
        let started = Instant::now();
        let buffers = self.ground.buffers();
        let tiles: Vec<DrawTile<'_>> = work
            .drawn
            .iter()
            .filter_map(|drawn| {
                let buffers = buffers.get(&drawn.id)?;
                Some(DrawTile { buffers, skirt_depth_m: drawn.skirt_depth_m })
            })
            .collect();
        let view = FrameView {
            camera: &camera,
            style: &self.options.style,
            roads: self.options.roads,
            exaggeration: self.options.exaggeration,
            point_scale: self.source.manifest().point_scale,
            height_range_m: self.height_range_m,
            wireframe: Wireframe::Hidden,
        };
        self.renderer.draw_timed(self.gpu, &view, &tiles, &self.targets, self.timer.as_mut());
        self.gpu.finish()?;
        let draw_ms = ms_since(started);
        let passes = self.timer.as_mut().map(|timer| timer.read(self.gpu)).transpose()?;
        let record = FrameRecord {
            frame,
            time_s,
            pose,
            tiles_drawn: tiles.len(),
            tiles_loaded: work.loaded,
            tiles_uploaded: work.uploaded,
            tiles_evicted: work.evicted,
            tiles_missing: work.missing,
            triangles: tiles.iter().map(|tile| tile.buffers.triangles()).sum(),
            road_segments: tiles
                .iter()
                .map(|tile| tile.buffers.road_segments(self.options.roads))
                .sum(),
            gpu_bytes: buffers.values().map(TileBuffers::gpu_bytes).sum(),
            select_ms: work.select_ms,
            decode_ms: work.decode_ms,
            upload_ms: work.upload_ms,
            draw_ms,
            passes,
        };
        self.next += 1;
        Ok(Some(record))
    }

    /// The picture of the frame drawn last, with credits.
    ///
    /// # Errors
    /// When the device is lost.
    pub fn picture(&self) -> Result<RgbaImage, ReplayError> {
        let mut picture = self.targets.picture().read_image(self.gpu)?;
        draw_attribution(&mut picture, &self.source.manifest().attribution);
        Ok(picture)
    }

    /// Seconds between two frames.
    #[must_use]
    pub fn step_s(&self) -> f64 {
        self.timetable.step_s()
    }

    /// Frames in which the flight leads too near to the ground: there the eye is lifted, as in a window.
    #[must_use]
    pub fn lifted(&self) -> Lifted {
        self.survey.lifted()
    }

    fn vertical_scale(&self) -> f64 {
        self.options.exaggeration * self.source.manifest().point_scale
    }

    fn camera(&self, Pose { eye_m: [x, y, height_m], orientation }: Pose, focus_m: f64) -> Camera {
        let eye = DVec3::new(x, y, height_m * self.vertical_scale());
        let size_px = self.options.size_px;
        // Only the direction matters here; the view axes do not depend on where one looks from.
        let backward = Camera::look_at(eye, 1.0, orientation, size_px).world_from_view().z_axis;
        Camera::look_at(eye - backward * focus_m, focus_m, orientation, size_px)
    }

    /// Has what the frame shows on the graphics card, as far as it may be.
    fn work(&mut self, frame: u32, camera: &Camera) -> Result<Work, ReplayError> {
        let vertical_scale = self.vertical_scale();
        let ahead_s = self.options.ahead_s;
        let ahead = (ahead_s > 0.0).then(|| {
            let time_s = self.timetable.time_s(frame) + ahead_s;
            let stand = self.survey.stand(self.timetable.frame_at(time_s));
            self.camera(self.timetable.flight.at(time_s), stand.focus_m)
        });
        match &mut self.ground {
            Ground::Streamed(streamed) => {
                let quality = Quality {
                    screen_space_error_px: self.options.screen_space_error_px,
                    vertical_scale,
                };
                // A flight begins with a whole picture; after that, frames do not wait.
                let patience = if frame == 0 { Patience::UntilSettled } else { Patience::None };
                streamed.advance(camera, ahead.as_ref(), quality, patience, self.is_stopped)
            }
            Ground::Finest(finest) if self.options.detail == Detail::Full => Ok(finest.all()),
            Ground::Finest(finest) => Ok(finest.in_view(self.source, camera, vertical_scale)),
        }
    }
}

fn check(options: &ReplayOptions) -> Result<(), OutOfRange> {
    range::check_ground(options.screen_space_error_px, options.exaggeration)?;
    range::check_supersampling(options.supersampling)?;
    range::within("a look ahead", options.ahead_s, 0.0..=3600.0, "0 to 3600 seconds")?;
    let frames = f64::from(options.frames);
    range::within("a number of frames", frames, 1.0..=1e6, "1 to 1 000 000")
}

fn ms_since(started: Instant) -> f64 {
    started.elapsed().as_secs_f64() * 1e3
}
