//! What a frame does: tiles that have arrived, time, choice of tiles, drawing, and what the page is told.

use corniche_live::{MapScene, controls::Mode, request_of_view};
use corniche_viewer::{camera::Camera, lod::Quality, tiles::MapPackage as _};

use crate::map::{HURRY_S, Map, fineness_of, ground};
use crate::{
    canvas::Scene,
    flights::view_of_pose,
    problem::Problem,
    report::{FrameReport, GroundPlace, Next, Notice, TileCounts},
    settings::Settings,
    view_record::ViewRecord,
};
use corniche_live::controls::KnownGround as _;

/// While tiles are loaded anew, what was shown stays, but no longer than this.
const MOST_WAIT_S: f64 = 1.0;

impl Map {
    /// Does all of a frame.
    ///
    /// # Errors
    /// When the device is lost or cannot draw.
    pub(crate) fn next_frame(&mut self, now_s: f64) -> Result<FrameReport, Problem> {
        if self.canvas.gpu().is_lost() {
            return Err(Problem::new(
                "device-lost",
                "The graphics device was lost.",
                "The map is opened again.",
            ));
        }
        if let Some(what) = self.canvas.gpu().take_fault() {
            let is_memory = what.to_lowercase().contains("memory");
            let kind = if is_memory { "out-of-memory" } else { "other" };
            let advice = if is_memory {
                "Make the map smaller, take fewer samples a pixel, or close other pages."
            } else {
                "Reload the page."
            };
            return Err(Problem::new(
                kind,
                format!("The graphics device could not do its work: {what}"),
                advice,
            ));
        }
        for defect in self.tiles.take_arrivals() {
            self.notices.push(Notice::warning(defect));
        }
        for problem in self.loader.take_problems() {
            // Its tiles are those of another package now.
            if problem.kind == "changed" {
                return Err(problem);
            }
            let text = format!("Tiles are asked for again. {}", problem.message);
            self.notices.push(Notice::warning(text));
        }
        self.last_s = now_s;
        self.fly(now_s);
        self.place_again();
        let camera = {
            let ground = ground(
                &self.tiles,
                &self.settings,
                self.tileset.package.manifest(),
                self.height_range_m,
            );
            self.camera.advance(now_s, self.size_px, self.pixels_per_point as f32, &ground)
        };
        let is_under_way = self.change_tiles(&camera, now_s);
        let pose = self.pose();
        self.flights.note(now_s, pose);
        let is_there = self.tiles.missing() == 0 && !is_under_way;
        let is_waiting = self.anew_s.is_some_and(|begun_s| {
            !is_there
                && !self.tiles.is_full()
                && self.loader.troubled() == 0
                && now_s - begun_s < MOST_WAIT_S
        });
        if !is_waiting {
            self.anew_s = None;
        }
        let is_new = if is_waiting { false } else { self.draw(&camera, now_s)? };
        {
            let (scale, manifest) = (self.vertical_scale(), self.tileset.package.manifest());
            let ground = ground(&self.tiles, &self.settings, manifest, self.height_range_m);
            self.probe.look(&camera, self.cursor_px, is_new, &ground, scale, &manifest.coordinates);
        }
        Ok(self.report(&camera, is_under_way, now_s))
    }

    /// Moves the camera along a flight that is played.
    fn fly(&mut self, now_s: f64) {
        let Some(pose) = self.flights.pose(now_s) else { return };
        let scale = self.vertical_scale();
        let ground = ground(
            &self.tiles,
            &self.settings,
            self.tileset.package.manifest(),
            self.height_range_m,
        );
        let [x, y, _] = pose.eye_m;
        let ground_m = ground.height([x, y]).unwrap_or_else(|| ground.base_height());
        self.camera.jump_to(view_of_pose(pose, scale, ground_m));
    }

    /// Chooses tiles and brings them to the graphics card; tells whether the next frame may have more of this to do.
    fn change_tiles(&mut self, camera: &Camera, now_s: f64) -> bool {
        let ahead = self.camera.look_ahead(now_s, camera.size_px());
        let fineness = fineness_of(&self.settings);
        let manifest = self.tileset.package.manifest();
        let roads = self.settings.road_options();
        let quality =
            Quality::of_package(manifest, fineness, &self.style, roads, self.settings.exaggeration);
        let changes = self.tiles.choose(camera, ahead.as_ref(), quality);
        self.canvas.change(&changes.evict, &changes.upload);
        self.tiles.keep_ground(changes.upload);
        if self.tiles.take_first_time_full() {
            let text = "The memory for tiles is full: this view is coarser than asked.";
            self.notices.push(Notice::warning(text));
        }
        changes.is_under_way
    }

    /// Draws the map. Where the picture is too large for the adapter with so many samples, it is drawn with fewer.
    fn draw(&mut self, camera: &Camera, now_s: f64) -> Result<bool, Problem> {
        let is_hurrying = self.canvas.gpu().is_software()
            && self.camera.at_rest_s(now_s) < HURRY_S
            && self.canvas.shown_width_px() > 0;
        let most = camera
            .size_px()
            .into_iter()
            .max()
            .map_or(1, |side| (self.canvas.gpu().max_side_px() / side).max(1));
        let wanted = self.settings.samples.min(most);
        self.is_hurried = is_hurrying && wanted > 1;
        let samples = if self.is_hurried { 1 } else { wanted };
        let manifest = self.tileset.package.manifest();
        let map = MapScene {
            camera: self.camera.view().camera(camera.size_px()),
            style: self.style.clone(),
            roads: self.settings.pictures(),
            exaggeration: self.settings.exaggeration,
            point_scale: manifest.point_scale,
            height_range_m: self.height_range_m,
            cell_px: self.settings.cell_px.unwrap_or(f64::INFINITY),
            latitude_deg: manifest.wgs84_bounds.center()[1],
            wireframe: self.settings.edges(),
            drawn: self.tiles.drawn().to_vec(),
            samples_per_side: samples,
        };
        let Settings { compare, divider, .. } = self.settings;
        self.canvas.draw(&Scene { map, compare, divider })
    }

    fn report(&mut self, camera: &Camera, is_under_way: bool, now_s: f64) -> FrameReport {
        let manifest = self.tileset.package.manifest();
        let scale = self.vertical_scale();
        let place = {
            let ground = ground(&self.tiles, &self.settings, manifest, self.height_range_m);
            ViewRecord::of(request_of_view(
                &self.camera.view(),
                &ground,
                scale,
                manifest,
                camera.size_px(),
            ))
        };
        let point_scale = manifest.point_scale;
        let cursor = self.probe.cursor().map(|point| {
            let [lon, lat] = point.lon_lat_deg;
            GroundPlace { lon, lat, height: point.at_m[2] }
        });
        let metres_per_pixel = self.probe.middle_pixel_m().map(|pixel_m| pixel_m / point_scale);
        let tiles = TileCounts {
            drawn: self.tiles.drawn().len(),
            missing: self.tiles.missing(),
            loading: self.tiles.loading(),
            full: self.tiles.is_full(),
        };
        // Nothing is to be waited for from a server that gives no tiles.
        let troubled = self.loader.troubled();
        let is_moving = self.camera.is_moving() || self.flights.is_playing();
        // A recording needs frames only while something moves; a picture that was drawn in a hurry is drawn again at rest.
        let is_busy = is_moving || is_under_way || self.is_hurried || self.anew_s.is_some();
        let traffic = self.tileset.package.package().source().traffic();
        let (counts, [used, most]) = (self.canvas.counts(), self.tiles.bytes_of_budget());
        let wanted = (tiles.drawn + tiles.missing).max(1) as f64;
        let is_settled = !is_busy
            && (tiles.missing == 0 || tiles.full || troubled > 0)
            && tiles.loading == troubled;
        if is_settled {
            self.placed = None;
            self.loader.end_foresight();
        }
        FrameReport {
            next: if is_busy { Next::Now } else { Next::Asked },
            is_settled,
            view: place,
            cursor,
            metres_per_pixel,
            metres_per_point: metres_per_pixel.map(|pixel_m| pixel_m * self.pixels_per_point),
            mode: if self.camera.mode() == Mode::Fly { "fly" } else { "map" },
            tiles,
            triangles: counts.triangles,
            segments: counts.segments,
            gpu_bytes: [used, most],
            requests: traffic.requests,
            bytes: traffic.bytes,
            progress: if tiles.full { 1.0 } else { tiles.drawn as f64 / wanted },
            recording_s: self.flights.recording_s(now_s),
            is_playing: self.flights.is_playing(),
            notices: std::mem::take(&mut self.notices),
        }
    }
}
