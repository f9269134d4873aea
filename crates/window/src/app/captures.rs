//! Pictures that a person saves, from being asked for to being written.

use std::{collections::VecDeque, path::PathBuf};

use corniche_live::Shot;
use corniche_viewer::draw_attribution;
use egui_wgpu::ScreenDescriptor;
use image::RgbaImage;

use crate::{
    NotSaved, WindowError,
    canvas::{Canvas, Snapshot},
    files::FileWriter,
};

/// Pictures from being asked for to being saved.
pub(crate) struct Captures {
    pub(crate) files: FileWriter,
    /// Pictures that are asked for and not yet begun.
    pub(crate) wanted: Vec<Shot>,
    /// Pictures whose pixels are on their way back from the graphics card.
    pub(crate) developing: VecDeque<(Shot, Snapshot)>,
}

impl Captures {
    pub(crate) fn new(files: FileWriter) -> Self {
        Self { files, wanted: Vec::new(), developing: VecDeque::new() }
    }

    /// Begins the pictures that are asked for, and saves those whose pixels have come back, in the order in which they
    /// were asked for. Adds to `lost` why pictures were not taken, also when it fails.
    ///
    /// # Errors
    /// When the device is lost.
    pub(crate) fn take(
        &mut self,
        canvas: &mut Canvas,
        (primitives, screen): (&[egui::ClippedPrimitive], &ScreenDescriptor),
        divider_share: f32,
        credits: &[String],
        lost: &mut Vec<NotSaved>,
    ) -> Result<(), WindowError> {
        // What is asked for in this frame is drawn in full in the next one.
        if canvas.is_full() {
            for shot in std::mem::take(&mut self.wanted) {
                let snapshot = match shot {
                    Shot::Map => canvas.snap_map(divider_share),
                    Shot::Window => Some(canvas.snap_window(primitives, screen)),
                };
                match snapshot {
                    Some(snapshot) => self.developing.push_back((shot, snapshot)),
                    None => lost.push(NotSaved::Untaken),
                }
            }
        }
        while let Some((_, snapshot)) = self.developing.front_mut() {
            match snapshot.pixels.has_arrived(canvas.gpu()) {
                Ok(false) => break,
                Ok(true) => {}
                // The caller makes everything on the device again, and then `lose_device` is called.
                Err(error) if canvas.gpu().is_lost() => return Err(error.into()),
                Err(error) => {
                    // It is not known which of the pictures failed.
                    self.developing.clear();
                    lost.push(error.into());
                    break;
                }
            }
            let Some((shot, snapshot)) = self.developing.pop_front() else { break };
            match snapshot.into_image(canvas.gpu()) {
                Ok(picture) => self.save(shot, picture, credits),
                Err(error) => lost.push(error.into()),
            }
        }
        Ok(())
    }

    fn save(&mut self, shot: Shot, mut picture: RgbaImage, credits: &[String]) {
        // A picture of the window shows the credits already.
        if shot == Shot::Map {
            draw_attribution(&mut picture, credits);
        }
        self.files.save_picture(picture);
    }

    /// The graphics device is lost, and with it the pictures that were being taken: `Some` if there were any.
    pub(crate) fn lose_device(&mut self) -> Option<NotSaved> {
        let had_some = !self.developing.is_empty();
        self.developing.clear();
        had_some.then_some(NotSaved::DeviceLost)
    }

    /// The window closes: waits for the pictures that are being taken and written. Returns what
    /// became of them, for there is no panel any more to show it.
    pub(crate) fn end(
        &mut self,
        canvas: &Canvas,
        divider_share: f32,
        credits: &[String],
    ) -> Vec<Result<PathBuf, NotSaved>> {
        let mut saved = Vec::new();
        for shot in std::mem::take(&mut self.wanted) {
            // The map is there. The panel is not: it is laid out in frames only, and there will be none.
            match canvas.snap_map(divider_share) {
                Some(snapshot) if shot == Shot::Map && canvas.is_full() => {
                    self.developing.push_back((shot, snapshot));
                }
                _ => saved.push(Err(NotSaved::Untaken)),
            }
        }
        for (shot, snapshot) in std::mem::take(&mut self.developing) {
            match snapshot.into_image(canvas.gpu()) {
                Ok(picture) => self.save(shot, picture, credits),
                Err(error) => saved.push(Err(error.into())),
            }
        }
        saved.extend(self.files.finish());
        saved
    }
}

#[cfg(test)]
#[path = "captures_tests.rs"]
mod tests;
