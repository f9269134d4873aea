//! What outlasts a frame: flights, pictures, times and the trace.

use std::path::PathBuf;

use corniche_viewer::{draw_attribution, flight::Pose, gpu::ReadBackError};
use egui_wgpu::ScreenDescriptor;

use super::App;
use crate::{WindowError, canvas::Canvas, facts::Shot, shots::NotSaved, trace::TraceLine, words};

impl App {
    /// The window closes: saves what is being recorded and waits for what is being written. Returns what became of it, for
    /// there is no panel any more to show it.
    pub(crate) fn end(&mut self, now_s: f64) -> Vec<Result<PathBuf, NotSaved>> {
        let mut saved: Vec<_> = self.save_recording(now_s).err().into_iter().map(Err).collect();
        saved.extend(self.shots.finish());
        saved
    }

    pub(super) fn stop_recording(&mut self, now_s: f64) {
        if let Err(lost) = self.save_recording(now_s) {
            self.notice(words::with_causes(&lost));
        }
    }

    /// Fails when something was being recorded and there is nothing to save of it.
    fn save_recording(&mut self, now_s: f64) -> Result<(), NotSaved> {
        let Some(recorder) = self.recorder.take() else { return Ok(()) };
        let text = recorder.finish(now_s)?.to_text(&self.source.manifest().crs)?;
        self.shots.save_flight(text);
        Ok(())
    }

    pub(super) fn take_shots(
        &mut self,
        canvas: &mut Canvas,
        primitives: &[egui::ClippedPrimitive],
        screen: &ScreenDescriptor,
    ) -> Result<(), WindowError> {
        // What was asked for in this frame is drawn in full in the next.
        let is_full = canvas.is_full();
        for shot in std::mem::take(&mut self.wanted) {
            if !is_full {
                self.wanted.push(shot);
                continue;
            }
            let read = match shot {
                Shot::Map => canvas.read_map(self.settings.divider_share).map(|mut picture| {
                    draw_attribution(&mut picture, &self.source.manifest().attribution);
                    picture
                }),
                Shot::Window => canvas.read_window(primitives, screen),
            };
            match read {
                Ok(picture) => self.shots.save_picture(picture),
                Err(error) => self.survive(canvas, "no picture was taken", error)?,
            }
        }
        Ok(())
    }

    /// Asks the graphics card how long the last frames took.
    pub(super) fn take_times(&mut self, canvas: &mut Canvas) -> Result<(), WindowError> {
        match canvas.times() {
            Ok(times) => self.passes = times,
            Err(error) => {
                self.passes.clear();
                self.survive(canvas, "no pass was timed", error)?;
            }
        }
        Ok(())
    }

    /// What could not be read is said; only a device that is lost is an error.
    fn survive(
        &mut self,
        canvas: &Canvas,
        what: &str,
        error: ReadBackError,
    ) -> Result<(), WindowError> {
        if canvas.gpu().is_lost() {
            return Err(error.into());
        }
        self.notice(format!("{what}: {error}"));
        Ok(())
    }

    pub(super) fn write_trace(&mut self, pose: Pose, size_px: [u32; 2]) -> Result<(), WindowError> {
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
