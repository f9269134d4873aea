//! The map of a page: a session of `corniche-live`, its tiles from a server, and what the page is told.

use std::rc::Rc;

use corniche_live::{
    Compare, MapScene, MapSettings, NamedStyle, Session, SettingsRecord, StyleList,
    TileLoader as _, ViewRecord, controls::Mode,
};
use corniche_roads::FunctionalRoadClass;
use corniche_styles::{Rgb, Style};
use corniche_tileset::FORMAT_VERSION;
use corniche_viewer::{
    BoundaryLines,
    flight::{Flight, FlightRecord, WorkingCrs},
    range,
    tiles::TileDecoder,
};
use serde_json::{Value, json};

use crate::{
    canvas::PageCanvas,
    decoders::Reading,
    loader::{PageLoader, Tileset},
    problem::Problem,
    tables,
};

/// While tiles are loaded anew, what was shown stays, but no longer than this.
const MOST_WAIT_S: f64 = 1.0;

/// A map on a canvas. All positions are pixels of the canvas, all times seconds of one clock.
pub(crate) struct Map {
    pub(crate) address: String,
    pub(crate) canvas: PageCanvas,
    pub(crate) tileset: Rc<Tileset>,
    pub(crate) loader: PageLoader,
    pub(crate) session: Session,
    pub(crate) settings: SettingsRecord,
    pub(crate) labels: [String; FunctionalRoadClass::COUNT],
    pub(crate) size_px: [u32; 2],
    pub(crate) pixels_per_point: f64,
    /// Messages that the page was not told yet.
    pub(crate) notices: Vec<Value>,
    /// The scene of the last frame was drawn with fewer samples than asked.
    pub(crate) is_hurried: bool,
    /// When tiles began to be loaded anew; what was shown stays until those of the view are there.
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
    /// A warning for the person.
    pub(crate) fn warn(&mut self, text: impl Into<String>) {
        self.notices.push(json!({ "kind": "warn", "text": text.into() }));
    }

    /// News for the person.
    pub(crate) fn tell(&mut self, text: &str) {
        self.notices.push(json!({ "kind": "tell", "text": text }));
    }

    /// Changes settings: JSON with those to change.
    pub(crate) fn change(&mut self, changes: &str) -> Result<(), String> {
        let (changed, style) = changed(&self.settings, changes)?;
        let shown = changed.of_session();
        let reading = reading_of(&shown, &style);
        self.session.change(shown);
        self.session.styles = style_list(&changed.style, style);
        self.session.camera.set_inertia(changed.inertia());
        if self.loader.read_otherwise(reading) {
            self.session.begin_again();
            self.canvas.map.clear();
            self.anew_s = Some(self.last_s);
        }
        self.settings = changed;
        Ok(())
    }

    /// Moves to a place that the page names, as JSON.
    pub(crate) fn go(&mut self, place: &str, now_s: f64, is_jump: bool) -> Result<(), String> {
        let place: ViewRecord = serde_json::from_slice(place.as_bytes())
            .map_err(|error| format!("the place: {error}"))?;
        let request = place.request();
        range::check_camera(request).map_err(|error| error.to_string())?;
        let gone = if is_jump {
            self.session.jump_to(request, self.size_px)
        } else {
            self.session.travel_to(request, self.size_px, now_s)
        };
        gone.map_err(|error| error.to_string())
    }

    /// Ends the recording; the flight as JSON, with the fields of its TOML.
    pub(crate) fn stop_recording(&mut self, now_s: f64) -> Result<String, String> {
        let recorded = self.session.flights.stop_recording(now_s);
        let flight = recorded.ok_or("no flight is being recorded")?;
        let flight = flight.map_err(|error| error.to_string())?;
        let record = flight.record(WorkingCrs::of(self.session.manifest()));
        serde_json::to_string(&record).map_err(|error| error.to_string())
    }

    /// Plays a flight: JSON with the fields of its TOML.
    pub(crate) fn play(&mut self, flight: &str, now_s: f64) -> Result<(), String> {
        let record: FlightRecord = serde_json::from_slice(flight.as_bytes())
            .map_err(|error| format!("this is no flight: {error}"))?;
        let manifest = self.session.manifest();
        let flight = Flight::of_record(&record, WorkingCrs::of(manifest), &manifest.coordinates);
        self.session.flights.play(flight.map_err(|error| error.to_string())?, now_s);
        Ok(())
    }

    /// What is known of the map before anything is drawn.
    pub(crate) fn about(&self) -> Value {
        let (manifest, look) = (self.session.manifest(), self.session.look());
        let gpu = self.canvas.gpu();
        let entry = |label: &str, color| json!({ "label": label, "color": css(color) });
        let roads = self.labels.iter().zip(&look.roads);
        let roads = roads.map(|(label, road)| entry(label, road.bands.main_color()));
        let boundaries = BoundaryLines::of(manifest, &look).into_iter();
        let boundaries = boundaries.map(|lines| entry(&lines.label, lines.style.color));
        json!({
            "src": self.address,
            "attribution": manifest.attribution,
            "bounds": manifest.wgs84_bounds.to_array(),
            "heights": self.session.height_range_m(),
            "tiles": manifest.levels.iter().map(|level| level.tiles).sum::<u64>(),
            "levels": manifest.levels.len(),
            "styles": tables::style_names(),
            "classes": roads.collect::<Vec<Value>>(),
            "boundaries": boundaries.collect::<Vec<Value>>(),
            "has": {
                "photo": manifest.settings.photo.is_some(),
                "areas": manifest.areas.is_some(),
                "boundaries": manifest.boundaries.is_some(),
            },
            "adapter": gpu.adapter_name(),
            "is_software": gpu.is_software(),
            "max_side_px": gpu.max_side_px(),
            "format_version": FORMAT_VERSION,
            "bytes": self.tileset.package.package().source().file_bytes(),
        })
    }

    /// Does all of a frame. Returns what the page is told.
    ///
    /// # Errors
    /// When the device is lost or cannot draw.
    pub(crate) fn next_frame(&mut self, now_s: f64) -> Result<Value, Problem> {
        self.check_device()?;
        for defect in self.session.tiles.take_arrivals() {
            self.warn(defect);
        }
        for problem in self.loader.take_problems() {
            // Its tiles are those of another package now.
            if problem.kind == "changed" {
                return Err(problem);
            }
            self.warn(format!("Tiles are asked for again. {}", problem.message));
        }
        self.last_s = now_s;
        let (canvas, pixels_per_point) = (&mut self.canvas.map, self.pixels_per_point as f32);
        let step = self.session.step(canvas, self.size_px, pixels_per_point, now_s);
        if self.session.tiles.take_first_time_full() {
            self.warn("The memory for tiles is full: this view is coarser than asked.");
        }
        let tiles = &self.session.tiles;
        let is_there = tiles.missing() == 0 && !step.is_under_way;
        let is_stuck = tiles.is_full() || self.loader.troubled() > 0;
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
        let gpu = self.canvas.gpu();
        if gpu.is_lost() {
            return Err(Problem::new(
                "device-lost",
                "The graphics device was lost.",
                "The map is opened again.",
            ));
        }
        let Some(what) = gpu.take_fault() else { return Ok(()) };
        let (kind, advice) = if what.to_lowercase().contains("memory") {
            let advice = "Make the map smaller, take fewer samples a pixel, or close other pages.";
            ("out-of-memory", advice)
        } else {
            ("other", "Reload the page.")
        };
        let message = format!("The graphics device could not do its work: {what}");
        Err(Problem::new(kind, message, advice))
    }

    /// Draws the map. Where the picture is too large for the adapter with so many samples, it is drawn with fewer.
    fn draw(&mut self, now_s: f64) -> Result<bool, Problem> {
        let MapSettings { samples_per_side, divider_share, .. } = self.session.settings;
        let wanted = samples_per_side.min(self.canvas.map.most_samples(self.size_px));
        self.is_hurried = self.session.is_hurrying(&self.canvas.map, now_s) && wanted > 1;
        let samples = if self.is_hurried { 1 } else { wanted };
        let scene = self.session.scene(self.size_px, samples);
        let revision = u64::from(divider_share.to_bits());
        self.canvas.draw(&MapScene { revision, ..scene }, divider_share)
    }

    /// What came of the frame.
    fn report(&mut self, is_under_way: bool, now_s: f64) -> Value {
        let Session { tiles, camera, flights, probe, .. } = &self.session;
        let (drawn, missing) = (tiles.drawn().len(), tiles.missing());
        let (loading, is_full) = (tiles.loading(), tiles.is_full());
        let cursor = probe.cursor().map(|point| {
            let ([lon, lat], [.., height]) = (point.lon_lat_deg, point.at_m);
            json!({ "lon": lon, "lat": lat, "height": height })
        });
        let point_scale = self.session.manifest().point_scale;
        let metres_per_pixel = probe.middle_pixel_m().map(|pixel_m| pixel_m / point_scale);
        // Nothing is to be waited for from a server that gives no tiles.
        let troubled = self.loader.troubled();
        let is_playing = flights.is_playing();
        // A recording needs frames only while something moves; a picture that was drawn in a hurry is drawn again at rest.
        let is_busy = camera.is_moving()
            || is_playing
            || is_under_way
            || self.is_hurried
            || self.anew_s.is_some();
        let traffic = self.tileset.package.package().source().traffic();
        let counts = self.canvas.map.counts();
        let is_settled =
            !is_busy && (missing == 0 || is_full || troubled > 0) && loading == troubled;
        let share_there = drawn as f64 / (drawn + missing).max(1) as f64;
        let report = json!({
            "next": if is_busy { "now" } else { "asked" },
            "is_settled": is_settled,
            "view": ViewRecord::of(self.session.request()),
            "cursor": cursor,
            "metres_per_pixel": metres_per_pixel,
            "metres_per_point": metres_per_pixel.map(|pixel_m| pixel_m * self.pixels_per_point),
            "mode": if camera.mode() == Mode::Fly { "fly" } else { "map" },
            "tiles": { "drawn": drawn, "missing": missing, "loading": loading, "full": is_full },
            "triangles": counts.triangles,
            "segments": counts.segments,
            "gpu_bytes": tiles.bytes_of_budget(),
            "requests": traffic.requests,
            "bytes": traffic.bytes,
            "progress": if is_full { 1.0 } else { share_there },
            "recording_s": flights.recording_s(now_s),
            "is_playing": is_playing,
            "notices": std::mem::take(&mut self.notices),
        });
        if is_settled {
            self.session.settle();
            self.loader.end_foresight();
        }
        report
    }
}

/// Settings with some of them changed, as JSON says, and their style.
///
/// # Errors
/// In words, when a value cannot be, or there is no such style.
pub(crate) fn changed(
    settings: &SettingsRecord,
    changes: &str,
) -> Result<(SettingsRecord, Style), String> {
    let changed = settings.changed_by(changes)?;
    let style = tables::style(&changed.style)?;
    Ok((changed, style))
}

/// A style as the one that a session can choose.
pub(crate) fn style_list(name: &str, style: Style) -> StyleList {
    StyleList::new(vec![NamedStyle { name: name.to_owned(), style }], None)
}

/// What is read of tiles for these settings.
pub(crate) fn reading_of(settings: &MapSettings, style: &Style) -> Reading {
    let look = settings.applied_to(style);
    Reading::of(&match settings.compare {
        Compare::Off => TileDecoder::default().for_look(settings.roads.method, &look),
        Compare::Split | Compare::Difference => TileDecoder::default().with_layers_of(&look),
    })
}

/// A size that the adapter can draw with one sample a pixel.
pub(crate) fn clamped(size_px: [u32; 2], most_px: u32) -> [u32; 2] {
    size_px.map(|side| side.clamp(1, most_px))
}

/// A colour as in CSS: `#rrggbb`.
fn css(color: Rgb) -> String {
    let [r, g, b] = color.map(|part| (part * 255.0).round() as u8);
    format!("#{r:02x}{g:02x}{b:02x}")
}
