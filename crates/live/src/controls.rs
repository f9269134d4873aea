//! Controls that move the camera: `MapLibre`'s controls and a fly mode, as pure functions of inputs
//! and time.
//!
//! ```text
//!  left drag                pan; the ground grabbed stays under the cursor
//!  right drag, Ctrl + left  turn (sideways) and tilt (up, down) about the middle of the picture
//!  middle drag              turn and tilt about the ground grabbed
//!  wheel                    zoom at the cursor; in fly mode: speed
//!  double click             zoom in at the cursor; with Shift out
//!  arrows                   pan; with Shift turn and tilt
//!  + −                      zoom by a level; with Shift by two
//!  two fingers              zoom (apart, together) and turn; tilt (both up or down)
//!  W A S D, Q E             fly mode: ahead, left, back, right, down, up; with Shift fast
//! ```
//!
//! Differences from `MapLibre`: there is no box zoom (Shift and drag pans). Two fingers zoom and
//! rotate at once, as soon as it is clear that they do not tilt. A notch of the wheel is a third of
//! a level, whatever size the system reports for it; in `MapLibre` it is about a sixth. + and −
//! zoom by one level from the current zoom, not to the next whole level: no level is special here.
//! A double click acts on the second press of the button. The largest tilt is 85°, in `MapLibre`
//! usually 60°. A drag or a zoom keeps a point of the terrain under the cursor. `MapLibre` has no
//! action for the middle button.
//!
//! This module knows no window, tile or clock: times are arguments, and heights come from a
//! [`KnownGround`]. All positions are in world space: the working CRS, with heights times the
//! vertical scale.

mod bounded_view;
mod fingers;
mod flying;
mod input;
mod movement;
mod navigator;
mod options;
mod sight;
mod view;

pub use self::{
    input::{Button, CameraKey, Input, Modifiers},
    navigator::Navigator,
    options::{CameraLimits, Mode},
    view::{CameraView, KnownGround},
};
