//! The window without a window: what it shows, what inputs do to it, what a frame has to do.
//!
//! A frame, in this order: tiles that have arrived, time, choice of tiles, map, panel. What the panel changes is seen in
//! the next frame, which it asks for.

mod keep;
mod start;

pub(crate) use self::start::Package;

use std::{collections::VecDeque, sync::Arc};

use corniche_styles::Rgb;
use corniche_viewer::{
    RoadMethod,
    camera::Camera,
    flight::{Pose, WorkingCrs},
    gpu::{GpuError, PassTimes, Wireframe},
    lod::Quality,
    tiles::PackageSource,
};
use egui::{Rect, pos2};
use egui_wgpu::ScreenDescriptor;
use glam::DVec2;

use crate::{
    NamedStyle, Reload, WindowError,
    canvas::{Canvas, Drew, Scene, Snapshot},
    clicks::{Click, Clicks},
    controls::{Button, Ground as _, Input, Modifiers, Navigator, View},
    facts::{Command, Facts, GroundPoint, Shot},
    frame_times::FrameTimes,
    notices::Notices,
    panel::{self, Answer},
    recorder::Recorder,
    settings::{Refinement, Settings},
    shots::Shots,
    tiles::{Changes, ShownGround, Tiles},
    trace::Trace,
    words,
};

/// The style's file is asked after so often.
const RELOAD_S: f64 = 1.0;
/// For so long after the camera moved the processor, if it draws, draws coarsely.
const HURRY_S: f64 = 0.15;
/// Tiles are loaded in advance for where the camera will be after this time.
const AHEAD_S: f64 = 0.5;
/// So long after a frame its passes' times are asked for, if nothing else makes a frame before.
const CLOCK_S: f64 = 0.1;
/// Pixels that are on their way back are asked for so often.
const PICTURE_S: f64 = 0.02;
/// A mouse that pauses for so long in the midst of a drag rests.
const REST_S: f64 = 0.5;
/// A panel that wishes to be painted again later than this does not wish it; its toolkit says so with ages.
const LONGEST_WISH_S: f64 = 3600.0;
/// How a notice begins that a style's file cannot be used.
const STYLE_STAYS: &str = "the style stays as it was: ";

/// The window's state.
pub(crate) struct App {
    source: Arc<PackageSource>,
    height_range_m: [f64; 2],
    tiles: Tiles,
    navigator: Navigator,
    settings: Settings,
    styles: Vec<NamedStyle>,
    style_names: Vec<String>,
    reload: Option<Reload>,
    reloaded_s: f64,
    adapter: String,
    is_software: bool,
    frame_times: FrameTimes,
    /// When the last frame began, if it drew the map and another one was to follow, and how much later at most.
    drawing_since_s: Option<(f64, f64)>,
    passes: Vec<(RoadMethod, PassTimes)>,
    recorder: Option<Recorder>,
    shots: Shots,
    wanted: Vec<Shot>,
    /// Pictures whose pixels are on their way back from the graphics card.
    developing: VecDeque<(Shot, Snapshot)>,
    notices: Notices,
    /// Whether it was said that the graphics memory allowed is full.
    was_full: bool,
    trace: Option<Trace>,
    frame: u64,
    clicks: Clicks,
    cursor_px: Option<DVec2>,
    is_dragging: bool,
    /// Where the mouse is the panel's, points.
    occupied: Vec<Rect>,
    pixels_per_point: f32,
    last_view: Option<(f64, View)>,
    moved_s: f64,
    seen: Seen,
}

/// What rays into the scene found; kept while neither the scene nor the cursor changes.
#[derive(Default)]
struct Seen {
    cursor_px: Option<DVec2>,
    /// The ground under the cursor, and the side of a pixel there in world metres.
    cursor: Option<(GroundPoint, f64)>,
    /// Side of a pixel in the middle of the window, world metres.
    middle_pixel_m: Option<f64>,
}

/// What a frame is given. Times are seconds of one clock.
pub(crate) struct FrameInput {
    pub(crate) now_s: f64,
    pub(crate) size_px: [u32; 2],
    pub(crate) pixels_per_point: f32,
    pub(crate) ui: egui::RawInput,
}

/// When the next frame is due.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Redraw {
    /// As soon as may be.
    Now,
    /// At a time, unless something happens before.
    At(f64),
    /// When something happens.
    Asked,
}

/// What the window system has to do.
pub(crate) struct Frame {
    /// The window's contents, to be painted with [`Canvas::paint`].
    pub(crate) primitives: Vec<egui::ClippedPrimitive>,
    pub(crate) screen: ScreenDescriptor,
    /// For [`Canvas::free_textures`], when it is painted.
    pub(crate) unused_textures: Vec<egui::TextureId>,
    /// Cursor and the like.
    pub(crate) platform: egui::PlatformOutput,
    pub(crate) redraw: Redraw,
}

impl App {
    /// Whether the mouse at this pixel of the window is the map's, not the panel's.
    pub(crate) fn is_map(&self, ui: &egui::Context, at_px: DVec2) -> bool {
        let at = self.in_points(at_px);
        let at = pos2(at.x as f32, at.y as f32);
        // Lists that hang from the panel lie in layers of their own.
        let is_in_front =
            ui.layer_id_at(at).is_some_and(|layer| layer.order != egui::Order::Background);
        !is_in_front && !self.occupied.iter().any(|rect| rect.contains(at))
    }

    /// A button of the mouse goes down on the map.
    pub(crate) fn press(&mut self, button: Button, at_px: DVec2, modifiers: Modifiers, now_s: f64) {
        let input = if self.clicks_at(button, at_px, now_s) == Click::Double {
            Input::DoubleClick { at_px, modifiers }
        } else {
            self.is_dragging = true;
            Input::Press { button, at_px, modifiers }
        };
        self.input(&input, now_s);
    }

    fn in_points(&self, at_px: DVec2) -> DVec2 {
        at_px / f64::from(self.pixels_per_point)
    }

    fn clicks_at(&mut self, button: Button, at_px: DVec2, now_s: f64) -> Click {
        match button {
            Button::Left => self.clicks.press(self.in_points(at_px), now_s),
            _ => Click::Single,
        }
    }

    /// Something else that moves the camera.
    pub(crate) fn input(&mut self, input: &Input, now_s: f64) {
        match input {
            Input::Move { at_px } => self.clicks.move_to(self.in_points(*at_px)),
            Input::Release { button } => {
                self.is_dragging = false;
                if *button == Button::Left {
                    self.clicks.release();
                }
            }
            Input::LetGo => {
                self.is_dragging = false;
                self.clicks.let_go();
            }
            _ => {}
        }
        let ground = ground(&self.tiles, &self.settings, &self.source, self.height_range_m);
        self.navigator.handle(input, now_s, &ground);
    }

    /// The cursor is here; `None` outside the window.
    pub(crate) fn point_at(&mut self, cursor_px: Option<DVec2>) {
        self.cursor_px = cursor_px;
    }

    /// A key asks for this.
    pub(crate) fn command(&mut self, command: Command, now_s: f64) {
        match command {
            Command::NorthUp => self.input(&Input::NorthUp, now_s),
            Command::Reset => self.input(&Input::Reset, now_s),
            Command::ToggleFly => self.input(&Input::ToggleFly, now_s),
            Command::Take(shot) => self.wanted.push(shot),
            Command::ToggleRecording if self.recorder.is_some() => self.stop_recording(now_s),
            Command::ToggleRecording | Command::StartRecording => {
                self.recorder = Some(Recorder::new(now_s, self.pose()));
            }
            Command::StopRecording => self.stop_recording(now_s),
            Command::Dismiss(place) => {
                self.notices.dismiss(place);
            }
        }
    }

    /// Shows the panel, or hides it.
    pub(crate) fn toggle_panel(&mut self) {
        self.settings.is_panel_open = !self.settings.is_panel_open;
    }

    /// Everything on the graphics card is gone.
    pub(crate) fn begin_again(&mut self, canvas: &Canvas) {
        self.tiles.begin_again();
        // A choice that stays as it is would stay empty.
        self.settings.refinement = Refinement::Live;
        canvas.gpu().adapter_name().clone_into(&mut self.adapter);
        self.is_software = canvas.gpu().is_software();
        self.passes.clear();
        self.forget_pictures();
        self.notice("the graphics device was lost; everything was loaded again".to_owned());
    }

    fn notice(&mut self, words: String) {
        self.notices.warn(words);
    }

    fn vertical_scale(&self) -> f64 {
        self.settings.exaggeration * self.source.manifest().point_scale
    }

    /// The camera as flights have it.
    fn pose(&self) -> Pose {
        let View { eye_in_world: eye, orientation, .. } = self.navigator.view();
        Pose { eye_m: [eye.x, eye.y, eye.z / self.vertical_scale()], orientation }
    }

    /// Everything a frame does, up to its being painted.
    ///
    /// # Errors
    /// When the pictures cannot be drawn or the trace cannot be written.
    pub(crate) fn frame(
        &mut self,
        canvas: &mut Canvas,
        ui: &egui::Context,
        input: FrameInput,
    ) -> Result<Frame, WindowError> {
        let FrameInput { now_s, size_px, pixels_per_point, ui: raw } = input;
        self.frame += 1;
        self.pixels_per_point = pixels_per_point;
        self.take_news(now_s);
        self.navigator.resize(size_px);
        self.navigator.set_pixels_per_point(f64::from(pixels_per_point));
        let ground = ground(&self.tiles, &self.settings, &self.source, self.height_range_m);
        self.navigator.advance(now_s, &ground);
        let camera = self.navigator.camera();
        let changes = self.choose_tiles(&camera, now_s);
        canvas.change(&changes);
        let is_under_way = changes.is_under_way;
        self.tiles.keep_ground(changes.upload);
        self.tell_if_full();
        let pose = self.pose();
        if let Some(recorder) = &mut self.recorder {
            recorder.note(now_s, pose);
        }
        let drew = self.draw(canvas, &camera, now_s)?;
        self.look(&camera, drew.is_new);
        self.take_times(canvas)?;

        let before = self.settings.clone();
        let mut answer = Answer::default();
        let mut output = self.lay_out(canvas, ui, raw, drew, now_s, &mut answer);
        for command in answer.commands {
            self.command(command, now_s);
        }
        self.occupied = answer.occupied;
        let is_changed = self.settings != before;
        self.follow_exaggeration(&before);

        let screen = ScreenDescriptor { size_in_pixels: size_px, pixels_per_point };
        let unused_textures = canvas.take_textures(std::mem::take(&mut output.textures_delta));
        let primitives = ui.tessellate(std::mem::take(&mut output.shapes), pixels_per_point);
        self.take_shots(canvas, &primitives, &screen)?;
        self.write_trace(pose, size_px)?;

        let is_busy = self.navigator.is_moving() || is_under_way || !self.wanted.is_empty();
        self.time(now_s, drew.is_new, is_busy);
        let wishes = output.viewport_output.values().map(|viewport| viewport.repaint_delay);
        let wish_s = wishes.map(|delay| delay.as_secs_f64()).fold(f64::INFINITY, f64::min);
        let redraw = if is_busy || is_changed || wish_s <= 0.0 {
            Redraw::Now
        } else {
            let hurry_s = self.is_hurrying(now_s).then_some(HURRY_S);
            // A little later the graphics card tells how long this frame took.
            let clock_s = canvas.is_timing().then_some(CLOCK_S);
            let wish_s = (wish_s <= LONGEST_WISH_S).then_some(wish_s);
            let picture_s = (!self.developing.is_empty()).then_some(PICTURE_S);
            let rests_s = [hurry_s, clock_s, picture_s, wish_s, self.words_change_in_s(now_s)];
            let soonest_s = rests_s.into_iter().flatten().reduce(f64::min);
            soonest_s.map_or(Redraw::Asked, |rest_s| Redraw::At(now_s + rest_s))
        };
        Ok(Frame { primitives, screen, unused_textures, platform: output.platform_output, redraw })
    }

    /// When a notice goes or a recording is a second longer, though nothing moves.
    fn words_change_in_s(&self, now_s: f64) -> Option<f64> {
        let second_s = self.recorder.as_ref().map(|recorder| {
            let duration_s = recorder.duration_s(now_s);
            duration_s.floor() + 1.0 - duration_s
        });
        let end_s = self.notices.next_end_s().map(|until_s| (until_s - now_s).max(0.0));
        [second_s, end_s].into_iter().flatten().reduce(f64::min)
    }

    /// When the style's file is to be looked at.
    pub(crate) fn reload_due_s(&self) -> Option<f64> {
        self.reload.as_ref().map(|_| self.reloaded_s + RELOAD_S)
    }

    /// Looks at the style's file, if it is time; tells whether there is something to show.
    pub(crate) fn reload(&mut self, now_s: f64) -> bool {
        if self.reload_due_s().is_none_or(|due_s| due_s > now_s) {
            return false;
        }
        self.reloaded_s = now_s;
        match self.reload.as_mut().and_then(|reload| reload()) {
            None => return false,
            Some(Ok(style)) => {
                if let Some(first) = self.styles.first_mut() {
                    first.style = style;
                }
                // What was wrong with it is wrong no more.
                self.notices.retract(STYLE_STAYS);
                self.notices.tell("the style was loaded again".to_owned(), now_s);
            }
            Some(Err(why)) => {
                self.notices.retract(STYLE_STAYS);
                self.notices.warn(format!("{STYLE_STAYS}{why}"));
            }
        }
        true
    }

    /// The graphics device could not do something.
    pub(crate) fn fault(&mut self, what: &str) {
        self.notice(format!("the graphics device could not do its work: {what}"));
    }

    fn take_news(&mut self, now_s: f64) {
        self.notices.expire(now_s);
        for defect in self.tiles.take_arrivals() {
            self.notice(format!("{defect}; it is shown without its ground"));
        }
        for saved in self.shots.news() {
            // That something could not be saved must be seen; where a file is may be asked at once.
            match saved {
                Ok(path) => self.notices.tell(format!("saved {}", path.display()), now_s),
                Err(lost) => self.notices.warn(words::with_causes(&lost)),
            }
        }
    }

    /// Once: after that the line of positions says so while it is so.
    fn tell_if_full(&mut self) {
        if self.tiles.is_full() && !std::mem::replace(&mut self.was_full, true) {
            self.notice(
                "the graphics memory allowed is full: this view is drawn more coarsely than asked; allow more with \
                 --gpu-memory"
                    .to_owned(),
            );
        }
    }

    fn choose_tiles(&mut self, camera: &Camera, now_s: f64) -> Changes {
        let view = self.navigator.view();
        let ahead = self.last_view.and_then(|(last_s, last)| {
            let passed_s = now_s - last_s;
            let way = view.eye_in_world - last.eye_in_world;
            let is_moving = passed_s > 0.0 && passed_s < AHEAD_S && way.length() > 0.0;
            is_moving.then(|| {
                let eye_in_world = view.eye_in_world + way * (AHEAD_S / passed_s);
                View { eye_in_world, ..view }.camera(camera.size_px())
            })
        });
        if self.last_view.is_some_and(|(_, last)| last != view) {
            self.moved_s = now_s;
        }
        self.last_view = Some((now_s, view));
        let quality = Quality {
            screen_space_error_px: self.settings.screen_space_error_px,
            vertical_scale: self.vertical_scale(),
        };
        match self.settings.refinement {
            Refinement::Live => self.tiles.choose(camera, ahead.as_ref(), quality),
            Refinement::Frozen => Changes::default(),
        }
    }

    fn is_hurrying(&self, now_s: f64) -> bool {
        self.is_software && now_s - self.moved_s < HURRY_S && self.frame > 1
    }

    /// Draws the map; where it is too large for the adapter with its samples, with fewer. With one it never is: the window
    /// is no larger.
    fn draw(
        &mut self,
        canvas: &mut Canvas,
        camera: &Camera,
        now_s: f64,
    ) -> Result<Drew, WindowError> {
        let mut scene = self.scene(camera, now_s);
        let wanted = scene.samples_per_side;
        let drew = loop {
            match canvas.draw(&scene) {
                Err(GpuError::TooLarge { .. }) if scene.samples_per_side > 1 => {
                    scene.samples_per_side -= 1;
                }
                drew => break drew?,
            }
        };
        let drawn = scene.samples_per_side;
        if drawn < wanted {
            self.notice(format!(
                "{wanted} × {wanted} samples a pixel are more than the adapter can draw in a window of this size; there \
                 are {drawn} × {drawn} now"
            ));
            self.settings.samples_per_side = drawn;
        }
        Ok(drew)
    }

    fn scene(&self, camera: &Camera, now_s: f64) -> Scene {
        let window_px = camera.size_px();
        // A picture that is to be saved is drawn in full.
        let is_coarse = self.is_hurrying(now_s) && self.wanted.is_empty();
        let (size_px, samples_per_side) = if is_coarse {
            (window_px.map(|side| side.div_ceil(2)), 1)
        } else {
            (window_px, self.settings.samples_per_side)
        };
        let style = &self.styles[self.settings.style.min(self.styles.len() - 1)].style;
        let shown = |is_shown| if is_shown { Wireframe::Shown } else { Wireframe::Hidden };
        Scene {
            camera: self.navigator.view().camera(size_px),
            window_px,
            style: self.settings.applied_to(style),
            roads: self.settings.compare.pictures(self.settings.roads),
            compare: self.settings.compare,
            exaggeration: self.settings.exaggeration,
            point_scale: self.source.manifest().point_scale,
            height_range_m: self.height_range_m,
            wireframe: shown(self.settings.is_wireframe),
            drawn: self.tiles.drawn().to_vec(),
            samples_per_side,
        }
    }

    /// Looks what is under the cursor and in the middle, where that may have changed.
    fn look(&mut self, camera: &Camera, is_new: bool) {
        let scale = self.vertical_scale();
        let ground = ground(&self.tiles, &self.settings, &self.source, self.height_range_m);
        let pixel_m = |at_px: DVec2| {
            let hit = ground.hit(camera.eye_in_world(), camera.ray_in_world(at_px))?;
            let (_, depth) = camera.project(hit)?;
            Some((hit, depth * camera.pixel_at_unit_depth_m()))
        };
        if is_new {
            let [width, height] = camera.size_px().map(f64::from);
            self.seen.middle_pixel_m =
                pixel_m(DVec2::new(width, height) / 2.0).map(|(_, pixel_m)| pixel_m);
        }
        if is_new || self.seen.cursor_px != self.cursor_px {
            let coordinates = &self.source.manifest().coordinates;
            self.seen.cursor = self.cursor_px.and_then(pixel_m).map(|(hit, pixel_m)| {
                let point = GroundPoint {
                    lon_lat_deg: coordinates.wgs84_from_working([hit.x, hit.y]),
                    at_m: [hit.x, hit.y, hit.z / scale],
                };
                (point, pixel_m)
            });
            self.seen.cursor_px = self.cursor_px;
        }
    }

    fn lay_out(
        &mut self,
        canvas: &Canvas,
        ui: &egui::Context,
        raw: egui::RawInput,
        drew: Drew,
        now_s: f64,
        answer: &mut Answer,
    ) -> egui::FullOutput {
        let manifest = self.source.manifest();
        let is_over_map = self.cursor_px.is_some_and(|at_px| self.is_map(ui, at_px));
        let style = &self.styles[self.settings.style.min(self.styles.len() - 1)].style;
        let road_colors: Vec<Rgb> = style.roads.iter().map(|road| road.color).collect();
        let counts = canvas.counts();
        let points = f64::from(self.pixels_per_point) / manifest.point_scale;
        let facts = Facts {
            adapter: &self.adapter,
            attribution: &manifest.attribution,
            crs: WorkingCrs::of(manifest),
            cursor: self.seen.cursor.filter(|_| is_over_map).map(|(point, _)| point),
            pose: self.pose(),
            metres_per_point: self.seen.middle_pixel_m.map(|pixel_m| pixel_m * points),
            mode: self.navigator.mode(),
            style_names: &self.style_names,
            road_colors: &road_colors,
            tiles_drawn: self.tiles.drawn().len(),
            tiles_missing: self.tiles.missing(),
            tiles_loading: self.tiles.loading(),
            is_full: self.tiles.is_full(),
            triangles: counts.triangles,
            segments: counts.segments,
            gpu_bytes: self.tiles.bytes_of_budget(),
            passes: &self.passes,
            frame_times: &self.frame_times,
            recording_s: self.recorder.as_ref().map(|recorder| recorder.duration_s(now_s)),
            notices: self.notices.all(),
        };
        let mut settings = self.settings.clone();
        let output = ui.run_ui(raw, |ui| {
            let shown = panel::show(ui, &mut settings, &facts, drew.pictures);
            // What was clicked in a first layout is not clicked in a second one.
            answer.commands.extend(shown.commands);
            answer.occupied = shown.occupied;
        });
        self.settings = settings;
        output
    }

    /// The camera keeps its place over the ground when heights are drawn otherwise.
    fn follow_exaggeration(&mut self, before: &Settings) {
        let factor = self.settings.exaggeration / before.exaggeration;
        if self.settings.exaggeration.to_bits() != before.exaggeration.to_bits() {
            let ground = ground(&self.tiles, before, &self.source, self.height_range_m);
            self.navigator.rescale_heights(factor, &ground);
        }
    }

    /// Only frames that follow one another without a rest tell how long a frame takes.
    fn time(&mut self, now_s: f64, is_new: bool, is_busy: bool) {
        if let Some((since_s, most_s)) = self.drawing_since_s
            && now_s - since_s <= most_s
        {
            self.frame_times.push((now_s - since_s) * 1e3);
        }
        // What is asked for at once begins as soon as the last frame is shown, however long that takes.
        let most_s = if is_busy { f64::INFINITY } else { REST_S };
        let is_one_of_many = is_new && (is_busy || self.is_dragging);
        self.drawing_since_s = is_one_of_many.then_some((now_s, most_s));
    }
}

fn ground<'a>(
    tiles: &'a Tiles,
    settings: &Settings,
    source: &PackageSource,
    [lowest_m, highest_m]: [f64; 2],
) -> ShownGround<'a> {
    let vertical_scale = settings.exaggeration * source.manifest().point_scale;
    tiles.ground(vertical_scale, f64::midpoint(lowest_m, highest_m))
}
