//! What moves the camera: `MapLibre`'s controls and a fly mode, as pure functions of inputs and time.
//!
//! ```text
//!  left drag                pan; the ground grabbed stays under the cursor
//!  right drag, Ctrl + left  turn (sideways) and tilt (up, down) about the middle of the picture
//!  middle drag              turn and tilt about the ground grabbed
//!  wheel                    zoom at the cursor; in fly mode: speed
//!  double click             zoom in at the cursor; with Shift out
//!  arrows, + −              pan, zoom; with Shift turn and tilt
//!  W A S D, Q E             fly mode: ahead, left, back, right, down, up; with Shift fast
//! ```
//!
//! Nothing here knows a window, a tile or a clock: times are handed in, ground is asked of a [`Ground`]. All positions
//! are in world space: the working CRS, heights times the vertical scale.

mod flying;
mod input;
mod navigator;
mod view;

pub use self::{
    input::{Button, Input, Key, KeyState, Modifiers},
    navigator::{Inertia, Limits, Mode, Navigator},
    view::{Ground, View},
};
