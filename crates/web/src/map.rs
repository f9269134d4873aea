//! The map of a page: a session of `corniche-live`, its tiles from a server, and the reports to the
//! page.

use std::rc::Rc;

use corniche_live::{
    FrameRest, MapScene, MapSettings, NamedStyle, Session, StoredSettings, StyleList,
    TileLoader as _,
};
use corniche_roads::FunctionalRoadClass;
use corniche_styles::Style;
use serde_json::{Value, json};

use crate::{
    canvas::PageCanvas,
    decoders::DecodedParts,
    loader::{PageLoader, Tileset},
    problem::Problem,
    tables,
};

/// While all tiles are reloaded, the old image stays, but no longer than this.
const MOST_WAIT_S: f64 = 1.0;

/// A map on a canvas. All positions are pixels of the canvas, all times seconds of one clock.
pub(crate) struct Map {
    pub(crate) address: String,
    pub(crate) canvas: PageCanvas,
    pub(crate) tileset: Rc<Tileset>,
    pub(crate) loader: PageLoader,
    pub(crate) session: Session,
    pub(crate) settings: StoredSettings,
    pub(crate) labels: [String; FunctionalRoadClass::COUNT],
    pub(crate) size_px: [u32; 2],
    pub(crate) pixels_per_point: f64,
    /// Messages that were not passed to the page yet.
    pub(crate) notices: Vec<Value>,
    /// Whether the scene of the last frame was drawn with fewer samples than requested.
    pub(crate) is_hurried: bool,
    /// The start of reloading all tiles; the old image stays until the tiles of the view are
    /// loaded.
    pub(crate) anew_s: Option<f64>,
    /// Time of the last frame.
    pub(crate) last_s: f64,
}

impl Drop for Map {
    fn drop(&mut self) {
        self.loader.forget();
    }
}

impl Map {
    /// Adds a warning for the user.
    pub(crate) fn warn(&mut self, text: impl Into<String>) {
        self.notices.push(json!({ "kind": "warn", "text": text.into() }));
    }

    /// Adds a message for the user.
    pub(crate) fn tell(&mut self, text: &str) {
        self.notices.push(json!({ "kind": "tell", "text": text }));
    }

    /// Changes settings: JSON with the settings to change.
    pub(crate) fn change(&mut self, changes: &str) -> Result<(), String> {
        let (changed, style) = changed(&self.settings, changes)?;
        let shown = changed.of_session();
        let reading = DecodedParts::from_decoder(&shown.decoder(self.session.manifest(), &style));
        self.session.change(shown);
        self.session.styles = style_list(&changed.style, style);
        self.session.camera.navigator.has_inertia = changed.inertia;
        if self.loader.read_otherwise(reading) {
            self.session.begin_again();
            self.canvas.map.clear();
            self.anew_s = Some(self.last_s);
        }
        self.settings = changed;
        Ok(())
    }

    /// The properties of the map before anything is drawn.
    pub(crate) fn about(&self) -> Value {
        let mut about = self.session.about(&self.labels, &self.canvas.map.gpu);
        about["src"] = json!(self.address);
        about["styles"] = json!(tables::style_names());
        about["bytes"] = json!(self.tileset.package.package.source().file_bytes());
        about
    }

    /// Executes a frame. Returns the report for the page.
    ///
    /// # Errors
    /// When the device is lost or cannot draw.
    pub(crate) fn next_frame(&mut self, now_s: f64) -> Result<Value, Problem> {
        self.check_device()?;
        for defect in self.session.tiles.take_arrivals() {
            self.warn(defect);
        }
        for problem in self.loader.take_problems() {
            // The tiles of the file are now those of another package.
            if problem.kind == "changed" {
                return Err(problem);
            }
            self.warn(format!("The map requests these tiles again. {}", problem.message));
        }
        self.last_s = now_s;
        let (canvas, pixels_per_point) = (&mut self.canvas.map, self.pixels_per_point as f32);
        let step = self.session.step(canvas, self.size_px, pixels_per_point, now_s);
        if self.session.tiles.take_first_time_full() {
            self.warn("The memory for tiles is full: this view is coarser than requested.");
        }
        let tiles = &self.session.tiles;
        let is_there = tiles.missing == 0 && !step.is_under_way;
        let is_stuck = tiles.is_full || self.loader.troubled() > 0;
        let is_waiting = self
            .anew_s
            .is_some_and(|begun_s| !is_there && !is_stuck && now_s - begun_s < MOST_WAIT_S);
        if !is_waiting {
            self.anew_s = None;
        }
        let is_new = if is_waiting { false } else { self.draw(now_s)? };
        self.session.look_at_ground(&step.camera, is_new);
        Ok(self.report(step.is_under_way, now_s))
    }

    fn check_device(&self) -> Result<(), Problem> {
        let gpu = &self.canvas.map.gpu;
        if gpu.is_lost() {
            return Err(Problem::new(
                "device-lost",
                "The graphics device was lost.",
                "The map is reopened.",
            ));
        }
        let Some(what) = gpu.take_fault() else { return Ok(()) };
        let (kind, advice) = if what.to_lowercase().contains("memory") {
            let advice = "Make the map smaller, use fewer samples per pixel, or close other pages.";
            ("out-of-memory", advice)
        } else {
            ("other", "Reload the page.")
        };
        let message = format!("The graphics device failed: {what}");
        Err(Problem::new(kind, message, advice))
    }

    /// Draws the map. If the image is too large for the adapter with this many samples, it is drawn
    /// with fewer.
    fn draw(&mut self, now_s: f64) -> Result<bool, Problem> {
        let MapSettings { samples_per_side, divider_share, .. } = self.session.settings;
        let wanted = samples_per_side.min(self.canvas.map.most_samples(self.size_px));
        self.is_hurried = self.session.is_hurrying(&self.canvas.map, now_s) && wanted > 1;
        let samples = if self.is_hurried { 1 } else { wanted };
        let scene = self.session.scene(self.size_px, samples);
        let revision = u64::from(divider_share.to_bits());
        self.canvas.draw(&MapScene { revision, ..scene }, divider_share)
    }

    /// The report of the frame for the page.
    fn report(&mut self, is_under_way: bool, now_s: f64) -> Value {
        // An image that was drawn in a hurry is drawn again at rest.
        let is_busy = is_under_way || self.is_hurried || self.anew_s.is_some();
        // The map does not wait for tiles that the server does not send.
        let rest = FrameRest { is_busy, troubled: self.loader.troubled() };
        let counts = self.canvas.map.counts;
        let (mut report, is_settled) =
            self.session.report(counts, rest, self.pixels_per_point, now_s);
        let traffic = self.tileset.package.package.source().traffic();
        report["requests"] = json!(traffic.requests);
        report["bytes"] = json!(traffic.bytes);
        report["notices"] = Value::Array(std::mem::take(&mut self.notices));
        if is_settled {
            self.session.settle();
            self.loader.end_foresight();
        }
        report
    }
}

/// Applies JSON changes to the settings, and returns them with their style.
///
/// # Errors
/// When a value is invalid, or there is no such style, as a message.
pub(crate) fn changed(
    settings: &StoredSettings,
    changes: &str,
) -> Result<(StoredSettings, Style), String> {
    let changed = settings.changed_by(changes)?;
    let style = tables::style(&changed.style)?;
    Ok((changed, style))
}

/// The list with one style that a session can choose from.
pub(crate) fn style_list(name: &str, style: Style) -> StyleList {
    StyleList::new(vec![NamedStyle { name: name.to_owned(), style }], None)
}

/// A size that the adapter can draw with one sample per pixel.
pub(crate) fn clamped(size_px: [u32; 2], most_px: u32) -> [u32; 2] {
    size_px.map(|side| side.clamp(1, most_px))
}
