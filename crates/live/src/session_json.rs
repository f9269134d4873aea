//! The JSON that a page exchanges with a session.

use corniche_styles::Rgb;
use corniche_tileset::FORMAT_VERSION;
use corniche_viewer::{
    LayerLegend,
    flight::{Flight, FlightRecord, WorkingCrs},
    gpu::Gpu,
    range,
};
use serde_json::{Value, json};

use crate::{controls::Mode, map_canvas::SceneCounts, session::Session, view_json::ViewRecord};

/// Pending work of a frame that the session does not know of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FrameRest {
    /// Whether the next frame is needed at once.
    pub is_busy: bool,
    /// The number of loading tiles that will be delayed.
    pub troubled: usize,
}

impl Session {
    /// The properties of the map before anything is drawn; `labels` are the names of the classes.
    #[must_use]
    pub fn about(&self, labels: &[String], gpu: &Gpu) -> Value {
        let (manifest, look) = (self.manifest(), self.look());
        let entry = |label: &str, color| json!({ "label": label, "color": css(color) });
        let roads = labels.iter().zip(&look.roads);
        let roads = roads.map(|(label, road)| entry(label, road.bands.main_color()));
        let layers = LayerLegend::from_manifest(manifest, &self.layer_looks()).into_iter();
        let layers = layers.map(|LayerLegend { id, title, geometry, rows }| {
            let classes = rows.iter().map(|row| entry(&row.label, row.look.color()));
            json!({
                "id": id,
                "title": title,
                "geometry": geometry.name(),
                "classes": classes.collect::<Vec<Value>>(),
            })
        });
        json!({
            "attribution": manifest.attribution,
            "bounds": manifest.wgs84_bounds.to_array(),
            "heights": self.height_range_m(),
            "tiles": manifest.levels.iter().map(|level| level.tiles).sum::<u64>(),
            "levels": manifest.levels.len(),
            "classes": roads.collect::<Vec<Value>>(),
            "layers": layers.collect::<Vec<Value>>(),
            "has": { "photo": manifest.settings.photo.is_some() },
            "adapter": &gpu.adapter_name,
            "is_software": gpu.is_software(),
            "max_side_px": gpu.max_side_px(),
            "format_version": FORMAT_VERSION,
        })
    }

    /// Moves to a place given as JSON, in a window or page element of `size_px`: at once, or
    /// gradually.
    ///
    /// # Errors
    /// When the text is not a place or there is no ground, as a message.
    pub fn go_to_record(
        &mut self,
        place: &str,
        size_px: [u32; 2],
        is_jump: bool,
        now_s: f64,
    ) -> Result<(), String> {
        let place: ViewRecord = serde_json::from_slice(place.as_bytes())
            .map_err(|error| format!("invalid view: {error}"))?;
        let request = place.request();
        range::check_camera(request).map_err(|error| error.to_string())?;
        let gone = if is_jump {
            self.jump_to(request, size_px)
        } else {
            self.travel_to(request, size_px, now_s)
        };
        gone.map_err(|error| error.to_string())
    }

    /// Ends the recording and returns the flight as JSON, with the fields of its TOML.
    ///
    /// # Errors
    /// When nothing was recorded, as a message.
    pub fn stop_recording(&mut self, now_s: f64) -> Result<String, String> {
        let flight = self.flights.stop_recording(now_s).ok_or("no flight is being recorded")?;
        let flight = flight.map_err(|error| error.to_string())?;
        let record = flight.record(WorkingCrs::from_manifest(self.manifest()));
        serde_json::to_string(&record).map_err(|error| error.to_string())
    }

    /// Plays a flight given as JSON, with the fields of its TOML.
    ///
    /// # Errors
    /// When the text is not a flight for this package, as a message.
    pub fn play(&mut self, flight: &str, now_s: f64) -> Result<(), String> {
        let record: FlightRecord = serde_json::from_slice(flight.as_bytes())
            .map_err(|error| format!("invalid flight: {error}"))?;
        let manifest = self.manifest();
        let flight =
            Flight::of_record(&record, WorkingCrs::from_manifest(manifest), &manifest.coordinates);
        self.flights.playing = Some((flight.map_err(|error| error.to_string())?, now_s));
        Ok(())
    }

    /// Reports a frame, and whether nothing moves and nothing is being loaded any more.
    #[must_use]
    pub fn report(
        &self,
        counts: SceneCounts,
        rest: FrameRest,
        pixels_per_point: f64,
        now_s: f64,
    ) -> (Value, bool) {
        let Self { tiles, camera, flights, probe, .. } = self;
        let (drawn, missing) = (tiles.drawn.len(), tiles.missing);
        let (loading, is_full) = (tiles.loading(), tiles.is_full);
        let point_scale = self.manifest().point_scale;
        let metres_per_pixel = probe.middle_pixel_m.map(|pixel_m| pixel_m / point_scale);
        let is_playing = flights.is_playing();
        // A recording needs frames only while something moves.
        let is_busy = camera.navigator.is_moving() || is_playing || rest.is_busy;
        let has_all = missing == 0 || is_full || rest.troubled > 0;
        let is_settled = !is_busy && has_all && loading == rest.troubled;
        let share_there = drawn as f64 / (drawn + missing).max(1) as f64;
        let report = json!({
            "next": if is_busy { "now" } else { "asked" },
            "is_settled": is_settled,
            "view": ViewRecord::from_request(self.request()),
            "cursor": probe.cursor().map(|point| point.record()),
            "metres_per_pixel": metres_per_pixel,
            "metres_per_point": metres_per_pixel.map(|pixel_m| pixel_m * pixels_per_point),
            "mode": if camera.navigator.mode == Mode::Fly { "fly" } else { "map" },
            "tiles": { "drawn": drawn, "missing": missing, "loading": loading, "full": is_full },
            "triangles": counts.triangles,
            "segments": counts.segments,
            "gpu_bytes": tiles.bytes_of_budget(),
            "progress": if is_full { 1.0 } else { share_there },
            "recording_s": flights.recording_s(now_s),
            "is_playing": is_playing,
        });
        (report, is_settled)
    }
}

/// A colour as in CSS: `#rrggbb`.
fn css(color: Rgb) -> String {
    let [r, g, b] = color.map(|part| (part * 255.0).round() as u8);
    format!("#{r:02x}{g:02x}{b:02x}")
}
