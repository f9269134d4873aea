//! From a request to the first frame.

use std::{collections::VecDeque, sync::Arc};

use corniche_geom::TileId;
use corniche_roads::FunctionalRoadClass;
use corniche_viewer::{
    CameraRequest,
    camera::{Camera, Orientation},
    eye_height::clearance_m,
    gpu::tile_bytes,
    range,
    tiles::{PackageSource, TileSource as _},
};

use super::{App, Seen};
use crate::{
    WindowError, WindowRequest,
    canvas::Canvas,
    clicks::Clicks,
    controls::{Limits, Navigator, View},
    frame_times::FrameTimes,
    notices::Notices,
    panel,
    platform::{Loader, SharedSource},
    settings::{Compare, Refinement, Settings},
    shots::Shots,
    tiles::Tiles,
    trace::Trace,
};

/// Tilt of map mode; beyond, what lies under the cursor is too far away to be dragged.
const MAX_PITCH_DEG: f64 = 85.0;

/// A package that can be shown.
pub(crate) struct Package {
    source: Arc<PackageSource>,
    height_range_m: [f64; 2],
}

impl Package {
    /// Checks the request and reads the package's root. No window is needed for it, and none should open if it cannot be
    /// shown.
    ///
    /// # Errors
    /// When it cannot be read, has no ground or does not fit the graphics memory allowed.
    pub(crate) fn of(request: &WindowRequest) -> Result<Self, WindowError> {
        check(request)?;
        let source = Arc::clone(&request.source);
        let none = || WindowError::NoGround { name: request.name.clone() };
        if !source.exists(TileId::ROOT) {
            return Err(none());
        }
        let root = source.load(TileId::ROOT)?;
        let height_range_m = root.summary.ok_or_else(none)?.height_range_m;
        let (wanted_bytes, budget_bytes) = (tile_bytes(&root), request.budget.gpu_bytes);
        if wanted_bytes > budget_bytes {
            return Err(WindowError::OverBudget { wanted_bytes, budget_bytes });
        }
        Ok(Self { source, height_range_m })
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
        pixels_per_point: f32,
    ) -> Result<Self, WindowError> {
        let Package { source, height_range_m } = package;
        let manifest = source.manifest();
        let vertical_scale = request.exaggeration * manifest.point_scale;
        let panel_px = panel::width(size_px[0] as f32 / pixels_per_point) * pixels_per_point;
        let part_px = match request.camera {
            // All is to be seen, and so beside the panel.
            CameraRequest::FrameAll => {
                [size_px[0].saturating_sub(panel_px as u32).max(1), size_px[1]]
            }
            CameraRequest::LookAt { .. } => size_px,
        };
        let camera = request.camera.camera(
            manifest,
            source.as_ref(),
            height_range_m,
            vertical_scale,
            part_px,
        )?;
        let home = in_left_part(&camera, request.camera.orientation(), size_px[0]);
        let limits = Limits {
            data: manifest.data_bounds,
            clearance_m: clearance_m(manifest.point_scale),
            max_pitch_deg: MAX_PITCH_DEG,
        };
        let shared: SharedSource = Arc::<PackageSource>::clone(&source);
        let room = request.budget.tiles_in_flight;
        let loader = Loader::new(&shared, Loader::usual_threads(), room, wake)
            .map_err(|source| WindowError::Thread { source })?;
        let trace = request
            .trace
            .map(|begin| begin().and_then(Trace::begin))
            .transpose()
            .map_err(|source| WindowError::Trace { source })?;
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
            developing: VecDeque::new(),
            notices: Notices::default(),
            was_full: false,
            trace,
            frame: 0,
            clicks: Clicks::default(),
            cursor_px: None,
            is_dragging: false,
            occupied: Vec::new(),
            pixels_per_point,
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

fn check(request: &WindowRequest) -> Result<(), WindowError> {
    if request.styles.is_empty() {
        return Err(WindowError::NoStyle);
    }
    range::check_ground(request.screen_space_error_px, request.exaggeration)?;
    if let Some(samples) = request.samples_per_side {
        range::check_supersampling(samples)?;
    }
    let [width, height] = request.size_px;
    let least = f64::from(width.min(height));
    range::within("a window's side", least, 1.0..=f64::MAX, "at least 1 pixel")?;
    range::check_camera(request.camera)?;
    let pitch_deg = request.camera.orientation().pitch_deg;
    range::within("a pitch", pitch_deg, 0.0..=MAX_PITCH_DEG, "0 (straight down) to 85")?;
    Ok(())
}

/// What `camera` sees, in the left part of a window of this width.
fn in_left_part(camera: &Camera, orientation: Orientation, window_width_px: u32) -> View {
    let mut view = View::of(camera, orientation);
    let part_width_px = camera.size_px()[0];
    let hidden_px = f64::from(window_width_px.saturating_sub(part_width_px));
    // The window's middle lies so much to the right of the part's. A pixel is as large in both, for its size follows
    // from the height.
    let aside_px = hidden_px / 2.0;
    // What is near moves farther aside than what is in the middle: a step back makes room for it.
    let back_m = view.focus_m * hidden_px / f64::from(part_width_px) / 8.0;
    let aside_m = aside_px * camera.pixel_at_unit_depth_m() * (view.focus_m + back_m);
    let axes = view.world_from_view();
    view.eye_in_world += axes.x_axis * aside_m + axes.z_axis * back_m;
    view
}

#[cfg(test)]
#[path = "start_tests.rs"]
mod tests;
