//! Two fingers on a touch screen: they zoom and turn, or they tilt.

use glam::{DVec2, DVec3};

/// Two fingers that move less than this have not said yet what they want.
const DECIDE_POINTS: f64 = 6.0;
/// Fingers that tilt move at least so much more up or down than sideways, and both alike.
const UPRIGHT: f64 = 1.5;
/// Fingers nearer than this to each other tell no direction.
const LEAST_APART_PX: f64 = 1.0;

/// What two fingers do.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Meaning {
    Undecided,
    Pinch,
    Tilt,
}

/// What a movement of the fingers asks for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Step {
    /// Nothing yet.
    None,
    /// Tilt: so many points downwards on the screen.
    Tilt { points: f64 },
    /// Zoom in by these levels and turn what is seen clockwise; what was grabbed comes between the fingers.
    Pinch { levels: f64, clockwise_deg: f64, between_px: DVec2 },
}

/// Two fingers that touch the map.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Fingers {
    /// The ground that was grabbed between them, world metres.
    pub(crate) anchor: DVec3,
    meaning: Meaning,
    /// Where they were when the last step was taken.
    at_px: [DVec2; 2],
}

impl Fingers {
    /// Fingers that touch the map now.
    pub(crate) fn begin(anchor: DVec3, at_px: [DVec2; 2]) -> Self {
        Self { anchor, meaning: Meaning::Undecided, at_px }
    }

    /// The fingers are elsewhere.
    pub(crate) fn move_to(&mut self, at_px: [DVec2; 2], pixels_per_point: f64) -> Step {
        let moved = [0, 1].map(|finger| (at_px[finger] - self.at_px[finger]) / pixels_per_point);
        if self.meaning == Meaning::Undecided {
            self.meaning = meaning(moved);
        }
        match self.meaning {
            Meaning::Undecided => Step::None,
            Meaning::Tilt => {
                self.at_px = at_px;
                Step::Tilt { points: f64::midpoint(moved[0].y, moved[1].y) }
            }
            Meaning::Pinch => {
                let before = self.at_px[1] - self.at_px[0];
                let now = at_px[1] - at_px[0];
                self.at_px = at_px;
                let between_px = at_px[0].midpoint(at_px[1]);
                if before.length() < LEAST_APART_PX || now.length() < LEAST_APART_PX {
                    return Step::Pinch { levels: 0.0, clockwise_deg: 0.0, between_px };
                }
                // y grows downwards, so angles grow clockwise.
                Step::Pinch {
                    levels: libm::log2(now.length() / before.length()),
                    clockwise_deg: before.angle_to(now).to_degrees(),
                    between_px,
                }
            }
        }
    }
}

/// What fingers mean that moved so far, in points.
fn meaning([a, b]: [DVec2; 2]) -> Meaning {
    if a.length().max(b.length()) < DECIDE_POINTS {
        return Meaning::Undecided;
    }
    let is_upright = |moved: DVec2| moved.y.abs() > UPRIGHT * moved.x.abs();
    // One finger is reported before the other: the second one decides whether both go the same way.
    if is_upright(a) && is_upright(b) && a.y * b.y > 0.0 {
        return Meaning::Tilt;
    }
    let has_one_rested = a.length().min(b.length()) < 1.0;
    if has_one_rested && a.length().max(b.length()) < 2.0 * DECIDE_POINTS {
        return Meaning::Undecided;
    }
    Meaning::Pinch
}

#[cfg(test)]
#[path = "fingers_tests.rs"]
mod tests;
