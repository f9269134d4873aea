//! What outlasts a frame: flights, pictures, times and the trace.

use std::path::PathBuf;

use corniche_viewer::{
    draw_attribution,
    flight::{Pose, WorkingCrs},
};
use egui_wgpu::ScreenDescriptor;
use image::RgbaImage;

use super::App;
use crate::{WindowError, canvas::Canvas, facts::Shot, shots::NotSaved, trace::TraceLine, words};

impl App {
    /// The window closes: saves what is being recorded and waits for what is being taken and written. Returns what became
    /// of it, for there is no panel any more to show it.
    pub(crate) fn end(&mut self, canvas: &Canvas, now_s: f64) -> Vec<Result<PathBuf, NotSaved>> {
        let mut saved: Vec<_> = self.save_recording(now_s).err().into_iter().map(Err).collect();
        for shot in std::mem::take(&mut self.wanted) {
            // The map is there; the panel is laid out in frames alone, and there will be none.
            match canvas.snap_map(self.settings.divider_share) {
                Some(snapshot) if shot == Shot::Map && canvas.is_full() => {
                    self.developing.push_back((shot, snapshot));
                }
                _ => saved.push(Err(NotSaved::Untaken)),
            }
        }
        for (shot, snapshot) in std::mem::take(&mut self.developing) {
            match snapshot.into_image(canvas.gpu()) {
                Ok(picture) => self.save_picture(shot, picture),
                Err(error) => saved.push(Err(error.into())),
            }
        }
        saved.extend(self.shots.finish());
        saved
    }

    pub(crate) fn stop_recording(&mut self, now_s: f64) {
        if let Err(lost) = self.save_recording(now_s) {
            self.notice(words::with_causes(&lost));
        }
    }

    /// Fails when something was being recorded and there is nothing to save of it.
    fn save_recording(&mut self, now_s: f64) -> Result<(), NotSaved> {
        let Some(recorder) = self.recorder.take() else { return Ok(()) };
        let text = recorder.finish(now_s)?.to_text(WorkingCrs::of(self.source.manifest()))?;
        self.shots.save_flight(text);
        Ok(())
    }

    /// Begins the pictures that are wanted, and saves those whose pixels have come back, in the order of the wishes.
    pub(crate) fn take_shots(
        &mut self,
        canvas: &mut Canvas,
        primitives: &[egui::ClippedPrimitive],
        screen: &ScreenDescriptor,
    ) -> Result<(), WindowError> {
        // What was asked for in this frame is drawn in full in the next.
        if canvas.is_full() {
            for shot in std::mem::take(&mut self.wanted) {
                let snapshot = match shot {
                    Shot::Map => canvas.snap_map(self.settings.divider_share),
                    Shot::Window => Some(canvas.snap_window(primitives, screen)),
                };
                match snapshot {
                    Some(snapshot) => self.developing.push_back((shot, snapshot)),
                    None => self.notice(words::with_causes(&NotSaved::Untaken)),
                }
            }
        }
        while let Some((_, snapshot)) = self.developing.front_mut() {
            match snapshot.has_arrived(canvas.gpu()) {
                Ok(false) => break,
                Ok(true) => {}
                // What becomes of them is told by whoever makes everything anew, or fails to.
                Err(error) if canvas.gpu().is_lost() => return Err(error.into()),
                Err(error) => {
                    // Nobody knows to which of them it happened.
                    self.developing.clear();
                    self.notice(words::with_causes(&NotSaved::from(error)));
                    break;
                }
            }
            let Some((shot, snapshot)) = self.developing.pop_front() else { break };
            match snapshot.into_image(canvas.gpu()) {
                Ok(picture) => self.save_picture(shot, picture),
                Err(error) => self.notice(words::with_causes(&NotSaved::from(error))),
            }
        }
        Ok(())
    }

    fn save_picture(&mut self, shot: Shot, mut picture: RgbaImage) {
        // A picture of the window shows them already.
        if shot == Shot::Map {
            draw_attribution(&mut picture, &self.source.manifest().attribution);
        }
        self.shots.save_picture(picture);
    }

    /// The pictures that were being taken went with the device.
    pub(crate) fn forget_pictures(&mut self) {
        if !self.developing.is_empty() {
            self.developing.clear();
            self.notice(words::with_causes(&NotSaved::DeviceLost));
        }
    }

    /// Asks the graphics card how long the last frames took.
    pub(crate) fn take_times(&mut self, canvas: &mut Canvas) -> Result<(), WindowError> {
        match canvas.times() {
            Ok(times) => self.passes = times,
            Err(error) if canvas.gpu().is_lost() => return Err(error.into()),
            Err(error) => {
                self.passes.clear();
                self.notice(format!("no pass was timed: {error}"));
            }
        }
        Ok(())
    }

    pub(crate) fn write_trace(&mut self, pose: Pose, size_px: [u32; 2]) -> Result<(), WindowError> {
        let line = TraceLine {
            frame: self.frame,
            cursor_px: self.cursor_px,
            ground_m: self.seen.cursor.map(|(point, _)| point.at_m),
            pixel_m: self.seen.cursor.map(|(_, pixel_m)| pixel_m),
            pose,
            tiles: self.tiles.drawn().len(),
            missing: self.tiles.missing(),
            loading: self.tiles.loading(),
            is_moving: self.navigator.is_moving(),
            size_px,
        };
        let Some(trace) = &mut self.trace else { return Ok(()) };
        trace.write(line).map_err(|source| WindowError::Trace { source })
    }
}
