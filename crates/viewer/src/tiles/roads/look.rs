use corniche_roads::{Form, RoadAttributes, Structure};

/// The places along a line from which dashes are counted are this many metres apart, so that f32 is precise enough between
/// them. A power of two, as the dashes are.
const DASH_ANCHOR_M: f64 = 65_536.0;

/// What a road is, as far as it changes how it is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum RoadLook {
    /// As its class is.
    #[default]
    Plain,
    /// A slip road: narrower, without the bands that take less than half of the width.
    Link,
    /// Under the ground: pale, with a dashed edge, and hidden by every road that is not.
    Tunnel,
}

impl RoadLook {
    /// What the tags of a way say.
    #[must_use]
    pub fn of(attributes: &RoadAttributes) -> Self {
        if attributes.structure == Structure::Tunnel {
            Self::Tunnel
        } else if attributes.form == Form::Link {
            Self::Link
        } else {
            Self::Plain
        }
    }

    /// Its number in shaders: `PLAIN`, `LINK`, `TUNNEL` in `shaders/common.wgsl`.
    pub(crate) fn number(self) -> u32 {
        match self {
            Self::Plain => 0,
            Self::Link => 1,
            Self::Tunnel => 2,
        }
    }
}

/// How far the start of a segment in plan is along its direction, counted from the CRS's zero in whole lengths of
/// [`DASH_ANCHOR_M`]. So the dashes of a tunnel are at the same places in every tile and by both methods, wherever these cut
/// the line. At a bend they begin anew.
pub(crate) fn dash_m([start, end]: [[f64; 2]; 2]) -> f32 {
    let [dx, dy] = [end[0] - start[0], end[1] - start[1]];
    let length_m = dx.hypot(dy);
    if length_m == 0.0 {
        return 0.0;
    }
    ((start[0] * dx + start[1] * dy) / length_m).rem_euclid(DASH_ANCHOR_M) as f32
}

#[cfg(test)]
#[path = "look_tests.rs"]
mod tests;
