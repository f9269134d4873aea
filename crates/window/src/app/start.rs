//! From a request to the first frame.

use std::{num::NonZeroUsize, sync::Arc, thread};

use corniche_geom::TileId;
use corniche_roads::FunctionalRoadClass;
use corniche_viewer::{
    CameraRequest,
    camera::{Camera, Orientation, WorldBox},
    tiles::{PackageSource, TileSource as _, TileStore},
};
use glam::DVec3;

use super::{App, Seen};
use crate::{
    WindowError, WindowRequest,
    canvas::Canvas,
    clicks::Clicks,
    controls::{Limits, Navigator, View},
    frame_times::FrameTimes,
    loader::{Loader, SharedSource},
    settings::{Compare, Refinement, Settings, range},
    shots::Shots,
    tiles::Tiles,
    trace::Trace,
};

/// The eye stays so far above the ground: nearer it would see through the TIN's skirts.
const CLEARANCE_M: f64 = 2.0;
/// Tilt of map mode; beyond, what lies under the cursor is too far away to be dragged.
const MAX_PITCH_DEG: f64 = 85.0;
/// More threads that decode would take turns with the one that draws.
const MOST_THREADS: usize = 4;

/// A package that has ground.
pub(crate) struct Package {
    source: Arc<PackageSource>,
    height_range_m: [f64; 2],
}

impl Package {
    /// Opens it and reads its root. No window is needed for it, and none should open if it cannot be had.
    ///
    /// # Errors
    /// When it cannot be read or has no ground.
    pub(crate) fn open(request: &WindowRequest) -> Result<Self, WindowError> {
        check(request)?;
        let source = PackageSource::open(&request.package)?;
        let none = || WindowError::NoGround { package: request.package.clone() };
        if !source.exists(TileId::ROOT) {
            return Err(none());
        }
        let root = source.load(TileId::ROOT)?;
        let height_range_m = root.summary.ok_or_else(none)?.height_range_m;
        Ok(Self { source: Arc::new(source), height_range_m })
    }
}

impl App {
    /// Ready for the first frame. `wake` is called from other threads when there is something new to show.
    ///
    /// # Errors
    /// When the first view is none, or the system gives no thread or no trace.
    pub(crate) fn new(
        request: WindowRequest,
        package: Package,
        canvas: &Canvas,
        wake: &Arc<dyn Fn() + Send + Sync>,
        size_px: [u32; 2],
    ) -> Result<Self, WindowError> {
        let Package { source, height_range_m } = package;
        let manifest = source.manifest();
        let vertical_scale = request.exaggeration * manifest.point_scale;
        let home = home(&request, &source, height_range_m, vertical_scale, size_px)?;
        let limits = Limits {
            data: manifest.data_bounds,
            clearance_m: CLEARANCE_M * manifest.point_scale,
            max_pitch_deg: MAX_PITCH_DEG,
        };
        let shared: SharedSource = Arc::<PackageSource>::clone(&source);
        let room = request.budget.tiles_in_flight;
        let loader = Loader::new(&shared, threads(), room, wake)
            .map_err(|source| WindowError::Thread { source })?;
        let trace = request
            .trace
            .map(|path| Trace::create(&path).map_err(|source| WindowError::Trace { path, source }))
            .transpose()?;
        let is_software = canvas.gpu().is_software();
        let mut app = Self {
            height_range_m,
            tiles: Tiles::new(shared, manifest.vertical.quantum_m, loader, request.budget),
            navigator: Navigator::new(home, limits, size_px, request.inertia),
            settings: Settings {
                roads: request.roads,
                compare: Compare::Off,
                divider_share: 0.5,
                width_factors: [1.0; FunctionalRoadClass::COUNT],
                style: 0,
                exaggeration: request.exaggeration,
                screen_space_error_px: request.screen_space_error_px,
                samples_per_side: request.samples_per_side.unwrap_or(if is_software {
                    1
                } else {
                    2
                }),
                is_wireframe: false,
                refinement: Refinement::Live,
                is_panel_open: true,
            },
            style_names: request.styles.iter().map(|style| style.name.clone()).collect(),
            styles: request.styles,
            reload: request.reload,
            reloaded_s: 0.0,
            adapter: canvas.gpu().adapter_name().to_owned(),
            is_software,
            frame_times: FrameTimes::default(),
            drawing_since_s: None,
            passes: Vec::new(),
            recorder: None,
            shots: Shots::new(request.folder, Arc::clone(wake)),
            wanted: Vec::new(),
            notices: Vec::new(),
            trace,
            frame: 0,
            clicks: Clicks::default(),
            cursor_px: None,
            is_dragging: false,
            occupied: Vec::new(),
            pixels_per_point: 1.0,
            last_view: None,
            moved_s: f64::NEG_INFINITY,
            seen: Seen::default(),
            source,
        };
        if is_software {
            app.notice(format!(
                "no graphics card was found: the processor draws ({}), more coarsely while the camera moves",
                app.adapter
            ));
        }
        Ok(app)
    }
}

/// One core is left to the thread that draws.
fn threads() -> NonZeroUsize {
    let cores = thread::available_parallelism().map_or(2, NonZeroUsize::get);
    NonZeroUsize::new((cores - 1).clamp(1, MOST_THREADS)).unwrap_or(NonZeroUsize::MIN)
}

fn check(request: &WindowRequest) -> Result<(), WindowError> {
    let within = |name, value: f64, fits: bool, range| {
        // Not a number fits nowhere: every test below is false for it.
        if fits { Ok(()) } else { Err(WindowError::Range { name, value, range }) }
    };
    if request.styles.is_empty() {
        return Err(WindowError::NoStyle);
    }
    let error_px = request.screen_space_error_px;
    within(
        "a screen-space error",
        error_px,
        error_px > 0.0 && error_px.is_finite(),
        "above 0 pixels",
    )?;
    let exaggeration = request.exaggeration;
    within("an exaggeration", exaggeration, (0.01..=100.0).contains(&exaggeration), "0.01 to 100")?;
    if let Some(samples) = request.samples_per_side {
        let fits = range::SAMPLES_PER_SIDE.contains(&samples);
        within("supersampling", f64::from(samples), fits, "1 to 3")?;
    }
    let [width, height] = request.size_px;
    let least = f64::from(width.min(height));
    within("a window's side", least, least >= 1.0, "at least 1 pixel")?;
    if let CameraRequest::LookAt { distance_m, orientation, .. } = request.camera {
        within("a distance", distance_m, (1.0..=1e8).contains(&distance_m), "1 m to 100 000 km")?;
        let Orientation { heading_deg, pitch_deg } = orientation;
        within("a heading", heading_deg, heading_deg.is_finite(), "an angle in degrees")?;
        within(
            "a pitch",
            pitch_deg,
            (0.0..=MAX_PITCH_DEG).contains(&pitch_deg),
            "0 (straight down) to 85",
        )?;
    }
    Ok(())
}

/// The first view.
fn home(
    request: &WindowRequest,
    source: &PackageSource,
    height_range_m: [f64; 2],
    vertical_scale: f64,
    size_px: [u32; 2],
) -> Result<View, WindowError> {
    let manifest = source.manifest();
    match request.camera {
        CameraRequest::FrameAll => {
            let range = height_range_m.map(|height_m| height_m * vertical_scale);
            let subject = WorldBox::new(manifest.data_bounds, range);
            let oblique = Orientation { heading_deg: 0.0, pitch_deg: 45.0 };
            Ok(View::of(&Camera::framing(subject, oblique, size_px), oblique))
        }
        CameraRequest::LookAt { lon_deg, lat_deg, distance_m, orientation } => {
            let off_ground = || WindowError::OffGround {
                lon_deg,
                lat_deg,
                covered_deg: manifest.wgs84_bounds.to_array(),
            };
            let at = manifest.coordinates.working_from_wgs84([lon_deg, lat_deg]);
            let at = at.ok_or_else(off_ground)?;
            let height_m = TileStore::new(source).ground_height_m(at)?.ok_or_else(off_ground)?;
            let target = DVec3::new(at[0], at[1], height_m * vertical_scale);
            let distance_in_world_m = distance_m * manifest.point_scale;
            let camera = Camera::look_at(target, distance_in_world_m, orientation, size_px);
            Ok(View::of(&camera, orientation))
        }
    }
}
