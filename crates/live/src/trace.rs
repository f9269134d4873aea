//! A diagnostic: a file with one line per frame. A script that reads it can wait until everything
//! is loaded, and check that the grabbed ground stays under the cursor.

use std::io;

use corniche_viewer::flight::Pose;
use glam::DVec2;

use crate::session::Session;

/// The data of a frame in the trace.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TraceLine {
    /// The number of the frame, from 1.
    pub frame: u64,
    /// The cursor, pixels of the window; `None` outside.
    pub cursor_px: Option<DVec2>,
    /// The ground under the cursor: x and y in the working CRS, true height; `None` over sky and
    /// voids.
    pub ground_m: Option<[f64; 3]>,
    /// The side of a pixel there, in metres of the working CRS.
    pub pixel_m: Option<f64>,
    /// The camera.
    pub pose: Pose,
    /// The number of drawn tiles.
    pub tiles: usize,
    /// The number of tiles that the view needs and that are not on the GPU.
    pub missing: usize,
    /// The number of tiles being loaded.
    pub loading: usize,
    /// Whether the camera moves without input.
    pub is_moving: bool,
    /// Width and height of the window, pixels.
    pub size_px: [u32; 2],
}

/// The names of the columns.
const HEAD: &str = "frame,cursor_x_px,cursor_y_px,ground_x_m,ground_y_m,ground_height_m,pixel_m,eye_x_m,eye_y_m,\
                    eye_height_m,heading_deg,pitch_deg,tiles,missing,loading,moving,width_px,height_px\n";

impl TraceLine {
    /// The line of a session after the frame of this number, in a window of this size.
    #[must_use]
    pub fn from_session(session: &Session, frame: u64, size_px: [u32; 2]) -> Self {
        let Session { probe, camera, tiles, cursor_px, .. } = session;
        Self {
            frame,
            cursor_px: *cursor_px,
            ground_m: probe.cursor().map(|point| point.at_m),
            pixel_m: probe.cursor_pixel_m(),
            pose: session.pose(),
            tiles: tiles.drawn.len(),
            missing: tiles.missing,
            loading: tiles.loading(),
            is_moving: camera.navigator.is_moving(),
            size_px,
        }
    }

    fn to_text(self) -> String {
        let some = |value: Option<f64>, digits: usize| {
            value.map(|value| format!("{value:.digits$}")).unwrap_or_default()
        };
        let Pose { eye_m: [x, y, height_m], orientation } = self.pose;
        let ground = |axis: usize| some(self.ground_m.map(|ground_m| ground_m[axis]), 3);
        [
            self.frame.to_string(),
            some(self.cursor_px.map(|cursor| cursor.x), 2),
            some(self.cursor_px.map(|cursor| cursor.y), 2),
            ground(0),
            ground(1),
            ground(2),
            some(self.pixel_m, 6),
            some(Some(x), 3),
            some(Some(y), 3),
            some(Some(height_m), 3),
            some(Some(orientation.heading_deg), 4),
            some(Some(orientation.pitch_deg), 4),
            self.tiles.to_string(),
            self.missing.to_string(),
            self.loading.to_string(),
            u8::from(self.is_moving).to_string(),
            self.size_px[0].to_string(),
            self.size_px[1].to_string(),
        ]
        .join(",")
    }
}

/// The writer of the lines.
pub struct Trace {
    out: Box<dyn io::Write>,
}

impl Trace {
    /// Begins the trace with the names of the columns.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn begin(mut out: Box<dyn io::Write>) -> io::Result<Self> {
        out.write_all(HEAD.as_bytes())?;
        Ok(Self { out })
    }

    /// Writes a line in one piece: a reader of the file sees all of it or nothing.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn write(&mut self, line: TraceLine) -> io::Result<()> {
        self.out.write_all(format!("{}\n", line.to_text()).as_bytes())
    }
}

#[cfg(test)]
#[path = "trace_tests.rs"]
mod tests;
