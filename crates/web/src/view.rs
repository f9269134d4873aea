//! A map on a canvas.

mod frame;
mod open;

use std::rc::Rc;

use corniche_geom::TileId;
use corniche_live::{
    CameraControl, GroundProbe, ShownGround, TileLoader as _, Tiles,
    controls::{Button, Inertia, Input, Key, KeyState, KnownGround as _, Mode, Modifiers},
    place_in_world,
};
use corniche_roads::FunctionalRoadClass;
use corniche_styles::{Rgb, RoadStyle, Style};
use corniche_tileset::{FORMAT_VERSION, Manifest};
use corniche_viewer::{
    SightedGround,
    flight::Pose,
    lod::Fineness,
    range,
    tiles::{MapExtent, MapPackage as _, TileDecoder},
};
use glam::DVec2;
use js_sys::{Promise, Uint8Array};
use wasm_bindgen::{JsValue, prelude::wasm_bindgen};
use wasm_bindgen_futures::future_to_promise;
use web_sys::HtmlCanvasElement;

use crate::{
    canvas::PageCanvas,
    flights::Flights,
    host::Host,
    loader::{PageLoader, Tileset},
    pick::road_at,
    place::{Place, view_of},
    problem::Problem,
    report::{About, ClassEntry, GroundPlace, Has, Notice, Pick},
    settings::{Compare, Settings},
    tables,
    timer::pause,
};

/// A place is picked at most so far beside a road, points of the screen.
const PICK_POINTS: f64 = 6.0;
/// A processor that draws takes one sample a pixel until the camera has been at rest for this time.
const HURRY_S: f64 = 0.15;

/// A map on a canvas. All positions are pixels of the canvas, all times seconds of one clock.
#[wasm_bindgen]
pub struct MapView {
    address: String,
    canvas: PageCanvas,
    tileset: Rc<Tileset>,
    loader: PageLoader,
    tiles: Tiles,
    camera: CameraControl,
    settings: Settings,
    style: Style,
    labels: [String; FunctionalRoadClass::COUNT],
    height_range_m: [f64; 2],
    size_px: [u32; 2],
    pixels_per_point: f64,
    probe: GroundProbe,
    cursor_px: Option<DVec2>,
    flights: Flights,
    notices: Vec<Notice>,
    /// The scene of the last frame was drawn with fewer samples than asked.
    is_hurried: bool,
    /// Tiles are loaded anew; what is shown stays until those of the view are there.
    is_beginning_again: bool,
}

#[wasm_bindgen]
impl MapView {
    /// Opens a package by its address. `options` is JSON. Rejects with a problem: `{kind, message, advice}`.
    ///
    /// # Errors
    /// When there is nothing to draw with, or nothing to show.
    pub async fn open(
        canvas: HtmlCanvasElement,
        src: String,
        options: String,
        host: Host,
    ) -> Result<MapView, JsValue> {
        Box::pin(open::open(canvas, src, &options, host)).await.map_err(JsValue::from)
    }

    /// The canvas has this size in pixels of the screen now.
    pub fn resize(&mut self, width_px: u32, height_px: u32, pixels_per_point: f64) {
        self.size_px = clamped([width_px, height_px], self.canvas.gpu().max_side_px());
        self.pixels_per_point = pixels_per_point.max(0.1);
    }

    /// Moves, loads and draws. Returns a report as JSON.
    ///
    /// # Errors
    /// When the device is lost or cannot draw: a problem.
    pub fn frame(&mut self, now_s: f64) -> Result<String, JsValue> {
        let report = self.next_frame(now_s)?;
        Ok(json(&report))
    }

    /// A button goes down: 0 left, 1 middle, 2 right.
    pub fn press(&mut self, button: u8, x: f64, y: f64, shift: bool, control: bool, now_s: f64) {
        self.flights.stop_playing();
        let Some(button) = button_of(button) else { return };
        let ground = ground(
            &self.tiles,
            &self.settings,
            self.tileset.package.manifest(),
            self.height_range_m,
        );
        self.camera.press(button, DVec2::new(x, y), Modifiers { shift, control }, now_s, &ground);
    }

    /// The pointer is here.
    pub fn move_to(&mut self, x: f64, y: f64, now_s: f64) {
        self.cursor_px = Some(DVec2::new(x, y));
        self.input(&Input::Move { at_px: DVec2::new(x, y) }, now_s);
    }

    /// A button goes up.
    pub fn release(&mut self, button: u8, now_s: f64) {
        if let Some(button) = button_of(button) {
            self.input(&Input::Release { button }, now_s);
        }
    }

    /// The pointer is outside.
    pub fn leave(&mut self) {
        self.cursor_px = None;
    }

    /// The wheel turns by so many notches; positive zooms in.
    pub fn wheel(&mut self, steps: f64, x: f64, y: f64, now_s: f64) {
        self.flights.stop_playing();
        self.input(&Input::Wheel { steps, at_px: DVec2::new(x, y) }, now_s);
    }

    /// Two fingers touch the map, or are elsewhere now.
    pub fn two_fingers(&mut self, ax: f64, ay: f64, bx: f64, by: f64, now_s: f64) {
        self.flights.stop_playing();
        self.input(&Input::TwoFingers { at_px: [DVec2::new(ax, ay), DVec2::new(bx, by)] }, now_s);
    }

    /// Less than two fingers touch the map.
    pub fn end_two_fingers(&mut self, now_s: f64) {
        self.input(&Input::EndTwoFingers, now_s);
    }

    /// A key goes down or up, by its `KeyboardEvent.code`. Returns whether it means something here.
    pub fn key(
        &mut self,
        code: &str,
        is_down: bool,
        shift: bool,
        control: bool,
        now_s: f64,
    ) -> bool {
        let modifiers = Modifiers { shift, control };
        if code.starts_with("Shift") || code.starts_with("Control") {
            self.input(&Input::Modify { modifiers }, now_s);
            return false;
        }
        let Some(key) = key_of(code) else { return false };
        let is_flying = matches!(
            key,
            Key::Ahead | Key::Back | Key::StrafeLeft | Key::StrafeRight | Key::Rise | Key::Sink
        );
        if control || (is_flying && self.camera.mode() == Mode::Map) {
            return false;
        }
        if is_down {
            self.flights.stop_playing();
        }
        let state = if is_down { KeyState::Pressed } else { KeyState::Released };
        self.input(&Input::Key { key, state, modifiers }, now_s);
        true
    }

    /// All keys and buttons count as released.
    pub fn let_go(&mut self, now_s: f64) {
        self.input(&Input::LetGo, now_s);
    }

    /// Does what a button of the page asks for: `north-up`, `reset`, `toggle-fly`, `toggle-above`, `start-recording`, `stop-recording`. The last
    /// returns the flight as JSON with the fields of its TOML, others an empty text.
    pub fn command(&mut self, name: &str, now_s: f64) -> String {
        self.flights.stop_playing();
        match name {
            "north-up" => self.input(&Input::NorthUp, now_s),
            "reset" => self.input(&Input::Reset, now_s),
            "toggle-fly" => self.input(&Input::ToggleFly, now_s),
            "toggle-above" | "start-recording" if self.is_recording_from_above(name) => {
                self.notices
                    .push(Notice::told("Flights are recorded in perspective: not from above."));
            }
            "toggle-above" => self.input(&Input::ToggleAbove, now_s),
            "start-recording" => self.flights.start_recording(now_s, self.pose()),
            "stop-recording" => {
                match self.flights.stop_recording(now_s, self.tileset.package.manifest()) {
                    Ok(text) => return text,
                    Err(why) => self.notices.push(Notice::warning(why)),
                }
            }
            other => self.notices.push(Notice::warning(format!("There is no command {other:?}."))),
        }
        String::new()
    }

    /// Plays a flight, JSON with the fields of its TOML; returns an empty text, or why not.
    pub fn play(&mut self, flight: &str, now_s: f64) -> String {
        let played = self.flights.play(flight, now_s, self.tileset.package.manifest());
        played.err().unwrap_or_default()
    }

    /// Changes settings: a JSON object with those to change. Returns an empty text, or why not.
    pub fn set(&mut self, settings: &str) -> String {
        self.change(settings).err().unwrap_or_default()
    }

    /// All settings as JSON.
    pub fn settings(&self) -> String {
        json(&self.settings)
    }

    /// What is known of the package and the graphics adapter, as JSON.
    pub fn about(&self) -> String {
        json(&self.told())
    }

    /// Looks at a place, at once or by a flight there: JSON. Returns an empty text, or why not.
    pub fn look_at(&mut self, place: &str, now_s: f64, jump: bool) -> String {
        self.flights.stop_playing();
        self.go(place, now_s, jump).err().unwrap_or_default()
    }

    /// Looks at a place as people write it: `9.52,47.14`. Returns an empty text, or why not.
    pub fn go_to(&mut self, lon_lat: &str, now_s: f64) -> String {
        let manifest = self.tileset.package.manifest();
        let ground = ground(&self.tiles, &self.settings, manifest, self.height_range_m);
        match place_in_world(lon_lat, manifest, &ground) {
            Ok(target_in_world) => {
                self.flights.stop_playing();
                self.input(&Input::GoTo { target_in_world }, now_s);
                String::new()
            }
            Err(why) => why,
        }
    }

    /// What is at a pixel: a promise of JSON, `null` over the sky.
    pub fn pick(&self, x: f64, y: f64) -> Promise {
        let Some((at, tile, at_m, reach_m)) = self.ground_at(DVec2::new(x, y)) else {
            return future_to_promise(async { Ok("null".into()) });
        };
        let (tileset, labels, style) =
            (Rc::clone(&self.tileset), self.labels.clone(), self.style.clone());
        let point_scale = tileset.package.manifest().point_scale;
        let classes = self.settings.road_options().classes;
        future_to_promise(async move {
            let half_width_m = |class: FunctionalRoadClass| {
                let width_m = f64::from(style.roads[usize::from(class.number())].width_m);
                classes.contains(class).then_some(width_m * point_scale / 2.0)
            };
            let road = match tile {
                Some(tile) => road_at(&tileset, tile, at_m, reach_m, &half_width_m, &labels).await,
                None => None,
            };
            Ok(json(&Pick { at, road }).into())
        })
    }

    /// The pixels that are shown: a promise of bytes, four a pixel, rows from the top.
    pub fn read_pixels(&self) -> Promise {
        let (parts, gpu, width) = (
            self.canvas.begin_read(),
            Rc::clone(self.canvas.gpu()),
            self.canvas.shown_width_px() as usize,
        );
        future_to_promise(async move {
            let told = |error| JsValue::from(Problem::other(&error));
            let mut picture: Vec<u8> = Vec::new();
            for (mut read, columns) in parts {
                while !read.has_arrived(&gpu).map_err(told)? {
                    pause(5.0).await;
                }
                let texels = read.into_texels(&gpu).map_err(told)?;
                if picture.is_empty() {
                    picture = texels;
                    continue;
                }
                let columns = 4 * columns.start as usize..4 * columns.end as usize;
                for (row, from) in
                    picture.chunks_exact_mut(4 * width).zip(texels.chunks_exact(4 * width))
                {
                    row[columns.clone()].copy_from_slice(&from[columns.clone()]);
                }
            }
            Ok(Uint8Array::from(&picture[..]).into())
        })
    }
}

impl Drop for MapView {
    fn drop(&mut self) {
        self.loader.forget();
    }
}

impl MapView {
    fn manifest(&self) -> &Manifest {
        self.tileset.package.manifest()
    }

    fn vertical_scale(&self) -> f64 {
        self.settings.exaggeration * self.manifest().point_scale
    }

    fn input(&mut self, input: &Input, now_s: f64) {
        let ground = ground(
            &self.tiles,
            &self.settings,
            self.tileset.package.manifest(),
            self.height_range_m,
        );
        self.camera.input(input, now_s, &ground);
    }

    /// The camera as flights have it.
    fn pose(&self) -> Pose {
        self.camera.pose(self.vertical_scale())
    }

    /// Whether a flight would be recorded from above, after this command.
    fn is_recording_from_above(&self, command: &str) -> bool {
        let is_recording = self.flights.recording_s(0.0).is_some();
        let is_above = self.camera.view().from_above.is_some();
        if command == "toggle-above" { is_recording } else { is_above }
    }

    fn change(&mut self, changes: &str) -> Result<(), String> {
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
        if self.loader.read_otherwise(decoder_of(&changed, &style)) {
            self.tiles.begin_again();
            self.canvas.clear();
            self.is_beginning_again = true;
        }
        (self.settings, self.style) = (changed, style);
        Ok(())
    }

    fn told(&self) -> About {
        let manifest = self.manifest();
        let gpu = self.canvas.gpu();
        let entry = |(label, road): (&String, &RoadStyle)| ClassEntry {
            label: label.clone(),
            color: css(road.bands.main_color()),
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

    fn go(&mut self, place: &str, now_s: f64, jump: bool) -> Result<(), String> {
        let place: Place = serde_json::from_slice(place.as_bytes())
            .map_err(|error| format!("the place: {error}"))?;
        let request = place.request();
        range::check_camera(request).map_err(|error| error.to_string())?;
        let manifest = self.tileset.package.manifest();
        let scale = self.vertical_scale();
        let ground = ground(&self.tiles, &self.settings, manifest, self.height_range_m);
        let at = request.place(manifest).map_err(|error| error.to_string())?;
        let sighted = SightedGround {
            extent: MapExtent::of_data(manifest.data_bounds, self.height_range_m),
            heights_m: self.height_range_m,
            at_place_m: at.and_then(|at| ground.height(at)).map(|height| height / scale),
        };
        let camera = request
            .camera(manifest, sighted, scale, self.size_px)
            .map_err(|error| error.to_string())?;
        let view = view_of(
            request,
            &camera,
            manifest,
            self.height_range_m.map(|height_m| height_m * scale),
        );
        if jump {
            self.camera.jump_to(view);
        } else {
            self.camera.travel_to(view, now_s);
        }
        Ok(())
    }

    /// The ground at a pixel: where it is, the tile that is drawn there, and how far beside a road it may be picked, working metres.
    fn ground_at(&self, at_px: DVec2) -> Option<(GroundPlace, Option<TileId>, [f64; 2], f64)> {
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
fn ground<'a>(
    tiles: &'a Tiles,
    settings: &Settings,
    manifest: &Manifest,
    height_range_m: [f64; 2],
) -> ShownGround<'a> {
    tiles.ground(settings.exaggeration * manifest.point_scale, height_range_m)
}

/// What is read of tiles for these settings, as JSON.
fn decoder_of(settings: &Settings, style: &Style) -> String {
    let decoder = match settings.compare {
        Compare::Off => TileDecoder::default().for_look(settings.road_options().method, style),
        Compare::Split | Compare::Difference => TileDecoder::default().with_layers_of(style),
    };
    json(&decoder)
}

/// How fine the ground is to be.
fn fineness_of(settings: &Settings) -> Fineness {
    Fineness {
        screen_space_error_px: settings.error_px,
        cell_px: settings.cell_px.unwrap_or(f64::INFINITY),
    }
}

/// A size that the adapter can draw with one sample a pixel.
fn clamped(size_px: [u32; 2], most_px: u32) -> [u32; 2] {
    size_px.map(|side| side.clamp(1, most_px))
}

fn css(color: Rgb) -> String {
    let [r, g, b] = color.map(|part| (part * 255.0).round() as u8);
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// A value of this crate as JSON.
fn json(value: &impl serde::Serialize) -> String {
    // These values have text keys and finite numbers only, so there is always a text.
    serde_json::to_string(value).unwrap_or_default()
}

fn button_of(number: u8) -> Option<Button> {
    [Button::Left, Button::Middle, Button::Right].get(usize::from(number)).copied()
}

fn key_of(code: &str) -> Option<Key> {
    Some(match code {
        "ArrowLeft" => Key::Left,
        "ArrowRight" => Key::Right,
        "ArrowUp" => Key::Up,
        "ArrowDown" => Key::Down,
        "Equal" | "NumpadAdd" => Key::ZoomIn,
        "Minus" | "NumpadSubtract" => Key::ZoomOut,
        "KeyW" => Key::Ahead,
        "KeyS" => Key::Back,
        "KeyA" => Key::StrafeLeft,
        "KeyD" => Key::StrafeRight,
        "KeyE" => Key::Rise,
        "KeyQ" => Key::Sink,
        _ => return None,
    })
}
