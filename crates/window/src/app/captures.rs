//! Images that the user saves, from the request to the file.

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

/// Images from the request to the file.
pub(crate) struct Captures {
    pub(crate) files: FileWriter,
    /// Images that are requested and not started yet.
    pub(crate) wanted: Vec<Shot>,
    /// Images whose pixels are being read back from the GPU.
    pub(crate) developing: VecDeque<(Shot, Snapshot)>,
}

impl Captures {
    pub(crate) fn new(files: FileWriter) -> Self {
        Self { files, wanted: Vec::new(), developing: VecDeque::new() }
    }

    /// Starts the requested images, and saves those whose pixels have arrived, in the order of the
    /// requests. Adds the reasons for images that were not taken to `lost`, even if it fails.
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
        // An image requested in this frame is drawn in full resolution in the next one.
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
                // The caller recreates everything on the device, and then calls `lose_device`.
                Err(error) if canvas.gpu().is_lost() => return Err(error.into()),
                Err(error) => {
                    // It is unknown which of the images failed.
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
        // An image of the window shows the attribution already.
        if shot == Shot::Map {
            draw_attribution(&mut picture, credits);
        }
        self.files.save_picture(picture);
    }

    /// Handles the loss of the graphics device and of the images being taken: `Some` if there were
    /// any.
    pub(crate) fn lose_device(&mut self) -> Option<NotSaved> {
        let had_some = !self.developing.is_empty();
        self.developing.clear();
        had_some.then_some(NotSaved::DeviceLost)
    }

    /// Closes the window: waits for images being taken and written. Returns the results, because no
    /// panel can show them any more.
    pub(crate) fn end(
        &mut self,
        canvas: &Canvas,
        divider_share: f32,
        credits: &[String],
    ) -> Vec<Result<PathBuf, NotSaved>> {
        let mut saved = Vec::new();
        for shot in std::mem::take(&mut self.wanted) {
            // The map can still be read. The panel cannot: it is laid out in frames only, and there
            // will be none.
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
