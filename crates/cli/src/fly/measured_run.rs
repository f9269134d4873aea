//! One measured flight, frame by frame.

use corniche_viewer::{Detail, FrameRecord};

use crate::args::{DETAILS, Roads, word_of};

/// One flight with one method and one choice of tiles.
pub(crate) struct MeasuredRun {
    pub lod: Detail,
    pub roads: Roads,
    pub frames: Vec<FrameRecord>,
}

impl MeasuredRun {
    /// Its two words on the command line: how much of the ground is drawn, and how roads are drawn.
    pub(crate) fn words(&self) -> [&'static str; 2] {
        [word_of(&DETAILS, &self.lod), self.roads.word()]
    }

    pub(crate) fn name(&self) -> String {
        self.words().join(", roads ")
    }

    /// A warning if figures or images show less than requested.
    pub(crate) fn doubt(&self) -> Option<String> {
        if self.frames.iter().all(|frame| frame.triangles == 0) {
            return Some(
                "no frame shows any ground. Check that the flight path belongs to this package"
                    .to_owned(),
            );
        }
        let coarse = self.frames.iter().filter(|frame| frame.tiles_missing > 0).count();
        (coarse > 0).then(|| {
            format!(
                "{coarse} of {} frames are coarser than requested, because their tiles were not loaded in time. Use more frames, or \
                 --lod culled, which waits for all tiles",
                self.frames.len()
            )
        })
    }

    /// The frames that count for figures: all but the first, which waits for its tiles and for the
    /// driver's shader compiler.
    pub(crate) fn counted(&self) -> &[FrameRecord] {
        self.frames.get(1..).unwrap_or_default()
    }
}

#[cfg(test)]
#[path = "measured_run_tests.rs"]
pub(crate) mod tests;
