//! An interactive map, independent of the program that shows it: its state, and the work between
//! frames and in a frame.
//!
//! ```text
//!  inputs, commands, settings ──► Session::step ──► camera, tiles ──► scene ──► MapCanvas ──► pictures
//!                                    ▲                                              │
//!                                    └───────────── Session::look: ground ◄─────────┘
//! ```

use std::sync::Arc;

use corniche_geom::TileId;
use corniche_styles::{Rgb, Style};
use corniche_tileset::Manifest;
use corniche_viewer::{
    CameraRequest, PackageLooks, SightedGround, ViewpointOffGround,
    camera::Camera,
    flight::Pose,
    stream::StreamBudget,
    tiles::{MapExtent, MapPackage},
};
use glam::DVec2;

use crate::{
    camera_control::CameraControl,
    controls::{Button, CameraView, Input, KnownGround as _, Modifiers, Navigator},
    flights::Flights,
    ground_probe::{GroundPoint, GroundProbe},
    map_canvas::{MapCanvas, MapScene},
    picked_road::PickPlace,
    settings::MapSettings,
    style_list::StyleList,
    tiles::{Changes, ShownGround, TileLoader, Tiles},
    views::{limits, place_in_world, request_of_view, view_on},
};

/// A CPU that draws does so coarsely until the camera has been at rest for this time.
pub(crate) const HURRY_S: f64 = 0.15;
/// The largest distance between a picked position and a road, in points of the screen.
const PICK_POINTS: f64 = 6.0;

/// The initial state of a session.
pub struct SessionStart {
    /// The package.
    pub package: Arc<dyn MapPackage>,
    /// The true heights between which all ground lies.
    pub height_range_m: [f64; 2],
    /// The first view, to which the user can return.
    pub home: CameraView,
    /// The initial settings.
    pub settings: MapSettings,
    /// The styles to choose from.
    pub styles: StyleList,
    /// Loads tiles.
    pub loader: Box<dyn TileLoader>,
    /// The limits of tiles being loaded and kept.
    pub budget: StreamBudget,
    /// Width and height of the window or page element, in pixels; no side is 0.
    pub size_px: [u32; 2],
    /// Pixels per point of the screen.
    pub pixels_per_point: f32,
    /// Whether movements slow down smoothly, or end at once.
    pub has_inertia: bool,
}

/// An interactive map. Times are seconds of one clock, positions are pixels of the window or page
/// element.
pub struct Session {
    package: ShownPackage,
    /// The tiles, from the request to the drawing.
    pub tiles: Tiles,
    /// The camera and what moves it.
    pub camera: CameraControl,
    /// The settings of the user. Change heights with [`Session::change`].
    pub settings: MapSettings,
    /// The styles to choose from.
    pub styles: StyleList,
    /// The flight that is being recorded, and the one that is being played.
    pub flights: Flights,
    /// The results of rays into the scene.
    pub probe: GroundProbe,
    /// The position of the cursor; `None` outside.
    pub cursor_px: Option<DVec2>,
    /// The place and the view after a jump. The ground there may still be loading.
    placed: Option<(CameraRequest, CameraView)>,
}

/// The package, and the true heights between which all its ground lies.
struct ShownPackage {
    package: Arc<dyn MapPackage>,
    height_range_m: [f64; 2],
}

impl ShownPackage {
    fn vertical_scale(&self, settings: &MapSettings) -> f64 {
        settings.exaggeration * self.package.manifest().point_scale
    }

    /// The ground as the camera's controls see it.
    fn ground<'a>(&self, tiles: &'a Tiles, settings: &MapSettings) -> ShownGround<'a> {
        tiles.ground(self.vertical_scale(settings), self.height_range_m)
    }
}

/// The result of a step.
pub struct SessionStep {
    /// The camera, for an image as large as the window or page element.
    pub camera: Camera,
    /// Tiles that were removed from the GPU.
    pub evicted: Vec<TileId>,
    /// Whether tiles were uploaded.
    pub has_new_tiles: bool,
    /// Whether the next step may have more tiles to upload to the GPU.
    pub is_under_way: bool,
}

impl Session {
    /// Creates a session that is ready for the first step.
    #[must_use]
    pub fn new(start: SessionStart) -> Self {
        let SessionStart { package, height_range_m, size_px, pixels_per_point, .. } = start;
        let manifest = package.manifest();
        let navigator = Navigator::new(start.home, limits(manifest), size_px, start.has_inertia);
        Self {
            tiles: Tiles::new(Arc::<dyn MapPackage>::clone(&package), start.loader, start.budget),
            camera: CameraControl::new(navigator, pixels_per_point),
            settings: start.settings,
            styles: start.styles,
            flights: Flights::default(),
            probe: GroundProbe::default(),
            cursor_px: None,
            placed: None,
            package: ShownPackage { package, height_range_m },
        }
    }

    /// The manifest of the package.
    #[must_use]
    pub fn manifest(&self) -> &Manifest {
        self.package.package.manifest()
    }

    /// The true heights between which all ground lies.
    #[must_use]
    pub fn height_range_m(&self) -> [f64; 2] {
        self.package.height_range_m
    }

    /// World height of one metre of true height.
    #[must_use]
    pub fn vertical_scale(&self) -> f64 {
        self.package.vertical_scale(&self.settings)
    }

    /// The ground as the camera's controls see it.
    #[must_use]
    pub fn ground(&self) -> ShownGround<'_> {
        self.package.ground(&self.tiles, &self.settings)
    }

    /// The camera as flights store it.
    #[must_use]
    pub fn pose(&self) -> Pose {
        self.camera.pose(self.vertical_scale())
    }

    /// The chosen style, before the other settings are applied.
    #[must_use]
    pub fn style(&self) -> &Style {
        self.styles.at(self.settings.style)
    }

    /// The colours of the lines of this many files, in the chosen style.
    #[must_use]
    pub fn overlay_colors(&self, overlays: usize) -> Vec<Rgb> {
        self.style().overlays.iter().take(overlays).map(|line| line.color).collect()
    }

    /// The style with all settings applied.
    #[must_use]
    pub fn look(&self) -> Style {
        self.settings.applied_to(self.style())
    }

    /// How the package's layers are drawn.
    #[must_use]
    pub fn layer_looks(&self) -> PackageLooks {
        self.settings.looks(self.manifest(), self.style())
    }

    /// Changes the settings. If heights change, the camera keeps its place above the ground.
    pub fn change(&mut self, changed: MapSettings) {
        if changed.exaggeration.to_bits() != self.settings.exaggeration.to_bits() {
            let factor = changed.exaggeration / self.settings.exaggeration;
            let ground = self.package.ground(&self.tiles, &self.settings);
            self.camera.navigator.rescale_heights(factor, &ground);
        }
        self.settings = changed;
    }

    /// Gives control to the user: a flight that is being played ends.
    pub fn take_over(&mut self) {
        self.flights.playing = None;
        self.placed = None;
    }

    /// Handles a press of a mouse button on the map.
    pub fn press(&mut self, button: Button, at_px: DVec2, modifiers: Modifiers, now_s: f64) {
        let ground = self.package.ground(&self.tiles, &self.settings);
        self.camera.press(button, at_px, modifiers, now_s, &ground);
    }

    /// Handles any other input that moves the camera, and a press that is never the second of a
    /// double click.
    pub fn input(&mut self, input: &Input, now_s: f64) {
        let ground = self.package.ground(&self.tiles, &self.settings);
        self.camera.input(input, now_s, &ground);
    }

    /// Switches between perspective and a view straight from above. Flights are in perspective:
    /// while one is being recorded, nothing changes. Returns whether something changed.
    pub fn toggle_above(&mut self, now_s: f64) -> bool {
        let is_recording = self.flights.recording_s(now_s).is_some();
        if !is_recording {
            self.input(&Input::ToggleAbove, now_s);
        }
        !is_recording
    }

    /// Starts recording a flight, unless the view is from above; drops a recording in progress.
    /// Returns whether it started.
    pub fn start_recording(&mut self, now_s: f64) -> bool {
        let is_above = self.camera.view().from_above.is_some();
        if !is_above {
            let pose = self.pose();
            self.flights.start_recording(now_s, pose);
        }
        !is_above
    }

    /// Moves to a place in the usual notation: `9.52,47.14`.
    ///
    /// # Errors
    /// When the text is not a place or there is no ground, as a message.
    pub fn go_to(&mut self, lon_lat: &str, now_s: f64) -> Result<(), String> {
        let target_in_world = place_in_world(lon_lat, self.manifest(), &self.ground())?;
        self.take_over();
        self.input(&Input::GoTo { target_in_world }, now_s);
        Ok(())
    }

    /// Moves to the requested view, in a window or page element of `size_px`.
    ///
    /// # Errors
    /// When the place has no ground, and no height is given.
    pub fn travel_to(
        &mut self,
        request: CameraRequest,
        size_px: [u32; 2],
        now_s: f64,
    ) -> Result<(), ViewpointOffGround> {
        let view = self.view_at(request, size_px)?;
        self.placed = None;
        self.camera.navigator.travel_to(view, now_s);
        Ok(())
    }

    /// Shows the requested view at once. When finer ground arrives at another height, the view
    /// follows it until the user moves the map.
    ///
    /// # Errors
    /// When the place has no ground, and no height is given.
    pub fn jump_to(
        &mut self,
        request: CameraRequest,
        size_px: [u32; 2],
    ) -> Result<(), ViewpointOffGround> {
        let view = self.view_at(request, size_px)?;
        self.camera.navigator.jump_to(view);
        self.placed = Some((request, self.camera.view()));
        Ok(())
    }

    /// The requested view over the known ground.
    fn view_at(
        &self,
        request: CameraRequest,
        size_px: [u32; 2],
    ) -> Result<CameraView, ViewpointOffGround> {
        let (manifest, scale, ground) = (self.manifest(), self.vertical_scale(), self.ground());
        let heights_m = self.package.height_range_m;
        let at = request.place(manifest)?;
        let at_place_m = at.and_then(|at| {
            let known_m = ground.height(at).map(|height| height / scale);
            // Before the first tiles are loaded, any height will do.
            let is_inside = manifest.data_bounds.contains(at) && self.tiles.drawn.is_empty();
            known_m.or_else(|| is_inside.then(|| f64::midpoint(heights_m[0], heights_m[1])))
        });
        let extent = MapExtent::of_data(manifest.data_bounds, heights_m);
        let sighted = SightedGround { extent, heights_m, at_place_m };
        view_on(request, manifest, sighted, scale, size_px)
    }

    /// Updates the view of a place that was jumped to, as long as nothing else moves the camera.
    fn place_again(&mut self, size_px: [u32; 2]) {
        let Some((request, view)) = self.placed.take() else { return };
        if self.camera.view() != view {
            return;
        }
        if let Ok(again) = self.view_at(request, size_px)
            && again != view
        {
            self.camera.navigator.jump_to(again);
        }
        self.placed = Some((request, self.camera.view()));
    }

    /// Notes that the view is at rest and all its tiles are loaded: the ground of a place that was
    /// jumped to will not change any more.
    pub fn settle(&mut self) {
        self.placed = None;
    }

    /// The request that shows the current view again.
    #[must_use]
    pub fn request(&self) -> CameraRequest {
        let (view, size_px) = (self.camera.view(), self.camera.size_px());
        request_of_view(&view, &self.ground(), self.vertical_scale(), self.manifest(), size_px)
    }

    /// The ground at a pixel, for finding the road there; `None` over the sky.
    #[must_use]
    pub fn pick_at(&self, at_px: DVec2, size_px: [u32; 2]) -> Option<PickPlace> {
        let manifest = self.manifest();
        let camera = self.camera.view().camera(size_px);
        let hit = self.ground().under(&camera, at_px)?;
        let (_, depth_m) = camera.project(hit)?;
        let mut drawn = self.tiles.drawn.iter().map(|drawn| drawn.id);
        let reach_points = PICK_POINTS * self.camera.pixels_per_point;
        Some(PickPlace {
            point: GroundPoint::from_world(hit, self.vertical_scale(), &manifest.coordinates),
            tile: drawn.find(|id| manifest.frame.tile_bounds(*id).contains([hit.x, hit.y])),
            reach_m: reach_points * camera.pixel_at_depth_m(depth_m),
            style: self.look(),
            classes: self.settings.roads.classes,
        })
    }

    /// Moves the camera, chooses tiles and uploads them to the GPU.
    pub fn step(
        &mut self,
        canvas: &mut MapCanvas,
        size_px: [u32; 2],
        pixels_per_point: f32,
        now_s: f64,
    ) -> SessionStep {
        let scale = self.vertical_scale();
        let ground = self.package.ground(&self.tiles, &self.settings);
        if let Some(view) = self.flights.view(now_s, scale, &ground) {
            self.camera.navigator.jump_to(view);
        }
        self.place_again(size_px);
        let ground = self.package.ground(&self.tiles, &self.settings);
        let camera = self.camera.advance(now_s, size_px, pixels_per_point, &ground);
        let ahead = self.camera.look_ahead(now_s, camera.size_px);
        let quality = self.settings.quality(self.manifest(), self.style());
        let Changes { evict, upload, is_under_way } = if self.settings.is_frozen {
            Changes::default()
        } else {
            self.tiles.choose(&camera, ahead.as_ref(), quality)
        };
        canvas.change(&evict, &upload);
        let has_new_tiles = !upload.is_empty();
        self.tiles.keep_ground(upload);
        let pose = self.pose();
        self.flights.note(now_s, pose);
        SessionStep { camera, evicted: evict, has_new_tiles, is_under_way }
    }

    /// Loads all tiles again, after everything on the GPU was lost or when other sections of tiles
    /// are needed.
    pub fn begin_again(&mut self) {
        self.tiles.begin_again();
        // A frozen selection of tiles would stay empty.
        self.settings.is_frozen = false;
    }

    /// Whether the map is drawn coarsely for a moment, because the CPU draws and the camera moves.
    #[must_use]
    pub fn is_hurrying(&self, canvas: &MapCanvas, now_s: f64) -> bool {
        canvas.gpu.is_software() && self.camera.at_rest_s(now_s) < HURRY_S
    }

    /// The scene for an image of this size.
    #[must_use]
    pub fn scene(&self, size_px: [u32; 2], samples_per_side: u32) -> MapScene {
        let (manifest, settings) = (self.manifest(), &self.settings);
        MapScene {
            camera: self.camera.view().camera(size_px),
            shown_px: size_px,
            style: self.look(),
            layers: self.layer_looks(),
            compare: settings.compare,
            roads: settings.compare.pictures(settings.roads),
            exaggeration: settings.exaggeration,
            point_scale: manifest.point_scale,
            height_range_m: self.package.height_range_m,
            cell_px: settings.cell_px,
            latitude_deg: manifest.wgs84_bounds.center()[1],
            is_wireframe: settings.is_wireframe,
            drawn: self.tiles.drawn.clone(),
            samples_per_side,
            revision: 0,
        }
    }

    /// Updates the ground under the cursor and in the middle; `is_new` means that something was
    /// drawn.
    pub fn look_at_ground(&mut self, camera: &Camera, is_new: bool) {
        let scale = self.vertical_scale();
        let coordinates = &self.package.package.manifest().coordinates;
        let ground = self.package.ground(&self.tiles, &self.settings);
        self.probe.look(camera, self.cursor_px, is_new, &ground, scale, coordinates);
    }
}

#[cfg(test)]
#[path = "session_tests.rs"]
mod tests;
