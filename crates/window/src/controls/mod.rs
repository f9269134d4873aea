//! What moves the camera: `MapLibre`'s controls and a fly mode, as pure functions of inputs and time.
//!
//! ```text
//!  left drag                pan; the ground grabbed stays under the cursor
//!  right drag, Ctrl + left  turn (sideways) and tilt (up, down) about the middle of the picture
//!  middle drag              turn and tilt about the ground grabbed
//!  wheel                    zoom at the cursor; in fly mode: speed
//!  double click             zoom in at the cursor; with Shift out
//!  arrows                   pan; with Shift turn and tilt
//!  + −                      zoom by a level; with Shift by two
//!  W A S D, Q E             fly mode: ahead, left, back, right, down, up; with Shift fast
//! ```
//!
//! What is otherwise than in `MapLibre`: there is no box zoom (Shift and drag pans), and touch has no gestures. A notch of
//! the wheel is a third of a level, whatever the system says of its size, where `MapLibre` takes about a sixth. + and −
//! zoom by whole levels, and not to the next whole one: without a fixed tiling of the screen none is special. A double
//! click acts when the button goes down for the second time. One may tilt to 85°, there usually to 60°. The ground
//! grabbed is on the terrain, in a drag as in a zoom; the middle button is our own.
//!
//! Nothing here knows a window, a tile or a clock: times are handed in, ground is asked of a [`KnownGround`]. All positions
//! are in world space: the working CRS, heights times the vertical scale.

mod flying;
mod input;
mod navigator;
mod view;

pub use self::{
    input::{Button, Input, Key, KeyState, Modifiers},
    navigator::{Inertia, Limits, Mode, Navigator},
    view::{KnownGround, View},
};
