//! Gestures of two fingers on a touch screen: they zoom and rotate, or they tilt.

use glam::{DVec2, DVec3};

/// Below this movement, the gesture of two fingers is still undecided.
const DECIDE_POINTS: f64 = 6.0;
/// Fingers that tilt both move in the same direction, and at least this many times more up or down
/// than sideways.
const UPRIGHT: f64 = 1.5;
/// Fingers nearer to each other than this define no direction.
const LEAST_APART_PX: f64 = 1.0;

/// The meaning of a gesture of two fingers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Meaning {
    Undecided,
    Pinch,
    Tilt,
}

/// The step that a movement of the fingers requests.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum FingerStep {
    /// Nothing yet.
    None,
    /// Tilt: the movement downwards on the screen, in points.
    Tilt { points: f64 },
    /// Zoom in by these levels and rotate the map clockwise; the grabbed ground moves to the middle
    /// between the fingers.
    Pinch { levels: f64, clockwise_deg: f64, between_px: DVec2 },
}

/// Two fingers that touch the map.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Fingers {
    /// The ground grabbed between the fingers, in world metres.
    pub(crate) anchor: DVec3,
    meaning: Meaning,
    /// The positions of the fingers at the last step.
    at_px: [DVec2; 2],
}

impl Fingers {
    /// Starts a gesture: two fingers touch the map.
    pub(crate) fn begin(anchor: DVec3, at_px: [DVec2; 2]) -> Self {
        Self { anchor, meaning: Meaning::Undecided, at_px }
    }

    /// Handles a movement of the fingers.
    pub(crate) fn move_to(&mut self, at_px: [DVec2; 2], pixels_per_point: f64) -> FingerStep {
        let moved = [0, 1].map(|finger| (at_px[finger] - self.at_px[finger]) / pixels_per_point);
        if self.meaning == Meaning::Undecided {
            self.meaning = meaning(moved);
        }
        match self.meaning {
            Meaning::Undecided => FingerStep::None,
            Meaning::Tilt => {
                self.at_px = at_px;
                FingerStep::Tilt { points: f64::midpoint(moved[0].y, moved[1].y) }
            }
            Meaning::Pinch => {
                let before = self.at_px[1] - self.at_px[0];
                let now = at_px[1] - at_px[0];
                self.at_px = at_px;
                let between_px = at_px[0].midpoint(at_px[1]);
                if before.length() < LEAST_APART_PX || now.length() < LEAST_APART_PX {
                    return FingerStep::Pinch { levels: 0.0, clockwise_deg: 0.0, between_px };
                }
                // y grows downwards, so angles grow clockwise.
                FingerStep::Pinch {
                    levels: libm::log2(now.length() / before.length()),
                    clockwise_deg: before.angle_to(now).to_degrees(),
                    between_px,
                }
            }
        }
    }
}

/// The meaning of the fingers' movement so far, in points.
fn meaning([a, b]: [DVec2; 2]) -> Meaning {
    if a.length().max(b.length()) < DECIDE_POINTS {
        return Meaning::Undecided;
    }
    let is_upright = |moved: DVec2| moved.y.abs() > UPRIGHT * moved.x.abs();
    // The system reports one finger before the other: only the second one decides whether both move
    // the same way.
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
