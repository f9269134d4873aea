//! Rounds the corners of lines.

use glam::DVec2;

use super::document::{DocumentLine, DrawnPoint};

/// The largest number of new points between two neighbours.
const MOST_PIECES: usize = 8;
/// The largest number of points of a smoothed line.
const MOST_POINTS: usize = 1 << 20;

/// The reason why a line was not changed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub(crate) enum Unchanged {
    /// No point of a line is selected.
    #[error("select a line first: click one of its points")]
    NothingPicked,
    /// The line has fewer than three different points.
    #[error("the line needs at least three points")]
    FewPoints,
    /// The result would have far more points than a user draws.
    #[error("the line has more than {most} points")]
    ManyPoints {
        /// The largest number of points that can be smoothed.
        most: usize,
    },
}

/// The points of a curve through all points of a line, or around an area.
///
/// Existing points stay, and new ones are inserted between them: a centripetal Catmull-Rom spline,
/// which makes no loops and no cusps within a piece.
///
/// Source: Yuksel, Schaefer & Keyser 2011, *Parameterization and applications of Catmull-Rom
/// curves*, Computer-Aided Design 43.
pub(crate) fn smoothed(
    line: &DocumentLine,
    place: impl Fn([f64; 2]) -> DrawnPoint,
) -> Result<Vec<DrawnPoint>, Unchanged> {
    let bits = |point: &DrawnPoint| point.at_m.map(f64::to_bits);
    let mut points = line.points.clone();
    points.dedup_by_key(|point| bits(point));
    if line.is_area && points.len() > 1 && points.first().map(bits) == points.last().map(bits) {
        points.pop();
    }
    let count = points.len();
    if count < 3 {
        return Err(Unchanged::FewPoints);
    }
    if count * MOST_PIECES > MOST_POINTS {
        return Err(Unchanged::ManyPoints { most: MOST_POINTS / MOST_PIECES });
    }
    let at = |index: usize| DVec2::from_array(points[index % count].at_m);
    // Beyond the ends of a line, the neighbours of the ends are mirrored at them.
    let before = |index: usize| match index {
        0 if line.is_area => at(count - 1),
        0 => 2.0 * at(0) - at(1),
        _ => at(index - 1),
    };
    let after = |index: usize| {
        if line.is_area || index + 2 < count {
            at(index + 2)
        } else {
            2.0 * at(count - 1) - at(count - 2)
        }
    };
    let segments = if line.is_area { count } else { count - 1 };
    let mut curve = Vec::with_capacity(segments * MOST_PIECES + 1);
    for (index, point) in points.iter().enumerate().take(segments) {
        curve.push(*point);
        let corners = [before(index), at(index), at(index + 1), after(index)];
        let between = (1..MOST_PIECES).map(|piece| piece as f64 / MOST_PIECES as f64);
        curve.extend(between.map(|share| place(on_curve(corners, share).to_array())));
    }
    if !line.is_area {
        curve.push(points[count - 1]);
    }
    Ok(curve)
}

/// The position on the curve between the second and the third of four corners (Barry & Goldman
/// 1988, *A recursive evaluation algorithm for a class of Catmull-Rom splines*, Computer Graphics
/// 22).
fn on_curve([a, b, c, d]: [DVec2; 4], share: f64) -> DVec2 {
    // Centripetal: parameters grow with the square roots of distances.
    let step = |from: DVec2, to: DVec2| from.distance(to).sqrt().max(1e-6);
    let (at_b, at_c) = (step(a, b), step(a, b) + step(b, c));
    let at_d = at_c + step(c, d);
    let at = at_b + share * (at_c - at_b);
    let mix = |from: DVec2, to: DVec2, first: f64, last: f64| {
        from + (to - from) * ((at - first) / (last - first))
    };
    let (ab, bc, cd) = (mix(a, b, 0.0, at_b), mix(b, c, at_b, at_c), mix(c, d, at_c, at_d));
    mix(mix(ab, bc, 0.0, at_c), mix(bc, cd, at_b, at_d), at_b, at_c)
}

#[cfg(test)]
#[path = "smooth_tests.rs"]
mod tests;
