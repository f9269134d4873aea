//! A map that a person moves, whatever shows it: its state, and what is asked of it between two
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
    CameraRequest, OffGround, SightedGround,
    camera::Camera,
    flight::Pose,
    stream::StreamBudget,
    tiles::{MapExtent, MapPackage},
};
use glam::DVec2;

use crate::{
    camera_control::CameraControl,
    controls::{Button, Input, KnownGround as _, Modifiers, Navigator, View},
    flights::Flights,
    ground_probe::{GroundPoint, GroundProbe},
    map_canvas::{MapCanvas, MapScene},
    picked_road::PickPlace,
    settings::MapSettings,
    style_list::StyleList,
    tiles::{Changes, ShownGround, TileLoader, Tiles},
    views::{limits, place_in_world, request_of_view, view_on},
};

/// A processor that draws draws coarsely until the camera has been at rest for this time.
pub(crate) const HURRY_S: f64 = 0.15;
/// A road is picked at most so far beside it, points of the screen.
const PICK_POINTS: f64 = 6.0;

/// What a session begins with.
pub struct SessionStart {
    /// The package.
    pub package: Arc<dyn MapPackage>,
    /// All its ground lies between these true heights.
    pub height_range_m: [f64; 2],
    /// The first view, to which a person can return.
    pub home: View,
    /// What is shown at first.
    pub settings: MapSettings,
    /// The styles to choose from.
    pub styles: StyleList,
    /// Loads tiles.
    pub loader: Box<dyn TileLoader>,
    /// What may be loaded and kept.
    pub budget: StreamBudget,
    /// Width and height of what shows the map, pixels; no side is 0.
    pub size_px: [u32; 2],
    /// Pixels to a point of the screen.
    pub pixels_per_point: f32,
    /// Whether movements slow down smoothly, or end at once.
    pub has_inertia: bool,
}

/// A map that a person moves. Times are seconds of one clock, positions pixels of what shows the
/// map.
pub struct Session {
    package: ShownPackage,
    /// The tiles, from the request to the drawing.
    pub tiles: Tiles,
    /// The camera and what moves it.
    pub camera: CameraControl,
    /// What a person can change. Changes of the heights are made with [`Session::change`].
    pub settings: MapSettings,
    /// The styles to choose from.
    pub styles: StyleList,
    /// The flight that is recorded, and the one that is played.
    pub flights: Flights,
    /// What rays into the scene found.
    pub probe: GroundProbe,
    /// Where the cursor is; `None` outside.
    pub cursor_px: Option<DVec2>,
    /// A place that was jumped to, and the view of it. The ground there may still be on its way.
    placed: Option<(CameraRequest, View)>,
}

/// The package, and between which true heights all its ground lies.
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

/// What a step came to.
pub struct SessionStep {
    /// The camera, for a picture as large as what shows the map.
    pub camera: Camera,
    /// Tiles that were removed from the graphics card.
    pub evicted: Vec<TileId>,
    /// Whether tiles were uploaded.
    pub has_new_tiles: bool,
    /// Whether the next step may have more tiles to bring to the graphics card.
    pub is_under_way: bool,
}

impl Session {
    /// Ready for the first step.
    #[must_use]
    pub fn new(start: SessionStart) -> Self {
        let SessionStart { package, height_range_m, size_px, pixels_per_point, .. } = start;
        let manifest = package.manifest();
        let navigator = Navigator::new(start.home, limits(manifest), size_px, start.has_inertia);
        let quantum_m = manifest.vertical.quantum_m;
        Self {
            tiles: Tiles::new(
                Arc::<dyn MapPackage>::clone(&package),
                quantum_m,
                start.loader,
                start.budget,
            ),
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

    /// The package's table of contents.
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

    /// The camera as flights have it.
    #[must_use]
    pub fn pose(&self) -> Pose {
        self.camera.pose(self.vertical_scale())
    }

    /// The style that was chosen, without what the other settings make of it.
    #[must_use]
    pub fn style(&self) -> &Style {
        self.styles.at(self.settings.style)
    }

    /// Colours of the lines of so many files, in the style that was chosen.
    #[must_use]
    pub fn overlay_colors(&self, overlays: usize) -> Vec<Rgb> {
        self.style().overlays.iter().take(overlays).map(|line| line.color).collect()
    }

    /// How the map looks: the style with all settings.
    #[must_use]
    pub fn look(&self) -> Style {
        self.settings.applied_to(self.style())
    }

    /// Changes the settings. Where heights change, the camera keeps its place over the ground.
    pub fn change(&mut self, changed: MapSettings) {
        if changed.exaggeration.to_bits() != self.settings.exaggeration.to_bits() {
            let factor = changed.exaggeration / self.settings.exaggeration;
            let ground = self.package.ground(&self.tiles, &self.settings);
            self.camera.navigator.rescale_heights(factor, &ground);
        }
        self.settings = changed;
    }

    /// Somebody moves the map, and has it from now on: a flight that is played ends.
    pub fn take_over(&mut self) {
        self.flights.stop_playing();
        self.placed = None;
    }

    /// A button of the mouse goes down on the map.
    pub fn press(&mut self, button: Button, at_px: DVec2, modifiers: Modifiers, now_s: f64) {
        let ground = self.package.ground(&self.tiles, &self.settings);
        self.camera.press(button, at_px, modifiers, now_s, &ground);
    }

    /// Any other input that moves the camera, and a press that is never the second of a double
    /// click.
    pub fn input(&mut self, input: &Input, now_s: f64) {
        let ground = self.package.ground(&self.tiles, &self.settings);
        self.camera.input(input, now_s, &ground);
    }

    /// Changes to a view straight from above, or back. Flights are in perspective: while one is
    /// recorded, nothing is done. Returns whether something was.
    pub fn toggle_above(&mut self, now_s: f64) -> bool {
        let is_recording = self.flights.recording_s(now_s).is_some();
        if !is_recording {
            self.input(&Input::ToggleAbove, now_s);
        }
        !is_recording
    }

    /// Begins to record a flight, unless the view is from above; one that is being recorded already
    /// is dropped. Returns whether it began.
    pub fn start_recording(&mut self, now_s: f64) -> bool {
        let is_above = self.camera.view().from_above.is_some();
        if !is_above {
            let pose = self.pose();
            self.flights.start_recording(now_s, pose);
        }
        !is_above
    }

    /// Moves to a place as people write it: `9.52,47.14`.
    ///
    /// # Errors
    /// In words, when the text tells no place or there is no ground.
    pub fn go_to(&mut self, lon_lat: &str, now_s: f64) -> Result<(), String> {
        let target_in_world = place_in_world(lon_lat, self.manifest(), &self.ground())?;
        self.take_over();
        self.input(&Input::GoTo { target_in_world }, now_s);
        Ok(())
    }

    /// Moves to the view of a request, in what is `size_px` large.
    ///
    /// # Errors
    /// When the place has no ground, and no height is given.
    pub fn travel_to(
        &mut self,
        request: CameraRequest,
        size_px: [u32; 2],
        now_s: f64,
    ) -> Result<(), OffGround> {
        let view = self.view_at(request, size_px)?;
        self.placed = None;
        self.camera.navigator.travel_to(view, now_s);
        Ok(())
    }

    /// Shows the view of a request at once. Where finer ground comes, at another height, the view
    /// follows it until somebody moves the map.
    ///
    /// # Errors
    /// When the place has no ground, and no height is given.
    pub fn jump_to(&mut self, request: CameraRequest, size_px: [u32; 2]) -> Result<(), OffGround> {
        let view = self.view_at(request, size_px)?;
        self.camera.navigator.jump_to(view);
        self.placed = Some((request, self.camera.view()));
        Ok(())
    }

    /// The view of a request, by the ground that is known.
    fn view_at(&self, request: CameraRequest, size_px: [u32; 2]) -> Result<View, OffGround> {
        let (manifest, scale, ground) = (self.manifest(), self.vertical_scale(), self.ground());
        let heights_m = self.package.height_range_m;
        let at = request.place(manifest)?;
        let at_place_m = at.and_then(|at| {
            let known_m = ground.height(at).map(|height| height / scale);
            // Before the first tiles are there, any height will do.
            let is_inside = manifest.data_bounds.contains(at) && self.tiles.drawn.is_empty();
            known_m.or_else(|| is_inside.then(|| f64::midpoint(heights_m[0], heights_m[1])))
        });
        let extent = MapExtent::of_data(manifest.data_bounds, heights_m);
        let sighted = SightedGround { extent, heights_m, at_place_m };
        view_on(request, manifest, sighted, scale, size_px)
    }

    /// Looks again at the place that was jumped to, as long as nothing else moves the camera.
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

    /// The view has come to rest, and all its tiles are there: the ground of a place that was
    /// jumped to will not change any more.
    pub fn settle(&mut self) {
        self.placed = None;
    }

    /// The request that shows again what is seen now.
    #[must_use]
    pub fn request(&self) -> CameraRequest {
        let (view, size_px) = (self.camera.view(), self.camera.size_px());
        request_of_view(&view, &self.ground(), self.vertical_scale(), self.manifest(), size_px)
    }

    /// The ground at a pixel, to look for a road there; `None` over the sky.
    #[must_use]
    pub fn pick_at(&self, at_px: DVec2, size_px: [u32; 2]) -> Option<PickPlace> {
        let manifest = self.manifest();
        let camera = self.camera.view().camera(size_px);
        let (start, ray) = (camera.ray_start_in_world(at_px), camera.ray_in_world(at_px));
        let hit = self.ground().hit(start, ray)?;
        let (_, depth_m) = camera.project(hit)?;
        let [x, y] = [hit.x, hit.y];
        let mut drawn = self.tiles.drawn.iter().map(|drawn| drawn.id);
        let reach_points = PICK_POINTS * self.camera.pixels_per_point;
        Some(PickPlace {
            point: GroundPoint {
                lon_lat_deg: manifest.coordinates.wgs84_from_working([x, y]),
                at_m: [x, y, hit.z / self.vertical_scale()],
            },
            tile: drawn.find(|id| manifest.frame.tile_bounds(*id).contains([x, y])),
            reach_m: reach_points * camera.pixel_at_depth_m(depth_m),
            style: self.look(),
            classes: self.settings.roads.classes,
        })
    }

    /// Moves the camera, chooses tiles and brings them to the graphics card.
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

    /// Everything on the graphics card is lost, or other parts of tiles are needed: all tiles are
    /// loaded again.
    pub fn begin_again(&mut self) {
        self.tiles.begin_again();
        // A frozen choice of tiles would stay empty.
        self.settings.is_frozen = false;
    }

    /// Whether the map is drawn coarsely for a moment, because a processor draws and the camera moves.
    #[must_use]
    pub fn is_hurrying(&self, canvas: &MapCanvas, now_s: f64) -> bool {
        canvas.gpu.is_software() && self.camera.at_rest_s(now_s) < HURRY_S
    }

    /// What a picture of this size shows.
    #[must_use]
    pub fn scene(&self, size_px: [u32; 2], samples_per_side: u32) -> MapScene {
        let (manifest, settings) = (self.manifest(), &self.settings);
        MapScene {
            camera: self.camera.view().camera(size_px),
            shown_px: size_px,
            style: self.look(),
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

    /// Looks at the ground under the cursor and in the middle; `is_new` says that something was
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
