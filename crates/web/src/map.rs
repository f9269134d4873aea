//! The state of a map, and what a page asks of it.

use std::rc::Rc;

use corniche_geom::TileId;
use corniche_live::{
    CameraControl, GroundProbe, ShownGround, TileLoader as _, Tiles,
    controls::{Inertia, Input, KnownGround as _, View},
};
use corniche_roads::FunctionalRoadClass;
use corniche_styles::{Rgb, RoadStyle, Style};
use corniche_tileset::{FORMAT_VERSION, Manifest};
use corniche_viewer::{
    BoundaryLines, CameraRequest, OffGround, SightedGround,
    flight::Pose,
    lod::Fineness,
    range,
    tiles::{MapExtent, MapPackage as _, TileDecoder},
};
use glam::DVec2;

use crate::{
    canvas::PageCanvas,
    decoders::Reading,
    flights::Flights,
    loader::{PageLoader, Tileset},
    report::{About, ClassEntry, GroundPlace, Has, Notice},
    settings::{Compare, Settings},
    tables,
    view_record::{ViewRecord, view_on},
};

/// A place is picked at most so far beside a road, points of the screen.
pub(crate) const PICK_POINTS: f64 = 6.0;
/// A processor that draws takes one sample a pixel until the camera has been at rest for this time.
pub(crate) const HURRY_S: f64 = 0.15;

/// A map on a canvas. All positions are pixels of the canvas, all times seconds of one clock.
pub(crate) struct Map {
    pub(crate) address: String,
    pub(crate) canvas: PageCanvas,
    pub(crate) tileset: Rc<Tileset>,
    pub(crate) loader: PageLoader,
    pub(crate) tiles: Tiles,
    pub(crate) camera: CameraControl,
    pub(crate) settings: Settings,
    pub(crate) style: Style,
    pub(crate) labels: [String; FunctionalRoadClass::COUNT],
    pub(crate) height_range_m: [f64; 2],
    pub(crate) size_px: [u32; 2],
    pub(crate) pixels_per_point: f64,
    pub(crate) probe: GroundProbe,
    pub(crate) cursor_px: Option<DVec2>,
    pub(crate) flights: Flights,
    pub(crate) notices: Vec<Notice>,
    /// The scene of the last frame was drawn with fewer samples than asked.
    pub(crate) is_hurried: bool,
    /// When tiles began to be loaded anew; what was shown stays until those of the view are there.
    pub(crate) anew_s: Option<f64>,
    /// A place that was jumped to, and the view of it. The ground there may still be on its way.
    pub(crate) placed: Option<(CameraRequest, View)>,
    /// Time of the last frame.
    pub(crate) last_s: f64,
}

impl Drop for Map {
    fn drop(&mut self) {
        self.loader.forget();
    }
}

impl Map {
    pub(crate) fn manifest(&self) -> &Manifest {
        self.tileset.package.manifest()
    }

    pub(crate) fn vertical_scale(&self) -> f64 {
        self.settings.exaggeration * self.manifest().point_scale
    }

    /// Somebody moves the map, and has it from now on.
    pub(crate) fn take_over(&mut self) {
        self.flights.stop_playing();
        self.placed = None;
    }

    pub(crate) fn input(&mut self, input: &Input, now_s: f64) {
        let ground = ground(
            &self.tiles,
            &self.settings,
            self.tileset.package.manifest(),
            self.height_range_m,
        );
        self.camera.input(input, now_s, &ground);
    }

    /// The camera as flights have it.
    pub(crate) fn pose(&self) -> Pose {
        self.camera.pose(self.vertical_scale())
    }

    /// Whether a flight would be recorded from above, after this command.
    pub(crate) fn is_recording_from_above(&self, command: &str) -> bool {
        let is_recording = self.flights.recording_s(0.0).is_some();
        let is_above = self.camera.view().from_above.is_some();
        if command == "toggle-above" { is_recording } else { is_above }
    }

    pub(crate) fn change(&mut self, changes: &str) -> Result<(), String> {
        let changed = self.settings.changed_by(changes)?;
        let style = changed.look()?;
        let factor = changed.exaggeration / self.settings.exaggeration;
        if changed.exaggeration.to_bits() != self.settings.exaggeration.to_bits() {
            let ground = ground(
                &self.tiles,
                &self.settings,
                self.tileset.package.manifest(),
                self.height_range_m,
            );
            self.camera.rescale_heights(factor, &ground);
        }
        self.camera.set_inertia(if changed.inertia { Inertia::On } else { Inertia::Off });
        if self.loader.read_otherwise(reading_of(&changed, &style)) {
            self.tiles.begin_again();
            self.canvas.clear();
            self.anew_s = Some(self.last_s);
        }
        (self.settings, self.style) = (changed, style);
        Ok(())
    }

    pub(crate) fn told(&self) -> About {
        let manifest = self.manifest();
        let gpu = self.canvas.gpu();
        let entry = |(label, road): (&String, &RoadStyle)| ClassEntry {
            label: label.clone(),
            color: css(road.bands.main_color()),
        };
        let boundaries = BoundaryLines::of(manifest, &self.style).into_iter();
        let line = |lines: BoundaryLines| {
            let color = css(lines.style.color);
            ClassEntry { label: lines.label, color }
        };
        About {
            src: self.address.clone(),
            attribution: manifest.attribution.clone(),
            bounds: manifest.wgs84_bounds.to_array(),
            heights: self.height_range_m,
            tiles: manifest.levels.iter().map(|level| level.tiles).sum(),
            levels: manifest.levels.len(),
            styles: tables::style_names(),
            classes: self.labels.iter().zip(&self.style.roads).map(entry).collect(),
            boundaries: boundaries.map(line).collect(),
            has: Has {
                photo: manifest.settings.photo.is_some(),
                areas: manifest.areas.is_some(),
                boundaries: manifest.boundaries.is_some(),
            },
            adapter: gpu.adapter_name().to_owned(),
            is_software: gpu.is_software(),
            max_side_px: gpu.max_side_px(),
            format_version: u64::from(FORMAT_VERSION),
            bytes: self.tileset.package.package().source().file_bytes(),
        }
    }

    /// Moves to a place that the page names, as JSON.
    pub(crate) fn go(&mut self, place: &str, now_s: f64, jump: bool) -> Result<(), String> {
        let place: ViewRecord = serde_json::from_slice(place.as_bytes())
            .map_err(|error| format!("the place: {error}"))?;
        let request = place.request();
        range::check_camera(request).map_err(|error| error.to_string())?;
        let view = self.view_at(request).map_err(|error| error.to_string())?;
        self.placed = None;
        if jump {
            self.camera.jump_to(view);
            self.placed = Some((request, self.camera.view()));
        } else {
            self.camera.travel_to(view, now_s);
        }
        Ok(())
    }

    /// The view of a place, by the ground that is known.
    fn view_at(&self, request: CameraRequest) -> Result<View, OffGround> {
        let manifest = self.tileset.package.manifest();
        let scale = self.vertical_scale();
        let ground = ground(&self.tiles, &self.settings, manifest, self.height_range_m);
        let at = request.place(manifest)?;
        let sighted = SightedGround {
            extent: MapExtent::of_data(manifest.data_bounds, self.height_range_m),
            heights_m: self.height_range_m,
            at_place_m: at.and_then(|at| {
                let known_m = ground.height(at).map(|height| height / scale);
                // Before the first tiles are there, any height will do.
                let [low_m, high_m] = self.height_range_m;
                let is_inside = manifest.data_bounds.contains(at) && self.tiles.drawn().is_empty();
                known_m.or_else(|| is_inside.then(|| f64::midpoint(low_m, high_m)))
            }),
        };
        view_on(request, manifest, sighted, scale, self.size_px)
    }

    /// Looks again at the place that was jumped to, as long as nothing else moves the camera: finer ground has come, at another height.
    pub(crate) fn place_again(&mut self) {
        let Some((request, view)) = self.placed.take() else { return };
        if self.camera.view() != view {
            return;
        }
        if let Ok(again) = self.view_at(request)
            && again != view
        {
            self.camera.jump_to(again);
        }
        self.placed = Some((request, self.camera.view()));
    }

    /// The ground at a pixel: where it is, the tile that is drawn there, and how far beside a road it may be picked, working metres.
    pub(crate) fn ground_at(
        &self,
        at_px: DVec2,
    ) -> Option<(GroundPlace, Option<TileId>, [f64; 2], f64)> {
        let manifest = self.manifest();
        let ground = ground(&self.tiles, &self.settings, manifest, self.height_range_m);
        let camera = self.camera.view().camera(self.size_px);
        let hit = ground.hit(camera.ray_start_in_world(at_px), camera.ray_in_world(at_px))?;
        let (_, depth_m) = camera.project(hit)?;
        let at_m = [hit.x, hit.y];
        let [lon, lat] = manifest.coordinates.wgs84_from_working(at_m);
        let place = GroundPlace { lon, lat, height: hit.z / self.vertical_scale() };
        let tile = self
            .tiles
            .drawn()
            .iter()
            .map(|drawn| drawn.id)
            .find(|id| manifest.frame.tile_bounds(*id).contains(at_m));
        let reach_m = PICK_POINTS * self.pixels_per_point * camera.pixel_at_depth_m(depth_m);
        Some((place, tile, at_m, reach_m))
    }
}

/// The ground as the controls see it.
pub(crate) fn ground<'a>(
    tiles: &'a Tiles,
    settings: &Settings,
    manifest: &Manifest,
    height_range_m: [f64; 2],
) -> ShownGround<'a> {
    tiles.ground(settings.exaggeration * manifest.point_scale, height_range_m)
}

/// What is read of tiles for these settings.
pub(crate) fn reading_of(settings: &Settings, style: &Style) -> Reading {
    let decoder = match settings.compare {
        Compare::Off => TileDecoder::default().for_look(settings.road_options().method, style),
        Compare::Split | Compare::Difference => TileDecoder::default().with_layers_of(style),
    };
    Reading::of(&decoder)
}

/// How fine the ground is to be.
pub(crate) fn fineness_of(settings: &Settings) -> Fineness {
    Fineness {
        screen_space_error_px: settings.error_px,
        cell_px: settings.cell_px.unwrap_or(f64::INFINITY),
    }
}

/// A size that the adapter can draw with one sample a pixel.
pub(crate) fn clamped(size_px: [u32; 2], most_px: u32) -> [u32; 2] {
    size_px.map(|side| side.clamp(1, most_px))
}

pub(crate) fn css(color: Rgb) -> String {
    let [r, g, b] = color.map(|part| (part * 255.0).round() as u8);
    format!("#{r:02x}{g:02x}{b:02x}")
}
