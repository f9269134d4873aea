//! The interface of a map for a page.

use std::rc::Rc;

use corniche_live::{
    PickPlace, StoredSettings,
    controls::{Button, CameraKey, Input, Mode, Modifiers},
};
use corniche_viewer::{gpu::ReadBackError, tiles::MapPackage as _};
use glam::DVec2;
use js_sys::{Promise, Uint8Array};
use wasm_bindgen::{JsValue, prelude::wasm_bindgen};
use wasm_bindgen_futures::future_to_promise;
use web_sys::HtmlCanvasElement;

use crate::{
    canvas::PageCanvas,
    host::{Host, pause},
    map::{Map, changed, clamped},
    open::open,
    problem::{Problem, json},
    tables,
};

/// A map on a canvas. All positions are pixels of the canvas, all times seconds of one clock.
#[wasm_bindgen]
pub struct MapView(Map);

#[wasm_bindgen]
impl MapView {
    /// Opens a package by its address. `options` is JSON. Rejects with a problem:
    /// `{kind, message, advice}`.
    ///
    /// # Errors
    /// When there is no graphics device, or nothing to show.
    pub async fn open(
        canvas: HtmlCanvasElement,
        src: String,
        options: String,
        host: Host,
    ) -> Result<MapView, JsValue> {
        Box::pin(open(canvas, src, &options, host)).await.map(MapView).map_err(JsValue::from)
    }

    /// The default settings, as JSON.
    #[must_use]
    pub fn usual_settings() -> String {
        json(&StoredSettings::default())
    }

    /// Checks a change of the default settings, given as JSON for `set`. Returns an empty text, or
    /// an error message.
    #[must_use]
    pub fn fault_of(settings: &str) -> String {
        changed(&StoredSettings::default(), settings).err().unwrap_or_default()
    }

    /// Stores a custom style for all maps of the page, under the address of its file; `table` is
    /// from the module for custom styles. Returns an empty text, or an error message.
    #[must_use]
    pub fn keep_style(table: &[u8]) -> String {
        tables::keep(table).err().unwrap_or_default()
    }

    /// Sets the size of the canvas in pixels of the screen.
    pub fn resize(&mut self, width_px: u32, height_px: u32, pixels_per_point: f64) {
        self.0.size_px = clamped([width_px, height_px], self.0.canvas.map.gpu.max_side_px());
        self.0.pixels_per_point = pixels_per_point.max(0.1);
    }

    /// Moves, loads and draws. Returns a report as JSON.
    ///
    /// # Errors
    /// When the device is lost or cannot draw: a problem.
    pub fn frame(&mut self, now_s: f64) -> Result<String, JsValue> {
        let report = self.0.next_frame(now_s)?;
        Ok(json(&report))
    }

    /// Whether there is no problem with the device or the server that the next frame would report.
    /// A page at rest asks from time to time.
    #[must_use]
    pub fn is_well(&self) -> bool {
        let gpu = &self.0.canvas.map.gpu;
        !gpu.is_lost() && !gpu.has_fault()
    }

    /// Handles a press of a button: 0 left, 1 middle, 2 right.
    pub fn press(&mut self, button: u8, x: f64, y: f64, shift: bool, control: bool, now_s: f64) {
        self.0.session.take_over();
        if let Some(button) = button_of(button) {
            let modifiers = Modifiers { shift, control };
            self.0.session.press(button, DVec2::new(x, y), modifiers, now_s);
        }
    }

    /// Handles a movement of the pointer.
    pub fn move_to(&mut self, x: f64, y: f64, now_s: f64) {
        self.0.session.cursor_px = Some(DVec2::new(x, y));
        self.0.session.input(&Input::Move { at_px: DVec2::new(x, y) }, now_s);
    }

    /// Handles the release of a button.
    pub fn release(&mut self, button: u8, now_s: f64) {
        if let Some(button) = button_of(button) {
            self.0.session.input(&Input::Release { button }, now_s);
        }
    }

    /// Handles a pointer that leaves the map.
    pub fn leave(&mut self) {
        self.0.session.cursor_px = None;
    }

    /// Turns the wheel by this number of notches; positive zooms in.
    pub fn wheel(&mut self, steps: f64, x: f64, y: f64, now_s: f64) {
        self.0.session.take_over();
        self.0.session.input(&Input::Wheel { steps, at_px: DVec2::new(x, y) }, now_s);
    }

    /// Handles two fingers that touch the map or have moved.
    pub fn two_fingers(&mut self, ax: f64, ay: f64, bx: f64, by: f64, now_s: f64) {
        self.0.session.take_over();
        let at_px = [DVec2::new(ax, ay), DVec2::new(bx, by)];
        self.0.session.input(&Input::TwoFingers { at_px }, now_s);
    }

    /// Handles fewer than two fingers on the map.
    pub fn end_two_fingers(&mut self, now_s: f64) {
        self.0.session.input(&Input::EndTwoFingers, now_s);
    }

    /// Handles a key that goes down or up, by its `KeyboardEvent.code`. Returns whether the key has
    /// a meaning here.
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
            self.0.session.input(&Input::Modify { modifiers }, now_s);
            return false;
        }
        let Some(key) = CameraKey::of_code(code) else { return false };
        let is_map_mode = self.0.session.camera.navigator.mode == Mode::Map;
        if control || (key.is_for_flying() && is_map_mode) {
            return false;
        }
        if is_down {
            self.0.session.take_over();
        }
        self.0.session.input(&Input::Key { key, is_down, modifiers }, now_s);
        true
    }

    /// Treats all keys and buttons as released.
    pub fn let_go(&mut self, now_s: f64) {
        self.0.session.input(&Input::LetGo, now_s);
    }

    /// Executes a command of the page: `north-up`, `reset`, `toggle-fly`, `toggle-above`,
    /// `start-recording`, `stop-recording`. The last returns the flight as JSON with the fields of
    /// its TOML, others an empty text.
    pub fn command(&mut self, name: &str, now_s: f64) -> String {
        self.0.session.take_over();
        match name {
            "north-up" => self.0.session.input(&Input::NorthUp, now_s),
            "reset" => self.0.session.input(&Input::Reset, now_s),
            "toggle-fly" => self.0.session.input(&Input::ToggleFly, now_s),
            "toggle-above" | "start-recording" => {
                let session = &mut self.0.session;
                let is_done = match name {
                    "toggle-above" => session.toggle_above(now_s),
                    _ => session.start_recording(now_s),
                };
                if !is_done {
                    self.0.tell(
                        "Flights are recorded in perspective; leave the view from above first.",
                    );
                }
            }
            "stop-recording" => match self.0.session.stop_recording(now_s) {
                Ok(text) => return text,
                Err(why) => self.0.warn(why),
            },
            other => self.0.warn(format!("There is no command {other:?}.")),
        }
        String::new()
    }

    /// Plays a flight, given as JSON with the fields of its TOML; returns an empty text, or an
    /// error message.
    pub fn play(&mut self, flight: &str, now_s: f64) -> String {
        self.0.session.play(flight, now_s).err().unwrap_or_default()
    }

    /// Changes settings: a JSON object with the settings to change. Returns an empty text, or an
    /// error message.
    pub fn set(&mut self, settings: &str) -> String {
        self.0.change(settings).err().unwrap_or_default()
    }

    /// All settings as JSON.
    pub fn settings(&self) -> String {
        json(&self.0.settings)
    }

    /// The properties of the package and the graphics adapter, as JSON.
    pub fn about(&self) -> String {
        json(&self.0.about())
    }

    /// Looks at a place given as JSON, at once or by a flight there. Returns an empty text, or an
    /// error message.
    pub fn look_at(&mut self, place: &str, now_s: f64, jump: bool) -> String {
        self.0.session.take_over();
        let gone = self.0.session.go_to_record(place, self.0.size_px, jump, now_s);
        gone.err().unwrap_or_default()
    }

    /// Looks at a place in the usual notation: `9.52,47.14`. Returns an empty text, or an error
    /// message.
    pub fn go_to(&mut self, lon_lat: &str, now_s: f64) -> String {
        self.0.session.go_to(lon_lat, now_s).err().unwrap_or_default()
    }

    /// The place at a pixel: a promise of JSON, `null` over the sky.
    pub fn pick(&self, x: f64, y: f64) -> Promise {
        let Some(place) = self.0.session.pick_at(DVec2::new(x, y), self.0.size_px) else {
            return future_to_promise(async { Ok("null".into()) });
        };
        let (tileset, labels) = (Rc::clone(&self.0.tileset), self.0.labels.clone());
        future_to_promise(async move {
            let package = &tileset.package;
            let told = |error| JsValue::from(tileset.problem_of(&error));
            let mut road = None;
            if let Some(tile) = place.tile
                && let Some(bytes) =
                    package.payload_for(tile, PickPlace::SECTIONS).await.map_err(told)?
            {
                road = place.road_in(&bytes, tile, package.manifest()).map_err(told)?;
            }
            Ok(json(&place.record(road, &labels)).into())
        })
    }

    /// The shown pixels: a promise of bytes, four per pixel, rows from the top.
    pub fn read_pixels(&self) -> Promise {
        let PageCanvas { map, divider, .. } = &self.0.canvas;
        let (reading, gpu) = (map.begin_read(*divider), Rc::clone(&map.gpu));
        future_to_promise(async move {
            let told = |error: ReadBackError| JsValue::from(Problem::other(&error));
            let Some(mut reading) = reading else {
                return Ok(Uint8Array::new_with_length(0).into());
            };
            while !reading.has_arrived(&gpu).map_err(told)? {
                pause(5.0).await;
            }
            let pixels = reading.into_pixels(&gpu).map_err(told)?;
            Ok(Uint8Array::from(&pixels[..]).into())
        })
    }
}

fn button_of(number: u8) -> Option<Button> {
    [Button::Left, Button::Middle, Button::Right].get(usize::from(number)).copied()
}
