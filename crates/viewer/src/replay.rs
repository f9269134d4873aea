//! A flight over a package, frame by frame, without a window: what is drawn, what is loaded, how long it takes.
//!
//! Time steps are fixed, tiles arrive in the frame after they were asked for, and the first frame waits until nothing is
//! missing; so the same flight gives the same tiles, numbers and pictures each time. Only the milliseconds differ.

use std::{collections::BTreeMap, time::Instant};

use corniche_geom::TileId;
use glam::DVec3;
use image::RgbaImage;

use crate::{
    attribution::draw_attribution,
    camera::{Camera, WorldBox},
    flight::{Flight, Pose},
    gpu::{
        DrawTile, FrameView, Gpu, GpuError, PassTimer, PassTimes, ReadBackError, Renderer, Targets,
        TileBuffers, tile_bytes,
    },
    lod::{Drawn, Quality, Request},
    scene::RoadOptions,
    stream::{StreamBudget, Streamer, TileFacts},
    style::Style,
    tiles::{LoadTileError, PackageSource, TileGeometry, TileSource, TileStore},
};

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
    /// Where the camera is.
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
        "at {time_s:.2} s the eye would be {lacking_m:.0} m too low: it must stay {clearance_m:.0} m above the ground"
    )]
    UnderGround { time_s: f64, lacking_m: f64, clearance_m: f64 },
    #[error("{name} of {value} is out of range; it must be {range}")]
    Range { name: &'static str, value: f64, range: &'static str },
    #[error(
        "{wanted_bytes} bytes of tiles do not fit the {budget_bytes} bytes of graphics memory allowed; allow more{or_less}"
    )]
    OverBudget { wanted_bytes: u64, budget_bytes: u64, or_less: &'static str },
}

/// A flight under way.
pub struct Replay<'a> {
    gpu: &'a Gpu,
    source: &'a PackageSource,
    flight: &'a Flight,
    options: &'a ReplayOptions,
    height_range_m: [f64; 2],
    focus_m: f64,
    next: u32,
    streamer: Streamer,
    /// Decoded, but not on the graphics card.
    decoded: BTreeMap<TileId, TileGeometry>,
    /// Height ranges of the finest tiles; empty when tiles are chosen by screen-space error.
    finest: BTreeMap<TileId, [f64; 2]>,
    buffers: BTreeMap<TileId, TileBuffers>,
    renderer: Renderer,
    targets: Targets,
    timer: Option<PassTimer>,
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

/// The eye stays so far above the ground, or twice the near plane's depth if that is more: nearer it would see into it.
const MIN_CLEARANCE_M: f64 = 2.0;
/// So many tiles are kept while the flight's clearance is looked up.
const LOOK_UP_TILES: usize = 256;

/// The pass over a package that is flown when no flight is given.
///
/// # Errors
/// When a tile cannot be had or there is no ground.
pub fn default_flight(source: &PackageSource) -> Result<Flight, ReplayError> {
    let mut ground = GroundLookUp::new(source);
    Flight::over(source.manifest().data_bounds, &mut |at| ground.height_m(at))?
        .ok_or(ReplayError::NoGround)
}

impl<'a> Replay<'a> {
    /// Gets ready: checks that the whole flight is above the ground and, for [`Detail::Full`] and
    /// [`Detail::Culled`], loads all finest tiles.
    ///
    /// # Errors
    /// When the options make no sense, the flight meets the ground, a tile cannot be had, or not all fits.
    pub fn new(
        gpu: &'a Gpu,
        source: &'a PackageSource,
        flight: &'a Flight,
        options: &'a ReplayOptions,
    ) -> Result<Self, ReplayError> {
        check(options)?;
        let mut store = TileStore::new(source);
        if !store.exists(TileId::ROOT) {
            return Err(ReplayError::NoGround);
        }
        store.load(&[Request { id: TileId::ROOT, priority_px: f64::INFINITY }])?;
        let summary = store.get(TileId::ROOT).and_then(|root| root.summary);
        let height_range_m = summary.ok_or(ReplayError::NoGround)?.height_range_m;
        let mut replay = Self {
            gpu,
            source,
            flight,
            options,
            height_range_m,
            focus_m: 0.0,
            next: 0,
            streamer: Streamer::new(options.budget),
            decoded: BTreeMap::new(),
            finest: BTreeMap::new(),
            buffers: BTreeMap::new(),
            renderer: Renderer::new(gpu),
            targets: Targets::new(gpu, options.size_px)?,
            timer: PassTimer::new(gpu),
        };
        replay.focus_m = replay.survey()?;
        if options.detail != Detail::Adaptive {
            replay.load_finest()?;
        }
        Ok(replay)
    }

    /// Flies on and draws; `None` after the last frame.
    ///
    /// # Errors
    /// When a tile cannot be had or the device is lost.
    pub fn next_frame(&mut self) -> Result<Option<FrameRecord>, ReplayError> {
        if self.next == self.options.frames {
            return Ok(None);
        }
        let frame = self.next;
        let time_s = self.time_s(frame);
        let camera = self.camera(self.flight.at(time_s));
        let work = match self.options.detail {
            Detail::Adaptive => self.stream(frame, time_s, &camera)?,
            Detail::Full | Detail::Culled => self.choose_finest(&camera),
        };
        let started = Instant::now();
        let tiles: Vec<DrawTile<'_>> = work
            .drawn
            .iter()
            .filter_map(|drawn| {
                let buffers = self.buffers.get(&drawn.id)?;
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
            supersampling: 1,
        };
        self.renderer.draw_timed(self.gpu, &view, &tiles, &self.targets, self.timer.as_ref());
        self.gpu.finish()?;
        let draw_ms = ms_since(started);
        let passes = self.timer.as_ref().map(|timer| timer.read(self.gpu)).transpose()?;
        let method = self.options.roads.method;
        let record = FrameRecord {
            frame,
            time_s,
            pose: self.flight.at(time_s),
            tiles_drawn: tiles.len(),
            tiles_loaded: work.loaded,
            tiles_uploaded: work.uploaded,
            tiles_evicted: work.evicted,
            tiles_missing: work.missing,
            triangles: tiles.iter().map(|tile| tile.buffers.triangles()).sum(),
            road_segments: tiles.iter().map(|tile| tile.buffers.road_segments(method)).sum(),
            gpu_bytes: self.buffers.values().map(TileBuffers::gpu_bytes).sum(),
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
        let pixels = self.targets.read_picture(self.gpu)?;
        let [width, height] = self.options.size_px;
        let mut picture = RgbaImage::from_fn(width, height, |x, y| {
            let start = (y as usize * width as usize + x as usize) * 4;
            image::Rgba([0, 1, 2, 3].map(|channel| pixels[start + channel]))
        });
        draw_attribution(&mut picture, &self.source.manifest().attribution);
        Ok(picture)
    }

    /// Seconds between two frames.
    #[must_use]
    pub fn step_s(&self) -> f64 {
        self.flight.duration_s() / f64::from(self.options.frames.saturating_sub(1).max(1))
    }

    fn time_s(&self, frame: u32) -> f64 {
        self.flight.span_s()[0] + f64::from(frame) * self.step_s()
    }

    fn vertical_scale(&self) -> f64 {
        self.options.exaggeration * self.source.manifest().point_scale
    }

    fn camera(&self, Pose { eye_m: [x, y, height_m], orientation }: Pose) -> Camera {
        let eye = DVec3::new(x, y, height_m * self.vertical_scale());
        let size_px = self.options.size_px;
        // Only the direction matters here; the view axes do not depend on where one looks from.
        let backward = Camera::look_at(eye, 1.0, orientation, size_px).world_from_view().z_axis;
        Camera::look_at(eye - backward * self.focus_m, self.focus_m, orientation, size_px)
    }

    /// Checks that no frame is too low and tells from how far away one looks at the ground, in the mean: haze and near
    /// plane follow from that, and are to stay the same all the way.
    fn survey(&self) -> Result<f64, ReplayError> {
        let mut ground = GroundLookUp::new(self.source);
        let scale = self.vertical_scale();
        let mut looks = Vec::new();
        for frame in 0..self.options.frames {
            let time_s = self.time_s(frame);
            let Pose { eye_m: [x, y, height_m], orientation } = self.flight.at(time_s);
            let above_m = ground.height_m([x, y])?.map(|ground_m| (height_m - ground_m) * scale);
            looks.push((time_s, above_m, orientation.pitch_deg));
        }
        let slants_m: Vec<f64> = looks
            .iter()
            .filter_map(|(_, above_m, pitch_deg)| {
                // Looking level one looks infinitely far; five times the height is far enough.
                Some(above_m.as_ref()?.max(1.0) / pitch_deg.to_radians().cos().max(0.2))
            })
            .collect();
        let focus_m = if slants_m.is_empty() {
            // Nowhere above the data: as far as the data are wide.
            self.source.manifest().data_bounds.width().max(1.0)
        } else {
            slants_m.iter().sum::<f64>() / slants_m.len() as f64
        };
        let near_m = self.camera_at_focus(focus_m).near_m();
        let clearance_m = MIN_CLEARANCE_M.max(2.0 * near_m);
        for (time_s, above_m, _) in looks {
            if let Some(lacking_m) = above_m.map(|above_m| clearance_m - above_m)
                && lacking_m > 0.0
            {
                return Err(ReplayError::UnderGround { time_s, lacking_m, clearance_m });
            }
        }
        Ok(focus_m)
    }

    fn camera_at_focus(&self, focus_m: f64) -> Camera {
        let orientation = self.flight.at(self.flight.span_s()[0]).orientation;
        Camera::look_at(DVec3::ZERO, focus_m, orientation, self.options.size_px)
    }

    /// Loads for a frame, at most as much as the budget says; for the first one, as much as it takes.
    fn stream(&mut self, frame: u32, time_s: f64, camera: &Camera) -> Result<Work, ReplayError> {
        let ahead = (self.options.ahead_s > 0.0)
            .then(|| self.camera(self.flight.at(time_s + self.options.ahead_s)));
        let quality = Quality {
            screen_space_error_px: self.options.screen_space_error_px,
            vertical_scale: self.vertical_scale(),
        };
        let mut work = Work::default();
        loop {
            let started = Instant::now();
            let plan = self.streamer.plan(self.source, camera, ahead.as_ref(), quality);
            work.select_ms += ms_since(started);

            let started = Instant::now();
            for id in &plan.evict {
                self.buffers.remove(id);
            }
            for id in &plan.upload {
                if let Some(tile) = self.decoded.remove(id) {
                    self.buffers.insert(*id, TileBuffers::new(self.gpu, &tile));
                }
            }
            work.upload_ms += ms_since(started);

            let started = Instant::now();
            for id in &plan.cancel {
                self.decoded.remove(id);
            }
            for id in &plan.load {
                let tile = self.source.load(*id)?;
                let facts = TileFacts { ground: tile.summary, gpu_bytes: tile_bytes(&tile) };
                self.streamer.arrived(*id, facts);
                self.decoded.insert(*id, tile);
            }
            work.decode_ms += ms_since(started);

            work.evicted += plan.evict.len();
            work.uploaded += plan.upload.len();
            work.loaded += plan.load.len();
            let is_settled = plan.load.is_empty() && plan.upload.is_empty();
            if frame > 0 || is_settled {
                if let (true, Some(root)) = (is_settled, self.decoded.get(&TileId::ROOT)) {
                    return Err(ReplayError::OverBudget {
                        wanted_bytes: tile_bytes(root),
                        budget_bytes: self.options.budget.gpu_bytes,
                        or_less: "",
                    });
                }
                return Ok(Work { drawn: plan.drawn, missing: plan.missing, ..work });
            }
        }
    }

    /// Loads all tiles without tiles beneath them.
    fn load_finest(&mut self) -> Result<(), ReplayError> {
        let mut next = vec![TileId::ROOT];
        let mut gpu_bytes = 0;
        while let Some(id) = next.pop() {
            let beneath = next.len();
            if id.z() < self.source.frame().max_level() {
                next.extend(id.children().filter(|child| self.source.exists(*child)));
            }
            if next.len() > beneath {
                continue;
            }
            let tile = self.source.load(id)?;
            gpu_bytes += tile_bytes(&tile);
            let budget_bytes = self.options.budget.gpu_bytes;
            if gpu_bytes > budget_bytes {
                return Err(ReplayError::OverBudget {
                    wanted_bytes: gpu_bytes,
                    budget_bytes,
                    or_less: ", or draw by level of detail",
                });
            }
            self.buffers.insert(id, TileBuffers::new(self.gpu, &tile));
            self.finest.extend(tile.summary.map(|summary| (id, summary.height_range_m)));
        }
        Ok(())
    }

    fn choose_finest(&self, camera: &Camera) -> Work {
        let started = Instant::now();
        let frustum = camera.frustum();
        let scale = self.vertical_scale();
        let is_drawn = |id: TileId, range_m: [f64; 2]| {
            let plan = self.source.frame().tile_bounds(id);
            let ground = WorldBox::new(plan, range_m.map(|height_m| height_m * scale));
            self.options.detail == Detail::Full || frustum.may_see(&ground)
        };
        let drawn: Vec<Drawn> = self
            .finest
            .iter()
            .filter(|(id, range_m)| is_drawn(**id, **range_m))
            .map(|(id, _)| Drawn { id: *id, skirt_depth_m: 0.0 })
            .collect();
        Work { drawn, select_ms: ms_since(started), ..Work::default() }
    }
}

/// True heights of the ground from the finest tiles, of which it keeps some.
struct GroundLookUp<'a> {
    source: &'a PackageSource,
    store: TileStore<'a>,
}

impl<'a> GroundLookUp<'a> {
    fn new(source: &'a PackageSource) -> Self {
        Self { source, store: TileStore::new(source) }
    }

    fn height_m(&mut self, at: [f64; 2]) -> Result<Option<f64>, ReplayError> {
        if self.store.len() > LOOK_UP_TILES {
            self.store = TileStore::new(self.source);
        }
        Ok(self.store.ground_height_m(at)?)
    }
}

fn check(options: &ReplayOptions) -> Result<(), ReplayError> {
    let error_px = options.screen_space_error_px;
    let frames = f64::from(options.frames);
    for (name, value, fits, range) in [
        (
            "a screen-space error",
            error_px,
            error_px > 0.0 && error_px.is_finite(),
            "above 0 pixels",
        ),
        (
            "an exaggeration",
            options.exaggeration,
            (0.01..=100.0).contains(&options.exaggeration),
            "0.01 to 100",
        ),
        (
            "a look ahead",
            options.ahead_s,
            (0.0..=3600.0).contains(&options.ahead_s),
            "0 to 3600 seconds",
        ),
        ("a number of frames", frames, (1.0..=1e6).contains(&frames), "1 to 1 000 000"),
    ] {
        // Not a number fits nowhere: every test above is false for it.
        if !fits {
            return Err(ReplayError::Range { name, value, range });
        }
    }
    Ok(())
}

fn ms_since(started: Instant) -> f64 {
    started.elapsed().as_secs_f64() * 1e3
}
